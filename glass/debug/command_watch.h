// What the debugger is told of commands that write memory without shaders.
#pragma once

#include <cstddef>
#include <cstdint>

#include "glass/finding.h"

namespace vitrine::glass::debug {

class CommandWatch {
 public:
  virtual ~CommandWatch() = default;
  /// A command has written these bytes. The thread that replays calls it.
  virtual void wrote(const std::byte* first, std::uint64_t size, const Address& command) = 0;
};

/// Of this process; null: nobody debugs.
CommandWatch* command_watch();

}  // namespace vitrine::glass::debug

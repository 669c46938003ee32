// Which bytes of shared memory the invocations of a workgroup have written so far.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <vector>

#include "glass/sanitize/reporter.h"

namespace vitrine::glass::sanitize {

/// Of one workgroup at a time: one thread runs its waves one after the other.
class SharedShadow {
 public:
  void begin(const spirv::Wave& wave);
  void write(std::uint32_t offset, std::uint32_t bytes);
  bool written(std::uint32_t offset, std::uint32_t bytes) const;

 private:
  std::vector<std::uint8_t> written_;  ///< a byte each
};

/// Those of one program: one for each memory that threads keep for workgroups.
class SharedShadows {
 public:
  /// That of the wave's workgroup, which begins with its first wave. Null: the wave has no shared memory.
  SharedShadow* of(const spirv::Wave& wave, const spirv::Instruction* start);

 private:
  std::mutex mutex_;
  std::map<const std::byte*, SharedShadow> shadows_;
};

}  // namespace vitrine::glass::sanitize

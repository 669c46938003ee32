// Which parts of variables the invocations of a wave have written so far, and which values depend on the others.
#pragma once

#include <map>
#include <mutex>
#include <vector>

#include "glass/sanitize/reporter.h"

namespace vitrine::glass::sanitize {

/// Of one wave: by cell and by slot (spirv/probe.h) the lanes.
struct VariableShadow {
  std::vector<base::LaneMask> written;    ///< by cell
  std::vector<base::LaneMask> undefined;  ///< by slot

  void begin(std::uint32_t cells, std::uint32_t slots);
};

/// Those of one program.
class VariableShadows {
 public:
  explicit VariableShadows(const spirv::Program& program);
  /// That of a wave, which begins at the program's start. Null: all variables have been written where they are read.
  VariableShadow* of(const spirv::Wave& wave, const spirv::Instruction* start);

 private:
  std::uint32_t cells_ = 0, slots_ = 0;
  std::mutex mutex_;
  std::map<const spirv::Wave*, VariableShadow> shadows_;
};

}  // namespace vitrine::glass::sanitize

// From an instruction that is about to run to the words that its lanes touch.
#pragma once

#include "glass/race/group.h"
#include "spirv/exec/observe.h"

namespace vitrine::glass::race {

/// Which instructions of a program can meet writes at all, given what is bound: what nothing writes is only read.
class Tracked {
 public:
  void update(const Sites& sites, const spirv::Wave& wave);
  bool operator[](std::uint32_t site) const { return tracked_[site] != 0; }

 private:
  std::vector<std::uint8_t> tracked_;
};

/// An instruction that accesses memory or an image is about to run. `who`: of lane 0, the others behind it; or, of
/// draws, `names` of all lanes.
void record_access(Group& group, const Tracked& tracked, std::uint32_t site, const spirv::Wave& wave,
                   const spirv::Instruction* i, const spirv::InstructionNote& note, std::uint32_t first,
                   const std::uint32_t* names);

}  // namespace vitrine::glass::race

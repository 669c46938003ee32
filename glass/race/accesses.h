// From an instruction that is about to run to the words that its lanes touch.
#pragma once

#include "glass/race/group.h"
#include "spirv/exec/observe.h"

namespace vitrine::glass::race {

/// Which instructions of a program can meet writes at all, given what is bound: what nothing writes is only read.
class Tracked {
 public:
  void update(const Sites& sites, const spirv::Wave& wave);
  /// Of an instruction, Sites::kNone where it can not.
  std::uint32_t site(std::size_t instruction) const { return sites_[instruction]; }
  /// The same without shared memory.
  std::uint32_t device_site(std::size_t instruction) const { return device_sites_[instruction]; }
  /// The same of shared memory alone.
  std::uint32_t shared_site(std::size_t instruction) const { return shared_sites_[instruction]; }
  bool has_device_sites() const { return has_device_sites_; }
  /// Whether all workgroups of the command do the same to shared memory.
  bool alike() const { return alike_; }

 private:
  void find(const Sites& sites, const spirv::Wave& wave);
  std::vector<std::uint8_t> tracked_;  ///< by site
  std::vector<std::uint32_t> sites_, device_sites_, shared_sites_;
  bool has_device_sites_ = false, alike_ = false;
};

/// An instruction that accesses shared memory is about to run. Whether that need not be recorded: the workgroup follows
/// another one, or it has been written down.
bool skip_shared(Group& group, std::uint32_t site, const spirv::Wave& wave, const spirv::Instruction* i,
                 const spirv::InstructionNote& note, std::uint32_t first);

/// An instruction that accesses memory or an image, for which skip_shared() says no if that is shared, is about to run.
void record_access(Group& group, std::uint32_t site, const spirv::Wave& wave, const spirv::Instruction* i,
                   const spirv::InstructionNote& note, const WaveNames& names);

}  // namespace vitrine::glass::race

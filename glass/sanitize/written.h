// Checks that what shaders read of buffers and images has been written, and tells the shadow what they write.
#pragma once

#include <vector>

#include "glass/sanitize/unwritten.h"

namespace vitrine::glass::sanitize {

/// Of one run of a wave.
class WrittenCheck {
 public:
  /// `reads`: where what is found waits; null: nothing is checked.
  WrittenCheck(Reporter& reporter, UnwrittenReads* reads) : reporter_(reporter), reads_(reads) {}

  /// An instruction that accesses memory or an image is about to run.
  void access(const spirv::Wave& wave, const spirv::Instruction* i, const spirv::InstructionNote& note);

 private:
  friend class WrittenAccess;

  /// What a lane of this run has read before anything had written it: if it writes the same bytes, their value still
  /// depends on nothing.
  struct OwnRead {
    std::size_t lane;
    std::uintptr_t address;
    std::uint32_t bytes;
  };

  Reporter& reporter_;
  UnwrittenReads* const reads_;
  std::vector<OwnRead> own_;
};

}  // namespace vitrine::glass::sanitize

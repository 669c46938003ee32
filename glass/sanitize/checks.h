// The checks of the sanitizer, one file each.
#pragma once

#include "glass/sanitize/reporter.h"

namespace vitrine::glass::sanitize {

/// An instruction that accesses memory is about to run: outside of what it may access? (memory.cpp)
void check_memory(Reporter& reporter, const spirv::Wave& wave, const spirv::Instruction* i,
                  const spirv::InstructionNote& note);

}  // namespace vitrine::glass::sanitize

// Runs of observed shaders that can be left out, because who observes them is told nothing of what they compute.
#pragma once

#include <cstdint>

#include "base/lanes.h"

namespace vitrine::spirv {

class BoundShader;

/// Whether who observes the shader is told the same by count_runs() as by WaveRunner::run(): which lanes begin, and
/// nothing else. False: nobody does.
bool is_counted(const BoundShader& shader);

/// The same for WaveRunner::is_constant(): whether the shader does nothing but to be counted, and output `reg` is the
/// same in all lanes. is_counted() only.
bool is_counted_constant(const BoundShader& shader, std::uint32_t reg);

/// Tells of `times` runs that are left out. is_counted() only.
void count_runs(const BoundShader& shader, base::LaneMask active, base::LaneMask helpers, std::uint64_t times);

}  // namespace vitrine::spirv

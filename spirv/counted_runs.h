// Runs of observed shaders that can be left out, because who observes them is told nothing of what they compute.
#pragma once

#include <cstdint>

#include "base/lanes.h"

namespace vitrine::spirv {

class BoundShader;

/// Whether who observes the shader is told the same by count_run() as by WaveRunner::run(): which lanes begin, and
/// nothing else. False: nobody does.
bool is_counted(const BoundShader& shader);

/// The same for WaveRunner::is_constant(): whether the shader does nothing but to be counted, and output `reg` is the
/// same in all lanes. is_counted() only.
bool is_counted_constant(const BoundShader& shader, std::uint32_t reg);

/// Tells of a run that is left out. is_counted() only.
void count_run(const BoundShader& shader, base::LaneMask active, base::LaneMask helpers);

}  // namespace vitrine::spirv

// The vector paths of the sampler: two-dimensional images and arrays, the formats and filters that matter.
#pragma once

#include "texel/sampler/plan.h"

namespace vitrine::texel {

/// Samples a wave with SIMD if this combination has a vector path; false if not, and then nothing is written.
bool sample_wave_2d(const Plan& plan, const SampleRequest& request, base::WaveRegister result[4]);

}  // namespace vitrine::texel

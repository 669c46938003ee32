// The vector path of reads by integer coordinates.
#pragma once

#include "texel/sampler.h"

namespace vitrine::texel {

/// fetch() with SIMD for two-dimensional single-sampled views; false if there is no vector path, and then nothing is
/// written.
bool fetch_wave(const ImageView& view, const FetchRequest& request, base::WaveRegister result[4]);

/// fetch_buffer() with SIMD for texels of whole words.
bool fetch_buffer_wave(const BufferTexelView& view, base::LaneMask active, const base::WaveRegister& index,
                       base::WaveRegister result[4]);

}  // namespace vitrine::texel

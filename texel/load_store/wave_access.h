// The vector paths of reads and writes by integer coordinates: the twins of fetch, fetch_buffer, store and
// store_buffer. False if there is none for the view, and then nothing is written.
#pragma once

#include "texel/sampler.h"

namespace vitrine::texel {

/// Plain single texels whose places fit 31 bits.
bool offsets_fit(const ImageView& view);
bool offsets_fit(const BufferTexelView& view);

bool fetch_wave(const ImageView& view, const FetchRequest& request, const SampleResult& result);
bool fetch_buffer_wave(const BufferTexelView& view, base::LaneMask active, const base::WaveRegister& index,
                       const SampleResult& result);

bool store_wave(const ImageView& view, const FetchRequest& request, const StoredValue& value);
bool store_buffer_wave(const BufferTexelView& view, base::LaneMask active, const base::WaveRegister& index,
                       const StoredValue& value);

}  // namespace vitrine::texel

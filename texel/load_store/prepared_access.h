// Makes reads and writes by integer coordinates ready.
#pragma once

#include "texel/load_store/prepared.h"

namespace vitrine::texel {

/// Not ready where there is no vector path for the view, or its texels are not in one level or moved by offsets.
PreparedFetch prepare_fetch(const ImageView& view, const FetchRequest& request, const SampleResult& result);
PreparedFetch prepare_fetch(const BufferTexelView& view, const base::WaveRegister& index, const SampleResult& result);
PreparedStore prepare_store(const ImageView& view, const FetchRequest& request, const StoredValue& value);
PreparedStore prepare_store(const BufferTexelView& view, const base::WaveRegister& index, const StoredValue& value);

/// Only the conversion of a fetch from texels that are not in one level: without a grid; null where there is no vector
/// path.
PreparedFetch prepare_conversion(const ImageView& view, const SampleResult& result);

}  // namespace vitrine::texel

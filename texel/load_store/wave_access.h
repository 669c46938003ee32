// The vector paths of reads and writes by integer coordinates: the parts that they are made of. Null where the formats
// are such that there is none.
#pragma once

#include "texel/load_store/prepared.h"

namespace vitrine::texel {

PreparedFetch::Convert field_conversion(const FormatDesc& format);
PreparedStore::Encode field_encoder(const FormatDesc& format);

/// Of plain formats.
PreparedFetch::Load texel_load(const FormatDesc& format);
PreparedStore::Store texel_store(const FormatDesc& format);

/// The words of the texels of any request; those of what lies outside, and of lanes that are not active, are 0. The
/// view is that of a plain format whose places fit 31 bits.
void load_levels(const ImageView& view, const FetchRequest& request, base::WaveRegister words[4]);

}  // namespace vitrine::texel

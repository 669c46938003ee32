// Texels of four bytes, one a channel, in any order: who has them, and where the channels lie.
#pragma once

#include <cstddef>

#include "raster/output/color_writer.h"

namespace vitrine::raster {

/// Four UNORM bytes, in any order.
bool is_four_bytes(const texel::FormatDesc& format);
/// The same with sRGB colours.
bool is_four_srgb_bytes(const texel::FormatDesc& format);

/// Fills in pack_places and alpha_places for such a format.
void set_byte_places(ColorWriter& writer);

/// Position of a component's byte in the texel of such a format, bits.
inline int shift_of(const ColorWriter& writer, std::size_t component) {
  return writer.format->channel[static_cast<std::size_t>(writer.format->rgba[component])].offset;
}

}  // namespace vitrine::raster

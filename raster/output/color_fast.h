// What the fast colour functions share with the code that picks them.
#pragma once

#include "raster/output/color.h"

namespace vitrine::raster {

/// Colour functions of the SIMD target in use for targets of four 8-bit UNORM channels.
struct ByteColorFunctions {
  ColorFunction store, blend;
  ColorFunction store_srgb, blend_srgb;  ///< three of them sRGB
};
ByteColorFunctions byte_color_functions();

/// The colour function for channels of 16-bit floats or 32-bit words that lie in the order R, G, B, A, or null
/// (color_floats.cpp).
ColorFunction float_color_function(const ColorWriter& writer);

/// Four UNORM bytes, in any order.
bool is_four_bytes(const texel::FormatDesc& format);
/// The same with sRGB colours.
bool is_four_srgb_bytes(const texel::FormatDesc& format);
/// Whether a blend factor is a dual-source one.
bool reads_second_source(const ColorWriter& writer);

/// Fills in pack_places and alpha_places for such a format.
void set_byte_places(ColorWriter& writer);

/// Position of a component's byte in the texel of such a format, bits.
inline int shift_of(const ColorWriter& writer, std::size_t component) {
  return writer.format->channel[static_cast<std::size_t>(writer.format->rgba[component])].offset;
}

/// Lanes of a set of quads (bit q = quad q).
constexpr base::LaneMask lanes_of(std::uint32_t quads) {
  base::LaneMask lanes = 0;
  for (; quads; quads &= quads - 1) lanes |= base::LaneMask{0xf} << (4 * std::countr_zero(quads));
  return lanes;
}

/// Splits a wave's quads so that no pass meets a pixel twice: calls pass(quad mask: bit q = quad q) in lane order.
/// Quads are compared modulo 64 pixels, which at worst makes a pass more than needed.
template <class F>
inline void for_each_pass(const ColorWave& wave, F&& pass) {
  std::uint32_t left = 0;
  for (std::size_t q = 0; q < base::kQuadsPerWave; ++q) {
    if (wave.mask >> (4 * q) & 0xf) left |= 1u << q;
  }
  while (left) {
    std::uint64_t seen[16] = {};
    std::uint32_t now = 0;
    for (std::uint32_t rest = left; rest; rest &= rest - 1) {
      const auto q = static_cast<std::size_t>(std::countr_zero(rest));
      const std::size_t row = (wave.quads->y[q] >> 1) & 31, column = (wave.quads->x[q] >> 1) & 31;
      std::uint64_t& word = seen[row >> 1];
      const std::uint64_t bit = std::uint64_t{1} << ((row & 1) * 32 + column);
      // A later quad on this pixel waits, and so do the ones after it there: `seen` keeps their bit.
      if (!(word & bit)) now |= 1u << q;
      word |= bit;
    }
    pass(now);
    left &= ~now;
  }
}

}  // namespace vitrine::raster

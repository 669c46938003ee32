// Waves whose quads may lie on the same pixels, cut so that loads and stores of whole waves keep the order of the
// lanes.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "raster/output/color_writer.h"

namespace vitrine::raster {

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

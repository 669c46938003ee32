// Placement of points along a side.
#include "raster/front/stages/tessellator_side.h"

#include <bit>

namespace vitrine::raster {
namespace {

Fixed floor_of(Fixed value) { return value & 0x7fff0000u; }
Fixed ceil_of(Fixed value) { return (value & 0xffffu) != 0 ? floor_of(value) + kFixedOne : value; }

/// round(2^16 / n).
Fixed reciprocal(std::uint32_t n) { return (kFixedOne + n / 2) / n; }

std::uint32_t without_top_bit(std::uint32_t value) { return value == 0 ? 0 : value & ~std::bit_floor(value); }

}  // namespace

Side make_side(Fixed level, bool odd) {
  const Fixed half_level = (level + 1) / 2;
  Side side;
  side.odd = odd;
  side.count = odd ? ceil_of(kFixedHalf + half_level) * 2 >> 16 : (ceil_of(half_level) * 2 >> 16) + 1;
  // A level of 1 counts as even where the domain needs a middle.
  const Fixed half = half_level + (odd || half_level == kFixedHalf ? kFixedHalf : 0);
  const Fixed low = floor_of(half), high = ceil_of(half);
  side.fraction = half - low;
  side.half = high >> 16;
  if (low == high)
    side.split = side.half + 1;  // none
  else if (odd && low == kFixedOne)
    side.split = 0;
  else
    side.split = without_top_bit((low >> 16) - (odd ? 1 : 0)) * 2 + 1;
  const std::uint32_t less = odd ? 1 : 0;
  side.inverse_low = reciprocal((low * 2 >> 16) - less);
  side.inverse_high = reciprocal((high * 2 >> 16) - less);
  return side;
}

Fixed Side::place(std::uint32_t i) const {
  const bool mirrored = i >= half;
  if (mirrored) i = 2 * half - i - (odd ? 1 : 0);
  if (i == half) return kFixedHalf;
  const Fixed low = (i > split ? i - 1 : i) * inverse_low, high = i * inverse_high;
  const Fixed at = (low * (kFixedOne - fraction) + high * fraction + kFixedHalf) >> 16;
  return mirrored ? kFixedOne - at : at;
}

std::uint32_t ruler_rank(std::uint32_t i) {
  if (i == 0) return 0;
  if (i == 1) return 32;
  const auto zeros = static_cast<std::uint32_t>(std::countr_zero(i - 1));
  return (16u >> zeros) + ((i - 1) >> (zeros + 1));
}

}  // namespace vitrine::raster

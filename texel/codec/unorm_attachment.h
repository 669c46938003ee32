// Rounding of normalised colour attachments (lavapipe-texture-blend.md part D): values to bytes or words, and what
// channels of fewer bits keep of those. Encoding and blending share it.
#pragma once

#include <algorithm>
#include <cstdint>

#include "base/numeric.h"

namespace vitrine::texel {

/// MIN(1, x) * 255 to nearest even, saturated; NaN and negative numbers are 0.
inline std::uint32_t unorm8_attachment(float x) {
  return static_cast<std::uint32_t>(std::clamp(base::round_to_int(base::min_second(1.0f, x) * 255.0f), 0, 255));
}

/// Clamped to [0, 1], scaled by an addition that leaves the integer in the low mantissa bits; NaN is 0.
inline std::uint32_t unorm16_attachment(float x) {
  const float clamped = base::min_second(base::max_second(x, 0.0f), 1.0f);
  return base::bits_of(clamped * (65535.0f / 65536.0f) + 128.0f) & 0xffff;
}

/// What a channel of `bits` <= 8 keeps of a byte: the high bits, but 4-bit channels round.
inline std::uint32_t narrow_unorm8(std::uint32_t value, std::uint32_t bits) {
  if (bits == 4) {
    return base::bits_of(static_cast<float>(value) * (1.0f / 255.0f) * (15.0f / 16.0f) + 524288.0f) & 15;
  }
  return value >> (8 - bits);
}

/// What a channel of `bits` <= 16 keeps of a word: the high bits, but 2-bit channels round.
inline std::uint32_t narrow_unorm16(std::uint32_t value, std::uint32_t bits) {
  return bits == 2 ? (((value >> 2) * 3 + 8192) >> 14) & 3 : value >> (16 - bits);
}

}  // namespace vitrine::texel

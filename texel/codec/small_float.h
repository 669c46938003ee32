// Unsigned 11- and 10-bit floats and the shared-exponent format: conversions to and from binary32.
#pragma once

#include <algorithm>
#include <cstdint>

#include "base/numeric.h"

namespace vitrine::texel {

/// Exact value of an unsigned float with a 5-bit exponent (bias 15) above `mantissa_bits` (6 or 5) bits.
inline float decode_small_float(std::uint32_t bits, int mantissa_bits) {
  return base::half_to_float(static_cast<std::uint16_t>(bits << (10 - mantissa_bits)));
}

/// The part of the encoders that all agree on: NaN and infinities. True if `out` is final.
inline bool encode_small_special(float value, int mantissa_bits, std::uint32_t nan_mantissa, std::uint32_t& out) {
  const std::uint32_t bits = base::bits_of(value);
  const std::uint32_t infinity = 31u << mantissa_bits;
  if ((bits & 0x7fffffffu) > 0x7f800000u) {
    out = infinity | nan_mantissa;
  } else if (bits == 0x7f800000u) {
    out = infinity;
  } else if (!(value > 0.0f)) {
    out = 0;
  } else {
    return false;
  }
  return true;
}

/// Truncation, denormals produced: colour attachments and imageStore (lavapipe-texture-blend.md part D). The largest
/// finite value is the limit.
inline std::uint32_t encode_small_float(float value, int mantissa_bits) {
  std::uint32_t out = 0;
  if (encode_small_special(value, mantissa_bits, 1u << (mantissa_bits - 1), out)) return out;
  const std::uint32_t bits = base::bits_of(value);
  const int drop = 23 - mantissa_bits;
  const std::int32_t exponent = static_cast<std::int32_t>(bits >> 23) - 112;
  const std::uint32_t largest = (31u << mantissa_bits) - 1;
  if (exponent >= 31) return largest;
  if (exponent >= 1) return (bits - (112u << 23)) >> drop;
  const int shift = drop + 1 - exponent;
  return shift > 24 ? 0 : ((bits & 0x7fffffu) | 0x800000u) >> shift;
}

/// As clears do it: truncation, results below 2^-14 become 0 (lavapipe-rasterization.md 11.1).
inline std::uint32_t encode_small_float_clear(float value, int mantissa_bits) {
  std::uint32_t out = 0;
  if (encode_small_special(value, mantissa_bits, 1, out)) return out;
  return value < 6.103515625e-05f ? 0 : encode_small_float(value, mantissa_bits);
}

/// R, G, B of E5B9G9R9: exact.
inline void decode_shared_exponent(std::uint32_t word, float rgb[3]) {
  const float scale = base::float_of(((word >> 27) + 127 - 24) << 23);
  for (int i = 0; i < 3; ++i) rgb[i] = static_cast<float>((word >> (9 * i)) & 511u) * scale;
}

/// E5B9G9R9 of R, G, B (Vulkan 1.3.239, "RGB to Shared Exponent Conversion"): mantissas round to nearest, half up.
inline std::uint32_t encode_shared_exponent(const float rgb[3]) {
  constexpr float kLargest = 65408.0f;  // (511 / 512) * 2^16
  float clamped[3];
  for (int i = 0; i < 3; ++i) clamped[i] = rgb[i] > 0.0f ? std::min(rgb[i], kLargest) : 0.0f;
  const float top = std::max({clamped[0], clamped[1], clamped[2]});
  // Rounding the largest one's mantissa to 9 bits may carry into the exponent.
  const std::uint32_t rounded = base::bits_of(top) + (base::bits_of(top) & (1u << 14));
  const std::int32_t exponent = std::max(static_cast<std::int32_t>(rounded >> 23) - 127, -16) + 16;
  const float scale = base::float_of(static_cast<std::uint32_t>(127 + 24 - exponent) << 23);
  std::uint32_t word = static_cast<std::uint32_t>(exponent) << 27;
  for (int i = 0; i < 3; ++i) {
    const auto doubled = static_cast<std::uint32_t>(clamped[i] * (2.0f * scale));
    word |= ((doubled >> 1) + (doubled & 1)) << (9 * i);
  }
  return word;
}

}  // namespace vitrine::texel

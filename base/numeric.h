// Scalar conversions between number types: the only place where rounding is defined. Vector twins in the rooms must
// give the same bits (tests compare them).
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#if defined(__clang__) && defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace vitrine::base {

inline std::uint32_t bits_of(float value) { return std::bit_cast<std::uint32_t>(value); }
inline float float_of(std::uint32_t bits) { return std::bit_cast<float>(bits); }

/// CVTPS2DQ: round to nearest even; NaN and out of range give 0x80000000 (lavapipe-rasterization.md section 0, rne).
inline std::int32_t round_to_int(float value) {
  if (!(value >= -2147483648.0f && value < 2147483648.0f)) return INT32_MIN;
  return static_cast<std::int32_t>(std::nearbyintf(value));
}

/// CVTTPS2DQ: truncate; NaN and out of range give 0x80000000.
inline std::int32_t truncate_to_int(float value) {
  if (!(value >= -2147483648.0f && value < 2147483648.0f)) return INT32_MIN;
  return static_cast<std::int32_t>(value);
}

/// VCVTTPS2UDQ: truncate; NaN, values <= -1 and >= 2^32 give 0xFFFFFFFF (lavapipe-shader-math.md 7.1).
inline std::uint32_t truncate_to_uint(float value) {
  if (!(value > -1.0f && value < 4294967296.0f)) return UINT32_MAX;
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(value));
}

/// Round half away from zero, by adding 0.5 in binary32 and truncating (lavapipe-rasterization.md section 0, iround).
inline std::int32_t round_half_away(float value) {
  return truncate_to_int(value >= 0.0f ? value + 0.5f : value - 0.5f);
}

/// MINPS / MAXPS: the second operand when the operands are equal or unordered. GCC makes one instruction of the choice,
/// clang at times a comparison and a move, which keeps a denormal that the instruction flushes.
#if defined(__clang__) && defined(__SSE__)
inline float min_second(float a, float b) { return _mm_cvtss_f32(_mm_min_ss(_mm_set_ss(a), _mm_set_ss(b))); }
inline float max_second(float a, float b) { return _mm_cvtss_f32(_mm_max_ss(_mm_set_ss(a), _mm_set_ss(b))); }
#else
inline float min_second(float a, float b) { return a < b ? a : b; }
inline float max_second(float a, float b) { return a > b ? a : b; }
#endif

/// fma(a, b, c) with one rounding, also at compile time and where the CPU has no such instruction: the product is exact
/// in binary64, and its sum with c is rounded to odd there, so that the rounding to binary32 is the only visible one.
constexpr float fma_exact(float a, float b, float c) {
  const double product = static_cast<double>(a) * static_cast<double>(b);
  const double addend = static_cast<double>(c);
  const double sum = product + addend;
  const double product_share = sum - addend;
  const double addend_share = sum - product_share;
  const double error = (product - product_share) + (addend - addend_share);
  std::uint64_t bits = std::bit_cast<std::uint64_t>(sum);
  if ((error < 0.0 || error > 0.0) && (bits & 1) == 0) {
    const bool toward_zero = (error < 0.0) != (sum < 0.0);
    bits += toward_zero ? ~std::uint64_t{0} : std::uint64_t{1};
  }
  return static_cast<float>(std::bit_cast<double>(bits));
}

/// binary16 bits to binary32, exact, denormals included, independent of the floating-point mode.
float half_to_float(std::uint16_t half);
/// Round to nearest even; overflow to infinity; NaN becomes sign|0x7E00 (lavapipe-shader-math.md section 8).
std::uint16_t float_to_half_nearest(float value);
/// Truncate toward zero; finite overflow to 65504; infinities and NaN kept (lavapipe-texture-blend.md part D).
std::uint16_t float_to_half_truncate(float value);

}  // namespace vitrine::base

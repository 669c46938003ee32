// binary16 conversions in integer arithmetic, so that the FTZ/DAZ mode cannot change them.
#include "base/numeric.h"

namespace vitrine::base {
namespace {

constexpr std::uint32_t kFloatExponentMask = 0x7f800000;
constexpr std::uint32_t kFloatMantissaMask = 0x007fffff;

/// Shared by both roundings: `round_up(kept, dropped, dropped_bits)` decides whether the magnitude grows by one unit.
template <class RoundUp>
std::uint16_t float_to_half(float value, std::uint16_t overflow, RoundUp round_up) {
  const std::uint32_t bits = bits_of(value);
  const auto sign = static_cast<std::uint16_t>((bits >> 16) & 0x8000);
  const std::uint32_t magnitude = bits & 0x7fffffff;
  if (magnitude > kFloatExponentMask) return static_cast<std::uint16_t>(sign | 0x7e00 | ((magnitude >> 13) & 0x3ff));
  if (magnitude == kFloatExponentMask) return static_cast<std::uint16_t>(sign | 0x7c00);
  const int exponent = static_cast<int>(magnitude >> 23) - 127 + 15;
  if (exponent >= 31) return static_cast<std::uint16_t>(sign | overflow);
  if (magnitude < 0x00800000) return sign;  // binary32 denormals are far below half range
  std::uint32_t mantissa = (magnitude & kFloatMantissaMask) | 0x00800000;
  int dropped_bits = 13;
  std::uint32_t base = static_cast<std::uint32_t>(exponent) << 10;
  if (exponent <= 0) {
    dropped_bits = 14 - exponent;
    if (dropped_bits > 25) return sign;
    base = 0;
  } else {
    mantissa &= kFloatMantissaMask;
  }
  const std::uint32_t kept = base + (mantissa >> dropped_bits);
  const std::uint32_t dropped = mantissa & ((std::uint32_t{1} << dropped_bits) - 1);
  const std::uint32_t rounded = kept + (round_up(kept, dropped, dropped_bits) ? 1 : 0);
  return static_cast<std::uint16_t>(sign | (rounded >= 0x7c00 ? overflow : rounded));
}

}  // namespace

float half_to_float(std::uint16_t half) {
  const std::uint32_t sign = static_cast<std::uint32_t>(half & 0x8000) << 16;
  const std::uint32_t exponent = (half >> 10) & 31;
  std::uint32_t mantissa = half & 0x3ff;
  if (exponent == 31) return float_of(sign | kFloatExponentMask | (mantissa << 13));
  if (exponent != 0) return float_of(sign | ((exponent + 112) << 23) | (mantissa << 13));
  if (mantissa == 0) return float_of(sign);
  const int shift = std::countl_zero(mantissa) - 21;  // leading one to bit 10
  mantissa = (mantissa << shift) & 0x3ff;
  return float_of(sign | (static_cast<std::uint32_t>(113 - shift) << 23) | (mantissa << 13));
}

std::uint16_t float_to_half_nearest(float value) {
  if (value != value) return static_cast<std::uint16_t>(((bits_of(value) >> 16) & 0x8000) | 0x7e00);
  return float_to_half(value, 0x7c00, [](std::uint32_t kept, std::uint32_t dropped, int dropped_bits) {
    const std::uint32_t half = std::uint32_t{1} << (dropped_bits - 1);
    return dropped > half || (dropped == half && (kept & 1) != 0);
  });
}

std::uint16_t float_to_half_truncate(float value) {
  return float_to_half(value, 0x7bff, [](std::uint32_t, std::uint32_t, int) { return false; });
}

}  // namespace vitrine::base

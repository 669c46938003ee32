// Arithmetic on single floats whose results that are not numbers have the bits of x86-64 on every CPU. The twin for
// lanes, which says more, is base/x86_arithmetic-inl.h.
#pragma once

#include <bit>
#include <cstdint>

namespace vitrine::base {

/// What x86 leaves where `result` is a NaN: the first operand that is one, made quiet, or its own NaN.
template <class... Operands>
inline float nan_of_x86(float result, [[maybe_unused]] Operands... operands) {
#ifdef __aarch64__
  if (result == result) return result;
  for (const float operand : {operands...})
    if (operand != operand) return std::bit_cast<float>(std::bit_cast<std::uint32_t>(operand) | 0x00400000u);
  return std::bit_cast<float>(0xffc00000u);
#else
  return result;
#endif
}

inline float x86_add(float a, float b) { return nan_of_x86(a + b, a, b); }
inline float x86_sub(float a, float b) { return nan_of_x86(a - b, a, b); }
inline float x86_mul(float a, float b) { return nan_of_x86(a * b, a, b); }
inline float x86_div(float a, float b) { return nan_of_x86(a / b, a, b); }

}  // namespace vitrine::base

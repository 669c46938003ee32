// Arithmetic on vectors of lanes whose results have the bits of x86-64 on every CPU. There it is the instruction.
//
// AArch64 does two things otherwise. Of operands that are NaNs it prefers signalling ones, and its own NaN of
// operations on numbers has no sign, where x86 takes the first operand that is one, and its own has a sign. And with
// denormals flushed it looks for results to flush before it rounds them, x86 afterwards: what rounds up to the smallest
// normal number is zero on AArch64. Sums are exact where they are that small.
//
// Which of two NaNs is the first of a sum or product is the compiler's choice on x86; spirv/alu/ordered-inl.h leaves it
// none. Include after <hwy/highway.h>, in a file that follows the foreach_target pattern (base/simd.h).

#include "base/simd.h"

#include <hwy/highway.h>

#include "base/lane_math-inl.h"

#if defined(VITRINE_BASE_X86_ARITHMETIC_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_BASE_X86_ARITHMETIC_INL_H_
#undef VITRINE_BASE_X86_ARITHMETIC_INL_H_
#else
#define VITRINE_BASE_X86_ARITHMETIC_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::base::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_NEON
namespace detail {

constexpr float kScale = 0x1p32f;  ///< of each factor, so that products near the smallest normal number are far from it

/// What x86 leaves in lanes where `result` is a NaN: the first operand that is one, made quiet, or its own NaN.
template <class V, class... Operands>
HWY_INLINE V nan_of_x86(V result, Operands... operands) {
  const auto lost = hn::IsNaN(result);
  if (hn::AllFalse(hn::DFromV<V>(), lost)) return result;
  const V in_order[] = {operands...};
  V nan = lanes_cast<float>(lanes_set<Rebound<std::uint32_t, V>>(0xffc00000u));
  for (std::size_t i = sizeof...(Operands); i-- > 0;) {
    const V quiet = hn::Or(in_order[i], lanes_cast<float>(lanes_set<Rebound<std::uint32_t, V>>(0x00400000u)));
    nan = hn::IfThenElse(hn::IsNaN(in_order[i]), quiet, nan);
  }
  return hn::IfThenElse(lost, nan, result);
}

/// The smallest normal number in lanes where `result` is zero because it was flushed before it would have been rounded
/// to that; `scaled()` is the same result times kScale * kScale, which needs no flushing there.
template <class V, class Scaled>
HWY_INLINE V flushed_as_on_x86(V result, Scaled scaled) {
  const hn::DFromV<V> d;
  const auto zero = hn::Eq(result, hn::Zero(d));
  if (hn::AllFalse(d, zero)) return result;
  const V large = scaled();
  const auto is_normal = hn::And(zero, hn::Eq(hn::Abs(large), hn::Set(d, 0x1p-126f * kScale * kScale)));
  return hn::IfThenElse(is_normal, hn::CopySign(hn::Set(d, 0x1p-126f), large), result);
}

template <class V>
HWY_INLINE V scaled(V v) {
  return hn::Mul(v, lanes_set<V>(kScale));
}

}  // namespace detail
#endif

/// rnd(a + b).
template <class V>
HWY_INLINE V x86_add(V a, V b) {
#if HWY_TARGET == HWY_NEON
  return detail::nan_of_x86(hn::Add(a, b), a, b);
#else
  return hn::Add(a, b);
#endif
}

/// rnd(a - b).
template <class V>
HWY_INLINE V x86_sub(V a, V b) {
#if HWY_TARGET == HWY_NEON
  return detail::nan_of_x86(hn::Sub(a, b), a, b);
#else
  return hn::Sub(a, b);
#endif
}

/// rnd(a * b).
template <class V>
HWY_INLINE V x86_mul(V a, V b) {
#if HWY_TARGET == HWY_NEON
  const V result = detail::flushed_as_on_x86(hn::Mul(a, b),
                                             [&]() HWY_ATTR { return hn::Mul(detail::scaled(a), detail::scaled(b)); });
  return detail::nan_of_x86(result, a, b);
#else
  return hn::Mul(a, b);
#endif
}

/// rnd(a / b).
template <class V>
HWY_INLINE V x86_div(V a, V b) {
#if HWY_TARGET == HWY_NEON
  const V result = detail::flushed_as_on_x86(hn::Div(a, b),
                                             [&]() HWY_ATTR { return hn::Div(detail::scaled(detail::scaled(a)), b); });
  return detail::nan_of_x86(result, a, b);
#else
  return hn::Div(a, b);
#endif
}

/// rnd(sqrt(a)).
template <class V>
HWY_INLINE V x86_sqrt(V a) {
#if HWY_TARGET == HWY_NEON
  return detail::nan_of_x86(hn::Sqrt(a), a);
#else
  return hn::Sqrt(a);
#endif
}

/// rnd(a * b + c); of several NaNs the factors' come first.
template <class V>
HWY_INLINE V x86_fma(V a, V b, V c) {
#if HWY_TARGET == HWY_NEON
  const V result = detail::flushed_as_on_x86(hn::MulAdd(a, b, c), [&]() HWY_ATTR {
    return hn::MulAdd(detail::scaled(a), detail::scaled(b), detail::scaled(detail::scaled(c)));
  });
  return detail::nan_of_x86(result, a, b, c);
#else
  return lanes_fma(a, b, c);
#endif
}

}  // namespace vitrine::base::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

// Arithmetic on vectors of lanes that must give the same bits in every SIMD target: a true FMA, conversions without
// Highway's fix-ups, lane masks as bits, binary16. Vector twins of base/numeric.h.
//
// Include after <hwy/highway.h>, in a file that follows the foreach_target pattern (base/simd.h). Nothing here depends
// on the denormal mode, except where an operation is the hardware's.

#include "base/lanes.h"
#include "base/simd.h"

#include <hwy/highway.h>

#include <cstdint>
#include <cstring>

#if defined(VITRINE_BASE_LANE_MATH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_BASE_LANE_MATH_INL_H_
#undef VITRINE_BASE_LANE_MATH_INL_H_
#else
#define VITRINE_BASE_LANE_MATH_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::base::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Vector of To with as many lanes as the vector V.
template <class To, class V>
using Rebound = hn::Vec<hn::Rebind<To, hn::DFromV<V>>>;

/// Reinterprets the bits of each lane.
template <class To, class V>
HWY_INLINE Rebound<To, V> lanes_cast(V v) {
  return hn::BitCast(hn::Rebind<To, hn::DFromV<V>>(), v);
}

/// A constant in every lane of a vector like `like`.
template <class V>
HWY_INLINE V lanes_set(hn::TFromV<V> value) {
  return hn::Set(hn::DFromV<V>(), value);
}

/// The same mask for vectors of another type of the same size.
template <class VTo, class M>
HWY_INLINE auto lanes_mask_cast(M mask) {
  return hn::RebindMask(hn::DFromV<VTo>(), mask);
}

// ---- fused multiply-add

#if HWY_TARGET == HWY_SSE4
namespace detail {

/// fma of two lanes through binary64: the product of two binary32 is exact there; the sum is rounded to odd, so that
/// the rounding to binary32 sees on which side of a tie it lies (53 >= 2*24 + 2 makes that exact).
HWY_INLINE __m128 fma_low_half(__m128 a, __m128 b, __m128 c) {
  const __m128d product = _mm_mul_pd(_mm_cvtps_pd(a), _mm_cvtps_pd(b));
  const __m128d addend = _mm_cvtps_pd(c);
  const __m128d sum = _mm_add_pd(product, addend);
  const __m128d product_share = _mm_sub_pd(sum, addend);
  const __m128d addend_share = _mm_sub_pd(sum, product_share);
  const __m128d error = _mm_add_pd(_mm_sub_pd(product, product_share), _mm_sub_pd(addend, addend_share));
  // Inexact with an even last bit: step one unit toward the exact value. NaN errors (infinite sums) compare false.
  const __m128d zero = _mm_setzero_pd();
  const __m128i inexact = _mm_castpd_si128(_mm_or_pd(_mm_cmplt_pd(error, zero), _mm_cmpgt_pd(error, zero)));
  const __m128i bits = _mm_castpd_si128(sum);
  const __m128i one = _mm_set1_epi64x(1);
  const __m128i even = _mm_andnot_si128(bits, one);
  const __m128i opposite = _mm_srli_epi64(_mm_xor_si128(_mm_castpd_si128(error), bits), 63);  // 1: toward zero
  const __m128i step = _mm_sub_epi64(one, _mm_add_epi64(opposite, opposite));                 // +1 or -1
  const __m128i apply = _mm_and_si128(inexact, _mm_cmpeq_epi64(even, one));
  return _mm_cvtpd_ps(_mm_castsi128_pd(_mm_add_epi64(bits, _mm_and_si128(step, apply))));
}

}  // namespace detail
#endif

/// fma(a, b, c) = a * b + c with one rounding, also where the CPU has no such instruction.
template <class V>
HWY_INLINE V lanes_fma(V a, V b, V c) {
#if HWY_TARGET == HWY_SSE4
  const __m128 low = detail::fma_low_half(a.raw, b.raw, c.raw);
  const __m128 high =
      detail::fma_low_half(_mm_movehl_ps(a.raw, a.raw), _mm_movehl_ps(b.raw, b.raw), _mm_movehl_ps(c.raw, c.raw));
  return V{_mm_movelh_ps(low, high)};
#else
  return hn::MulAdd(a, b, c);
#endif
}

// ---- minimum, maximum

#if HWY_TARGET == HWY_NEON
namespace detail {

/// Zero with the sign of v where v is zero, which denormals are while they are flushed: MINPS and MAXPS flush them,
/// too.
template <class V>
HWY_INLINE V flushed(V v) {
  const hn::DFromV<V> d;
  return hn::IfThenElse(hn::Eq(v, hn::Zero(d)), hn::And(v, hn::SignBit(d)), v);
}

}  // namespace detail
#endif

/// MINPS / MAXPS: the second operand when the operands are equal or unordered.
template <class V>
HWY_INLINE V lanes_min_second(V a, V b) {
#if HWY_TARGET == HWY_NEON
  return detail::flushed(hn::IfThenElse(hn::Lt(a, b), a, b));
#else
  return hn::Min(a, b);
#endif
}
template <class V>
HWY_INLINE V lanes_max_second(V a, V b) {
#if HWY_TARGET == HWY_NEON
  return detail::flushed(hn::IfThenElse(hn::Gt(a, b), a, b));
#else
  return hn::Max(a, b);
#endif
}

// ---- conversions

namespace detail {

#if HWY_TARGET == HWY_NEON
/// AArch64 gives the nearest integer where there is none, and 0 for NaN.
template <class V, class I>
HWY_INLINE I or_least(V v, I integer) {
  return hn::IfThenElse(lanes_mask_cast<I>(hn::Lt(v, lanes_set<V>(2147483648.0f))), integer, lanes_set<I>(INT32_MIN));
}
template <class V>
HWY_INLINE Rebound<std::int32_t, V> truncate(V v) {
  return or_least(v, hn::ConvertTo(hn::Rebind<std::int32_t, hn::DFromV<V>>(), v));
}
template <class V>
HWY_INLINE Rebound<std::int32_t, V> round(V v) {
  return or_least(v, hn::NearestInt(v));
}
#else
template <std::size_t N>
HWY_INLINE hn::Vec128<std::int32_t, N> truncate(hn::Vec128<float, N> v) {
  return hn::Vec128<std::int32_t, N>{_mm_cvttps_epi32(v.raw)};
}
template <std::size_t N>
HWY_INLINE hn::Vec128<std::int32_t, N> round(hn::Vec128<float, N> v) {
  return hn::Vec128<std::int32_t, N>{_mm_cvtps_epi32(v.raw)};
}
#endif
#if HWY_TARGET <= HWY_AVX2
HWY_INLINE hn::Vec256<std::int32_t> truncate(hn::Vec256<float> v) {
  return hn::Vec256<std::int32_t>{_mm256_cvttps_epi32(v.raw)};
}
HWY_INLINE hn::Vec256<std::int32_t> round(hn::Vec256<float> v) {
  return hn::Vec256<std::int32_t>{_mm256_cvtps_epi32(v.raw)};
}
#endif
#if HWY_TARGET <= HWY_AVX3
HWY_INLINE hn::Vec512<std::int32_t> truncate(hn::Vec512<float> v) {
  return hn::Vec512<std::int32_t>{_mm512_cvttps_epi32(v.raw)};
}
HWY_INLINE hn::Vec512<std::int32_t> round(hn::Vec512<float> v) {
  return hn::Vec512<std::int32_t>{_mm512_cvtps_epi32(v.raw)};
}
template <std::size_t N>
HWY_INLINE hn::Vec128<std::uint32_t, N> truncate_unsigned(hn::Vec128<float, N> v) {
  return hn::Vec128<std::uint32_t, N>{_mm_cvttps_epu32(v.raw)};
}
HWY_INLINE hn::Vec256<std::uint32_t> truncate_unsigned(hn::Vec256<float> v) {
  return hn::Vec256<std::uint32_t>{_mm256_cvttps_epu32(v.raw)};
}
HWY_INLINE hn::Vec512<std::uint32_t> truncate_unsigned(hn::Vec512<float> v) {
  return hn::Vec512<std::uint32_t>{_mm512_cvttps_epu32(v.raw)};
}
#endif

}  // namespace detail

/// CVTTPS2DQ: truncate; NaN and out of range give 0x80000000.
template <class V>
HWY_INLINE Rebound<std::int32_t, V> lanes_truncate_to_int(V v) {
  return detail::truncate(v);
}

/// CVTPS2DQ: round to nearest even; NaN and out of range give 0x80000000.
template <class V>
HWY_INLINE Rebound<std::int32_t, V> lanes_round_to_int(V v) {
  return detail::round(v);
}

/// VCVTTPS2UDQ: truncate; NaN, values <= -1 and >= 2^32 give 0xFFFFFFFF.
template <class V>
HWY_INLINE Rebound<std::uint32_t, V> lanes_truncate_to_uint(V v) {
#if HWY_TARGET <= HWY_AVX3
  return detail::truncate_unsigned(v);
#else
  const auto in_range = hn::And(hn::Gt(v, lanes_set<V>(-1.0f)), hn::Lt(v, lanes_set<V>(4294967296.0f)));
  const V half = lanes_set<V>(2147483648.0f);
  const auto upper = hn::Ge(v, half);
  const auto low = detail::truncate(hn::Sub(v, hn::IfThenElseZero(upper, half)));
  const auto flip = lanes_cast<std::uint32_t>(hn::IfThenElseZero(upper, lanes_set<V>(-0.0f)));
  const auto value = hn::Xor(lanes_cast<std::uint32_t>(low), flip);
  const auto all = lanes_set<Rebound<std::uint32_t, V>>(0xFFFFFFFFu);
  return lanes_cast<std::uint32_t>(hn::IfThenElse(in_range, lanes_cast<float>(value), lanes_cast<float>(all)));
#endif
}

/// Signed integer to binary32, round to nearest even.
template <class V>
HWY_INLINE Rebound<float, V> lanes_int_to_float(V v) {
  return hn::ConvertTo(hn::Rebind<float, hn::DFromV<V>>(), v);
}

/// Unsigned integer to binary32, round to nearest even.
template <class V>
HWY_INLINE Rebound<float, V> lanes_uint_to_float(V v) {
#if HWY_TARGET <= HWY_AVX3
  return hn::ConvertTo(hn::Rebind<float, hn::DFromV<V>>(), v);
#else
  // Both halves and the scaling are exact; only the sum rounds.
  const auto high = lanes_int_to_float(lanes_cast<std::int32_t>(hn::ShiftRight<16>(v)));
  const auto low = lanes_int_to_float(lanes_cast<std::int32_t>(hn::And(v, lanes_set<V>(0xFFFFu))));
  return hn::Add(hn::Mul(high, lanes_set<Rebound<float, V>>(65536.0f)), low);
#endif
}

// ---- binary16 (lavapipe-shader-math.md section 8)

/// binary32 of the binary16 in the low half of each lane (upper half ignored), exact in every denormal mode.
template <class V>
HWY_INLINE Rebound<float, V> lanes_half_to_float(V half) {
  const V exponent = hn::And(half, lanes_set<V>(0x7c00u));
  const V sign = hn::ShiftLeft<16>(hn::And(half, lanes_set<V>(0x8000u)));
  const V magnitude = hn::And(half, lanes_set<V>(0x7fffu));
  const V normal = hn::Add(hn::ShiftLeft<13>(magnitude), lanes_set<V>(112u << 23));
  const V special = hn::Or(hn::ShiftLeft<13>(magnitude), lanes_set<V>(0x7f800000u));
  const auto tiny = hn::Mul(lanes_int_to_float(lanes_cast<std::int32_t>(magnitude)),
                            lanes_set<Rebound<float, V>>(5.9604644775390625e-8f));  // 2^-24
  V bits = hn::IfThenElse(hn::Eq(exponent, lanes_set<V>(0x7c00u)), special, normal);
  bits = hn::IfThenElse(hn::Eq(exponent, hn::Zero(hn::DFromV<V>())), lanes_cast<std::uint32_t>(tiny), bits);
  return lanes_cast<float>(hn::Or(bits, sign));
}

/// binary16 bits, round to nearest even; overflow to infinity; NaN becomes sign|0x7E00; binary32 denormals become 0.
template <class V>
HWY_INLINE Rebound<std::uint32_t, V> lanes_float_to_half(V v) {
  using VU = Rebound<std::uint32_t, V>;
  using VI = Rebound<std::int32_t, V>;
  const VU bits = lanes_cast<std::uint32_t>(v);
  const VU sign = hn::And(hn::ShiftRight<16>(bits), lanes_set<VU>(0x8000u));
  const VU magnitude = hn::And(bits, lanes_set<VU>(0x7fffffffu));
  const VI order = lanes_cast<std::int32_t>(magnitude);  // magnitudes compare as integers
  // Normal results: add half a unit less one, plus the bit that stays, and drop 13 bits.
  const VU odd = hn::And(hn::ShiftRight<13>(magnitude), lanes_set<VU>(1u));
  const VU rounded = hn::Add(hn::Sub(magnitude, lanes_set<VU>(112u << 23)), hn::Add(odd, lanes_set<VU>(0xfffu)));
  const VU normal = hn::ShiftRight<13>(rounded);
  // Below 2^-14: adding 0.5, whose last bit weighs 2^-24, rounds to a multiple of the smallest binary16 denormal.
  const V shifted = hn::Add(lanes_cast<float>(magnitude), lanes_set<V>(0.5f));
  const VU denormal = hn::Sub(lanes_cast<std::uint32_t>(shifted), lanes_set<VU>(0x3f000000u));
  VU half = hn::IfThenElse(lanes_mask_cast<VU>(hn::Lt(order, lanes_set<VI>(113 << 23))), denormal, normal);
  half = hn::IfThenElse(lanes_mask_cast<VU>(hn::Gt(order, lanes_set<VI>(0x477fefff))), lanes_set<VU>(0x7c00u), half);
  half = hn::IfThenElse(lanes_mask_cast<VU>(hn::Gt(order, lanes_set<VI>(0x7f800000))), lanes_set<VU>(0x7e00u), half);
  return hn::Or(half, sign);
}

// ---- lane masks

/// Bits of a vector mask, lane 0 in bit 0.
template <class D, class M>
HWY_INLINE LaneMask lanes_mask_bits(D d, M mask) {
#if HWY_TARGET == HWY_AVX3
  // Straight from the mask register; through bytes it would be put together there a piece at a time.
  constexpr LaneMask kLanes = hn::MaxLanes(d) >= 64 ? ~LaneMask{0} : (LaneMask{1} << hn::MaxLanes(d) % 64) - 1;
  return static_cast<LaneMask>(mask.raw) & kLanes;
#endif
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  LaneMask bits;
  std::memcpy(&bits, bytes, sizeof(bits));
  return bits;
}

/// Vector mask of the lowest Lanes(d) bits.
template <class D>
HWY_INLINE hn::Mask<D> lanes_mask_from_bits(D d, LaneMask bits) {
  std::uint8_t bytes[8];
  std::memcpy(bytes, &bits, sizeof(bits));
  return hn::LoadMaskBits(d, bytes);
}

}  // namespace vitrine::base::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

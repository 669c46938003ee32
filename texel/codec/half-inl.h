// binary16 in memory to and from binary32, a vector at a time, in every denormal mode. The hardware's conversions where
// it has them.

#include "base/lane_math-inl.h"

#if defined(VITRINE_TEXEL_HALF_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_TEXEL_HALF_INL_H_
#undef VITRINE_TEXEL_HALF_INL_H_
#else
#define VITRINE_TEXEL_HALF_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using namespace vitrine::base::HWY_NAMESPACE;

using HalfLanes = hn::Vec<hn::Rebind<std::uint16_t, hn::ScalableTag<float>>>;

/// Exact, but signalling NaN may become quiet: where that is no harm since the next operation does it.
HWY_INLINE hn::Vec<hn::ScalableTag<float>> floats_of_halves_quieted(HalfLanes halves) {
#if HWY_TARGET <= HWY_AVX3
  return hn::Vec<hn::ScalableTag<float>>{_mm512_cvtph_ps(halves.raw)};
#elif HWY_TARGET <= HWY_AVX2
  return hn::Vec<hn::ScalableTag<float>>{_mm256_cvtph_ps(halves.raw)};
#else
  return lanes_half_to_float(hn::PromoteTo(hn::ScalableTag<std::uint32_t>(), halves));
#endif
}

/// Exact, as half_to_float.
HWY_INLINE hn::Vec<hn::ScalableTag<float>> floats_of_halves(HalfLanes halves) {
#if HWY_TARGET <= HWY_AVX2
  const hn::ScalableTag<float> d;
  const hn::ScalableTag<std::uint32_t> du;
  const auto quieted = floats_of_halves_quieted(halves);
  if (HWY_LIKELY(hn::AllTrue(d, hn::Eq(quieted, quieted)))) return quieted;
  const auto half = hn::PromoteTo(du, halves);
  const auto quiet = hn::Set(du, 0x00400000u);
  const auto nan = hn::Or(hn::AndNot(quiet, hn::BitCast(du, quieted)), hn::And(hn::ShiftLeft<13>(half), quiet));
  return hn::IfThenElse(hn::Eq(quieted, quieted), quieted, hn::BitCast(d, nan));
#else
  return floats_of_halves_quieted(halves);
#endif
}

/// Toward zero, as float_to_half_truncate.
HWY_INLINE HalfLanes halves_of_floats(hn::Vec<hn::ScalableTag<float>> value) {
#if HWY_TARGET <= HWY_AVX3
  return HalfLanes{_mm512_cvtps_ph(value.raw, _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC)};
#elif HWY_TARGET == HWY_AVX2
  return HalfLanes{_mm256_cvtps_ph(value.raw, _MM_FROUND_TO_ZERO | _MM_FROUND_NO_EXC)};
#else
  const hn::ScalableTag<float> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  const hn::RebindToSigned<decltype(d)> di;
  const auto bits = hn::BitCast(du, value);
  const auto sign = hn::And(hn::ShiftRight<16>(bits), hn::Set(du, 0x8000u));
  const auto magnitude = hn::And(bits, hn::Set(du, 0x7fffffffu));
  const auto order = hn::BitCast(di, magnitude);
  const auto select = [&](auto condition, auto yes, auto no) {
    return hn::IfThenElse(hn::RebindMask(du, condition), yes, no);
  };
  const auto shifted = hn::ShiftRight<13>(magnitude);
  // Below 2^-14: multiples of 2^-24.
  const auto tiny = lanes_truncate_to_int(hn::Mul(hn::BitCast(d, magnitude), hn::Set(d, 16777216.0f)));
  auto half = hn::Sub(shifted, hn::Set(du, 112u << 10));
  half = select(hn::Lt(order, hn::Set(di, 113 << 23)), hn::BitCast(du, tiny), half);
  half = select(hn::Gt(order, hn::Set(di, 0x477fffff)), hn::Set(du, 0x7bffu), half);
  half = select(hn::Eq(order, hn::Set(di, 0x7f800000)), hn::Set(du, 0x7c00u), half);
  const auto nan = hn::Or(hn::Set(du, 0x7e00u), hn::And(shifted, hn::Set(du, 0x3ffu)));
  half = select(hn::Gt(order, hn::Set(di, 0x7f800000)), nan, half);
  return hn::DemoteTo(hn::Rebind<std::uint16_t, decltype(d)>(), hn::BitCast(di, hn::Or(half, sign)));
#endif
}

/// Truncated binary16 without its sign and the low bits of its mantissa, `bits` in all; negative numbers are 0, NaN
/// keeps one bit.
HWY_INLINE hn::Vec<hn::ScalableTag<std::uint32_t>> unsigned_floats_of_floats(hn::Vec<hn::ScalableTag<float>> value,
                                                                             std::uint32_t bits) {
  const hn::ScalableTag<std::uint32_t> du;
  const int dropped = static_cast<int>(15 - bits);
  const auto half = hn::ShiftRightSame(hn::PromoteTo(du, halves_of_floats(value)), dropped);
  const auto nan = hn::Set(du, (0x7c00u >> dropped) | 1u << (bits - 6));
  const auto zero = hn::Zero(hn::ScalableTag<float>());
  const auto positive = hn::IfThenElseZero(hn::RebindMask(du, hn::Gt(value, zero)), half);
  return hn::IfThenElse(hn::RebindMask(du, hn::Eq(value, value)), positive, nan);
}

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

// Linear values to the sRGB codes of a colour attachment, a vector at a time: the bits of encode_srgb_attachment
// (lavapipe-texture-blend.md part D).

#include "base/lane_math-inl.h"
#include "texel/codec/srgb.h"

#if defined(VITRINE_TEXEL_SRGB_ENCODE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_TEXEL_SRGB_ENCODE_INL_H_
#undef VITRINE_TEXEL_SRGB_ENCODE_INL_H_
#else
#define VITRINE_TEXEL_SRGB_ENCODE_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using namespace vitrine::base::HWY_NAMESPACE;

#if HWY_TARGET != HWY_NEON
/// The CPU's RSQRTPS, which is not what Highway's approximation is with AVX-512. Only where cpu_has_rsqrt().
struct RsqrtOfCpu {
  HWY_INLINE hn::Vec128<float> operator()(hn::Vec128<float> v) const { return hn::Vec128<float>{_mm_rsqrt_ps(v.raw)}; }
#if HWY_TARGET <= HWY_AVX2
  HWY_INLINE hn::Vec256<float> operator()(hn::Vec256<float> v) const {
    return hn::Vec256<float>{_mm256_rsqrt_ps(v.raw)};
  }
#endif
#if HWY_TARGET <= HWY_AVX3
  HWY_INLINE hn::Vec512<float> operator()(hn::Vec512<float> v) const {
    const __m256 low = _mm256_rsqrt_ps(_mm512_castps512_ps256(v.raw));
    const __m256 high = _mm256_rsqrt_ps(_mm512_extractf32x8_ps(v.raw, 1));
    return hn::Vec512<float>{_mm512_insertf32x8(_mm512_castps256_ps512(low), high, 1)};
  }
#endif
};
#endif

/// approximate_rsqrt of positive normal numbers.
struct RsqrtByTable {
  template <class V>
  HWY_INLINE V operator()(V x) const {
    const hn::Rebind<std::int32_t, hn::DFromV<V>> d;
    const auto bits = hn::BitCast(d, x);
    const auto step = hn::And(hn::ShiftRight<11>(bits), hn::Set(d, 0x1fff));
    const auto* table = reinterpret_cast<const std::int32_t*>(kRsqrtSteps.data());
    const auto significand = hn::And(hn::GatherOffset(d, table, hn::Add(step, step)), hn::Set(d, 0xffff));
    const auto exponent = hn::ShiftRight<1>(hn::Add(hn::ShiftRight<23>(bits), hn::Set(d, 1)));
    const auto start = hn::ShiftLeft<23>(hn::Sub(hn::Set(d, 190), exponent));
    return hn::BitCast(hn::DFromV<V>(), hn::Add(start, hn::ShiftLeft<11>(significand)));
  }
};

#if HWY_TARGET == HWY_NEON
using RsqrtOfCpu = RsqrtByTable;  // never asked for: cpu_has_rsqrt() is false
#endif

/// Codes before they are clamped to [0, 255]; x in [0, 1].
template <class Rsqrt, class V>
HWY_INLINE Rebound<std::int32_t, V> srgb_codes(Rsqrt rsqrt, V x) {
  const hn::DFromV<V> d;
  const V limit = hn::Set(d, kSrgbLinearEnd);
  const V curved = hn::Max(x, limit);
  const V x05 = hn::Mul(curved, rsqrt(curved));
  const V x0375 = rsqrt(rsqrt(hn::Mul(x05, curved)));
  const V curve = hn::Add(hn::Mul(hn::Set(d, kSrgbCurve[0]), x0375),
                          lanes_fma(hn::Set(d, kSrgbCurve[1]), x05, hn::Set(d, kSrgbCurve[2])));
  return lanes_round_to_int(hn::IfThenElse(hn::Gt(x, limit), curve, hn::Mul(x, hn::Set(d, kSrgbLinearScale))));
}

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

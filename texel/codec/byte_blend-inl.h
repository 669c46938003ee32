// Blends of four bytes in a 32-bit lane with the reference's 8-bit rounding (lavapipe-texture-blend.md A3).

#include "base/lane_math-inl.h"

#if defined(VITRINE_TEXEL_BYTE_BLEND_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_TEXEL_BYTE_BLEND_INL_H_
#undef VITRINE_TEXEL_BYTE_BLEND_INL_H_
#else
#define VITRINE_TEXEL_BYTE_BLEND_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using namespace vitrine::base::HWY_NAMESPACE;

using D16 = hn::ScalableTag<std::int16_t>;
using V16 = hn::Vec<D16>;

/// Two of four bytes in 16-bit lanes each.
struct Halves {
  V16 even, odd;
};

HWY_INLINE Halves unpack_bytes(hn::Vec<hn::ScalableTag<std::uint32_t>> packed) {
  const auto mask = hn::Set(hn::ScalableTag<std::uint32_t>(), 0x00FF00FFu);
  const hn::RebindToUnsigned<D16> halves;
  return {hn::BitCast(D16(), hn::And(packed, mask)),
          hn::BitCast(D16(), hn::ShiftRight<8>(hn::BitCast(halves, packed)))};
}

HWY_INLINE hn::Vec<hn::ScalableTag<std::uint32_t>> pack_bytes(const Halves& halves) {
  const hn::ScalableTag<std::uint32_t> d;
  return hn::Or(hn::BitCast(d, halves.even), hn::ShiftLeft<8>(hn::BitCast(d, halves.odd)));
}

/// (a * b + 2^14) >> 15.
HWY_INLINE V16 rounded_product(V16 a, V16 b) { return hn::MulFixedPoint15(a, b); }

/// 128 w in both 16-bit halves of a lane, for w in [0, 255].
template <class VI32>
HWY_INLINE VI32 spread_weight(VI32 w) {
  return hn::Or(hn::ShiftLeft<7>(w), hn::ShiftLeft<23>(w));
}

/// a + ((w * (b - a) + 128) >> 8), with `weight` from spread_weight.
template <class VI32>
HWY_INLINE Halves blend_bytes(VI32 weight, const Halves& a, const Halves& b) {
  const V16 w = hn::BitCast(D16(), weight);
  return {hn::Add(a.even, rounded_product(w, hn::Sub(b.even, a.even))),
          hn::Add(a.odd, rounded_product(w, hn::Sub(b.odd, a.odd)))};
}

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

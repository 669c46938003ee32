// Four float registers to three sRGB codes and a UNORM alpha a pixel, a vector of pixels at a time: the bits of
// texel::encode_srgb_attachment (lavapipe-texture-blend.md part D). Include after <hwy/highway.h>, in a file that
// follows the foreach_target pattern.

#include <hwy/highway.h>

#include "base/lane_math-inl.h"
#include "raster/color_fast.h"
#include "texel/codec/srgb.h"

#if defined(VITRINE_RASTER_COLOR_SRGB_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_RASTER_COLOR_SRGB_INL_H_
#undef VITRINE_RASTER_COLOR_SRGB_INL_H_
#else
#define VITRINE_RASTER_COLOR_SRGB_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::raster::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

class SrgbPacker {
 public:
  using Floats = hn::CappedTag<float, 16>;
  using Texels = hn::Rebind<std::int32_t, Floats>;

  explicit SrgbPacker(const ColorWriter& writer) {
    for (std::size_t c = 0; c < 4; ++c) shift_[c] = shift_of(writer, c);
  }

  /// Texels of lanes [i, i + lanes).
  HWY_INLINE hn::Vec<Texels> pack(const base::WaveRegister* color, std::size_t i) const {
    auto texel = hn::ShiftLeftSame(alpha(load(color[3], i)), shift_[3]);
    for (std::size_t c = 0; c < 3; ++c) texel = hn::Or(texel, hn::ShiftLeftSame(code(load(color[c], i)), shift_[c]));
    return texel;
  }

 private:
  using V = hn::Vec<Floats>;
  using I = hn::Vec<Texels>;

  static HWY_INLINE V load(const base::WaveRegister& color, std::size_t i) {
    return hn::Load(Floats(), reinterpret_cast<const float*>(color.lane + i));
  }
  static HWY_INLINE V set(float x) { return hn::Set(Floats(), x); }
  static HWY_INLINE I to_code(V scaled) {
    const Texels d;
    return hn::Min(hn::Max(base::HWY_NAMESPACE::lanes_round_to_int(scaled), hn::Zero(d)), hn::Set(d, 255));
  }
  static HWY_INLINE I alpha(V x) {
    return to_code(hn::Mul(base::HWY_NAMESPACE::lanes_min_second(set(1.0f), x), set(255.0f)));
  }

  /// texel::approximate_rsqrt of positive normal numbers.
  static HWY_INLINE V rsqrt(V x) {
    const Texels d;
    const I bits = hn::BitCast(d, x);
    const I step = hn::And(hn::ShiftRight<11>(bits), hn::Set(d, 0x1fff));
    const auto* table = reinterpret_cast<const std::int32_t*>(texel::kRsqrtSteps.data());
    const I significand = hn::And(hn::GatherOffset(d, table, hn::Add(step, step)), hn::Set(d, 0xffff));
    const I exponent = hn::ShiftRight<1>(hn::Add(hn::ShiftRight<23>(bits), hn::Set(d, 1)));
    const I start = hn::ShiftLeft<23>(hn::Sub(hn::Set(d, 190), exponent));
    return hn::BitCast(Floats(), hn::Add(start, hn::ShiftLeft<11>(significand)));
  }

  static HWY_INLINE I code(V linear) {
    const V x =
        base::HWY_NAMESPACE::lanes_min_second(base::HWY_NAMESPACE::lanes_max_second(linear, set(0.0f)), set(1.0f));
    const V limit = set(texel::kSrgbLinearEnd);
    const V curved = hn::Max(x, limit);
    const V x05 = hn::Mul(curved, rsqrt(curved));
    const V x0375 = rsqrt(rsqrt(hn::Mul(x05, curved)));
    const V curve = hn::Add(hn::Mul(set(texel::kSrgbCurve[0]), x0375),
                            base::HWY_NAMESPACE::lanes_fma(set(texel::kSrgbCurve[1]), x05, set(texel::kSrgbCurve[2])));
    return to_code(hn::IfThenElse(hn::Gt(x, limit), curve, hn::Mul(x, set(texel::kSrgbLinearScale))));
  }

  int shift_[4];
};

}  // namespace vitrine::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

// Four float registers to three sRGB codes and a UNORM alpha a pixel, a vector of pixels at a time: the bits of
// texel::encode_srgb_attachment (lavapipe-texture-blend.md part D). Include after <hwy/highway.h>, in a file that
// follows the foreach_target pattern.

#include <hwy/highway.h>

#include "base/lane_math-inl.h"
#include "raster/output/byte_texels.h"
#include "texel/codec/srgb_encode-inl.h"

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
  HWY_INLINE hn::Vec<Texels> pack(const ColorRegisters& color, std::size_t i) const {
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
  static HWY_INLINE I to_byte(I code) {
    const Texels d;
    return hn::Min(hn::Max(code, hn::Zero(d)), hn::Set(d, 255));
  }
  static HWY_INLINE I alpha(V x) {
    const V scaled = hn::Mul(base::HWY_NAMESPACE::lanes_min_second(set(1.0f), x), set(255.0f));
    return to_byte(base::HWY_NAMESPACE::lanes_round_to_int(scaled));
  }

  static HWY_INLINE I code(V linear) {
    const V x =
        base::HWY_NAMESPACE::lanes_min_second(base::HWY_NAMESPACE::lanes_max_second(linear, set(0.0f)), set(1.0f));
    return to_byte(texel::HWY_NAMESPACE::srgb_codes(texel::HWY_NAMESPACE::RsqrtByTable(), x));
  }

  int shift_[4];
};

}  // namespace vitrine::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

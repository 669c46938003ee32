// Four float registers to four UNORM bytes a pixel, a vector of pixels at a time (lavapipe-texture-blend.md part D).
// Include after <hwy/highway.h>, in a file that follows the foreach_target pattern.

#include <hwy/highway.h>

#include "base/lane_math-inl.h"
#include "raster/color_fast.h"

#if defined(VITRINE_RASTER_COLOR_PACK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_RASTER_COLOR_PACK_INL_H_
#undef VITRINE_RASTER_COLOR_PACK_INL_H_
#else
#define VITRINE_RASTER_COLOR_PACK_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::raster::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

class BytePacker {
 public:
  using Floats = hn::CappedTag<float, 16>;
  using Texels = hn::Rebind<std::int32_t, Floats>;

  explicit BytePacker(const ColorWriter& writer) : places_(hn::LoadDup128(Bytes(), writer.pack_places)) {}

  /// Texels of lanes [i, i + lanes).
  HWY_INLINE hn::Vec<Texels> pack(const base::WaveRegister* color, std::size_t i) const {
    // Conversion from 32 to 16 bits saturates; 16 to 8 only needs the lower bound. The four pixels of a quad become
    // r b r b r b r b g a g a g a g a.
    const Words d16;
    const auto zero = hn::Zero(d16);
    const auto rg = hn::Max(hn::ReorderDemote2To(d16, to_bytes(color[0], i), to_bytes(color[1], i)), zero);
    const auto ba = hn::Max(hn::ReorderDemote2To(d16, to_bytes(color[2], i), to_bytes(color[3], i)), zero);
    const auto bytes = hn::BitCast(Bytes(), hn::Or(rg, hn::ShiftLeft<8>(ba)));
    return hn::BitCast(Texels(), hn::TableLookupBytes(bytes, places_));
  }

 private:
  using Words = hn::Repartition<std::int16_t, Floats>;
  using Bytes = hn::Repartition<std::uint8_t, Floats>;

  /// MIN(1, x) * 255, to nearest even, as signed integers. Below 0: not yet clamped.
  static HWY_INLINE hn::Vec<Texels> to_bytes(const base::WaveRegister& color, std::size_t i) {
    const Floats d;
    const auto x = hn::Load(d, reinterpret_cast<const float*>(color.lane + i));
    const auto scaled = hn::Mul(base::HWY_NAMESPACE::lanes_min_second(hn::Set(d, 1.0f), x), hn::Set(d, 255.0f));
    return base::HWY_NAMESPACE::lanes_round_to_int(scaled);
  }

  hn::Vec<Bytes> places_;
};

}  // namespace vitrine::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

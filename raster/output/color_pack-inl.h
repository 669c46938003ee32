// Four float registers to four UNORM bytes a pixel, a vector of pixels at a time (lavapipe-texture-blend.md part D).
// Include after <hwy/highway.h>, in a file that follows the foreach_target pattern.

#include <hwy/highway.h>

#include "base/lane_math-inl.h"
#include "raster/output/byte_texels.h"

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
  HWY_INLINE hn::Vec<Texels> pack(const ColorRegisters& color, std::size_t i) const {
    // Both narrowings saturate. The four pixels of a quad become r r r r g g g g b b b b a a a a.
    const Words d16;
    const auto rg = hn::ReorderDemote2To(d16, to_bytes(color[0], i), to_bytes(color[1], i));
    const auto ba = hn::ReorderDemote2To(d16, to_bytes(color[2], i), to_bytes(color[3], i));
    const auto bytes = narrow(rg, ba);
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

  /// Signed words to unsigned bytes, both operands per 128 bits.
  static HWY_INLINE hn::Vec<Bytes> narrow(hn::Vec<Words> low, hn::Vec<Words> high) {
#if HWY_TARGET <= HWY_AVX3
    return hn::Vec<Bytes>{_mm512_packus_epi16(low.raw, high.raw)};
#elif HWY_TARGET <= HWY_AVX2
    return hn::Vec<Bytes>{_mm256_packus_epi16(low.raw, high.raw)};
#elif HWY_TARGET == HWY_NEON
    return hn::Vec<Bytes>{vcombine_u8(vqmovun_s16(low.raw), vqmovun_s16(high.raw))};
#else
    return hn::Vec<Bytes>{_mm_packus_epi16(low.raw, high.raw)};
#endif
  }

  hn::Vec<Bytes> places_;
};

}  // namespace vitrine::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

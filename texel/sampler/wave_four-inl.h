// Bilinear filtering of texels of four halves or floats: texel by texel as they lie in memory, turned into one
// component per vector only at the end. The bits of the general filter.

#include "texel/sampler/wave_texels-inl.h"

#if defined(VITRINE_TEXEL_WAVE_FOUR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_TEXEL_WAVE_FOUR_INL_H_
#undef VITRINE_TEXEL_WAVE_FOUR_INL_H_
#else
#define VITRINE_TEXEL_WAVE_FOUR_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {

/// Texels of a wave one behind the other, kBytes each.
template <std::size_t kBytes>
struct alignas(64) PackedTexels {
  std::byte bytes[base::kWaveWidth * kBytes];
};

template <std::size_t kBytes>
HWY_INLINE void load_packed(const std::byte* base, const IntLanes& offset, PackedTexels<kBytes>& to) {
  for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane) {
    std::memcpy(to.bytes + kBytes * lane, base + offset.lane[lane], kBytes);
  }
}

/// Floats i.. of packed halves or floats.
HWY_INLINE VF packed_floats(const PackedTexels<16>& texels, std::size_t i) {
  return hn::Load(DF(), reinterpret_cast<const float*>(texels.bytes) + i);
}
HWY_INLINE VF packed_floats(const PackedTexels<8>& texels, std::size_t i) {
  const hn::Rebind<std::uint16_t, DF> d16;
  const auto half = hn::Load(d16, reinterpret_cast<const std::uint16_t*>(texels.bytes) + i);
  return half_field_to_float(hn::PromoteTo(DU(), half));
}

/// Weights of the texels whose components are floats i..: each four times.
HWY_INLINE VF spread_weights(const FloatLanes& weight, std::size_t i) {
  const float* w = weight.lane + i / 4;
#if HWY_TARGET <= HWY_AVX3
  alignas(64) static constexpr std::int32_t kQuarter[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
  return hn::TableLookupLanes(hn::LoadDup128(DF(), w), hn::SetTableIndices(DF(), kQuarter));
#elif HWY_TARGET == HWY_AVX2
  const hn::Half<DF> half;
  return hn::Combine(DF(), hn::Set(half, w[1]), hn::Set(half, w[0]));
#else
  return splat(w[0]);
#endif
}

template <std::size_t kBytes>
HWY_NOINLINE void filter_four(const std::byte* base, const TexelPlaces places[4], const FloatLanes& weight_x,
                              const FloatLanes& weight_y, WaveTexels& out) {
  PackedTexels<kBytes> texel[4];
  alignas(64) float mixed[4 * base::kWaveWidth];
  for (std::size_t k = 0; k < 4; ++k) load_packed<kBytes>(base, places[k].offset, texel[k]);
  for (std::size_t i = 0; i < 4 * base::kWaveWidth; i += hn::Lanes(DF())) {
    const auto lerp = [](VF w, VF a, VF b) { return lanes_fma(w, hn::Sub(b, a), a); };
    const VF x = spread_weights(weight_x, i), y = spread_weights(weight_y, i);
    const VF top = lerp(x, packed_floats(texel[0], i), packed_floats(texel[1], i));
    const VF bottom = lerp(x, packed_floats(texel[2], i), packed_floats(texel[3], i));
    hn::Store(lerp(y, top, bottom), DF(), mixed + i);
  }
  for (std::size_t i = 0; i < base::kWaveWidth; i += hn::Lanes(DF())) {
    VF r, g, b, a;
    hn::LoadInterleaved4(DF(), mixed + 4 * i, r, g, b, a);
    hn::Store(r, DF(), out.c[0].lane + i);
    hn::Store(g, DF(), out.c[1].lane + i);
    hn::Store(b, DF(), out.c[2].lane + i);
    hn::Store(a, DF(), out.c[3].lane + i);
  }
}

/// Whether texels are R, G, B, A as halves or floats.
inline bool has_four_floats(const FormatDesc& format) {
  const std::uint32_t bits = format.channel[0].bits;
  return format.plain && format.channel_count == 4 && format.channel[0].numeric == Numeric::kSfloat &&
         (bits == 16 || bits == 32) && format.component == std::array<std::uint8_t, 4>{0, 1, 2, 3};
}

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

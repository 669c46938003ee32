// Bilinear filtering of texels of four halves or floats: texel by texel as they lie in memory, turned into one
// component per vector only at the end. The bits of the general filter.

#include "texel/sampler/wave/texels-inl.h"

#if defined(VITRINE_TEXEL_WAVE_FOUR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_TEXEL_WAVE_FOUR_INL_H_
#undef VITRINE_TEXEL_WAVE_FOUR_INL_H_
#else
#define VITRINE_TEXEL_WAVE_FOUR_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {

/// Two texels of every fourth lane, a 128-bit block each.
struct TexelPair {
  VF first, second;
};

/// Halves as floats. Quieting a signalling NaN is no harm: the filter's next operation does.
#if HWY_TARGET <= HWY_AVX3
HWY_INLINE VF four_blocks(__m128i a, __m128i b, __m128i c, __m128i d) {
  const __m512i low = _mm512_inserti32x4(_mm512_castsi128_si512(a), b, 1);
  return VF{_mm512_castsi512_ps(_mm512_inserti32x4(_mm512_inserti32x4(low, c, 2), d, 3))};
}
HWY_INLINE VF two_pairs_as_floats(__m128i a, __m128i b) {
  return VF{_mm512_cvtph_ps(_mm256_inserti128_si256(_mm256_castsi128_si256(a), b, 1))};
}
HWY_INLINE __m128i load_block(const std::byte* texel) {
  return _mm_loadu_si128(reinterpret_cast<const __m128i*>(texel));
}
HWY_INLINE VF two_pairs(const std::byte* a, const std::byte* b) {
  const auto* low = reinterpret_cast<const __m256i*>(a);
  const auto* high = reinterpret_cast<const __m256i*>(b);
  return VF{_mm512_castsi512_ps(
      _mm512_inserti64x4(_mm512_castsi256_si512(_mm256_loadu_si256(low)), _mm256_loadu_si256(high), 1))};
}
HWY_INLINE __m128i load_two(const std::byte* a, const std::byte* b) {
  const __m128i low = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(a));
  std::int64_t high;
  std::memcpy(&high, b, sizeof(high));
  return _mm_insert_epi64(low, high, 1);
}

/// Blocks 0 and 2, or 1 and 3, of two vectors.
template <int kOdd>
HWY_INLINE VF every_other_block(VF low, VF high) {
  return VF{_mm512_shuffle_f32x4(low.raw, high.raw, kOdd != 0 ? 0xDD : 0x88)};
}

template <std::size_t kBytes>
HWY_INLINE VF load_texels(const std::byte* base, const std::int32_t* offset) {
  if constexpr (kBytes == 8) {
    return two_pairs_as_floats(load_two(base + offset[0], base + offset[4]),
                               load_two(base + offset[8], base + offset[12]));
  } else {
    return four_blocks(load_block(base + offset[0]), load_block(base + offset[4]), load_block(base + offset[8]),
                       load_block(base + offset[12]));
  }
}

/// The second texel of each pair follows the first in memory.
template <std::size_t kBytes>
HWY_INLINE TexelPair load_neighbours(const std::byte* base, const std::int32_t* offset) {
  const std::byte* const at[4] = {base + offset[0], base + offset[4], base + offset[8], base + offset[12]};
  VF low, high;
  if constexpr (kBytes == 8) {
    low = two_pairs_as_floats(load_block(at[0]), load_block(at[1]));
    high = two_pairs_as_floats(load_block(at[2]), load_block(at[3]));
  } else {
    low = two_pairs(at[0], at[1]);
    high = two_pairs(at[2], at[3]);
  }
  return {every_other_block<0>(low, high), every_other_block<1>(low, high)};
}

/// As below.
template <std::size_t kBytes>
HWY_INLINE void load_four_neighbours(const std::byte* base, const std::int32_t* offset, VF texel[4]) {
  const auto row = [&](std::size_t lane) HWY_ATTR {
    const std::byte* const at = base + offset[lane];
    if constexpr (kBytes == 8) return _mm512_cvtph_ps(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(at)));
    return _mm512_loadu_ps(at);
  };
  const __m512 a = row(0), b = row(4), c = row(8), d = row(12);
  const __m512 ab_low = _mm512_shuffle_f32x4(a, b, 0x44), ab_high = _mm512_shuffle_f32x4(a, b, 0xEE);
  const __m512 cd_low = _mm512_shuffle_f32x4(c, d, 0x44), cd_high = _mm512_shuffle_f32x4(c, d, 0xEE);
  texel[0] = VF{_mm512_shuffle_f32x4(ab_low, cd_low, 0x88)};
  texel[1] = VF{_mm512_shuffle_f32x4(ab_low, cd_low, 0xDD)};
  texel[2] = VF{_mm512_shuffle_f32x4(ab_high, cd_high, 0x88)};
  texel[3] = VF{_mm512_shuffle_f32x4(ab_high, cd_high, 0xDD)};
}
#else
template <std::size_t kBytes>
HWY_INLINE VF load_texels(const std::byte* base, const std::int32_t* offset) {
  constexpr std::size_t kLanes = hn::MaxLanes(DF()) / 4;
  alignas(32) std::byte texels[kLanes * kBytes];
  for (std::size_t i = 0; i < kLanes; ++i) std::memcpy(texels + kBytes * i, base + offset[4 * i], kBytes);
  if constexpr (kBytes == 16) return hn::Load(DF(), reinterpret_cast<const float*>(texels));
  const hn::Rebind<std::uint16_t, DF> d16;
  return half_field_to_float(hn::PromoteTo(DU(), hn::Load(d16, reinterpret_cast<const std::uint16_t*>(texels))));
}

template <std::size_t kBytes>
HWY_INLINE TexelPair load_neighbours(const std::byte* base, const std::int32_t* offset) {
  return {load_texels<kBytes>(base, offset), load_texels<kBytes>(base + kBytes, offset)};
}

/// Four texels of every fourth lane that follow one another in memory.
template <std::size_t kBytes>
HWY_INLINE void load_four_neighbours(const std::byte* base, const std::int32_t* offset, VF texel[4]) {
  for (std::size_t i = 0; i < 4; ++i) texel[i] = load_texels<kBytes>(base + i * kBytes, offset);
}
#endif

/// From the components of lanes k, k + 4, ... in the blocks of vector k to a component per vector.
HWY_INLINE void split_blocks(const VF block[4], VF component[4]) {
  const hn::Repartition<double, DF> d64;
  const auto rg0 = hn::BitCast(d64, hn::InterleaveLower(DF(), block[0], block[1]));
  const auto ba0 = hn::BitCast(d64, hn::InterleaveUpper(DF(), block[0], block[1]));
  const auto rg1 = hn::BitCast(d64, hn::InterleaveLower(DF(), block[2], block[3]));
  const auto ba1 = hn::BitCast(d64, hn::InterleaveUpper(DF(), block[2], block[3]));
  component[0] = hn::BitCast(DF(), hn::InterleaveLower(d64, rg0, rg1));
  component[1] = hn::BitCast(DF(), hn::InterleaveUpper(d64, rg0, rg1));
  component[2] = hn::BitCast(DF(), hn::InterleaveLower(d64, ba0, ba1));
  component[3] = hn::BitCast(DF(), hn::InterleaveUpper(d64, ba0, ba1));
}

/// Texels of a row, the first of each pair at `first`.
template <std::size_t kBytes, bool kNeighbours>
HWY_INLINE TexelPair load_row(const std::byte* base, const std::int32_t* first, const std::int32_t* second) {
  if constexpr (kNeighbours) return load_neighbours<kBytes>(base, first);
  return {load_texels<kBytes>(base, first), load_texels<kBytes>(base, second)};
}

/// The average of four texels for lanes i, i + 4, ...: their components in a block each.
template <std::size_t kBytes, bool kNeighbours>
HWY_INLINE VF mix_four(const std::byte* base, const TexelPlaces places[4], std::size_t lane, VF x, VF y) {
  const auto lerp = [](VF w, VF a, VF b) { return lanes_fma(w, hn::Sub(b, a), a); };
  const TexelPair top = load_row<kBytes, kNeighbours>(base, places[0].offset.lane + lane, places[1].offset.lane + lane);
  const TexelPair bottom =
      load_row<kBytes, kNeighbours>(base, places[2].offset.lane + lane, places[3].offset.lane + lane);
  return lerp(y, lerp(x, top.first, top.second), lerp(x, bottom.first, bottom.second));
}

template <std::size_t kBytes, bool kNeighbours>
HWY_INLINE void filter_four_lanes(const std::byte* base, const TexelPlaces places[4], const FloatLanes& weight_x,
                                  const FloatLanes& weight_y, WaveTexels& out) {
  for (std::size_t i = 0; i < base::kWaveWidth; i += hn::Lanes(DF())) {
    const VF x = hn::Load(DF(), weight_x.lane + i), y = hn::Load(DF(), weight_y.lane + i);
    const auto mix = [&](std::size_t lane, VF wx, VF wy) {
      return mix_four<kBytes, kNeighbours>(base, places, i + lane, wx, wy);
    };
    const VF mixed[4] = {
        mix(0, hn::Broadcast<0>(x), hn::Broadcast<0>(y)), mix(1, hn::Broadcast<1>(x), hn::Broadcast<1>(y)),
        mix(2, hn::Broadcast<2>(x), hn::Broadcast<2>(y)), mix(3, hn::Broadcast<3>(x), hn::Broadcast<3>(y))};
    VF component[4];
    split_blocks(mixed, component);
    for (std::size_t c = 0; c < 4; ++c) hn::Store(component[c], DF(), out.c[c].lane + i);
  }
}

/// `neighbours`: texels 1 and 3 follow 0 and 2 in memory.
template <std::size_t kBytes>
HWY_NOINLINE void filter_four(const std::byte* base, const TexelPlaces places[4], bool neighbours,
                              const FloatLanes& weight_x, const FloatLanes& weight_y, WaveTexels& out) {
  neighbours ? filter_four_lanes<kBytes, true>(base, places, weight_x, weight_y, out)
             : filter_four_lanes<kBytes, false>(base, places, weight_x, weight_y, out);
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

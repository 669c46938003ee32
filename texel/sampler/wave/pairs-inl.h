// Loads of words for a vector of lanes, one by one: on today's CPUs faster than gathering.

#include <cstring>

#include "texel/sampler/wave/state-inl.h"

#if defined(VITRINE_TEXEL_WAVE_PAIRS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_TEXEL_WAVE_PAIRS_INL_H_
#undef VITRINE_TEXEL_WAVE_PAIRS_INL_H_
#else
#define VITRINE_TEXEL_WAVE_PAIRS_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {

/// Offsets in memory, from where each costs one load. Compilers would rather take vectors apart, which is slower.
template <std::size_t kLanes>
struct OffsetLanes {
  alignas(64) std::int32_t at[kLanes];

  HWY_INLINE explicit OffsetLanes(VI offset) {
    hn::Store(offset, DI(), at);
    __asm__("" : "+m"(at));
  }
};

/// A word and the one that follows it in memory, per lane.
struct WordPair {
  VU first, second;
};

#if HWY_TARGET <= HWY_AVX3
/// 64 bits at each of eight offsets.
HWY_INLINE __m512i load_eight_pairs(const std::byte* base, const std::int32_t* offset) {
  const auto two = [base](std::int32_t low, std::int32_t high) {
    const __m128 a = _mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(base + low)));
    return _mm_castps_si128(_mm_loadh_pi(a, reinterpret_cast<const __m64*>(base + high)));
  };
  const __m256i low =
      _mm256_inserti128_si256(_mm256_castsi128_si256(two(offset[0], offset[1])), two(offset[2], offset[3]), 1);
  const __m256i high =
      _mm256_inserti128_si256(_mm256_castsi128_si256(two(offset[4], offset[5])), two(offset[6], offset[7]), 1);
  return _mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1);
}

HWY_INLINE WordPair load_word_pairs(const std::byte* base, VI offset) {
  const OffsetLanes<16> offsets(offset);
  const VU low{load_eight_pairs(base, offsets.at)}, high{load_eight_pairs(base, offsets.at + 8)};
  return {hn::ConcatEven(DU(), high, low), hn::ConcatOdd(DU(), high, low)};
}
#else
HWY_INLINE WordPair load_word_pairs(const std::byte* base, VI offset) {
  constexpr std::size_t kLanes = hn::MaxLanes(DU());
  const OffsetLanes<kLanes> offsets(offset);
  alignas(32) std::uint32_t words[2 * kLanes];
  for (std::size_t i = 0; i < kLanes; ++i) std::memcpy(words + 2 * i, base + offsets.at[i], 8);
  const VU low = hn::Load(DU(), words), high = hn::Load(DU(), words + kLanes);
  return {hn::ConcatEven(DU(), high, low), hn::ConcatOdd(DU(), high, low)};
}
#endif

/// Four words that follow one another, per lane.
HWY_INLINE void load_word_quads(const std::byte* base, VI offset, VU words[4]) {
  constexpr std::size_t kLanes = hn::MaxLanes(DU());
  const OffsetLanes<kLanes> offsets(offset);
#if HWY_TARGET <= HWY_AVX3
  const auto block = [&](std::size_t lane) HWY_ATTR {
    return _mm_loadu_si128(reinterpret_cast<const __m128i*>(base + offsets.at[lane]));
  };
  const auto every_fourth = [&](std::size_t lane) HWY_ATTR {
    const __m512i low = _mm512_inserti32x4(_mm512_castsi128_si512(block(lane)), block(lane + 4), 1);
    return VU{_mm512_inserti32x4(_mm512_inserti32x4(low, block(lane + 8), 2), block(lane + 12), 3)};
  };
  const hn::Repartition<std::uint64_t, DU> d64;
  const VU a = every_fourth(0), b = every_fourth(1), c = every_fourth(2), d = every_fourth(3);
  const auto ab_low = hn::BitCast(d64, hn::InterleaveLower(DU(), a, b));
  const auto ab_high = hn::BitCast(d64, hn::InterleaveUpper(DU(), a, b));
  const auto cd_low = hn::BitCast(d64, hn::InterleaveLower(DU(), c, d));
  const auto cd_high = hn::BitCast(d64, hn::InterleaveUpper(DU(), c, d));
  words[0] = hn::BitCast(DU(), hn::InterleaveLower(d64, ab_low, cd_low));
  words[1] = hn::BitCast(DU(), hn::InterleaveUpper(d64, ab_low, cd_low));
  words[2] = hn::BitCast(DU(), hn::InterleaveLower(d64, ab_high, cd_high));
  words[3] = hn::BitCast(DU(), hn::InterleaveUpper(d64, ab_high, cd_high));
#else
  alignas(32) std::uint32_t texels[4 * kLanes];
  for (std::size_t i = 0; i < kLanes; ++i) std::memcpy(texels + 4 * i, base + offsets.at[i], 16);
  hn::LoadInterleaved4(DU(), texels, words[0], words[1], words[2], words[3]);
#endif
}

/// kBytes per lane, and zeros behind them up to a word.
template <std::size_t kBytes>
HWY_INLINE VU load_narrow_words(const std::byte* base, VI offset) {
  constexpr std::size_t kLanes = hn::MaxLanes(DU());
  const OffsetLanes<kLanes> offsets(offset);
  alignas(64) std::uint32_t words[kLanes];
  for (std::size_t i = 0; i < kLanes; ++i) {
    std::uint32_t word = 0;
    std::memcpy(&word, base + offsets.at[i], kBytes);
    words[i] = word;
  }
  return hn::Load(DU(), words);
}

/// One word per lane.
HWY_INLINE VU load_words(const std::byte* base, VI offset) { return load_narrow_words<4>(base, offset); }

/// Texels of at most a word.
HWY_INLINE VU load_narrow_words(const std::byte* base, VI offset, std::uint32_t bytes) {
  switch (bytes) {
    case 1:
      return load_narrow_words<1>(base, offset);
    case 2:
      return load_narrow_words<2>(base, offset);
    case 3:
      return load_narrow_words<3>(base, offset);
    default:
      return load_words(base, offset);
  }
}

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

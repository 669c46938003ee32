// Loads of words for a vector of lanes, one by one: on today's CPUs faster than gathering.

#include <cstring>

#include "texel/sampler/wave_state-inl.h"

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

/// One word per lane.
HWY_INLINE VU load_words(const std::byte* base, VI offset) {
  constexpr std::size_t kLanes = hn::MaxLanes(DU());
  const OffsetLanes<kLanes> offsets(offset);
  alignas(64) std::uint32_t words[kLanes];
  for (std::size_t i = 0; i < kLanes; ++i) std::memcpy(words + i, base + offsets.at[i], 4);
  return hn::Load(DU(), words);
}

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

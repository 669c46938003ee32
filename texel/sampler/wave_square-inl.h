// The four words around each lane's point on one level of two dimensions. Lanes of a vector are neighbours on the
// screen and mostly in the image too: then a few rows of it hold all their texels, and permutations hand them out.

#include <algorithm>

#include "texel/sampler/wave_pairs-inl.h"
#include "texel/sampler/wave_state-inl.h"

#if defined(VITRINE_TEXEL_WAVE_SQUARE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_TEXEL_WAVE_SQUARE_INL_H_
#undef VITRINE_TEXEL_WAVE_SQUARE_INL_H_
#else
#define VITRINE_TEXEL_WAVE_SQUARE_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {

/// Texels of two rows.
struct WordSquare {
  WordPair top, bottom;
};

/// Columns and rows inside the level.
struct SquarePlaces {
  VI x[2], y[2];
};

/// Where a level lies, in bytes; one for all lanes of a vector if `uniform`.
struct SquareLevel {
  VI row_pitch, origin;
  std::ptrdiff_t first_pitch = 0, first_origin = 0;
  bool uniform = false;

  SquareLevel() = default;
  explicit SquareLevel(const LevelLanes& level)
      : row_pitch(level.row_pitch),
        origin(level.origin),
        first_pitch(hn::GetLane(level.row_pitch)),
        first_origin(hn::GetLane(level.origin)) {
    const auto same_pitch = hn::Eq(row_pitch, splat(static_cast<std::int32_t>(first_pitch)));
    const auto same_origin = hn::Eq(origin, splat(static_cast<std::int32_t>(first_origin)));
    uniform = hn::AllTrue(DI(), hn::And(same_pitch, same_origin));
  }
};

#if HWY_TARGET <= HWY_AVX3
/// Least halves of all lanes: both halves are in [0, 32767].
HWY_INLINE std::uint32_t least_halves(__m512i v) {
  const __m256i eight = _mm256_min_epi16(_mm512_castsi512_si256(v), _mm512_extracti64x4_epi64(v, 1));
  __m128i four = _mm_min_epi16(_mm256_castsi256_si128(eight), _mm256_extracti128_si256(eight, 1));
  four = _mm_min_epi16(four, _mm_shuffle_epi32(four, 0x4E));
  return static_cast<std::uint32_t>(_mm_cvtsi128_si32(_mm_min_epi16(four, _mm_shuffle_epi32(four, 0xB1))));
}
HWY_INLINE std::uint32_t largest_halves(__m512i v) {
  const __m256i eight = _mm256_max_epi16(_mm512_castsi512_si256(v), _mm512_extracti64x4_epi64(v, 1));
  __m128i four = _mm_max_epi16(_mm256_castsi256_si128(eight), _mm256_extracti128_si256(eight, 1));
  four = _mm_max_epi16(four, _mm_shuffle_epi32(four, 0x4E));
  return static_cast<std::uint32_t>(_mm_cvtsi128_si32(_mm_max_epi16(four, _mm_shuffle_epi32(four, 0xB1))));
}

/// A lane's word in two rows or four of sixteen; places are 16 * row + column.
HWY_INLINE VU pick_of_two(__m512i place, __m512i row0, __m512i row1) {
  return VU{_mm512_permutex2var_epi32(row0, place, row1)};
}
HWY_INLINE VU pick_of_four(__m512i place, const __m512i row[4]) {
  const __mmask16 lower = _mm512_test_epi32_mask(place, _mm512_set1_epi32(32));
  return VU{_mm512_mask_blend_epi32(lower, _mm512_permutex2var_epi32(row[0], place, row[1]),
                                    _mm512_permutex2var_epi32(row[2], place, row[3]))};
}

/// False if the texels do not lie in four rows of sixteen columns. Columns and rows are below 32768.
HWY_INLINE bool load_near_words(const std::byte* base, const SquareLevel& level, const SquarePlaces& at,
                                WordSquare& out) {
  // Columns and rows in one vector: x in the low halves, y in the high ones.
  const __m512i first = _mm512_or_si512(at.x[0].raw, _mm512_slli_epi32(at.y[0].raw, 16));
  const __m512i second = _mm512_or_si512(at.x[1].raw, _mm512_slli_epi32(at.y[1].raw, 16));
  const std::uint32_t low = least_halves(_mm512_min_epi16(first, second));
  const std::uint32_t high = largest_halves(_mm512_max_epi16(first, second));
  const std::uint32_t left = low & 0xFFFF, top = low >> 16;
  const std::uint32_t columns = (high & 0xFFFF) - left + 1, last_row = (high >> 16) - top;
  if (columns > 16 || last_row > 3) return false;

  const std::byte* const corner = base + level.first_origin + top * level.first_pitch + 4 * std::ptrdiff_t{left};
  const auto columns_mask = static_cast<__mmask16>((1u << columns) - 1);
  const auto load = [&](std::uint32_t row) {
    return _mm512_maskz_loadu_epi32(columns_mask, corner + std::min(row, last_row) * level.first_pitch);
  };
  const __m512i corner_halves = _mm512_set1_epi32(static_cast<std::int32_t>(low));
  const auto place = [](__m512i halves) { return _mm512_or_si512(halves, _mm512_srli_epi32(halves, 12)); };
  const __m512i halves0 = _mm512_sub_epi16(first, corner_halves), halves1 = _mm512_sub_epi16(second, corner_halves);
  const __m512i row_halves = _mm512_set1_epi32(static_cast<std::int32_t>(0xFFFF0000u));
  constexpr int kSelect = 0xCA;  // a ? b : c
  const __m512i top_left = place(halves0), bottom_right = place(halves1);
  const __m512i top_right = place(_mm512_ternarylogic_epi32(row_halves, halves0, halves1, kSelect));
  const __m512i bottom_left = place(_mm512_ternarylogic_epi32(row_halves, halves1, halves0, kSelect));
  const __m512i row0 = load(0), row1 = load(1);
  if (last_row < 2) {
    out.top = {pick_of_two(top_left, row0, row1), pick_of_two(top_right, row0, row1)};
    out.bottom = {pick_of_two(bottom_left, row0, row1), pick_of_two(bottom_right, row0, row1)};
    return true;
  }
  const __m512i rows[4] = {row0, row1, load(2), load(3)};
  const __mmask16 top_below = _mm512_test_epi32_mask(top_left, _mm512_set1_epi32(32));
  const __mmask16 bottom_below = _mm512_cmpge_epi32_mask(bottom_left, _mm512_set1_epi32(16));
  if (last_row == 2 && top_below == 0 && bottom_below == 0xFFFF) {
    // A permutation sees the lowest bit of the row: row 2 is even.
    out.top = {pick_of_two(top_left, row0, row1), pick_of_two(top_right, row0, row1)};
    out.bottom = {pick_of_two(bottom_left, rows[2], row1), pick_of_two(bottom_right, rows[2], row1)};
    return true;
  }
  out.top = {pick_of_four(top_left, rows), pick_of_four(top_right, rows)};
  out.bottom = {pick_of_four(bottom_left, rows), pick_of_four(bottom_right, rows)};
  return true;
}
#else
HWY_INLINE bool load_near_words(const std::byte*, const SquareLevel&, const SquarePlaces&, WordSquare&) {
  return false;
}
#endif

/// Rows as byte offsets with the level's origin.
HWY_INLINE WordSquare load_rows_of_words(const std::byte* base, VI row0, VI row1, VI x0, VI x1) {
  const VI left = hn::ShiftLeft<2>(x0);
  WordSquare out{load_word_pairs(base, hn::Add(row0, left)), load_word_pairs(base, hn::Add(row1, left))};
  const auto apart = hn::Ne(x1, hn::Add(x0, splat(1)));
  if (HWY_UNLIKELY(!hn::AllFalse(DI(), apart))) {
    const VI right = hn::ShiftLeft<2>(x1);
    out.top.second = load_words(base, hn::Add(row0, right));
    out.bottom.second = load_words(base, hn::Add(row1, right));
  }
  return out;
}

HWY_INLINE WordSquare load_square(const std::byte* base, const SquareLevel& level, const SquarePlaces& at) {
  WordSquare out;
  if (level.uniform && load_near_words(base, level, at, out)) return out;
  return load_rows_of_words(base, hn::Add(level.origin, hn::Mul(at.y[0], level.row_pitch)),
                            hn::Add(level.origin, hn::Mul(at.y[1], level.row_pitch)), at.x[0], at.x[1]);
}

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

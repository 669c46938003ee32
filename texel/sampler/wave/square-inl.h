// The four words around each lane's point on one level of two dimensions. Lanes of a vector are neighbours on the
// screen and mostly in the image too: then a few rows of it hold all their texels, and permutations hand them out.

#include <utility>

#include "texel/sampler/wave/pairs-inl.h"
#include "texel/sampler/wave/state-inl.h"

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

/// Where a level lies, in bytes; one for all lanes of a vector if `uniform`.
struct SquareLevel {
  VI row_pitch, origin;
  std::ptrdiff_t first_pitch = 0, first_origin = 0;
  std::int32_t width = 0, height = 0;  ///< texels
  bool uniform = false;

  HWY_INLINE void set(const LevelLanes& level) {
    row_pitch = level.row_pitch;
    origin = level.origin;
    first_pitch = hn::GetLane(row_pitch);
    first_origin = hn::GetLane(origin);
    width = hn::GetLane(level.axis[0].size);
    height = hn::GetLane(level.axis[1].size);
    const auto same_pitch = hn::Eq(row_pitch, splat(static_cast<std::int32_t>(first_pitch)));
    const auto same_origin = hn::Eq(origin, splat(static_cast<std::int32_t>(first_origin)));
    uniform = hn::AllTrue(DI(), hn::And(same_pitch, same_origin));
  }
};

inline constexpr std::size_t kVectors = base::kWaveWidth / hn::MaxLanes(DU());

#if HWY_TARGET <= HWY_AVX3
/// The texels of 2 or 4 bytes of a wave on one level, if those of every vector lie in four rows of 8 or 16 columns.
template <std::size_t kBytes>
class NearTexels {
 public:
  static constexpr bool kExists = true;

  HWY_INLINE void add_first(std::size_t vector, VI x, VI y) { first_[vector] = halves(x, y); }
  HWY_INLINE void add_second(std::size_t vector, VI x, VI y) { second_[vector] = halves(x, y); }

  /// After all vectors were added: whether load() may be called; without `kPairs` only load_firsts().
  template <bool kPairs>
  HWY_INLINE bool find(const SquareLevel& level) {
    __m512i low[kVectors], high[kVectors];
    for (std::size_t v = 0; v < kVectors; ++v) {
      low[v] = kPairs ? _mm512_min_epi16(first_[v], second_[v]) : first_[v];
      high[v] = kPairs ? _mm512_max_epi16(first_[v], second_[v]) : first_[v];
    }
    const __m512i least = fold(low, [](__m512i a, __m512i b) { return _mm512_min_epi16(a, b); });
    const __m512i largest = fold(high, [](__m512i a, __m512i b) { return _mm512_max_epi16(a, b); });
    for (const std::int32_t columns : {8, 16}) {
      if (kBytes == 2 && columns == 8) continue;
      if (level.width < columns || level.height < 4) return false;
      const __m512i limit = _mm512_set1_epi32((level.height - 4) << 16 | (level.width - columns));
      const __m512i corner = _mm512_min_epi16(least, limit);
      const __m512i extent = _mm512_set1_epi32(3 << 16 | (columns - 1));
      if (_mm512_cmpgt_epi16_mask(_mm512_sub_epi16(largest, corner), extent) != 0) continue;
      _mm512_store_si512(corner_, corner);
      wide_ = columns == 16;
      return true;
    }
    return false;
  }

  /// `base`: of a slice.
  HWY_INLINE WordSquare load(const std::byte* base, const SquareLevel& level, std::size_t vector) const {
    if constexpr (kBytes == 2) return load_square<Halves, 12>(base, level, vector);
    return wide_ ? load_wide(base, level, vector) : load_square<Narrow, 13>(base, level, vector);
  }
  /// The first texels alone, of all lanes of the wave.
  HWY_INLINE void load_firsts(const std::byte* base, const SquareLevel& level, std::uint32_t* to) const {
    for (std::size_t v = 0; v < kVectors; ++v) {
      const Corner corner(*this, base, level, v);
      const __m512i x = _mm512_sub_epi16(first_[v], corner.halves);
      VU words;
      if (!wide_) {
        words = Narrow(corner).pick(_mm512_or_si512(x, _mm512_srli_epi32(x, 13)));
      } else {
        const __m512i y = _mm512_srli_epi32(x, 12);
        words = Wide(corner).pick(_mm512_or_si512(x, y), below(y));
      }
      hn::Store(words, DU(), to + v * hn::Lanes(DU()));
    }
  }

 private:
  /// The texels' first column and row.
  struct Corner {
    Corner(const NearTexels& wave, const std::byte* base, const SquareLevel& level, std::size_t vector)
        : pitch(level.first_pitch) {
      const std::uint32_t corner = wave.corner_[4 * vector];
      at = base + level.first_origin + (corner >> 16) * pitch + std::ptrdiff_t{kBytes} * (corner & 0xFFFF);
      halves = _mm512_set1_epi32(static_cast<std::int32_t>(corner));
    }
    const std::byte* at;
    std::ptrdiff_t pitch;
    __m512i halves;
  };
  /// Four rows of eight; places are 8 * row + column, higher bits do not matter.
  struct Narrow {
    explicit Narrow(const Corner& c)
        : upper(two(c.at, c.at + c.pitch)), lower(two(c.at + 2 * c.pitch, c.at + 3 * c.pitch)) {}
    static __m512i two(const std::byte* a, const std::byte* b) {
      const __m256i low = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(a));
      return _mm512_inserti64x4(_mm512_castsi256_si512(low), _mm256_loadu_si256(reinterpret_cast<const __m256i*>(b)),
                                1);
    }
    HWY_INLINE VU pick(__m512i place) const { return VU{_mm512_permutex2var_epi32(upper, place, lower)}; }
    __m512i upper, lower;
  };
  /// Four rows of sixteen texels of two bytes; places are 16 * row + column in the low halves.
  struct Halves : Narrow {
    using Narrow::Narrow;
    HWY_INLINE VU pick(__m512i place) const {
      return VU{_mm512_maskz_permutex2var_epi16(0x55555555, this->upper, place, this->lower)};
    }
  };
  /// Four rows of sixteen words; places are 16 * row + column.
  struct Wide {
    explicit Wide(const Corner& c)
        : row{_mm512_loadu_si512(c.at), _mm512_loadu_si512(c.at + c.pitch), _mm512_loadu_si512(c.at + 2 * c.pitch),
              _mm512_loadu_si512(c.at + 3 * c.pitch)} {
      for (int i = 0; i < 4; ++i) _mm_prefetch(c.at + i * c.pitch + 128, _MM_HINT_T0);
    }
    HWY_INLINE VU pick(__m512i place, __mmask16 below) const {
      return VU{_mm512_mask_blend_epi32(below, _mm512_permutex2var_epi32(row[0], place, row[1]),
                                        _mm512_permutex2var_epi32(row[2], place, row[3]))};
    }
    __m512i row[4];
  };
  /// Columns and rows, below 32768, in one vector: x in the low halves, y in the high ones.
  static HWY_INLINE __m512i halves(VI x, VI y) { return _mm512_or_si512(x.raw, _mm512_slli_epi32(y.raw, 16)); }
  static HWY_INLINE __mmask16 below(__m512i place) { return _mm512_test_epi32_mask(place, _mm512_set1_epi32(32)); }

  /// kShift: from rows in the high halves to places.
  template <class Rows, int kShift>
  HWY_INLINE WordSquare load_square(const std::byte* base, const SquareLevel& level, std::size_t vector) const {
    const Corner corner(*this, base, level, vector);
    const Rows rows(corner);
    const __m512i x0 = _mm512_sub_epi16(first_[vector], corner.halves);
    const __m512i x1 = _mm512_sub_epi16(second_[vector], corner.halves);
    const __m512i y0 = _mm512_srli_epi32(x0, kShift), y1 = _mm512_srli_epi32(x1, kShift);
    return {{rows.pick(_mm512_or_si512(x0, y0)), rows.pick(_mm512_or_si512(x1, y0))},
            {rows.pick(_mm512_or_si512(x0, y1)), rows.pick(_mm512_or_si512(x1, y1))}};
  }
  HWY_INLINE WordSquare load_wide(const std::byte* base, const SquareLevel& level, std::size_t vector) const {
    const Corner corner(*this, base, level, vector);
    const Wide rows(corner);
    const __m512i x0 = _mm512_sub_epi16(first_[vector], corner.halves);
    const __m512i x1 = _mm512_sub_epi16(second_[vector], corner.halves);
    const __m512i y0 = _mm512_srli_epi32(x0, 12), y1 = _mm512_srli_epi32(x1, 12);
    const __mmask16 top = below(y0), bottom = below(y1);
    return {{rows.pick(_mm512_or_si512(x0, y0), top), rows.pick(_mm512_or_si512(x1, y0), top)},
            {rows.pick(_mm512_or_si512(x0, y1), bottom), rows.pick(_mm512_or_si512(x1, y1), bottom)}};
  }

  /// In block v of the result all lanes of vector v combined.
  template <class Combine>
  static HWY_INLINE __m512i fold(const __m512i v[kVectors], Combine combine) {
    const auto blocks = [&](__m512i a, __m512i b) {
      return combine(_mm512_shuffle_i32x4(a, b, 0x88), _mm512_shuffle_i32x4(a, b, 0xDD));
    };
    const __m512i four = blocks(blocks(v[0], v[1]), blocks(v[2], v[3]));
    const __m512i two = combine(four, _mm512_shuffle_epi32(four, _MM_PERM_BADC));
    return combine(two, _mm512_shuffle_epi32(two, _MM_PERM_CDAB));
  }

  __m512i first_[kVectors], second_[kVectors];
  alignas(64) std::uint32_t corner_[16];
  bool wide_ = false;
};
#else
template <std::size_t kBytes>
class NearTexels {
 public:
  static constexpr bool kExists = false;

  void add_first(std::size_t, VI, VI) {}
  void add_second(std::size_t, VI, VI) {}
  template <bool kPairs>
  bool find(const SquareLevel&) {
    return false;
  }
  WordSquare load(const std::byte*, const SquareLevel&, std::size_t) const {
    const VU zero = hn::Zero(DU());
    return {{zero, zero}, {zero, zero}};
  }
  void load_firsts(const std::byte*, const SquareLevel&, std::uint32_t*) const {}
};
#endif
using NearWave = NearTexels<4>;

/// Rows as byte offsets with the level's origin.
HWY_INLINE WordSquare load_rows_of_words(const std::byte* base, VI row0, VI row1, VI x0, VI x1) {
  const VI left = hn::ShiftLeft<2>(x0);
  const VI top = hn::Add(row0, left), bottom = hn::Add(row1, left);
  if (hn::AllTrue(DI(), hn::Eq(x1, hn::Add(x0, splat(1))))) {
    return {load_word_pairs(base, top), load_word_pairs(base, bottom)};
  }
  const VI right = hn::ShiftLeft<2>(x1);
  return {{load_words(base, top), load_words(base, hn::Add(row0, right))},
          {load_words(base, bottom), load_words(base, hn::Add(row1, right))}};
}

/// As above for texels of two bytes, of which two neighbours are a word.
HWY_INLINE WordSquare load_rows_of_halves(const std::byte* base, VI row0, VI row1, VI x0, VI x1) {
  const VI left = hn::ShiftLeft<1>(x0);
  const VI top = hn::Add(row0, left), bottom = hn::Add(row1, left);
  if (hn::AllTrue(DI(), hn::Eq(x1, hn::Add(x0, splat(1))))) {
    const auto split = [](VU both) HWY_ATTR {
      return WordPair{hn::And(both, hn::Set(DU(), 0xffffu)), hn::ShiftRight<16>(both)};
    };
    return {split(load_words(base, top)), split(load_words(base, bottom))};
  }
  const VI right = hn::ShiftLeft<1>(x1);
  return {{load_narrow_words<2>(base, top), load_narrow_words<2>(base, hn::Add(row0, right))},
          {load_narrow_words<2>(base, bottom), load_narrow_words<2>(base, hn::Add(row1, right))}};
}

/// Whether all lanes of the wave read one level of one layer or face, moved by one offset.
inline bool wave_has_one_level(const PreparedSampler& p, const SampleRequest& request, const WaveState& state,
                               int which) {
  const auto same = [](const auto& values) {
    const VU first = hn::Set(DU(), static_cast<std::uint32_t>(values.lane[0]));
    auto equal = hn::Eq(first, first);
    for (std::size_t i = 0; i < base::kWaveWidth; i += hn::Lanes(DU())) {
      const auto* lanes = reinterpret_cast<const std::uint32_t*>(values.lane + i);
      equal = hn::And(equal, hn::Eq(hn::Load(DU(), lanes), first));
    }
    return hn::AllTrue(DU(), equal);
  };
  for (const base::WaveRegister* offset : request.offset) {
    if (offset != nullptr && !same(*offset)) return false;
  }
  return (p.one_level || same(state.level[which])) && (!p.plan.arrayed || same(state.layer_offset)) &&
         (!p.plan.cube || same(state.face));
}

/// Calls reader.with_axes(x axis, y axis) with axes of which the compiler knows the commonest addresses.
template <bool kMoved, class Reader>
HWY_INLINE void with_known_addresses(const AxisLanes axis[2], Reader& reader) {
  const auto known = [&](Address address, std::size_t i) HWY_ATTR {
    return AxisLanes{address, true, true, kMoved, axis[i].size, axis[i].size_float, axis[i].offset};
  };
  const bool alike = axis[0].address == axis[1].address && axis[0].normalized && axis[0].has_offset == kMoved;
  if (alike && axis[0].address == Address::kRepeat && axis[0].pot && axis[1].pot) {
    reader.with_axes(known(Address::kRepeat, 0), known(Address::kRepeat, 1));
  } else if (alike && axis[0].address == Address::kClamp) {
    reader.with_axes(known(Address::kClamp, 0), known(Address::kClamp, 1));
  } else {
    reader.with_axes(axis[0], axis[1]);
  }
}

/// Texels with the weights of the second ones.
template <class Weight>
struct WeighedWords {
  WordSquare words;
  Weight x, y;
};

/// The texels of 2 or 4 bytes around the points of a wave on one of the two levels that its lanes read, as words; those
/// of a cube inside their faces. Axis: set() from AxisLanes that stay where they are, taps(coordinate) for two texels
/// and the weight of the second.
template <class Axis, std::size_t kBytes = 4>
class SquareReader {
 public:
  using Weight = decltype(std::declval<Axis>().taps(VF()).weight);
  using Weighed = WeighedWords<Weight>;

  HWY_INLINE SquareReader(const PreparedSampler& p, const SampleRequest& request, const WaveState& state, int which)
      : p_(p), request_(request), state_(state), which_(which), whole_(wave_has_one_level(p, request, state, which)) {
    if (!whole_) return;
    load_level_of(0);
    if constexpr (!Near::kExists) return;
    with_known_addresses<false>(level_.axis, *this);
    is_near_ = near_.template find<true>(square_);
  }

  /// Finds the texels of all vectors.
  HWY_INLINE void with_axes(const AxisLanes& x_axis, const AxisLanes& y_axis) {
    Axis x_taps, y_taps;
    x_taps.set(x_axis);
    y_taps.set(y_axis);
    for (std::size_t v = 0; v < kVectors; ++v) {
      const auto x = x_taps.taps(coord(0, v));
      const auto y = y_taps.taps(coord(1, v));
      near_.add_first(v, x.first, y.first);
      near_.add_second(v, x.second, y.second);
      x_[v] = x.weight;
      y_[v] = y.weight;
    }
  }

  HWY_INLINE Weighed read(std::size_t vector) {
    if constexpr (!Near::kExists) return find_alone(vector);
    if (is_near_) return {near_.load(p_.plan.view->base, square_, vector), x_[vector], y_[vector]};
    return read_alone(vector);
  }

 private:
  using Near = NearTexels<kBytes>;

  HWY_INLINE void load_level_of(std::size_t vector) {
    load_level<2>(p_, request_, state_, which_, vector * hn::Lanes(DF()), p_.plan.cube, level_);
    axis_[0].set(level_.axis[0]);
    axis_[1].set(level_.axis[1]);
    square_.set(level_);
  }
  HWY_INLINE VF coord(std::size_t i, std::size_t vector) const {
    return hn::LoadU(DF(), state_.coord[i] + vector * hn::Lanes(DF()));
  }
  /// A vector by itself.
  HWY_NOINLINE Weighed read_alone(std::size_t vector) { return find_alone(vector); }
  HWY_INLINE Weighed find_alone(std::size_t vector) {
    if (!whole_) load_level_of(vector);
    const std::byte* const base = p_.plan.view->base;
    const auto x = axis_[0].taps(coord(0, vector)), y = axis_[1].taps(coord(1, vector));
    if (square_.uniform) {
      Near near;
      for (std::size_t v = 0; v < kVectors; ++v) {
        near.add_first(v, x.first, y.first);
        near.add_second(v, x.second, y.second);
      }
      if (near.template find<true>(square_)) return {near.load(base, square_, 0), x.weight, y.weight};
    }
    const VI row0 = hn::Add(square_.origin, hn::Mul(y.first, square_.row_pitch));
    const VI row1 = hn::Add(square_.origin, hn::Mul(y.second, square_.row_pitch));
    if constexpr (kBytes == 2)
      return {load_rows_of_halves(base, row0, row1, x.first, x.second), x.weight, y.weight};
    else
      return {load_rows_of_words(base, row0, row1, x.first, x.second), x.weight, y.weight};
  }

  const PreparedSampler& p_;
  const SampleRequest& request_;
  const WaveState& state_;
  int which_;
  bool whole_;
  bool is_near_ = false;
  LevelLanes level_;
  Axis axis_[2];
  SquareLevel square_;
  Weight x_[kVectors], y_[kVectors];
  Near near_;
};

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

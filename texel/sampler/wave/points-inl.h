// The texel of one word at each lane's point in two dimensions: the nearest, or the first of a gather.

#include "texel/sampler/wave/square-inl.h"
#include "texel/sampler/wave/texels-inl.h"

#if defined(VITRINE_TEXEL_WAVE_POINTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_TEXEL_WAVE_POINTS_INL_H_
#undef VITRINE_TEXEL_WAVE_POINTS_INL_H_
#else
#define VITRINE_TEXEL_WAVE_POINTS_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {

/// Which texel of an axis a coordinate names.
struct NearestByteRule {
  static HWY_INLINE VI at(const AxisLanes& axis, VF s) { return lanes_nearest_bytes(axis, s); }
};
struct NearestFloatRule {
  static HWY_INLINE VI at(const AxisLanes& axis, VF s) { return lanes_nearest(axis, s); }
};
struct GatherRule {
  static HWY_INLINE VI at(const AxisLanes& axis, VF s) { return lanes_gather(axis, s).first; }
};

inline bool vector_is_active(const SampleRequest& request, std::size_t first) {
  return (request.active >> first & base::first_lanes(hn::Lanes(DF()))) != 0;
}

/// The texels of a wave's points; the request, state and what they point to must live as long. No cubes.
template <class Rule>
class PointReader {
 public:
  HWY_INLINE PointReader(const PreparedSampler& p, const SampleRequest& request, const WaveState& state)
      : p_(p), request_(request), state_(state), whole_(wave_has_one_level(p, request, state, 0)) {
    if (!whole_) return;
    load_level<2>(p, request, state, 0, 0, false, level_);
    square_.set(level_);
  }

  /// Of vectors with active lanes at least.
  HWY_INLINE void read(WordLanes& words) {
    if (!whole_) return read_apart(nullptr, words);
    words_ = &words;
    with_known_addresses<false>(level_.axis, *this);
  }

  /// The same with all points moved by texels, instead of by the request's offset.
  HWY_INLINE void read_moved(const std::array<std::int32_t, 2>& offset, WordLanes& words) {
    if (!whole_) return read_apart(&offset, words);
    move(offset);
    words_ = &words;
    with_known_addresses<true>(level_.axis, *this);
  }

  /// Reads all texels.
  HWY_INLINE void with_axes(const AxisLanes& x_axis, const AxisLanes& y_axis) const {
    VI x[kVectors], y[kVectors];
    NearWave near;
#pragma GCC unroll 4
    for (std::size_t v = 0; v < kVectors; ++v) {
      x[v] = Rule::at(x_axis, coord(0, v));
      y[v] = Rule::at(y_axis, coord(1, v));
      near.add_first(v, x[v], y[v]);
    }
    if (near.template find<false>(square_)) return near.load_firsts(p_.plan.view->base, square_, words_->lane);
    for (std::size_t v = 0; v < kVectors; ++v) {
      const std::size_t first = v * hn::Lanes(DF());
      if (vector_is_active(request_, first)) hn::Store(load(level_, x[v], y[v]), DU(), words_->lane + first);
    }
  }

 private:
  HWY_INLINE void move(const std::array<std::int32_t, 2>& offset) {
    for (std::size_t i = 0; i < 2; ++i) {
      level_.axis[i].has_offset = true;
      level_.axis[i].offset = splat(offset[i]);
    }
  }
  HWY_INLINE VF coord(std::size_t axis, std::size_t v) const {
    return hn::LoadU(DF(), state_.coord[axis] + v * hn::Lanes(DF()));
  }
  HWY_INLINE VU load(const LevelLanes& level, VI x, VI y) const {
    const VI row = hn::Add(level.origin, hn::Mul(y, level.row_pitch));
    return load_words(p_.plan.view->base, hn::Add(row, hn::ShiftLeft<2>(x)));
  }

  /// Vector by vector.
  HWY_NOINLINE void read_apart(const std::array<std::int32_t, 2>* offset, WordLanes& words) {
    for (std::size_t v = 0; v < kVectors; ++v) {
      const std::size_t first = v * hn::Lanes(DF());
      if (!vector_is_active(request_, first)) continue;
      load_level<2>(p_, request_, state_, 0, first, false, level_);
      if (offset != nullptr) move(*offset);
      const VI x = Rule::at(level_.axis[0], coord(0, v)), y = Rule::at(level_.axis[1], coord(1, v));
      hn::Store(load(level_, x, y), DU(), words.lane + first);
    }
  }

  const PreparedSampler& p_;
  const SampleRequest& request_;
  const WaveState& state_;
  bool whole_;
  LevelLanes level_;
  SquareLevel square_;
  WordLanes* words_ = nullptr;
};

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

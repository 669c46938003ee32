// The commonest samplers, vector by vector without a detour through memory: averages of neighbours in two or three
// dimensions, four bytes each, one level or two. The bits of the general 8-bit sampler.

#include <bit>

#include "texel/codec/byte_blend-inl.h"
#include "texel/sampler/wave/square-inl.h"
#include "texel/sampler/wave/state-inl.h"

#if defined(VITRINE_TEXEL_WAVE_BILINEAR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_TEXEL_WAVE_BILINEAR_INL_H_
#undef VITRINE_TEXEL_WAVE_BILINEAR_INL_H_
#else
#define VITRINE_TEXEL_WAVE_BILINEAR_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {

/// One axis of a level: what does not depend on the coordinate.
struct BilinearAxis {
  bool repeat = false;
  bool moved = false;
  VI last, offset;
  VF scale;  ///< coordinates to 256ths of texels

  HWY_INLINE void set(const AxisLanes& axis) {
    repeat = axis.address == Address::kRepeat;
    moved = axis.has_offset;
    offset = axis.offset;
    last = hn::Sub(axis.size, splat(1));
    scale = lanes_int_to_float(hn::ShiftLeft<8>(axis.size));
  }

  /// The two texels as lanes_linear_bytes finds them, for sizes that are powers of two if repeated.
  HWY_INLINE ByteTapLanes taps(VF s) const {
    const VI q = hn::Sub(lanes_round_to_int(hn::Mul(s, scale)), splat(128));
    VI i = hn::ShiftRight<8>(q);
    if (moved) i = hn::Add(i, offset);
    const VI next = hn::Add(i, splat(1)), weight = hn::And(q, splat(255));
    if (repeat) return {hn::And(i, last), hn::And(next, last), weight};
    // Two equal texels at the edges: any weight will do.
    return {lanes_clamp(i, last), lanes_clamp(next, last), weight};
  }
};

HWY_INLINE Halves mix_pair(VI weight, const WordPair& pair) {
  return blend_bytes(weight, unpack_bytes(pair.first), unpack_bytes(pair.second));
}

/// A slice: four texels, with spread weights.
HWY_INLINE Halves mix_square(const WordSquare& square, VI weight_x, VI weight_y) {
  return blend_bytes(weight_y, mix_pair(weight_x, square.top), mix_pair(weight_x, square.bottom));
}

/// Which of the four bytes each result is; or a constant.
struct ByteResults {
  struct Component {
    base::WaveRegister* to = nullptr;
    int byte = -1;
    float constant = 0;
  };
  Component component[4];

  ByteResults(const ImageView& view, const SampleResult& result) {
    for (std::size_t c = 0; c < 4; ++c) {
      const std::uint8_t source = view.swizzle[c];
      const int byte = source < 4 ? view.format->rgba[source] : -1;
      component[c] = {result[c], byte, source == 3 || source == 5 ? 1.0f : 0.0f};
    }
  }

  HWY_INLINE void store(const Halves& texel, base::LaneMask active, std::size_t first) const {
    const VU even = hn::BitCast(DU(), texel.even), odd = hn::BitCast(DU(), texel.odd);
    for (const Component& c : component) {
      if (c.to == nullptr) continue;
      if (c.byte < 0) {
        store_lanes(as_unsigned(splat(c.constant)), active, first, *c.to);
        continue;
      }
      const VU two = (c.byte & 1) != 0 ? odd : even;
      const VU byte = (c.byte & 2) != 0 ? hn::ShiftRight<16>(two) : hn::And(two, hn::Set(DU(), 0xFFFFu));
      const VF value = hn::Mul(lanes_int_to_float(hn::BitCast(DI(), byte)), splat(1.0f / 255.0f));
      store_lanes(as_unsigned(value), active, first, *c.to);
    }
  }
};

/// Spread weights of the farther level, if any lane has one.
struct LevelWeights {
  VI weight[kVectors];
  bool any = false;

  LevelWeights() = default;
  explicit LevelWeights(const WaveState& state) {
    auto none = hn::Eq(splat(0), splat(0));
    for (std::size_t v = 0; v < kVectors; ++v) {
      const VF scaled = hn::Mul(hn::Load(DF(), state.fraction.lane + v * hn::Lanes(DF())), splat(256.0f));
      const VI w = hn::And(lanes_truncate_to_int(scaled), splat(255));
      none = hn::And(none, hn::Eq(w, splat(0)));
      weight[v] = spread_weight(w);
    }
    any = !hn::AllTrue(DI(), none);
  }
};

inline bool any_active(const SampleRequest& request, std::size_t first) {
  return (request.active >> first & base::first_lanes(hn::Lanes(DF()))) != 0;
}

/// Two dimensions.
HWY_NOINLINE inline void sample_bilinear_flat(const PreparedSampler& p, const SampleRequest& request,
                                              const WaveState& state, const SampleResult& result) {
  const ByteResults results(*p.plan.view, result);
  const auto mix = [](const SquareReader<BilinearAxis>::Weighed& s)
                       HWY_ATTR { return mix_square(s.words, spread_weight(s.x), spread_weight(s.y)); };
  LevelWeights weights;
  if (p.plan.mip == MipFilter::kLinear && !p.one_level) weights = LevelWeights(state);
  SquareReader<BilinearAxis> nearer(p, request, state, 0);
  if (!weights.any) {
    for (std::size_t v = 0; v < kVectors; ++v) {
      const std::size_t first = v * hn::Lanes(DF());
      if (any_active(request, first)) results.store(mix(nearer.read(v)), request.active, first);
    }
    return;
  }
  SquareReader<BilinearAxis> farther(p, request, state, 1);
  for (std::size_t v = 0; v < kVectors; ++v) {
    const std::size_t first = v * hn::Lanes(DF());
    if (!any_active(request, first)) continue;
    results.store(blend_bytes(weights.weight[v], mix(nearer.read(v)), mix(farther.read(v))), request.active, first);
  }
}

/// Three dimensions: one level.
class VolumeLevel {
 public:
  HWY_INLINE void load(const PreparedSampler& p, const SampleRequest& request, const WaveState& state, int which,
                       std::size_t first) {
    LevelLanes level;
    load_level<3>(p, request, state, which, first, false, level);
    for (std::size_t i = 0; i < 3; ++i) axis_[i].set(level.axis[i]);
    slice_pitch_ = level.slice_pitch;
    square_.set(level);
  }

  HWY_INLINE Halves read(const std::byte* base, const VF coord[3]) const {
    const ByteTapLanes x = axis_[0].taps(coord[0]), y = axis_[1].taps(coord[1]), z = axis_[2].taps(coord[2]);
    const VI weight_x = spread_weight(x.weight), weight_y = spread_weight(y.weight);
    NearWave near;
    for (std::size_t v = 0; v < kVectors; ++v) {
      near.add_first(v, x.first, y.first);
      near.add_second(v, x.second, y.second);
    }
    Halves first, second;
    if (!square_.uniform || !near.find<true>(square_) ||
        !read_slices(base, near, z, weight_x, weight_y, first, second)) {
      const VI row0 = hn::Add(square_.origin, hn::Mul(y.first, square_.row_pitch));
      const VI row1 = hn::Add(square_.origin, hn::Mul(y.second, square_.row_pitch));
      const auto mix_slice = [&](VI slice) HWY_ATTR {
        const VI offset = hn::Mul(slice, slice_pitch_);
        const WordSquare square =
            load_rows_of_words(base, hn::Add(row0, offset), hn::Add(row1, offset), x.first, x.second);
        return mix_square(square, weight_x, weight_y);
      };
      first = mix_slice(z.first);
      second = mix_slice(z.second);
    }
    return blend_bytes(spread_weight(z.weight), first, second);
  }

 private:
  /// The averages in both slices of every lane, if there are at most two pairs of slices.
  HWY_INLINE bool read_slices(const std::byte* base, const NearWave& near, const ByteTapLanes& z, VI weight_x,
                              VI weight_y, Halves& first, Halves& second) const {
    const std::ptrdiff_t pitch = hn::GetLane(slice_pitch_);
    const auto mix_slice = [&](std::int32_t slice) HWY_ATTR {
      return mix_square(near.load(base + slice * pitch, square_, 0), weight_x, weight_y);
    };
    const std::int32_t a = hn::GetLane(z.first), a_next = hn::GetLane(z.second);
    const auto as_lane_0 = hn::And(hn::Eq(z.first, splat(a)), hn::Eq(z.second, splat(a_next)));
    const base::LaneMask others = ~lanes_mask_bits(DI(), as_lane_0) & base::first_lanes(hn::Lanes(DI()));
    if (others == 0) {
      first = mix_slice(a);
      second = mix_slice(a_next);
      return true;
    }
    alignas(64) std::int32_t slices[2][hn::MaxLanes(DI())];
    hn::Store(z.first, DI(), slices[0]);
    hn::Store(z.second, DI(), slices[1]);
    const auto other = static_cast<std::size_t>(std::countr_zero(others));
    const std::int32_t b = slices[0][other], b_next = slices[1][other];
    const auto as_other = hn::And(hn::Eq(z.first, splat(b)), hn::Eq(z.second, splat(b_next)));
    if (!hn::AllTrue(DI(), hn::Or(as_lane_0, as_other))) return false;
    const Halves at_a = mix_slice(a), at_b = mix_slice(b);
    const Halves at_a_next = a_next == b ? at_b : mix_slice(a_next), at_b_next = b_next == a ? at_a : mix_slice(b_next);
    const auto select = [&](const Halves& yes, const Halves& no) HWY_ATTR {
      const auto mask = hn::BitCast(D16(), hn::VecFromMask(DI(), as_lane_0));
      return Halves{hn::IfVecThenElse(mask, yes.even, no.even), hn::IfVecThenElse(mask, yes.odd, no.odd)};
    };
    first = select(at_a, at_b);
    second = select(at_a_next, at_b_next);
    return true;
  }

  BilinearAxis axis_[3];
  VI slice_pitch_;
  SquareLevel square_;
};

HWY_NOINLINE inline void sample_bilinear_volume(const PreparedSampler& p, const SampleRequest& request,
                                                const WaveState& state, const SampleResult& result) {
  const std::byte* const base = p.plan.view->base;
  const ByteResults results(*p.plan.view, result);
  LevelWeights weights;
  if (p.plan.mip == MipFilter::kLinear && !p.one_level) weights = LevelWeights(state);
  const bool same_level = level_is_uniform(p, request, false);
  VolumeLevel level, farther;
  if (same_level) level.load(p, request, state, 0, 0);
  for (std::size_t v = 0; v < kVectors; ++v) {
    const std::size_t first = v * hn::Lanes(DF());
    if (!any_active(request, first)) continue;
    VF coord[3];
    for (std::uint32_t i = 0; i < 3; ++i) coord[i] = hn::LoadU(DF(), state.coord[i] + first);
    if (!same_level) level.load(p, request, state, 0, first);
    Halves texel = level.read(base, coord);
    if (weights.any) {
      farther.load(p, request, state, 1, first);
      texel = blend_bytes(weights.weight[v], texel, farther.read(base, coord));
    }
    results.store(texel, request.active, first);
  }
}

inline void sample_bilinear(const PreparedSampler& p, const SampleRequest& request, const WaveState& state,
                            const SampleResult& result) {
  p.plan.dims == 2 ? sample_bilinear_flat(p, request, state, result)
                   : sample_bilinear_volume(p, request, state, result);
}

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

// The commonest samplers, vector by vector without a detour through memory: averages of neighbours in two or three
// dimensions, four bytes each, one level or two. The bits of the general 8-bit sampler.

#include "texel/codec/byte_blend-inl.h"
#include "texel/sampler/wave_square-inl.h"
#include "texel/sampler/wave_state-inl.h"

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
  VI last;
  VF scale;  ///< coordinates to 256ths of texels

  BilinearAxis() = default;
  explicit BilinearAxis(const AxisLanes& axis)
      : repeat(axis.address == Address::kRepeat),
        last(hn::Sub(axis.size, splat(1))),
        scale(lanes_int_to_float(hn::ShiftLeft<8>(axis.size))) {}

  /// The two texels as lanes_linear_bytes finds them, for sizes that are powers of two if repeated.
  HWY_INLINE ByteTapLanes taps(VF s) const {
    const VI q = hn::Sub(lanes_round_to_int(hn::Mul(s, scale)), splat(128));
    const VI i = hn::ShiftRight<8>(q), next = hn::Add(i, splat(1));
    const VI weight = hn::And(q, splat(255));
    if (repeat) return {hn::And(i, last), hn::And(next, last), weight};
    // Two equal texels at the edges: any weight will do.
    return {lanes_clamp(i, last), lanes_clamp(next, last), weight};
  }
};

template <std::uint32_t kDims>
struct BilinearLevel {
  BilinearAxis axis[3];
  VI slice_pitch;
  SquareLevel square;

  explicit BilinearLevel(const LevelLanes& level) : slice_pitch(level.slice_pitch), square(level) {
    for (std::uint32_t i = 0; i < kDims; ++i) axis[i] = BilinearAxis(level.axis[i]);
  }
};

HWY_INLINE Halves mix_pair(VI weight, const WordPair& pair) {
  return blend_bytes(weight, unpack_bytes(pair.first), unpack_bytes(pair.second));
}

/// A slice: four texels, with spread weights.
HWY_INLINE Halves mix_square(const WordSquare& square, VI weight_x, VI weight_y) {
  return blend_bytes(weight_y, mix_pair(weight_x, square.top), mix_pair(weight_x, square.bottom));
}

/// Four bytes per lane.
template <std::uint32_t kDims>
HWY_INLINE VU bilinear_bytes(const std::byte* base, const BilinearLevel<kDims>& level, const VF coord[kDims]) {
  const ByteTapLanes x = level.axis[0].taps(coord[0]), y = level.axis[1].taps(coord[1]);
  const VI weight_x = spread_weight(x.weight), weight_y = spread_weight(y.weight);
  if constexpr (kDims == 2) {
    const SquarePlaces places{{x.first, x.second}, {y.first, y.second}};
    return pack_bytes(mix_square(load_square(base, level.square, places), weight_x, weight_y));
  } else {
    const ByteTapLanes z = level.axis[2].taps(coord[2]);
    const VI row0 = hn::Add(level.square.origin, hn::Mul(y.first, level.square.row_pitch));
    const VI row1 = hn::Add(level.square.origin, hn::Mul(y.second, level.square.row_pitch));
    const auto mix_slice = [&](VI slice) {
      const VI offset = hn::Mul(slice, level.slice_pitch);
      const WordSquare square =
          load_rows_of_words(base, hn::Add(row0, offset), hn::Add(row1, offset), x.first, x.second);
      return mix_square(square, weight_x, weight_y);
    };
    return pack_bytes(blend_bytes(spread_weight(z.weight), mix_slice(z.first), mix_slice(z.second)));
  }
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

  HWY_INLINE void store(VU packed, base::LaneMask active, std::size_t first) const {
    for (const Component& c : component) {
      if (c.to == nullptr) continue;
      const VU byte = hn::And(hn::ShiftRightSame(packed, 8 * std::max(c.byte, 0)), hn::Set(DU(), 255u));
      VF value = hn::Mul(lanes_int_to_float(hn::BitCast(DI(), byte)), splat(1.0f / 255.0f));
      if (c.byte < 0) value = splat(c.constant);
      store_lanes(as_unsigned(value), active, first, *c.to);
    }
  }
};

template <std::uint32_t kDims>
HWY_NOINLINE void sample_bilinear(const PreparedSampler& p, const SampleRequest& request, const WaveState& state,
                                  const SampleResult& result) {
  const std::byte* const base = p.plan.view->base;
  const ByteResults results(*p.plan.view, result);
  const bool two_levels = p.plan.mip == MipFilter::kLinear && !p.one_level;
  const bool same_level = level_is_uniform(p, request, false);
  BilinearLevel<kDims> level(load_level<kDims>(p, request, state, 0, 0, false));
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DF())) {
    if ((request.active >> first & base::first_lanes(hn::Lanes(DF()))) == 0) continue;
    VF coord[kDims];
    for (std::uint32_t i = 0; i < kDims; ++i) coord[i] = hn::LoadU(DF(), state.coord[i] + first);
    if (!same_level) level = BilinearLevel<kDims>(load_level<kDims>(p, request, state, 0, first, false));
    VU packed = bilinear_bytes<kDims>(base, level, coord);
    if (two_levels) {
      const VF scaled = hn::Mul(hn::Load(DF(), state.fraction.lane + first), splat(256.0f));
      const VI weight = hn::And(lanes_truncate_to_int(scaled), splat(255));
      if (!hn::AllTrue(DI(), hn::Eq(weight, splat(0)))) {
        const BilinearLevel<kDims> farther(load_level<kDims>(p, request, state, 1, first, false));
        const VU other = bilinear_bytes<kDims>(base, farther, coord);
        packed = pack_bytes(blend_bytes(spread_weight(weight), unpack_bytes(packed), unpack_bytes(other)));
      }
    }
    results.store(packed, request.active, first);
  }
}

inline void sample_bilinear(const PreparedSampler& p, const SampleRequest& request, const WaveState& state,
                            const SampleResult& result) {
  p.plan.dims == 2 ? sample_bilinear<2>(p, request, state, result) : sample_bilinear<3>(p, request, state, result);
}

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

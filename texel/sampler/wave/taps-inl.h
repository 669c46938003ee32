// Where the texels of a float lookup lie: the taps of a whole wave on a level of any dimension, address mode and
// format, with their weights (lavapipe-texture-blend.md A3, A6).

#include "texel/sampler/model/cube.h"
#include "texel/sampler/prepared.h"
#include "texel/sampler/wave/bilinear_words-inl.h"
#include "texel/sampler/wave/cube-inl.h"
#include "texel/sampler/wave/single_words-inl.h"
#include "texel/sampler/wave/texels-inl.h"

#if defined(VITRINE_TEXEL_WAVE_TAPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_TEXEL_WAVE_TAPS_INL_H_
#undef VITRINE_TEXEL_WAVE_TAPS_INL_H_
#else
#define VITRINE_TEXEL_WAVE_TAPS_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {

inline constexpr std::size_t kMaxTaps = 8;

/// Texels of one level; tap k is the second of x if bit 0 is set, of y by bit 1, of z by bit 2.
struct FloatTaps {
  TexelPlaces place[kMaxTaps];
  base::LaneMask outside[kMaxTaps];  ///< of the level: the border colour
  FloatLanes weight[3];
  IntLanes corner;  ///< cubes: the tap that does not exist, 4 if all do
  base::LaneMask corners = 0;
  std::uint32_t count = 1;
  bool neighbours = false;  ///< every second texel in x follows the first in memory
};

/// Everything that one call passes from step to step.
struct Call {
  Call(const PreparedSampler& prepared, const SampleRequest& r, const SampleResult& result)
      : p(prepared), request(r), wanted(wanted_components(*prepared.plan.view, result)), compare(r.dref != nullptr) {}

  const PreparedSampler& p;
  const SampleRequest& request;
  Components wanted;
  bool compare;
  FloatLanes reference;  ///< only with `compare`
  WaveState state;

  const Plan& plan() const { return p.plan; }
  const ImageView& view() const { return *p.plan.view; }
  VkSamplerReductionMode reduction() const { return p.plan.sampler->reduction; }
};

struct AxisTaps {
  VI at[2];
};

HWY_INLINE AxisTaps find_axis(const AxisLanes& axis, VF s, bool linear, bool gather, std::size_t first,
                              FloatLanes& weight) {
  if (!linear) {
    const VI i = lanes_nearest(axis, s);
    return {{i, i}};
  }
  const TapLanes taps = gather ? lanes_gather(axis, s) : lanes_linear(axis, s);
  hn::Store(taps.weight, DF(), weight.lane + first);
  return {{taps.first, taps.second}};
}

HWY_INLINE hn::Mask<DI> outside_of(VI i, VI size) { return hn::Or(hn::Lt(i, splat(0)), hn::Not(hn::Lt(i, size))); }

/// Moves i inside the level and tells which lanes were not.
HWY_INLINE VI enter(VI i, VI size, base::LaneMask& outside, std::size_t first) {
  outside |= lanes_mask_bits(DI(), outside_of(i, size)) << first;
  return lanes_clamp(i, hn::Sub(size, splat(1)));
}

/// Where the two taps of one axis lie: bytes, and places inside a block.
struct AxisPlaces {
  VI offset[2];
  VI inner[2];
};

/// The places of axis i; lanes outside the level go to its edge and into `outside`.
HWY_INLINE AxisPlaces place_axis(const FormatDesc& format, const LevelLanes& level, std::uint32_t i, AxisTaps axis,
                                 bool linear, bool border, std::size_t first, base::LaneMask outside[2]) {
  const std::int32_t blocks[3] = {format.block_width, format.block_height, 1};
  const VI pitch[3] = {splat(static_cast<std::int32_t>(format.block_bytes)), level.row_pitch, level.slice_pitch};
  AxisPlaces places;
  for (std::uint32_t t = 0; t < (linear ? 2u : 1u); ++t) {
    VI at = axis.at[t];
    if (border) at = enter(at, level.axis[i].size, outside[t], first);
    if (blocks[i] != 1) {
      at = split_block(at, static_cast<std::uint32_t>(blocks[i]), places.inner[t]);
      if (i == 1) places.inner[t] = hn::Mul(places.inner[t], splat(blocks[0]));
    } else {
      places.inner[t] = splat(0);
    }
    places.offset[t] = hn::Mul(at, pitch[i]);
  }
  return places;
}

template <std::uint32_t kDims>
HWY_NOINLINE void find_taps_in(Call& call, int which, bool linear, FloatTaps& taps) {
  const Plan& plan = call.plan();
  const FormatDesc& format = *call.view().format;
  const bool border =
      plan.address[0] == Address::kBorder || plan.address[1] == Address::kBorder || plan.address[2] == Address::kBorder;
  const bool same_level = level_is_uniform(call.p, call.request, plan.cube);
  base::LaneMask outside[3][2]{};
  taps.count = linear ? 1u << kDims : 1u;
  taps.neighbours = linear && !format.is_compressed();
  LevelLanes level;
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DF())) {
    if (first == 0 || !same_level) load_level<kDims>(call.p, call.request, call.state, which, first, plan.cube, level);
    AxisPlaces axis[3];
    for (std::uint32_t i = 0; i < kDims; ++i) {
      const AxisTaps at = find_axis(level.axis[i], hn::LoadU(DF(), call.state.coord[i] + first), linear, plan.gather,
                                    first, taps.weight[i]);
      if (i == 0 && linear) {
        taps.neighbours = taps.neighbours && hn::AllTrue(DI(), hn::Eq(at.at[1], hn::Add(at.at[0], splat(1))));
      }
      axis[i] = place_axis(format, level, i, at, linear, border, first, outside[i]);
    }
    for (std::uint32_t k = 0; k < taps.count; ++k) {
      VI offset = hn::Add(level.origin, axis[0].offset[k & 1]);
      if (kDims > 1) offset = hn::Add(offset, axis[1].offset[k >> 1 & 1]);
      if (kDims > 2) offset = hn::Add(offset, axis[2].offset[k >> 2]);
      hn::Store(offset, DI(), taps.place[k].offset.lane + first);
      if (!format.is_compressed()) continue;
      VI inner = axis[0].inner[k & 1];
      if (kDims > 1) inner = hn::Add(inner, axis[1].inner[k >> 1 & 1]);
      hn::Store(inner, DI(), taps.place[k].inner.lane + first);
    }
  }
  for (std::uint32_t k = 0; k < taps.count; ++k) {
    taps.outside[k] = outside[0][k & 1] | outside[1][k >> 1 & 1] | outside[2][k >> 2];
  }
  taps.neighbours = taps.neighbours && !border;
}

/// The same in two dimensions of texels that are no blocks, and no border. Without `kPairs` the first texel alone.
template <class Axis, bool kPairs>
HWY_NOINLINE void find_flat_taps(Call& call, int which, FloatTaps& taps) {
  const VI bytes = splat(static_cast<std::int32_t>(call.view().format->block_bytes));
  const bool same_level = level_is_uniform(call.p, call.request, false);
  auto neighbours = hn::Eq(bytes, bytes);
  LevelLanes level;
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DF())) {
    if (first == 0 || !same_level) load_level<2>(call.p, call.request, call.state, which, first, false, level);
    const TapLanes x = Axis{&level.axis[0]}.taps(hn::LoadU(DF(), call.state.coord[0] + first));
    const TapLanes y = Axis{&level.axis[1]}.taps(hn::LoadU(DF(), call.state.coord[1] + first));
    if constexpr (!kPairs) {
      const VI row = hn::Add(level.origin, hn::Mul(y.first, level.row_pitch));
      hn::Store(hn::Add(row, hn::Mul(x.first, bytes)), DI(), taps.place[0].offset.lane + first);
      continue;
    }
    neighbours = hn::And(neighbours, hn::Eq(x.second, hn::Add(x.first, splat(1))));
    const VI left = hn::Mul(x.first, bytes), right = hn::Mul(x.second, bytes);
    const VI top = hn::Add(level.origin, hn::Mul(y.first, level.row_pitch));
    const VI bottom = hn::Add(level.origin, hn::Mul(y.second, level.row_pitch));
    hn::Store(x.weight, DF(), taps.weight[0].lane + first);
    hn::Store(y.weight, DF(), taps.weight[1].lane + first);
    hn::Store(hn::Add(top, left), DI(), taps.place[0].offset.lane + first);
    hn::Store(hn::Add(top, right), DI(), taps.place[1].offset.lane + first);
    hn::Store(hn::Add(bottom, left), DI(), taps.place[2].offset.lane + first);
    hn::Store(hn::Add(bottom, right), DI(), taps.place[3].offset.lane + first);
  }
  for (std::uint32_t k = 0; k < 4; ++k) taps.outside[k] = 0;
  taps.count = kPairs ? 4 : 1;
  taps.neighbours = kPairs && hn::AllTrue(DI(), neighbours);
}

inline HWY_NOINLINE void find_taps(Call& call, int which, bool linear, FloatTaps& taps) {
  const Plan& plan = call.plan();
  const bool border = plan.address[0] == Address::kBorder || plan.address[1] == Address::kBorder;
  if (plan.dims == 2 && !plan.cube && !border && !call.view().format->is_compressed()) {
    if (!linear) return find_flat_taps<NearestFloatAxis, false>(call, which, taps);
    return plan.gather ? find_flat_taps<GatherAxis, true>(call, which, taps)
                       : find_flat_taps<FloatAxis, true>(call, which, taps);
  }
  const std::uint32_t dims = plan.dims;
  const auto find = dims == 1 ? find_taps_in<1> : dims == 2 ? find_taps_in<2> : find_taps_in<3>;
  find(call, which, linear, taps);
}

inline HWY_NOINLINE void find_cube_taps(Call& call, int which, FloatTaps& taps) {
  const FormatDesc& format = *call.view().format;
  const VI stride = splat(static_cast<std::int32_t>(call.view().layer_stride));
  taps.count = 4;
  taps.corners = 0;
  taps.neighbours = false;
  for (base::LaneMask& mask : taps.outside) mask = 0;
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DF())) {
    LevelLanes level;
    load_level<2>(call.p, call.request, call.state, which, first, false, level);
    const VI origin = level.origin;
    const CubeLanes cube = find_cube_texels(hn::Load(DI(), call.state.face.lane + first),
                                            hn::Load(DF(), call.state.projected[0].lane + first),
                                            hn::Load(DF(), call.state.projected[1].lane + first), level.axis[0].size);
    hn::Store(cube.weight_x, DF(), taps.weight[0].lane + first);
    hn::Store(cube.weight_y, DF(), taps.weight[1].lane + first);
    hn::Store(cube.corner, DI(), taps.corner.lane + first);
    taps.corners |= lanes_mask_bits(DI(), hn::Lt(cube.corner, splat(4))) << first;
    for (std::uint32_t k = 0; k < 4; ++k) {
      level.origin = hn::Add(origin, hn::Mul(cube.face[k], stride));
      place_texels<2>(format, level, cube.x[k], cube.y[k], splat(0), first, taps.place[k]);
    }
  }
}

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

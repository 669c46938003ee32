// What the vector samplers know about a wave before they look at texels: coordinates, layers and levels of every lane.
// Twins of locate() and level_of_detail() (lavapipe-texture-blend.md A4, A5).

#include "texel/sampler/prepared.h"
#include "texel/sampler/wave/address-inl.h"

#if defined(VITRINE_TEXEL_WAVE_STATE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_TEXEL_WAVE_STATE_INL_H_
#undef VITRINE_TEXEL_WAVE_STATE_INL_H_
#else
#define VITRINE_TEXEL_WAVE_STATE_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {

/// One value per lane.
struct IntLanes {
  alignas(64) std::int32_t lane[base::kWaveWidth];
};
struct FloatLanes {
  alignas(64) float lane[base::kWaveWidth];
};

struct WaveState {
  const float* coord[3];  ///< lanes of s, t, r; on the face for cubes
  FloatLanes projected[2];
  FloatLanes slope_x[2], slope_y[2];  ///< given ones on the face; only of anisotropic cubes
  IntLanes face;
  IntLanes layer_offset;  ///< bytes; of the first face for cubes. Only of arrayed views
  IntLanes level[2];      ///< this and the rest: only if PreparedSampler::needs_levels
  FloatLanes fraction;    ///< weight of level[1]
  base::LaneMask minify;
};

HWY_INLINE VF load_lanes(const base::WaveRegister* values, std::size_t first) {
  return as_float(hn::Load(DU(), values->lane + first));
}
HWY_INLINE VI load_ints(const base::WaveRegister* values, std::size_t first) {
  return hn::BitCast(DI(), hn::Load(DU(), values->lane + first));
}

/// 0 <= i < size.
HWY_INLINE hn::Mask<DI> within(VI i, VI size) {
  return hn::RebindMask(DI(), hn::Lt(hn::BitCast(DU(), i), hn::BitCast(DU(), size)));
}

HWY_INLINE VF square_of(VF v) { return hn::Mul(v, v); }
HWY_INLINE VF flip_sign(VF v, VU sign) { return as_float(hn::Xor(as_unsigned(v), sign)); }
HWY_INLINE VF negated(VF v) { return flip_sign(v, hn::Set(DU(), 0x80000000u)); }

/// Derivatives of up to three coordinates.
struct Slopes {
  VF x[3];
  VF y[3];
};

/// Of the quad's first pixel; quads are the 128-bit blocks of a vector.
HWY_INLINE void coarse_slope(VF v, VF& x, VF& y) {
  x = hn::Sub(hn::Broadcast<1>(v), hn::Broadcast<0>(v));
  y = hn::Sub(hn::Broadcast<2>(v), hn::Broadcast<0>(v));
}

/// Of each pixel's own row and column.
HWY_INLINE void fine_slope(VF v, VF& x, VF& y) {
  x = hn::Sub(hn::DupOdd(v), hn::DupEven(v));
  const hn::Repartition<double, DF> d64;
  const auto pairs = hn::BitCast(d64, v);
  y = hn::Sub(hn::BitCast(DF(), hn::DupOdd(pairs)), hn::BitCast(DF(), hn::DupEven(pairs)));
}

HWY_INLINE Slopes load_slopes(const SampleRequest& request, std::uint32_t components, std::size_t first, bool given,
                              bool fine) {
  Slopes d;
  for (std::uint32_t i = 0; i < components; ++i) {
    if (given) {
      d.x[i] = load_lanes(request.ddx[i], first);
      d.y[i] = load_lanes(request.ddy[i], first);
    } else if (fine) {
      fine_slope(load_lanes(request.coord[i], first), d.x[i], d.y[i]);
    } else {
      coarse_slope(load_lanes(request.coord[i], first), d.x[i], d.y[i]);
    }
  }
  return d;
}

// ---- cubes

struct FacePoint {
  VF sc, tc;
};

HWY_INLINE FacePoint on_face(const VF v[3], hn::Mask<DF> x_major, hn::Mask<DF> z_major, VU sign) {
  const VU top = hn::Set(DU(), 0x80000000u);
  const VF minus_t = negated(v[1]);
  FacePoint p{v[0], flip_sign(v[2], sign)};
  p.sc = hn::IfThenElse(x_major, flip_sign(v[2], hn::Xor(sign, top)), p.sc);
  p.tc = hn::IfThenElse(x_major, minus_t, p.tc);
  p.sc = hn::IfThenElse(z_major, flip_sign(v[0], sign), p.sc);
  p.tc = hn::IfThenElse(z_major, minus_t, p.tc);
  return p;
}

HWY_INLINE VF major_of(const VF v[3], hn::Mask<DF> x_major, hn::Mask<DF> z_major) {
  return hn::IfThenElse(z_major, v[2], hn::IfThenElse(x_major, v[0], v[1]));
}

/// Projects directions; with `d`, their derivatives too, with the rounding that goes with them.
HWY_INLINE void project_cube(const VF v[3], Slopes* d, std::size_t first, WaveState& state) {
  const VF s = hn::Abs(v[0]), t = hn::Abs(v[1]), r = hn::Abs(v[2]);
  const auto z_major = hn::Not(hn::Lt(r, lanes_max_second(s, t)));
  const auto x_major = hn::And(hn::Not(z_major), hn::Not(hn::Le(s, t)));
  const VF major = major_of(v, x_major, z_major);
  const VU sign = hn::And(as_unsigned(major), hn::Set(DU(), 0x80000000u));
  const FacePoint p = on_face(v, x_major, z_major, sign);
  VF scale;
  if (d != nullptr) {
    const VF inverse = hn::Div(splat(1.0f), major);
    const VF half = hn::Mul(splat(0.5f), inverse);
    for (VF* slope : {d->x, d->y}) {
      const FacePoint q = on_face(slope, x_major, z_major, sign);
      const VF ratio = hn::Mul(major_of(slope, x_major, z_major), inverse);
      slope[0] = hn::Mul(hn::Sub(q.sc, hn::Mul(ratio, p.sc)), half);
      slope[1] = hn::Mul(hn::Sub(q.tc, hn::Mul(ratio, p.tc)), half);
    }
    scale = hn::Abs(half);
  } else {
    const VF magnitude = hn::Abs(major);
    scale = hn::IfThenZeroElse(hn::Le(magnitude, splat(0.0f)), hn::Div(splat(0.5f), magnitude));
  }
  const VI axis = hn::IfThenElse(hn::RebindMask(DI(), z_major), splat(4),
                                 hn::IfThenZeroElse(hn::RebindMask(DI(), x_major), splat(2)));
  hn::Store(hn::Add(axis, hn::BitCast(DI(), hn::ShiftRight<31>(sign))), DI(), state.face.lane + first);
  hn::Store(hn::Add(hn::Mul(p.sc, scale), splat(0.5f)), DF(), state.projected[0].lane + first);
  hn::Store(hn::Add(hn::Mul(p.tc, scale), splat(0.5f)), DF(), state.projected[1].lane + first);
}

// ---- level of detail

HWY_INLINE VF scaled_length(const VF d[3], const float size[3], std::uint32_t dims) {
  VF sum = square_of(hn::Mul(d[0], splat(size[0])));
  for (std::uint32_t i = 1; i < dims; ++i) sum = hn::Add(sum, square_of(hn::Mul(d[i], splat(size[i]))));
  return sum;
}

/// rho squared; rho itself for one dimension.
HWY_INLINE VF wave_rho(const Plan& plan, const Slopes& d, bool given) {
  const Extent& extent = plan.view->level[0].extent;
  const float size[3] = {static_cast<float>(extent.width), static_cast<float>(extent.height),
                         static_cast<float>(extent.depth)};
  if (plan.anisotropic) return lanes_min_second(scaled_length(d.x, size, 2), scaled_length(d.y, size, 2));
  VF rho;
  if (plan.dims == 1) {
    rho = hn::Mul(lanes_max_second(hn::Abs(d.x[0]), hn::Abs(d.y[0])), splat(size[0]));
  } else {
    rho = lanes_max_second(scaled_length(d.x, size, plan.dims), scaled_length(d.y, size, plan.dims));
  }
  if (!given) return rho;
  const VU exponent = hn::And(as_unsigned(rho), hn::Set(DU(), 0x7f800000u));
  return hn::IfThenZeroElse(hn::RebindMask(DF(), hn::Eq(exponent, hn::Set(DU(), 0x7f800000u))), rho);
}

HWY_INLINE VI exponent_field(VF v) {
  return hn::BitCast(DI(), hn::And(hn::ShiftRight<23>(as_unsigned(v)), hn::Set(DU(), 255u)));
}

HWY_INLINE VF fast_log2(VF v) {
  const VF exponent = lanes_int_to_float(hn::Sub(exponent_field(v), splat(128)));
  const VU mantissa = hn::Or(hn::And(as_unsigned(v), hn::Set(DU(), 0x7fffffu)), hn::Set(DU(), 0x3f800000u));
  return hn::Add(exponent, as_float(mantissa));
}

HWY_INLINE void choose_levels(const Plan& plan, VF lod, VI nearest, std::size_t first, WaveState& state) {
  const VI last = splat(static_cast<std::int32_t>(plan.view->level_count) - 1);
  VI level0, level1;
  VF fraction = splat(0.0f);
  if (plan.mip == MipFilter::kNone && !plan.anisotropic) {
    level0 = level1 = splat(0);
  } else if (plan.mip != MipFilter::kLinear || plan.anisotropic) {
    level0 = level1 = lanes_clamp(nearest, last);
  } else {
    const VF floor = hn::Floor(lod);
    const VI level = lanes_truncate_to_int(floor);
    level0 = lanes_clamp(level, last);
    const auto outside = hn::Or(hn::Lt(level, splat(0)), hn::Not(hn::Lt(level, last)));
    level1 = hn::IfThenElse(outside, level0, hn::Add(level0, splat(1)));
    fraction = hn::IfThenZeroElse(hn::RebindMask(DF(), outside), hn::Sub(lod, floor));
  }
  hn::Store(level0, DI(), state.level[0].lane + first);
  hn::Store(level1, DI(), state.level[1].lane + first);
  hn::Store(fraction, DF(), state.fraction.lane + first);
}

/// Where `lod` is NaN the level is minified, too.
HWY_INLINE void set_minify(VF lod, float largest_magnified, std::size_t first, WaveState& state) {
  state.minify |= lanes_mask_bits(DF(), hn::Not(hn::Le(lod, splat(largest_magnified)))) << first;
}

/// Levels of detail before and after their clamps.
struct LodLanes {
  VF value, clamped;
};

/// rho: only where slopes decide.
HWY_INLINE LodLanes find_lod(const Plan& plan, const SampleRequest& request, VF rho, std::size_t first) {
  const Sampler& sampler = *plan.sampler;
  VF lod = splat(sampler.min_lod);
  if (!plan.lod_fixed) {
    if (request.lod_mode == LodMode::kExplicit) {
      lod = load_lanes(request.lod, first);
    } else if (request.lod_mode == LodMode::kZero) {
      lod = splat(0.0f);
    } else {
      lod = hn::Mul(splat(0.5f), fast_log2(plan.squared_rho || plan.anisotropic ? rho : square_of(rho)));
      if (request.lod_mode == LodMode::kBias) lod = hn::Add(lod, load_lanes(request.lod, first));
    }
    if (sampler.mip_lod_bias != 0.0f) lod = hn::Add(lod, splat(sampler.mip_lod_bias));
  }
  VF clamped = lod;
  if (plan.apply_max_lod) clamped = lanes_min_second(clamped, splat(sampler.max_lod));
  if (plan.apply_min_lod) clamped = lanes_max_second(clamped, splat(sampler.min_lod));
  if (request.min_lod != nullptr) clamped = lanes_max_second(clamped, load_lanes(request.min_lod, first));
  return {lod, clamped};
}

/// Whether levels of detail follow from slopes.
HWY_INLINE bool has_slopes(const Plan& plan, const SampleRequest& request) {
  return !plan.lod_fixed && request.lod_mode != LodMode::kExplicit && request.lod_mode != LodMode::kZero;
}

HWY_INLINE VF slopes_to_rho(const Plan& plan, const SampleRequest& request, const Slopes& d) {
  if (!has_slopes(plan, request)) return splat(0.0f);
  return wave_rho(plan, d, (plan.cube && !plan.face_query) || request.lod_mode == LodMode::kGrad);
}

/// Only for plan.lod_needed.
HWY_INLINE void find_levels(const Plan& plan, const SampleRequest& request, const Slopes& d, std::size_t first,
                            WaveState& state) {
  const VF rho = slopes_to_rho(plan, request, d);
  if (has_slopes(plan, request) && plan.shortcut_lod && request.min_lod == nullptr) {
    const VF base = plan.squared_rho ? rho : hn::Mul(rho, splat(1.41421356237309504880f));
    const VI exponent = exponent_field(base);
    set_minify(rho, 1.0f, first, state);
    return choose_levels(
        plan, rho, plan.squared_rho ? hn::ShiftRight<1>(hn::Sub(exponent, splat(126))) : hn::Sub(exponent, splat(127)),
        first, state);
  }
  VF lod = find_lod(plan, request, rho, first).clamped;
  set_minify(lod, 0.0f, first, state);
  if (plan.view->min_lod != 0.0f) lod = lanes_max_second(lod, splat(plan.view->min_lod));
  choose_levels(plan, lod, plan.anisotropic ? lanes_truncate_to_int(lod) : lanes_round_to_int(lod), first, state);
}

HWY_INLINE void find_layer(const Plan& plan, const base::WaveRegister* coord, std::size_t first, WaveState& state) {
  VI layer = splat(0);
  if (coord != nullptr) {
    layer = lanes_round_to_int(load_lanes(coord, first));
    auto last = static_cast<std::int32_t>(plan.view->layer_count) - 1;
    if (plan.cube) {
      layer = hn::Mul(layer, splat(6));
      last = std::max(last - 5, 0);
    }
    layer = lanes_clamp(layer, splat(last));
  }
  const VI stride = splat(static_cast<std::int32_t>(plan.view->layer_stride));
  hn::Store(hn::Mul(layer, stride), DI(), state.layer_offset.lane + first);
}

/// Calls body(first, slopes) for every vector; cubes are projected before, and slopes of anisotropic ones and
/// of face_query are differences on the face. Slopes only if prepared.needs_levels, or given on the face.
template <class Body>
HWY_INLINE void for_each_slope(const PreparedSampler& prepared, const SampleRequest& request, WaveState& state,
                               Body&& body) {
  const Plan& plan = prepared.plan;
  const bool given = request.lod_mode == LodMode::kGrad;
  const bool sloped = (prepared.needs_levels && has_slopes(plan, request)) || (plan.cube && plan.anisotropic && given);
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DF())) {
    Slopes d;
    if (sloped) d = load_slopes(request, plan.cube ? 3 : plan.dims, first, given, plan.cube);
    if (plan.cube) {
      const VF v[3] = {load_lanes(request.coord[0], first), load_lanes(request.coord[1], first),
                       load_lanes(request.coord[2], first)};
      project_cube(v, sloped && !plan.face_query ? &d : nullptr, first, state);
      for (std::size_t i = 0; sloped && (plan.anisotropic || plan.face_query) && i < 2; ++i) {
        if (given) {
          hn::Store(d.x[i], DF(), state.slope_x[i].lane + first);
          hn::Store(d.y[i], DF(), state.slope_y[i].lane + first);
        } else {
          coarse_slope(hn::Load(DF(), state.projected[i].lane + first), d.x[i], d.y[i]);
        }
      }
    }
    body(first, d);
  }
}

inline void find_state(const PreparedSampler& prepared, const SampleRequest& request, WaveState& state) {
  const Plan& plan = prepared.plan;
  state.minify = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    state.coord[i] = request.coord[i] != nullptr ? reinterpret_cast<const float*>(request.coord[i]->lane) : nullptr;
  }
  if (plan.cube) state.coord[0] = state.projected[0].lane, state.coord[1] = state.projected[1].lane;
  if (!plan.cube && !plan.arrayed && !prepared.needs_levels) return;
  for_each_slope(prepared, request, state, [&](std::size_t first, const Slopes& d) HWY_ATTR {
    if (plan.arrayed) find_layer(plan, request.coord[plan.cube ? 3 : plan.dims], first, state);
    if (prepared.needs_levels) find_levels(plan, request, d, first, state);
  });
}

// ---- one axis of one level

/// The level that lanes read: `which` of the two, by lane or the same for all.
struct LevelLanes {
  AxisLanes axis[3];
  VI row_pitch, slice_pitch;
  VI origin;  ///< bytes, with the layer
};

/// A level for every lane of a vector, often the same.
struct LevelIndex {
  explicit LevelIndex(VI value) : lanes(value), first(static_cast<std::size_t>(hn::GetLane(value))) {
    uniform = hn::AllTrue(DI(), hn::Eq(value, splat(static_cast<std::int32_t>(first))));
  }
  explicit LevelIndex() : lanes(splat(0)) {}

  VI lookup(const std::int32_t* table) const {
    return uniform ? splat(table[first]) : hn::GatherIndex(DI(), table, lanes);
  }

  VI lanes;
  std::size_t first = 0;
  bool uniform = true;
};

/// kDims axes; `origin` includes the face if `with_face`. Fills `out` in place: a copy of its small fields just written
/// would wait for their stores.
template <std::uint32_t kDims>
HWY_INLINE void load_level(const PreparedSampler& p, const SampleRequest& request, const WaveState& state, int which,
                           std::size_t first, bool with_face, LevelLanes& out) {
  const Plan& plan = p.plan;
  const LevelIndex level = p.one_level ? LevelIndex() : LevelIndex(hn::Load(DI(), state.level[which].lane + first));
  const std::int32_t* const sizes[3] = {p.level.width, p.level.height, p.level.depth};
  const bool has_offset = request.offset[0] || request.offset[1] || request.offset[2];
  for (std::uint32_t i = 0; i < kDims; ++i) {
    AxisLanes& axis = out.axis[i];
    axis.address = plan.address[i];
    axis.pot = plan.pot[i];
    axis.normalized = !plan.sampler->unnormalized;
    axis.has_offset = has_offset;
    axis.offset = request.offset[i] != nullptr ? load_ints(request.offset[i], first) : splat(0);
    axis.size = level.lookup(sizes[i]);
    axis.size_float = lanes_int_to_float(axis.size);
  }
  out.row_pitch = level.lookup(p.level.row_pitch);
  out.slice_pitch = kDims == 3 ? level.lookup(p.level.slice_pitch) : splat(0);
  out.origin = level.lookup(p.level.offset);
  if (plan.arrayed) out.origin = hn::Add(out.origin, hn::Load(DI(), state.layer_offset.lane + first));
  if (with_face) {
    const VI stride = splat(static_cast<std::int32_t>(plan.view->layer_stride));
    out.origin = hn::Add(out.origin, hn::Mul(hn::Load(DI(), state.face.lane + first), stride));
  }
}

/// Whether load_level gives the same for every vector of the wave.
inline bool level_is_uniform(const PreparedSampler& p, const SampleRequest& request, bool with_face) {
  return p.one_level && !p.plan.arrayed && !with_face && !request.offset[0] && !request.offset[1] && !request.offset[2];
}

/// Stores lanes first.. of a result component, active ones only.
HWY_INLINE void store_lanes(VU value, base::LaneMask active, std::size_t first, base::WaveRegister& to) {
  if (active == base::kAllLanes) {
    hn::Store(value, DU(), to.lane + first);
  } else {
    hn::BlendedStore(value, lanes_mask_from_bits(DU(), active >> first), DU(), to.lane + first);
  }
}

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

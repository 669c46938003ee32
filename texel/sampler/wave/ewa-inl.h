// EWA (elliptical weighted average) for a vector of lanes: the footprints, ellipses, and the weights of the texels
// inside (lavapipe-texture-blend.md A8): twins of the steps of anisotropic.cpp.

#include "texel/sampler/model/anisotropic.h"
#include "texel/sampler/prepared.h"
#include "texel/sampler/wave/state-inl.h"

#if defined(VITRINE_TEXEL_WAVE_EWA_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_TEXEL_WAVE_EWA_INL_H_
#undef VITRINE_TEXEL_WAVE_EWA_INL_H_
#else
#define VITRINE_TEXEL_WAVE_EWA_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {

/// The ellipse of each lane; names as in model/anisotropic.cpp.
struct EllipseLanes {
  VF tu, tv;
  VF a, b, c;
  VI u0, u1, v0, v1;
};

/// Of the coordinates on the image or on the face.
HWY_INLINE Slopes ellipse_slopes(const PreparedSampler& p, const SampleRequest& request, const WaveState& state,
                                 std::size_t first) {
  Slopes d;
  for (std::size_t i = 0; i < 2; ++i) {
    if (request.lod_mode == LodMode::kGrad) {
      d.x[i] = p.plan.cube ? hn::Load(DF(), state.slope_x[i].lane + first) : load_lanes(request.ddx[i], first);
      d.y[i] = p.plan.cube ? hn::Load(DF(), state.slope_y[i].lane + first) : load_lanes(request.ddy[i], first);
    } else if (request.quads) {
      coarse_slope(hn::LoadU(DF(), state.coord[i] + first), d.x[i], d.y[i]);
    } else {
      d.x[i] = d.y[i] = splat(0.0f);
    }
  }
  return d;
}

HWY_INLINE EllipseLanes make_ellipse(const PreparedSampler& p, const SampleRequest& request, const WaveState& state,
                                     std::size_t first) {
  const ImageView& view = *p.plan.view;
  const VF s = hn::LoadU(DF(), state.coord[0] + first), t = hn::LoadU(DF(), state.coord[1] + first);
  const Slopes slope = ellipse_slopes(p, request, state, first);
  VF scaling = splat(1.0f / static_cast<float>(1u << view.base_level));
  if (!p.one_level) {
    // 2^-level, exactly.
    const VI level = hn::Add(hn::Load(DI(), state.level[0].lane + first), splat(static_cast<int>(view.base_level)));
    scaling = hn::BitCast(DF(), hn::ShiftLeft<23>(hn::Sub(splat(127), level)));
  }
  const VF width = splat(static_cast<float>(view.level0_extent.width));
  const VF height = splat(static_cast<float>(view.level0_extent.height));
  const VF ux = hn::Mul(hn::Mul(slope.x[0], width), scaling), uy = hn::Mul(hn::Mul(slope.y[0], width), scaling);
  const VF vx = hn::Mul(hn::Mul(slope.x[1], height), scaling), vy = hn::Mul(hn::Mul(slope.y[1], height), scaling);
  const VF one = splat(1.0f), four = splat(4.0f), two = splat(2.0f);
  EllipseLanes e;
  e.a = hn::Add(hn::Add(square_of(vx), square_of(vy)), one);
  e.b = hn::Mul(hn::Add(hn::Mul(ux, vx), hn::Mul(uy, vy)), splat(-2.0f));
  e.c = hn::Add(hn::Add(square_of(ux), square_of(uy)), one);
  const VF f = hn::Sub(hn::Mul(e.a, e.c), hn::Div(square_of(e.b), four));
  const VF d = hn::Add(hn::Sub(splat(0.0f), square_of(e.b)), hn::Mul(hn::Mul(e.a, e.c), four));
  const VF box_u = hn::Mul(hn::Div(two, d), hn::Sqrt(hn::Mul(hn::Mul(d, e.c), f)));
  const VF box_v = hn::Mul(hn::Div(two, d), hn::Sqrt(hn::Mul(hn::Mul(e.a, d), f)));
  const VF g = hn::Div(splat(1023.0f), f);
  e.a = hn::Mul(e.a, g);
  e.b = hn::Mul(e.b, g);
  e.c = hn::Mul(e.c, g);
  e.tu = hn::Add(hn::Mul(s, hn::Mul(width, scaling)), splat(-0.5f));
  e.tv = hn::Add(hn::Mul(t, hn::Mul(height, scaling)), splat(-0.5f));
  e.u0 = lanes_floor_to_int(hn::Sub(e.tu, box_u));
  e.u1 = lanes_truncate_to_int(hn::Ceil(hn::Add(e.tu, box_u)));
  e.v0 = lanes_floor_to_int(hn::Sub(e.tv, box_v));
  e.v1 = lanes_truncate_to_int(hn::Ceil(hn::Add(e.tv, box_v)));
  return e;
}

/// Whether every active lane's box is one that a vector can walk; else the wave goes lane by lane.
HWY_INLINE bool small_boxes(const EllipseLanes& e, base::LaneMask active) {
  // Differences of far bounds may wrap around.
  const VI limit = splat(1 << 29), side = splat((1 << 12) - 1);
  const auto near = [limit](VI i) HWY_ATTR { return hn::And(hn::Lt(i, limit), hn::Gt(i, hn::Neg(limit))); };
  const auto small = [&](VI low, VI high) HWY_ATTR {
    const VI more = hn::Sub(high, low);
    return hn::And(hn::And(near(low), near(high)), hn::And(hn::Not(hn::Lt(more, splat(0))), hn::Lt(more, side)));
  };
  const auto good = hn::And(small(e.u0, e.u1), small(e.v0, e.v1));
  const base::LaneMask lanes = active & base::first_lanes(hn::Lanes(DI()));
  return (~static_cast<base::LaneMask>(lanes_mask_bits(DI(), good)) & lanes) == 0;
}

/// kEwaWeights[max(index, 0)]; anything of indices above 1023.
HWY_INLINE VF ewa_weight(VI index) {
#if HWY_TARGET <= HWY_AVX3
  const EwaFactors& t = kEwaFactors;
  const __m512i fine = hn::Max(index, splat(0)).raw, coarse = _mm512_srli_epi32(fine, 5);
  const auto lookup = [](const float* table, __m512i i) HWY_ATTR {
    return VF{_mm512_permutex2var_ps(_mm512_load_ps(table), i, _mm512_load_ps(table + 16))};
  };
  const VF whole = lookup(t.whole, coarse);
  const VF millionths = hn::Add(whole, hn::Round(lanes_fma(whole, lookup(t.less, fine), lookup(t.rest, coarse))));
  return lanes_fma(millionths, splat(EwaFactors::kMillionth), hn::Mul(millionths, splat(EwaFactors::kMillionthRest)));
#else
  return hn::GatherIndex(DF(), kEwaWeights.data(), hn::Min(hn::Max(index, splat(0)), splat(1023)));
#endif
}

/// The texels u0 to u1 of one row and their weights, one after another.
struct RowWalk {
  VF q, dq, ddq;
  VI u, u1;
  hn::Mask<DI> row;  ///< lanes whose ellipse has this row

  struct Weight {
    VF value;  ///< 0 outside of the ellipse
    hn::Mask<DI> inside;
  };

  HWY_INLINE hn::Mask<DI> rest() const { return hn::And(row, hn::Not(hn::Gt(u, u1))); }

  HWY_INLINE Weight next() {
    const VI index = lanes_truncate_to_int(q);
    Weight w;
    w.inside = hn::And(rest(), hn::Not(hn::Gt(index, splat(1023))));
    w.value = hn::IfThenElseZero(hn::RebindMask(DF(), w.inside), ewa_weight(index));
    q = hn::Add(q, dq);
    dq = hn::Add(dq, ddq);
    u = hn::Add(u, splat(1));
    return w;
  }

  /// Moves on to the first texel that a lane weighs; false if there is none.
  HWY_INLINE bool next_weighed(Weight& out) {
    while (!hn::AllFalse(DI(), rest())) {
      out = next();
      if (!hn::AllFalse(DI(), out.inside)) return true;
    }
    return false;
  }
};

/// The rows of the ellipses.
struct EllipseWalk {
  const EllipseLanes& e;
  VF u_start, q_start, dq_start;

  HWY_INLINE explicit EllipseWalk(const EllipseLanes& ellipse)
      : e(ellipse), u_start(hn::Sub(lanes_int_to_float(e.u0), e.tu)) {
    dq_start = hn::Mul(hn::Add(hn::Mul(u_start, splat(2.0f)), splat(1.0f)), e.a);
    q_start = hn::Mul(square_of(u_start), e.a);
  }

  HWY_INLINE RowWalk row(VF v, hn::Mask<DI> lanes) const {
    const VF offset = hn::Sub(v, e.tv);
    RowWalk row;
    row.dq = hn::Add(hn::Mul(offset, e.b), dq_start);
    row.q = hn::Add(hn::Mul(hn::Add(hn::Mul(e.c, offset), hn::Mul(e.b, u_start)), offset), q_start);
    row.ddq = hn::Mul(e.a, splat(2.0f));
    row.u = e.u0;
    row.u1 = e.u1;
    row.row = lanes;
    return row;
  }
};

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

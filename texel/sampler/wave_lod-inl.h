// Level of detail of a vector of lanes, two-dimensional images: the twin of texel/sampler/lod.cpp.

#include "texel/sampler/wave_address-inl.h"

#if defined(VITRINE_TEXEL_WAVE_LOD_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_TEXEL_WAVE_LOD_INL_H_
#undef VITRINE_TEXEL_WAVE_LOD_INL_H_
#else
#define VITRINE_TEXEL_WAVE_LOD_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {

struct LodLanes {
  VI level0;
  VI level1;
  VF fraction;
  hn::Mask<DF> minify;
};

HWY_INLINE VF load_lanes(const base::WaveRegister* values, std::size_t first) {
  return as_float(hn::Load(DU(), values->lane + first));
}

HWY_INLINE VF square_of(VF v) { return hn::Mul(v, v); }

/// rho squared. Quads are the 128-bit blocks of a vector.
HWY_INLINE VF lanes_rho(const Plan& plan, const SampleRequest& request, VF s, VF t, std::size_t first) {
  const VF width = splat(static_cast<float>(plan.view->level[0].extent.width));
  const VF height = splat(static_cast<float>(plan.view->level[0].extent.height));
  VF dsdx, dtdx, dsdy, dtdy;
  const bool given = request.lod_mode == LodMode::kGrad;
  if (given) {
    dsdx = load_lanes(request.ddx[0], first);
    dtdx = load_lanes(request.ddx[1], first);
    dsdy = load_lanes(request.ddy[0], first);
    dtdy = load_lanes(request.ddy[1], first);
  } else {
    dsdx = hn::Sub(hn::Broadcast<1>(s), hn::Broadcast<0>(s));
    dtdx = hn::Sub(hn::Broadcast<1>(t), hn::Broadcast<0>(t));
    dsdy = hn::Sub(hn::Broadcast<2>(s), hn::Broadcast<0>(s));
    dtdy = hn::Sub(hn::Broadcast<2>(t), hn::Broadcast<0>(t));
  }
  const VF x = hn::Add(square_of(hn::Mul(dsdx, width)), square_of(hn::Mul(dtdx, height)));
  const VF y = hn::Add(square_of(hn::Mul(dsdy, width)), square_of(hn::Mul(dtdy, height)));
  const VF rho = lanes_max_second(x, y);
  if (!given) return rho;
  const VU exponent = hn::And(as_unsigned(rho), hn::Set(DU(), 0x7f800000u));
  return hn::IfThenZeroElse(hn::RebindMask(DF(), hn::Eq(exponent, hn::Set(DU(), 0x7f800000u))), rho);
}

HWY_INLINE VI exponent_field(VF v) {
  return hn::BitCast(DI(), hn::And(hn::ShiftRight<23>(as_unsigned(v)), hn::Set(DU(), 255u)));
}

HWY_INLINE VF lanes_fast_log2(VF v) {
  const VF exponent = lanes_int_to_float(hn::Sub(exponent_field(v), splat(128)));
  const VU mantissa = hn::Or(hn::And(as_unsigned(v), hn::Set(DU(), 0x7fffffu)), hn::Set(DU(), 0x3f800000u));
  return hn::Add(exponent, as_float(mantissa));
}

HWY_INLINE LodLanes lanes_levels(const Plan& plan, VF lod, VI nearest, hn::Mask<DF> minify) {
  const VI last = splat(static_cast<std::int32_t>(plan.view->level_count) - 1);
  LodLanes out;
  out.minify = minify;
  if (plan.mip != MipFilter::kLinear) {
    out.level0 = out.level1 = plan.mip == MipFilter::kNone ? splat(0) : lanes_clamp(nearest, last);
    out.fraction = splat(0.0f);
    return out;
  }
  const VF floor = hn::Floor(lod);
  const VI level = lanes_truncate_to_int(floor);
  out.level0 = lanes_clamp(level, last);
  const auto outside = hn::Or(hn::Lt(level, splat(0)), hn::Not(hn::Lt(level, last)));
  out.level1 = hn::IfThenElse(outside, out.level0, hn::Add(out.level0, splat(1)));
  out.fraction = hn::IfThenZeroElse(hn::RebindMask(DF(), outside), hn::Sub(lod, floor));
  return out;
}

/// Levels of lanes first..first+N-1. Only for plan.lod_needed.
HWY_INLINE LodLanes lanes_lod(const Plan& plan, const SampleRequest& request, VF s, VF t, std::size_t first) {
  const Sampler& sampler = *plan.sampler;
  VF lod = splat(sampler.min_lod);
  if (!plan.lod_fixed) {
    if (request.lod_mode == LodMode::kExplicit) {
      lod = load_lanes(request.lod, first);
    } else if (request.lod_mode == LodMode::kZero) {
      lod = splat(0.0f);
    } else {
      const VF rho = lanes_rho(plan, request, s, t, first);
      if (plan.shortcut_lod && request.min_lod == nullptr) {
        const VI level = hn::ShiftRight<1>(hn::Sub(exponent_field(rho), splat(126)));
        return lanes_levels(plan, rho, level, hn::Gt(rho, splat(1.0f)));
      }
      lod = hn::Mul(splat(0.5f), lanes_fast_log2(rho));
      if (request.lod_mode == LodMode::kBias) lod = hn::Add(lod, load_lanes(request.lod, first));
    }
    if (sampler.mip_lod_bias != 0.0f) lod = hn::Add(lod, splat(sampler.mip_lod_bias));
  }
  if (plan.apply_max_lod) lod = lanes_min_second(lod, splat(sampler.max_lod));
  if (plan.apply_min_lod) lod = lanes_max_second(lod, splat(sampler.min_lod));
  if (request.min_lod != nullptr) lod = lanes_max_second(lod, load_lanes(request.min_lod, first));
  return lanes_levels(plan, lod, lanes_round_to_int(lod), hn::Gt(lod, splat(0.0f)));
}

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

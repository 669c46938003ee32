// Clip test and viewport transform over a wave.
#include "raster/front/viewport.h"

#include "base/simd.h"
#include "base/x86_arithmetic.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/front/viewport.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/lane_math-inl.h"
#include "base/x86_arithmetic-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::raster::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using base::HWY_NAMESPACE::lanes_cast;
using base::HWY_NAMESPACE::lanes_round_to_int;
using base::HWY_NAMESPACE::x86_add;
using base::HWY_NAMESPACE::x86_div;
using base::HWY_NAMESPACE::x86_fma;
using base::HWY_NAMESPACE::x86_mul;

using F = hn::ScalableTag<float>;
using U = hn::ScalableTag<std::uint32_t>;
using VF = hn::Vec<F>;
using VU = hn::Vec<U>;

/// `bit` where not a <= b: true for NaN.
HWY_INLINE VU exceeds(VF a, VF b, std::uint32_t bit) {
  const VU ordered = lanes_cast<std::uint32_t>(hn::VecFromMask(F(), hn::Le(a, b)));
  return hn::AndNot(ordered, hn::Set(U(), bit));
}

HWY_INLINE VU clip_code(VF x, VF y, VF z, VF w, const TransformParameters& p) {
  const VF zero = hn::Zero(F());
  if (p.guard_band && !p.fused) {
    x = hn::Mul(x, hn::Set(F(), 0.5f));
    y = hn::Mul(y, hn::Set(F(), 0.5f));
  }
  VU code = exceeds(x, w, 1);
  code = hn::Or(code, exceeds(zero, hn::Add(x, w), 2));
  code = hn::Or(code, exceeds(y, w, 4));
  code = hn::Or(code, exceeds(zero, hn::Add(y, w), 8));
  if (p.depth_clip) {
    code = hn::Or(code, exceeds(zero, p.negative_one_to_one ? hn::Add(z, w) : z, 16));
    code = hn::Or(code, exceeds(z, w, 32));
  }
  return code;
}

HWY_INLINE void snap(VF v, VF offset, std::int32_t* out) {
  const VF scaled = hn::Mul(hn::Sub(v, offset), hn::Set(F(), 256.0f));
  hn::Store(lanes_round_to_int(scaled), hn::ScalableTag<std::int32_t>(), out);
}

void transform_lanes(const float* const clip[4], const TransformParameters& p, TransformedWave& out) {
  const F f;
  const ViewportTransform& t = p.viewport;
  const VF offset = hn::Set(f, p.pixel_offset);
  for (std::size_t i = 0; i < base::kWaveWidth; i += hn::Lanes(f)) {
    const VF x = hn::Load(f, clip[0] + i), y = hn::Load(f, clip[1] + i);
    const VF z = hn::Load(f, clip[2] + i), w = hn::Load(f, clip[3] + i);
    hn::Store(clip_code(x, y, z, w, p), U(), out.code + i);
    const VF oow = x86_div(hn::Set(f, 1.0f), w);
    const auto window = [&](VF clip, float scale, float translate) HWY_ATTR {
      const VF ndc = x86_mul(clip, oow), s = hn::Set(f, scale), move = hn::Set(f, translate);
      return p.fused ? x86_fma(ndc, s, move) : x86_add(x86_mul(ndc, s), move);
    };
    const VF wx = window(x, t.sx, t.tx), wy = window(y, t.sy, t.ty), wz = window(z, t.sz, t.tz);
    hn::Store(wx, f, out.x + i);
    hn::Store(wy, f, out.y + i);
    hn::Store(wz, f, out.z + i);
    hn::Store(oow, f, out.w + i);
    snap(wx, offset, out.snapped_x + i);
    snap(wy, offset, out.snapped_y + i);
  }
}

}  // namespace vitrine::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vitrine::raster {

HWY_EXPORT(transform_lanes);

void transform_wave(const float* const clip[4], const TransformParameters& parameters, TransformedWave& out) {
  HWY_DYNAMIC_DISPATCH(transform_lanes)(clip, parameters, out);
}

void transform_vertex(const float clip[4], const ViewportTransform& viewport, float window[4]) {
  const float oow = base::x86_div(1.0f, clip[3]);
  const auto axis = [&](float place, float scale, float translate) {
    return base::x86_add(base::x86_mul(base::x86_mul(place, oow), scale), translate);
  };
  window[0] = axis(clip[0], viewport.sx, viewport.tx);
  window[1] = axis(clip[1], viewport.sy, viewport.ty);
  window[2] = axis(clip[2], viewport.sz, viewport.tz);
  window[3] = oow;
}

}  // namespace vitrine::raster
#endif

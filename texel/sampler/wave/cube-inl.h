// The 2x2 footprints of a vector of lanes on a cube, across its edges: the twin of cube_taps.

#include "texel/sampler/model/cube.h"
#include "texel/sampler/wave/address-inl.h"

#if defined(VITRINE_TEXEL_WAVE_CUBE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_TEXEL_WAVE_CUBE_INL_H_
#undef VITRINE_TEXEL_WAVE_CUBE_INL_H_
#else
#define VITRINE_TEXEL_WAVE_CUBE_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {

struct CubeLanes {
  VI face[4], x[4], y[4];
  VF weight_x, weight_y;
  VI corner;  ///< the texel that does not exist, 4 if all do
};

/// Carries a texel that left its face over the edge, by table.
HWY_INLINE void cross_edge(VI last, VI& face, VI& x, VI& y) {
  const VI zero = splat(0);
  const auto below_x = hn::Lt(x, zero), above_x = hn::Gt(x, last);
  const auto below_y = hn::Lt(y, zero), above_y = hn::Gt(y, last);
  const auto off_x = hn::Or(below_x, above_x);
  const auto off = hn::Or(off_x, hn::Or(below_y, above_y));
  if (hn::AllFalse(DI(), off)) return;
  // Leaving in x takes precedence.
  const VI edge = hn::IfThenElse(off_x, hn::IfThenElseZero(above_x, splat(1)),
                                 hn::Add(splat(2), hn::IfThenElseZero(above_y, splat(1))));
  const VI crossing = hn::GatherIndex(DI(), kCubeCrossings.data(), hn::Add(hn::ShiftLeft<2>(face), edge));
  const VI along = lanes_clamp(hn::IfThenElse(off_x, y, x), last);
  const VI flipped = hn::Sub(last, along);
  const auto follow = [&](VI rule) {
    VI to = hn::IfThenElse(hn::Eq(rule, splat(1)), flipped, along);
    to = hn::IfThenZeroElse(hn::Eq(rule, splat(2)), to);
    return hn::IfThenElse(hn::Eq(rule, splat(3)), last, to);
  };
  face = hn::IfThenElse(off, hn::And(crossing, splat(7)), face);
  x = hn::IfThenElse(off, follow(hn::And(hn::ShiftRight<4>(crossing), splat(3))), x);
  y = hn::IfThenElse(off, follow(hn::ShiftRight<8>(crossing)), y);
}

HWY_INLINE CubeLanes find_cube_texels(VI face, VF u, VF v, VI size) {
  CubeLanes out;
  const VI last = hn::Sub(size, splat(1));
  const VF scale = lanes_int_to_float(size);
  const VF a = hn::Sub(hn::Mul(lanes_max_second(u, splat(0.0f)), scale), splat(0.5f));
  const VF b = hn::Sub(hn::Mul(lanes_max_second(v, splat(0.0f)), scale), splat(0.5f));
  out.weight_x = hn::Sub(a, hn::Floor(a));
  out.weight_y = hn::Sub(b, hn::Floor(b));
  const VI x0 = lanes_floor_to_int(a), y0 = lanes_floor_to_int(b);
  out.corner = splat(4);
  for (std::int32_t i = 0; i < 4; ++i) {
    VI x = hn::Add(x0, splat(i & 1)), y = hn::Add(y0, splat(i >> 1));
    const auto corner =
        hn::And(hn::Or(hn::Lt(x, splat(0)), hn::Gt(x, last)), hn::Or(hn::Lt(y, splat(0)), hn::Gt(y, last)));
    out.corner = hn::IfThenElse(corner, splat(i), out.corner);
    out.face[i] = face;
    cross_edge(last, out.face[i], x, y);
    out.x[i] = x;
    out.y[i] = y;
  }
  return out;
}

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

// Texel selection along one axis for a vector of lanes: the twin of texel/sampler/model/address.h.

#include "base/lane_math-inl.h"
#include "texel/sampler/plan.h"

#if defined(VITRINE_TEXEL_WAVE_ADDRESS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_TEXEL_WAVE_ADDRESS_INL_H_
#undef VITRINE_TEXEL_WAVE_ADDRESS_INL_H_
#else
#define VITRINE_TEXEL_WAVE_ADDRESS_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using namespace vitrine::base::HWY_NAMESPACE;

using DF = hn::ScalableTag<float>;
using DI = hn::RebindToSigned<DF>;
using DU = hn::RebindToUnsigned<DF>;
using VF = hn::Vec<DF>;
using VI = hn::Vec<DI>;
using VU = hn::Vec<DU>;

HWY_INLINE VF splat(float value) { return hn::Set(DF(), value); }
HWY_INLINE VI splat(std::int32_t value) { return hn::Set(DI(), value); }
HWY_INLINE VF as_float(VU v) { return hn::BitCast(DF(), v); }
HWY_INLINE VU as_unsigned(VF v) { return hn::BitCast(DU(), v); }
/// One axis of one level (or of one level per lane).
struct AxisLanes {
  Address address = Address::kRepeat;
  bool pot = false;
  bool normalized = true;
  bool has_offset = false;
  VI size;
  VF size_float;
  VI offset;
};

struct TapLanes {
  VI first;
  VI second;
  VF weight;
};

struct ByteTapLanes {
  VI first;
  VI second;
  VI weight;
};

HWY_INLINE VF lanes_scaled(const AxisLanes& axis, VF s) { return axis.normalized ? hn::Mul(s, axis.size_float) : s; }
HWY_INLINE VF lanes_plus_offset(const AxisLanes& axis, VF c) {
  return axis.has_offset ? hn::Add(c, lanes_int_to_float(axis.offset)) : c;
}
HWY_INLINE VF lanes_shifted(const AxisLanes& axis, VF s) {
  return axis.has_offset ? hn::Add(s, hn::Div(lanes_int_to_float(axis.offset), axis.size_float)) : s;
}
HWY_INLINE VI lanes_offset(const AxisLanes& axis, VI i) { return axis.has_offset ? hn::Add(i, axis.offset) : i; }
HWY_INLINE VI lanes_floor_to_int(VF c) { return lanes_truncate_to_int(hn::Floor(c)); }

HWY_INLINE VF lanes_signed_mirror(VF s) {
  VF c = hn::Mul(s, splat(0.5f));
  c = hn::Sub(c, hn::Round(c));
  return hn::Add(c, c);
}
HWY_INLINE VF lanes_mirror(VF s) { return lanes_max_second(hn::Abs(lanes_signed_mirror(s)), splat(0.0f)); }

HWY_INLINE VI lanes_clamp(VI i, VI last) { return hn::Min(hn::Max(i, splat(0)), last); }

HWY_INLINE VI lanes_min_unsigned(VI i, VI last) {
  return hn::BitCast(DI(), hn::Min(hn::BitCast(DU(), i), hn::BitCast(DU(), last)));
}

/// first + 1, or 0 after the last.
HWY_INLINE VI lanes_next_wrapped(VI first, VI last) {
  return hn::IfThenZeroElse(hn::Eq(first, last), hn::Add(first, splat(1)));
}

HWY_INLINE VI lanes_repeat_npot(const AxisLanes& axis, VF s) {
  VF c = lanes_shifted(axis, s);
  c = hn::Sub(c, hn::Floor(c));
  return lanes_truncate_to_int(hn::Mul(lanes_min_second(c, splat(0.99999994f)), axis.size_float));
}

HWY_INLINE VI lanes_nearest_bytes(const AxisLanes& axis, VF s) {
  const VI last = hn::Sub(axis.size, splat(1));
  if (axis.address == Address::kRepeat && !axis.pot) return lanes_repeat_npot(axis, s);
  const VI i = lanes_offset(axis, lanes_floor_to_int(lanes_scaled(axis, s)));
  return axis.address == Address::kRepeat ? hn::And(i, last) : lanes_clamp(i, last);
}

HWY_INLINE ByteTapLanes lanes_linear_bytes(const AxisLanes& axis, VF s) {
  ByteTapLanes taps;
  const VI last = hn::Sub(axis.size, splat(1));
  const VI low = splat(255);
  if (axis.address == Address::kRepeat && !axis.pot) {
    VF c = lanes_shifted(axis, s);
    c = hn::Mul(hn::Sub(c, hn::Floor(c)), axis.size_float);
    const VI k = hn::Sub(lanes_round_to_int(hn::Mul(c, splat(256.0f))), splat(128));
    taps.weight = hn::And(k, low);
    const VI i = hn::ShiftRight<8>(k);
    taps.first = hn::IfThenElse(hn::Lt(i, splat(0)), last, hn::Min(i, last));
    taps.second = lanes_next_wrapped(taps.first, last);
    return taps;
  }
  const VF scale = axis.normalized ? lanes_int_to_float(hn::ShiftLeft<8>(axis.size)) : splat(256.0f);
  const VI q = hn::Sub(lanes_round_to_int(hn::Mul(s, scale)), splat(128));
  const VI i = lanes_offset(axis, hn::ShiftRight<8>(q));
  taps.weight = hn::And(q, low);
  if (axis.address == Address::kRepeat) {
    taps.first = hn::And(i, last);
    taps.second = lanes_next_wrapped(taps.first, last);
  } else {
    taps.first = lanes_clamp(i, last);
    taps.second = lanes_clamp(hn::Add(taps.first, splat(1)), last);
    taps.second = hn::IfThenElse(hn::Lt(i, splat(0)), taps.first, taps.second);
  }
  return taps;
}

HWY_INLINE VI lanes_nearest(const AxisLanes& axis, VF s) {
  const VI last = hn::Sub(axis.size, splat(1));
  switch (axis.address) {
    case Address::kRepeat:
      if (!axis.pot) return lanes_repeat_npot(axis, s);
      return hn::And(lanes_offset(axis, lanes_floor_to_int(lanes_scaled(axis, s))), last);
    case Address::kClamp:
      return lanes_clamp(lanes_truncate_to_int(lanes_plus_offset(axis, lanes_scaled(axis, s))), last);
    case Address::kBorder:
      return lanes_offset(axis, lanes_floor_to_int(lanes_scaled(axis, s)));
    case Address::kMirror:
      return hn::Min(lanes_truncate_to_int(hn::Mul(lanes_mirror(lanes_shifted(axis, s)), axis.size_float)), last);
    default:
      return lanes_min_unsigned(lanes_truncate_to_int(hn::Abs(lanes_plus_offset(axis, lanes_scaled(axis, s)))), last);
  }
}

HWY_INLINE TapLanes lanes_split(VF c) {
  const VF floor = hn::Floor(c);
  const VI i = lanes_truncate_to_int(floor);
  return {i, hn::Add(i, splat(1)), hn::Sub(c, floor)};
}

HWY_INLINE TapLanes lanes_linear(const AxisLanes& axis, VF s) {
  const VI last = hn::Sub(axis.size, splat(1));
  const VF half = splat(0.5f);
  TapLanes taps;
  switch (axis.address) {
    case Address::kRepeat: {
      if (axis.pot) {
        taps = lanes_split(lanes_plus_offset(axis, hn::Sub(lanes_scaled(axis, s), half)));
        taps.first = hn::And(taps.first, last);
        taps.second = hn::And(taps.second, last);
        return taps;
      }
      VF c = lanes_shifted(axis, s);
      c = hn::Sub(hn::Mul(hn::Sub(c, hn::Floor(c)), axis.size_float), half);
      taps = lanes_split(c);
      const auto inside = hn::RebindMask(DI(), hn::Ge(c, splat(0.0f)));
      taps.first = hn::IfThenElse(inside, taps.first, last);
      taps.second = lanes_next_wrapped(taps.first, last);
      return taps;
    }
    case Address::kBorder:
      return lanes_split(hn::Sub(lanes_plus_offset(axis, lanes_scaled(axis, s)), half));
    case Address::kMirror:
      taps = lanes_split(hn::Sub(hn::Mul(lanes_mirror(lanes_shifted(axis, s)), axis.size_float), half));
      taps.first = hn::Max(taps.first, splat(0));
      taps.second = hn::Min(taps.second, last);
      return taps;
    default: {
      VF c = lanes_plus_offset(axis, lanes_scaled(axis, s));
      if (axis.address == Address::kMirrorClamp) c = hn::Abs(c);
      c = hn::Sub(lanes_min_second(c, axis.size_float), half);
      taps = lanes_split(lanes_max_second(c, splat(0.0f)));
      taps.second = hn::Min(taps.second, last);
      return taps;
    }
  }
}

/// The two texels of a gather; no weight.
HWY_INLINE TapLanes lanes_gather(const AxisLanes& axis, VF s) {
  const VI last = hn::Sub(axis.size, splat(1));
  const VF half = splat(0.5f);
  const auto fold = [last](VI i) { return hn::Min(hn::IfThenElse(hn::Lt(i, splat(0)), hn::Not(i), i), last); };
  TapLanes taps;
  switch (axis.address) {
    case Address::kClamp: {
      VF c = lanes_min_second(lanes_plus_offset(axis, lanes_scaled(axis, s)), axis.size_float);
      c = lanes_max_second(c, splat(0.0f));
      taps.first = lanes_truncate_to_int(hn::Sub(c, half));
      taps.second = hn::Min(lanes_truncate_to_int(hn::Add(c, half)), last);
      break;
    }
    case Address::kMirror:
      taps = lanes_split(hn::Sub(hn::Mul(lanes_signed_mirror(lanes_shifted(axis, s)), axis.size_float), half));
      taps = {fold(taps.first), fold(taps.second), half};
      break;
    case Address::kMirrorClamp:
      taps = lanes_split(hn::Sub(lanes_plus_offset(axis, lanes_scaled(axis, s)), half));
      taps = {fold(taps.first), fold(taps.second), half};
      break;
    default:
      taps = lanes_linear(axis, s);
  }
  taps.weight = splat(0.0f);
  return taps;
}

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

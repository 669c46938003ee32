// Cubic filtering for whole waves: the twin of texel/sampler/model/cubic.h, with its bits.
#include "texel/sampler/model/cubic.h"

#include <limits>

#include "texel/sampler/prepared.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "texel/sampler/wave/cubic.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "texel/sampler/wave/values-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {
namespace {

HWY_INLINE VI lanes_positive_modulo(VI i, VI n) {
  const VF quotient = hn::Floor(hn::Div(lanes_int_to_float(i), lanes_int_to_float(n)));
  VI rest = hn::Sub(i, hn::Mul(lanes_truncate_to_int(quotient), n));
  rest = hn::Add(rest, hn::IfThenElseZero(hn::Lt(rest, splat(0)), n));
  return hn::Sub(rest, hn::IfThenElseZero(hn::Not(hn::Lt(rest, n)), n));
}

HWY_INLINE VI lanes_wrapped_texel(Address address, VI i, VI size) {
  const VI last = hn::Sub(size, splat(1));
  switch (address) {
    case Address::kRepeat:
      return lanes_positive_modulo(i, size);
    case Address::kMirror: {
      const VI twice = hn::Add(size, size);
      const VI folded = lanes_positive_modulo(i, twice);
      return hn::Min(folded, hn::Sub(hn::Sub(twice, splat(1)), folded));
    }
    case Address::kMirrorClamp:
      return hn::Min(hn::IfThenElse(hn::Lt(i, splat(0)), hn::Not(i), i), last);
    case Address::kClamp:
      return lanes_clamp(i, last);
    case Address::kBorder:
      return i;
  }
  return splat(0);
}

HWY_INLINE VF lanes_without_turns(const AxisLanes& axis, VF s) {
  if (axis.normalized && axis.address == Address::kRepeat) return hn::Sub(s, hn::Floor(s));
  if (axis.normalized && axis.address == Address::kMirror)
    return hn::Sub(s, hn::Mul(splat(2.0f), hn::Floor(hn::Mul(s, splat(0.5f)))));
  return s;
}

struct CubicTapLanes {
  VI at[4];
};

/// Stores the weights of lanes first.. of a vector.
HWY_INLINE void store_weights(VF a, std::size_t first, FloatLanes weight[4]) {
  const VF half = splat(0.5f), square = hn::Mul(a, a);
  const VF one_half = splat(1.5f);
  const auto put = [&](std::size_t k, VF value) HWY_ATTR { hn::Store(value, DF(), weight[k].lane + first); };
  put(0, hn::Mul(a, hn::Sub(hn::Mul(a, hn::Sub(splat(1.0f), hn::Mul(half, a))), half)));
  put(1, hn::Add(hn::Mul(square, hn::Sub(hn::Mul(one_half, a), splat(2.5f))), splat(1.0f)));
  put(2, hn::Mul(a, hn::Add(hn::Mul(a, hn::Sub(splat(2.0f), hn::Mul(one_half, a))), half)));
  put(3, hn::Mul(square, hn::Sub(hn::Mul(half, a), half)));
}

HWY_INLINE CubicTapLanes find_cubic_axis(const AxisLanes& axis, VF s, std::size_t first, FloatLanes weight[4]) {
  VF c = hn::Sub(lanes_plus_offset(axis, lanes_scaled(axis, lanes_without_turns(axis, s))), splat(0.5f));
  c = lanes_max_second(lanes_min_second(c, splat(kFarthestTexel)), splat(-kFarthestTexel));
  const VF floor = hn::Floor(c);
  const VI i = lanes_truncate_to_int(floor);
  CubicTapLanes taps;
  for (std::int32_t k = 0; k < 4; ++k)
    taps.at[k] = lanes_wrapped_texel(axis.address, hn::Add(i, splat(k - 1)), axis.size);
  store_weights(hn::Sub(c, floor), first, weight);
  return taps;
}

/// Sixteen texels of every lane, rows of four.
struct CubicPlaces {
  TexelPlaces place[16];
  base::LaneMask outside[16] = {};
  FloatLanes weight_x[4], weight_y[4];
};

HWY_NOINLINE void find_cubic(Call& call, int which, CubicPlaces& out) {
  const FormatDesc& format = *call.view().format;
  base::LaneMask outside_x[4] = {}, outside_y[4] = {};
  LevelLanes level;
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DF())) {
    load_level<2>(call.p, call.request, call.state, which, first, /*with_face=*/false, level);
    const VF s = hn::LoadU(DF(), call.state.coord[0] + first), t = hn::LoadU(DF(), call.state.coord[1] + first);
    CubicTapLanes x = find_cubic_axis(level.axis[0], s, first, out.weight_x);
    CubicTapLanes y = find_cubic_axis(level.axis[1], t, first, out.weight_y);
    for (std::size_t k = 0; k < 4; ++k) {
      x.at[k] = enter(x.at[k], level.axis[0].size, outside_x[k], first);
      y.at[k] = enter(y.at[k], level.axis[1].size, outside_y[k], first);
    }
    for (std::size_t k = 0; k < 16; ++k)
      place_texels<2>(format, level, x.at[k % 4], y.at[k / 4], splat(0), first, out.place[k]);
  }
  for (std::size_t k = 0; k < 16; ++k) out.outside[k] = outside_x[k % 4] | outside_y[k / 4];
}

/// `sum` takes in the values with their weights, as the reduction mode says.
HWY_NOINLINE void take_in(const Call& call, const FloatLanes& weight, const WaveTexels& values, WaveTexels& sum) {
  const VF zero = splat(0.0f);
  switch (call.reduction()) {
    case VK_SAMPLER_REDUCTION_MODE_MIN:
      return combine(call.wanted, weight, sum, values, [&](VF w, VF total, VF value) HWY_ATTR {
        return hn::IfThenElse(hn::Eq(w, zero), total, lanes_min_second(total, value));
      });
    case VK_SAMPLER_REDUCTION_MODE_MAX:
      return combine(call.wanted, weight, sum, values, [&](VF w, VF total, VF value) HWY_ATTR {
        return hn::IfThenElse(hn::Eq(w, zero), total, lanes_max_second(total, value));
      });
    default:
      return combine(call.wanted, weight, sum, values,
                     [](VF w, VF total, VF value) HWY_ATTR { return hn::Add(total, hn::Mul(w, value)); });
  }
}

void start(const Call& call, WaveTexels& sum) {
  float value = 0.0f;
  if (call.reduction() == VK_SAMPLER_REDUCTION_MODE_MIN) value = std::numeric_limits<float>::infinity();
  if (call.reduction() == VK_SAMPLER_REDUCTION_MODE_MAX) value = -std::numeric_limits<float>::infinity();
  for (FloatLanes& lanes : sum.c) std::fill_n(lanes.lane, base::kWaveWidth, value);
}

HWY_NOINLINE void filter_cubic(Call& call, int which, WaveTexels& out) {
  CubicPlaces places;
  find_cubic(call, which, places);
  WaveTexels row, texels;
  start(call, out);
  for (std::size_t j = 0; j < 4; ++j) {
    start(call, row);
    for (std::size_t i = 0; i < 4; ++i) {
      fetch_tap(call, places.place[4 * j + i], places.outside[4 * j + i], texels);
      take_in(call, places.weight_x[i], texels, row);
    }
    take_in(call, places.weight_y[j], row, out);
  }
}

/// Waves with lanes that another filter is for go lane by lane.
void sample_cubic_wave(const PreparedSampler& p, const SampleRequest& request, const SampleResult& result) {
  const Plan& plan = p.plan;
  Call call(p, request, result);
  find_state(p, request, call.state);
  if (plan.two_filters) {
    const base::LaneMask cubic = plan.min_cubic ? call.state.minify : ~call.state.minify;
    if ((request.active & ~cubic) != 0) return sample_by_lane(p, request, result);
  }
  if (call.compare) {
    call.wanted = 1;
    load_reference(call);
  }
  WaveTexels texels;
  filter_cubic(call, 0, texels);
  const bool magnified_only = plan.two_filters && plan.mag_cubic;
  if (plan.mip == MipFilter::kLinear && plan.lod_needed && !magnified_only) {
    WaveTexels next;
    filter_cubic(call, 1, next);
    average(call.wanted, call.state.fraction, texels, next);
  }
  if (call.compare) complete_comparison(texels);
  store_texels(call.view(), texels, request.active, result);
}

}  // namespace
}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vitrine::texel {
namespace {

HWY_EXPORT(sample_cubic_wave);

}  // namespace

PreparedSampler::Kernel cubic_kernel() {
  base::select_simd_target();
  return &HWY_DYNAMIC_DISPATCH(sample_cubic_wave);
}

}  // namespace vitrine::texel

#endif

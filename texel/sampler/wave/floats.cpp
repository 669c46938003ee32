// The float sampler for whole waves (lavapipe-texture-blend.md A3 to A7, A9): every format, dimension and address mode,
// comparison, gathers, reductions, one or two levels. Bits equal sample_scalar's.
#include <algorithm>

#include "texel/sampler/prepared.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "texel/sampler/wave/floats.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "texel/sampler/wave/four-inl.h"
#include "texel/sampler/wave/single_words-inl.h"
#include "texel/sampler/wave/taps-inl.h"
#include "texel/sampler/wave/values-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {
namespace {

// ---- filters

HWY_NOINLINE void reduce(const Call& call, const FloatLanes& weight, WaveTexels& a, const WaveTexels& b) {
  const VF zero = splat(0.0f);
  switch (call.reduction()) {
    case VK_SAMPLER_REDUCTION_MODE_MIN:
      return combine(call.wanted, weight, a, b, [&](VF w, VF first, VF second) {
        return hn::IfThenElse(hn::Eq(w, zero), first, lanes_min_second(first, second));
      });
    case VK_SAMPLER_REDUCTION_MODE_MAX:
      return combine(call.wanted, weight, a, b, [&](VF w, VF first, VF second) {
        return hn::IfThenElse(hn::Eq(w, zero), first, lanes_max_second(first, second));
      });
    default:
      return average(call.wanted, weight, a, b);
  }
}

/// Along x comparisons are weighted by selection.
HWY_NOINLINE void reduce_x(const Call& call, const FloatLanes& weight, WaveTexels& a, const WaveTexels& b) {
  if (!call.compare) return reduce(call, weight, a, b);
  combine(1, weight, a, b, [](VF w, VF first, VF second) {
    const VF zero = splat(0.0f);
    return hn::Add(hn::IfThenElseZero(hn::Not(hn::Eq(second, zero)), w),
                   hn::IfThenElseZero(hn::Not(hn::Eq(first, zero)), hn::Sub(splat(1.0f), w)));
  });
}

/// Taps 4z..4z+3 (or the two of one dimension).
HWY_NOINLINE void filter_slice(Call& call, const FloatTaps& taps, std::uint32_t k, WaveTexels& out) {
  WaveTexels second;
  fetch_tap(call, taps.place[k], taps.outside[k], out);
  fetch_tap(call, taps.place[k + 1], taps.outside[k + 1], second);
  reduce_x(call, taps.weight[0], out, second);
  if (taps.count == 2) return;
  WaveTexels lower;
  fetch_tap(call, taps.place[k + 2], taps.outside[k + 2], lower);
  fetch_tap(call, taps.place[k + 3], taps.outside[k + 3], second);
  reduce_x(call, taps.weight[0], lower, second);
  reduce(call, taps.weight[1], out, lower);
}

/// At a corner of a cube three texels share the weight of the one that does not exist.
void weigh_corners(const Call& call, const FloatTaps& taps, base::LaneMask corners, const WaveTexels texels[4],
                   WaveTexels& out) {
  base::for_each_lane(corners, [&](std::size_t lane) {
    CubeTaps cube;
    cube.weight_x = taps.weight[0].lane[lane];
    cube.weight_y = taps.weight[1].lane[lane];
    cube.corner = static_cast<std::uint32_t>(taps.corner.lane[lane]);
    float weight[4];
    corner_weights(cube, weight);
    for (std::size_t c = 0; c < 4; ++c) {
      if ((call.wanted >> c & 1) == 0) continue;
      float sum = weight[0] * texels[0].c[c].lane[lane];
      for (std::size_t i = 1; i < 4; ++i) sum = weight[i] * texels[i].c[c].lane[lane] + sum;
      out.c[c].lane[lane] = sum;
    }
  });
}

HWY_NOINLINE void filter_cube(Call& call, const FloatTaps& taps, WaveTexels& out) {
  WaveTexels texels[4];
  for (std::uint32_t k = 0; k < 4; ++k) fetch_tap(call, taps.place[k], taps.outside[k], texels[k]);
  const bool averaged = call.reduction() == VK_SAMPLER_REDUCTION_MODE_WEIGHTED_AVERAGE;
  const base::LaneMask corners = averaged ? taps.corners & call.request.active : 0;
  WaveTexels at_corners;
  if (corners != 0) weigh_corners(call, taps, corners, texels, at_corners);
  out = texels[0];
  reduce_x(call, taps.weight[0], out, texels[1]);
  reduce_x(call, taps.weight[0], texels[2], texels[3]);
  reduce(call, taps.weight[1], out, texels[2]);
  base::for_each_lane(corners, [&](std::size_t lane) {
    for (std::size_t c = 0; c < 4; ++c) {
      if (call.wanted >> c & 1) out.c[c].lane[lane] = at_corners.c[c].lane[lane];
    }
  });
}

/// Averages of texels inside the level by the filters of certain formats; false if there is none for this call.
HWY_NOINLINE bool filter_directly(Call& call, const FloatTaps& taps, WaveTexels& out) {
  if (call.reduction() != VK_SAMPLER_REDUCTION_MODE_WEIGHTED_AVERAGE || taps.count < 4) return false;
  for (std::uint32_t k = 0; k < taps.count; ++k) {
    if (taps.outside[k] != 0) return false;
  }
  const FormatDesc& format = *call.view().format;
  if (averages_words(format)) {
    const WordTaps words{call.view(), taps.place, taps.weight, taps.neighbours};
    const VkCompareOp op = call.plan().sampler->compare_op;
    if (call.compare) {
      taps.count == 4 ? average_comparisons<4>(words, op, call.reference, out)
                      : average_comparisons<8>(words, op, call.reference, out);
    } else {
      taps.count == 4 ? average_words<4>(words, call.wanted, out) : average_words<8>(words, call.wanted, out);
    }
    return true;
  }
  if (taps.count != 4 || call.compare || !has_four_floats(format)) return false;
  const auto filter = format.block_bytes == 8 ? filter_four<8> : filter_four<16>;
  filter(call.view().base, taps.place, taps.neighbours, taps.weight[0], taps.weight[1], out);
  return true;
}

HWY_NOINLINE void filter_level(Call& call, int which, bool linear, WaveTexels& out) {
  FloatTaps taps;
  if (call.plan().seamless && linear) {
    find_cube_taps(call, which, taps);
    if ((taps.corners & call.request.active) == 0 && filter_directly(call, taps, out)) return;
    return filter_cube(call, taps, out);
  }
  find_taps(call, which, linear, taps);
  if (!linear) return fetch_tap(call, taps.place[0], taps.outside[0], out);
  if (filter_directly(call, taps, out)) return;
  filter_slice(call, taps, 0, out);
  if (taps.count < 8) return;
  WaveTexels farther;
  filter_slice(call, taps, 4, farther);
  reduce(call, taps.weight[2], out, farther);
}

/// Copies lanes of `from`.
HWY_NOINLINE void replace(Components wanted, base::LaneMask lanes, const WaveTexels& from, WaveTexels& to) {
  for (std::size_t c = 0; c < 4; ++c) {
    if ((wanted >> c & 1) == 0) continue;
    for (std::size_t i = 0; i < base::kWaveWidth; i += hn::Lanes(DF())) {
      hn::BlendedStore(hn::Load(DF(), from.c[c].lane + i), lanes_mask_from_bits(DF(), lanes >> i), DF(),
                       to.c[c].lane + i);
    }
  }
}

HWY_NOINLINE void filter_levels(Call& call, WaveTexels& out) {
  const Plan& plan = call.plan();
  const base::LaneMask active = call.request.active;
  const bool two_filters = plan.two_filters;
  // With two filters, magnified lanes take one level.
  const base::LaneMask minified = two_filters ? call.state.minify & active : active;
  if (minified != 0) {
    filter_level(call, 0, plan.min_linear, out);
    if (plan.mip == MipFilter::kLinear && plan.lod_needed) {
      WaveTexels next;
      filter_level(call, 1, plan.min_linear, next);
      average(call.wanted, call.state.fraction, out, next);
    }
  }
  if (minified == active) return;
  WaveTexels magnified;
  filter_level(call, 0, plan.mag_linear, magnified);
  replace(call.wanted, active & ~minified, magnified, out);
}

// ---- gathers

/// The four texels around a point, in the order (i0,j1) (i1,j1) (i1,j0) (i0,j0).
void gather(Call& call, const SampleResult& result) {
  const ImageView& view = call.view();
  const std::uint8_t source = call.compare ? 0 : view.swizzle[call.request.gather_component & 3];
  constexpr std::uint32_t kOrder[4] = {2, 3, 1, 0};
  FloatTaps taps;
  call.plan().seamless ? find_cube_taps(call, 0, taps) : find_taps(call, 0, true, taps);
  call.wanted = source < 4 ? 1u << source : 0u;
  FloatLanes value[4];
  for (std::uint32_t c = 0; c < 4; ++c) {
    const std::uint32_t k = kOrder[c];
    if (result[c] == nullptr && taps.corners == 0) continue;
    if (source < 4) {
      WaveTexels texels;
      fetch_tap(call, taps.place[k], taps.outside[k], texels);
      value[k] = texels.c[source];
    } else {
      const std::uint32_t one = view.format->is_integer() ? 1u : 0x3f800000u;
      const VF constant = as_float(hn::Set(DU(), source == 5 ? one : 0u));
      for (std::size_t i = 0; i < base::kWaveWidth; i += hn::Lanes(DF())) hn::Store(constant, DF(), value[k].lane + i);
    }
  }
  if (!view.format->is_integer()) {
    base::for_each_lane(taps.corners & call.request.active, [&](std::size_t lane) {
      const auto corner = static_cast<std::size_t>(taps.corner.lane[lane]);
      value[corner].lane[lane] = 0.0f;  // the texel that does not exist is the average of the others
      value[corner].lane[lane] =
          (1.0f / 3.0f) * ((value[0].lane[lane] + value[1].lane[lane]) + (value[2].lane[lane] + value[3].lane[lane]));
    });
  }
  for (std::size_t c = 0; c < 4; ++c) {
    if (result[c] == nullptr) continue;
    for (std::size_t i = 0; i < base::kWaveWidth; i += hn::Lanes(DF())) {
      store_lanes(as_unsigned(hn::Load(DF(), value[kOrder[c]].lane + i)), call.request.active, i, *result[c]);
    }
  }
}

/// A texel for each of four offsets: the (i0, j0) of its footprint.
void gather_each_offset(const PreparedSampler& p, const SampleRequest& request, const SampleResult& result) {
  base::WaveRegister gathered[4];  // results may be registers of the request
  for (std::size_t i = 0; i < 4; ++i) {
    if (result[i] == nullptr) continue;
    base::WaveRegister offset[2];
    for (std::size_t axis = 0; axis < 2; ++axis) {
      std::fill_n(offset[axis].lane, base::kWaveWidth, static_cast<std::uint32_t>((*request.gather_offsets)[i][axis]));
    }
    SampleRequest moved = request;
    moved.offset = {&offset[0], &offset[1], nullptr};
    const SampleResult one{nullptr, nullptr, nullptr, &gathered[i]};
    Call call(p, moved, one);
    find_state(p, moved, call.state);
    if (call.compare) load_reference(call);
    gather(call, one);
  }
  for (std::size_t c = 0; c < 4; ++c) {
    if (result[c] == nullptr) continue;
    for (std::size_t i = 0; i < base::kWaveWidth; i += hn::Lanes(DU())) {
      store_lanes(hn::Load(DU(), gathered[c].lane + i), request.active, i, *result[c]);
    }
  }
}

/// The level that would be read, and the level of detail before its clamps.
void query_lod(const PreparedSampler& p, const SampleRequest& request, const SampleResult& result) {
  const Plan& plan = p.plan;
  const VF last = splat(static_cast<float>(plan.view->level_count - 1));
  WaveState state;
  for_each_slope(p, request, state, [&](std::size_t first, const Slopes& d) HWY_ATTR {
    LodLanes lod = find_lod(plan, request, slopes_to_rho(plan, request, d), first);
    if (plan.view->min_lod != 0.0f) lod.clamped = lanes_max_second(lod.clamped, splat(plan.view->min_lod));
    VF level = splat(0.0f);
    if (plan.mip == MipFilter::kNearest) level = hn::Round(lod.clamped);
    if (plan.mip == MipFilter::kLinear) level = lod.clamped;
    level = lanes_min_second(lanes_max_second(level, splat(0.0f)), last);
    // Vectors are whole quads: what is stored is read no more.
    if (result[0] != nullptr) store_lanes(as_unsigned(level), request.active, first, *result[0]);
    if (result[1] != nullptr) store_lanes(as_unsigned(lod.value), request.active, first, *result[1]);
  });
}

/// Whether a texel is nearest on one level, and four words that are its values.
bool is_four_values(const Call& call) {
  const Plan& plan = call.plan();
  const FormatDesc& format = *call.view().format;
  const bool one = !plan.min_linear && !plan.mag_linear && (plan.mip != MipFilter::kLinear || !plan.lod_needed);
  return one && !call.compare && !plan.seamless && format.block_bytes == 16 && !format.is_compressed() &&
         format.channel[0].bits == 32;
}

/// From memory to the results in one walk.
HWY_NOINLINE void sample_four_values(Call& call, const SampleResult& result) {
  FloatTaps taps;
  find_taps(call, 0, false, taps);
  const ImageView& view = call.view();
  const base::LaneMask active = call.request.active;
  if (taps.outside[0] != 0) {
    WaveTexels texels;
    fetch_tap(call, taps.place[0], taps.outside[0], texels);
    return store_texels(view, texels, active, result);
  }
  const VU one = hn::Set(DU(), view.format->is_integer() ? 1u : 0x3f800000u);
  const bool in_order = view.swizzle == std::array<std::uint8_t, 4>{0, 1, 2, 3};
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::MaxLanes(DU())) {
    VU word[6];
    load_word_quads(view.base, hn::Load(DI(), taps.place[0].offset.lane + first), word);
    if (in_order) {
      for (std::size_t c = 0; c < 4; ++c)
        if (result[c] != nullptr) store_lanes(word[c], active, first, *result[c]);
      continue;
    }
    word[4] = hn::Zero(DU());
    word[5] = one;
    for (std::size_t c = 0; c < 4; ++c)
      if (result[c] != nullptr) store_lanes(word[view.swizzle[c]], active, first, *result[c]);
  }
}

/// Of a call whose state is known.
void sample_waves(Call& call, const SampleResult& result) {
  if (call.compare) {
    call.wanted = 1;
    load_reference(call);
  }
  if (call.plan().gather) return gather(call, result);
  if (is_four_values(call)) return sample_four_values(call, result);
  WaveTexels texels;
  filter_levels(call, texels);
  if (call.compare) complete_comparison(texels);
  store_texels(call.view(), texels, call.request.active, result);
}

void sample_floats(const PreparedSampler& p, const SampleRequest& request, const SampleResult& result) {
  if (request.gather_offsets != nullptr) return gather_each_offset(p, request, result);
  Call call(p, request, result);
  find_state(p, request, call.state);
  sample_waves(call, result);
}

void sample_words_or_compare(const PreparedSampler& p, const SampleRequest& request, const WaveState& state,
                             const SampleResult& result) {
  const bool halves = p.plan.view->format->block_bytes == 2;
  if (request.dref != nullptr)
    halves ? compare_words_bilinear<2>(p, request, state, result)
           : compare_words_bilinear<4>(p, request, state, result);
  else
    halves ? sample_words_bilinear<2>(p, request, state, result) : sample_words_bilinear<4>(p, request, state, result);
}

void sample_floats_bilinear(const PreparedSampler& p, const SampleRequest& request, const SampleResult& result) {
  WaveState state;
  find_state(p, request, state);
  sample_words_or_compare(p, request, state, result);
}

/// Texels of one word without a filter: gathers, or nearest ones.
void sample_single_words(const PreparedSampler& p, const SampleRequest& request, const SampleResult& result) {
  if (p.plan.gather && gathered_channel(*p.plan.view, request) < 0) return sample_floats(p, request, result);
  WaveState state;
  find_state(p, request, state);
  p.plan.gather ? gather_words(p, request, state, result) : sample_words_nearest(p, request, state, result);
}

/// Whether all lanes are on one face of one level, with all their texels inside it.
bool is_inside_face(const Call& call, int which) {
  if (!wave_has_one_level(call.p, call.request, call.state, which)) return false;
  const std::size_t level = call.p.one_level ? 0 : static_cast<std::size_t>(call.state.level[which].lane[0]);
  const VF size = lanes_int_to_float(splat(call.p.level.width[level]));
  const VF last = hn::Sub(size, splat(1.0f)), zero = splat(0.0f);
  auto inside = hn::Le(zero, last);
  for (std::size_t i = 0; i < base::kWaveWidth; i += hn::Lanes(DF())) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const VF at = hn::Sub(hn::Mul(hn::LoadU(DF(), call.state.coord[axis] + i), size), splat(0.5f));
      inside = hn::And(inside, hn::And(hn::Ge(at, zero), hn::Lt(at, last)));
    }
  }
  return hn::AllTrue(DF(), inside);
}

/// Cubes across whose edges filters reach: most waves lie inside a face, an image of two dimensions.
void sample_cube_bilinear(const PreparedSampler& p, const SampleRequest& request, const SampleResult& result) {
  Call call(p, request, result);
  find_state(p, request, call.state);
  const bool two_levels = p.plan.mip == MipFilter::kLinear && p.plan.lod_needed;
  if (is_inside_face(call, 0) && (!two_levels || is_inside_face(call, 1))) {
    return sample_words_or_compare(p, request, call.state, result);
  }
  sample_waves(call, result);
}

}  // namespace
}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vitrine::texel {
namespace {

HWY_EXPORT(sample_floats);
HWY_EXPORT(sample_floats_bilinear);
HWY_EXPORT(sample_cube_bilinear);
HWY_EXPORT(sample_single_words);
HWY_EXPORT(query_lod);

/// Whether sample_floats_bilinear does what the general sampler does; of cubes, sample_cube_bilinear.
bool bilinear_suits(const Plan& plan) {
  const FormatDesc& format = *plan.view->format;
  const bool border = plan.address[0] == Address::kBorder || plan.address[1] == Address::kBorder;
  return plan.dims == 2 && plan.cube == plan.seamless && !plan.gather && !border && plan.min_linear &&
         plan.mag_linear && averages_words(format) && (format.block_bytes == 2 || format.block_bytes == 4) &&
         plan.sampler->reduction == VK_SAMPLER_REDUCTION_MODE_WEIGHTED_AVERAGE;
}

/// Whether sample_single_words does what the general sampler does.
bool single_words_suit(const Plan& plan) {
  const FormatDesc& format = *plan.view->format;
  const bool border = plan.address[0] == Address::kBorder || plan.address[1] == Address::kBorder;
  const bool nearest = !plan.min_linear && !plan.mag_linear && plan.mip != MipFilter::kLinear;
  return (plan.gather || nearest) && plan.dims == 2 && !plan.cube && !border && format.plain &&
         format.block_bytes == 4 && format.format != VK_FORMAT_E5B9G9R9_UFLOAT_PACK32;
}

}  // namespace

PreparedSampler::Kernel float_kernel(const Plan& plan) {
  base::select_simd_target();
  if (single_words_suit(plan)) return &HWY_DYNAMIC_DISPATCH(sample_single_words);
  if (!bilinear_suits(plan)) return &HWY_DYNAMIC_DISPATCH(sample_floats);
  return plan.cube ? &HWY_DYNAMIC_DISPATCH(sample_cube_bilinear) : &HWY_DYNAMIC_DISPATCH(sample_floats_bilinear);
}

PreparedSampler::Kernel query_kernel() {
  base::select_simd_target();
  return &HWY_DYNAMIC_DISPATCH(query_lod);
}

}  // namespace vitrine::texel

#endif

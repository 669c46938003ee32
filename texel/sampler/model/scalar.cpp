// Samples lane by lane: every filter, dimension and address mode of lavapipe-texture-blend.md A3 to A9. The vector
// paths must give the same bits.
#include <algorithm>
#include <cmath>

#include "base/numeric.h"
#include "texel/sampler/model/address.h"
#include "texel/sampler/model/anisotropic.h"
#include "texel/sampler/model/cube.h"
#include "texel/sampler/model/cubic.h"
#include "texel/sampler/model/level.h"
#include "texel/sampler/model/lod.h"

namespace vitrine::texel {
namespace {

using base::bits_of;
using base::float_of;

std::uint8_t reduce_byte(VkSamplerReductionMode mode, std::int32_t weight, std::int32_t a, std::int32_t b) {
  if (mode == VK_SAMPLER_REDUCTION_MODE_MIN) return static_cast<std::uint8_t>(weight == 0 ? a : std::min(a, b));
  if (mode == VK_SAMPLER_REDUCTION_MODE_MAX) return static_cast<std::uint8_t>(weight == 0 ? a : std::max(a, b));
  return static_cast<std::uint8_t>(a + ((weight * (b - a) + 128) >> 8));
}

/// Between mip levels values are averaged in every reduction mode (bytes are reduced).
void blend_levels(const LaneSample& lane, float weight, Texel& a, const Texel& b) {
  const std::size_t channels = lane.compare ? 1 : 4;
  for (std::size_t c = 0; c < channels; ++c) {
    a[c] = bits_of(base::fma_exact(weight, float_of(b[c]) - float_of(a[c]), float_of(a[c])));
  }
}

ByteTexel bytes_at(const LaneSample& lane, std::uint32_t level, std::int32_t x, std::int32_t y, std::int32_t z) {
  ByteTexel out;
  fetch_bytes(*lane.plan->view, level, lane.layer + (lane.plan->cube ? lane.face : 0), static_cast<std::uint32_t>(x),
              static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(z), out);
  return out;
}

void reduce_bytes(const LaneSample& lane, std::int32_t weight, ByteTexel& a, const ByteTexel& b) {
  for (std::size_t c = 0; c < 4; ++c) a[c] = reduce_byte(lane.plan->sampler->reduction, weight, a[c], b[c]);
}

ByteTexel filter_byte_slice(const LaneSample& lane, std::uint32_t level, const ByteTaps taps[3], std::int32_t z) {
  ByteTexel upper = bytes_at(lane, level, taps[0].first, taps[1].first, z);
  reduce_bytes(lane, taps[0].weight, upper, bytes_at(lane, level, taps[0].second, taps[1].first, z));
  if (lane.plan->dims == 1) return upper;
  ByteTexel lower = bytes_at(lane, level, taps[0].first, taps[1].second, z);
  reduce_bytes(lane, taps[0].weight, lower, bytes_at(lane, level, taps[0].second, taps[1].second, z));
  reduce_bytes(lane, taps[1].weight, upper, lower);
  return upper;
}

ByteTexel sample_bytes(const LaneSample& lane, std::uint32_t level, bool linear) {
  if (!linear) {
    std::int32_t c[3] = {};
    for (std::uint32_t i = 0; i < lane.plan->dims; ++i) c[i] = nearest_bytes(make_axis(lane, level, i), lane.coord[i]);
    return bytes_at(lane, level, c[0], c[1], c[2]);
  }
  ByteTaps taps[3];
  for (std::uint32_t i = 0; i < lane.plan->dims; ++i) taps[i] = linear_bytes(make_axis(lane, level, i), lane.coord[i]);
  ByteTexel result = filter_byte_slice(lane, level, taps, taps[2].first);
  if (lane.plan->dims == 3) {
    reduce_bytes(lane, taps[2].weight, result, filter_byte_slice(lane, level, taps, taps[2].second));
  }
  return result;
}

Texel sample_all_bytes(const LaneSample& lane, const Lod& lod, bool linear, bool two_levels) {
  ByteTexel bytes = sample_bytes(lane, lod.level0, linear);
  if (two_levels) {
    const std::int32_t weight = base::truncate_to_int(lod.fraction * 256.0f) & 255;
    reduce_bytes(lane, weight, bytes, sample_bytes(lane, lod.level1, linear));
  }
  Texel texel;
  for (std::size_t c = 0; c < 4; ++c) texel[c] = bits_of(static_cast<float>(bytes[c]) * (1.0f / 255.0f));
  return texel;
}

Texel gather(const LaneSample& lane, const SampleRequest& request) {
  const ImageView& view = *lane.plan->view;
  CubeTaps cube;
  Taps taps[3];
  if (lane.plan->seamless) {
    const auto size = static_cast<std::int32_t>(view.level[0].extent.width);
    cube = cube_taps(lane.face, lane.coord[0], lane.coord[1], size);
  } else {
    find_taps(lane, 0, taps);
  }
  const std::int32_t x[2] = {taps[0].first, taps[0].second};
  const std::int32_t y[2] = {taps[1].first, taps[1].second};
  float value[4];
  for (std::size_t k = 0; k < 4; ++k) {
    const CubeTexel& at = cube.texel[k];
    Texel texel = lane.plan->seamless ? texel_or_border(lane, 0, lane.layer + at.face, at.x, at.y, 0)
                                      : texel_or_border(lane, 0, lane.layer + (lane.plan->cube ? lane.face : 0),
                                                        x[k & 1], y[k >> 1], 0);
    if (!lane.compare) apply_swizzle(view, texel);
    value[k] = float_of(texel[lane.compare ? 0 : request.gather_component & 3]);
  }
  if (cube.corner < 4 && !view.format->is_integer()) {
    value[cube.corner] = 0.0f;  // the texel that does not exist is the average of the others
    value[cube.corner] = (1.0f / 3.0f) * ((value[0] + value[1]) + (value[2] + value[3]));
  }
  constexpr std::size_t kOrder[4] = {2, 3, 1, 0};  // (i0,j1) (i1,j1) (i1,j0) (i0,j0); index = j*2 + i
  Texel result;
  for (std::size_t i = 0; i < 4; ++i) result[i] = bits_of(value[kOrder[i]]);
  return result;
}

Texel sample_lane(const LaneSample& lane, const SampleRequest& request, const LanePoint& point, std::size_t index) {
  const Plan& plan = *lane.plan;
  Lod lod;
  if (plan.lod_needed) lod = level_of_detail(plan, request, point, index);
  Texel texel;
  if (plan.anisotropic) {
    texel = sample_anisotropic(lane, point, lod.level0);
  } else {
    const bool linear = lod.minify ? plan.min_linear : plan.mag_linear;
    const bool cubic = lod.minify ? plan.min_cubic : plan.mag_cubic;
    const bool magnified_only = plan.two_filters && !lod.minify;
    const bool two_levels = plan.mip == MipFilter::kLinear && !magnified_only;
    if (plan.aos) {
      texel = sample_all_bytes(lane, lod, linear, two_levels);
    } else if (cubic) {
      texel = sample_cubic(lane, lod.level0);
      if (two_levels) blend_levels(lane, lod.fraction, texel, sample_cubic(lane, lod.level1));
    } else {
      texel = sample_level(lane, lod.level0, linear);
      if (two_levels) blend_levels(lane, lod.fraction, texel, sample_level(lane, lod.level1, linear));
    }
  }
  if (lane.compare) texel = {texel[0], 0, 0, bits_of(1.0f)};
  apply_swizzle(*plan.view, texel);
  return texel;
}

void set_offsets(LaneSample& lane, const SampleRequest& request, std::size_t index) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (request.offset[i] == nullptr) continue;
    lane.offset[i] = static_cast<std::int32_t>(request.offset[i]->lane[index]);
    lane.has_offset = true;
  }
}

/// One texel per offset: the (i0, j0) texel of each footprint.
Texel gather_each_offset(LaneSample& lane, const SampleRequest& request) {
  Texel result;
  for (std::size_t i = 0; i < 4; ++i) {
    lane.offset = {(*request.gather_offsets)[i][0], (*request.gather_offsets)[i][1], 0};
    lane.has_offset = true;
    result[i] = gather(lane, request)[3];
  }
  return result;
}

/// The array layer of the view that a lane's last coordinate names; the first face for cubes.
std::uint32_t select_layer(const Plan& plan, const SampleRequest& request, std::size_t lane) {
  const base::WaveRegister* coord = request.coord[plan.cube ? 3 : plan.dims];
  if (!plan.arrayed || coord == nullptr) return 0;
  std::int32_t layer = base::round_to_int(float_of(coord->lane[lane]));
  auto last = static_cast<std::int32_t>(plan.view->layer_count) - 1;
  if (plan.cube) {
    layer = static_cast<std::int32_t>(static_cast<std::uint32_t>(layer) * 6u);
    last = std::max(last - 5, 0);
  }
  return static_cast<std::uint32_t>(std::clamp(layer, 0, last));
}

Texel query_lod(const Plan& plan, const Lod& lod) {
  float level = 0;
  if (plan.mip == MipFilter::kNearest) level = std::nearbyintf(lod.clamped);
  if (plan.mip == MipFilter::kLinear) level = lod.clamped;
  const float last = static_cast<float>(plan.view->level_count - 1);
  level = base::min_second(base::max_second(level, 0.0f), last);
  return {bits_of(level), bits_of(lod.value), 0, 0};
}

}  // namespace

void sample_scalar(const Plan& plan, const SampleRequest& request, base::WaveRegister result[4]) {
  const bool fixed_point = plan.view->format->channel[0].numeric != Numeric::kSfloat;
  base::for_each_lane(request.active, [&](std::size_t index) {
    Texel texel{};
    if (!plan.zero) {
      const LanePoint point = locate(plan, request, index);
      LaneSample lane;
      lane.plan = &plan;
      std::copy(std::begin(point.coord), std::end(point.coord), lane.coord.begin());
      lane.face = point.face;
      lane.layer = select_layer(plan, request, index);
      set_offsets(lane, request, index);
      if (request.dref != nullptr) {
        lane.compare = true;
        const float reference = float_of(request.dref->lane[index]);
        lane.reference = fixed_point ? base::max_second(base::min_second(reference, 1.0f), 0.0f) : reference;
      }
      if (request.op == SampleOp::kQueryLod) {
        texel = query_lod(plan, level_of_detail(plan, request, point, index));
      } else if (plan.gather) {
        texel = request.gather_offsets != nullptr ? gather_each_offset(lane, request) : gather(lane, request);
      } else {
        texel = sample_lane(lane, request, point, index);
      }
    }
    const std::size_t components = request.op == SampleOp::kQueryLod ? 2 : 4;
    for (std::size_t c = 0; c < components; ++c) result[c].lane[index] = texel[c];
  });
}

}  // namespace vitrine::texel

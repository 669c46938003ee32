// Nearest and linear lookups of one lane (lavapipe-texture-blend.md A3, A5, A6, A9).
#include "texel/sampler/model/level.h"

#include <algorithm>
#include <cmath>

#include "base/numeric.h"
#include "texel/sampler/model/cube.h"

namespace vitrine::texel {
namespace {

using base::bits_of;
using base::float_of;

bool inside(std::int32_t i, std::uint32_t size) { return i >= 0 && static_cast<std::uint32_t>(i) < size; }

bool compare(VkCompareOp op, float reference, float texel) {
  switch (op) {
    case VK_COMPARE_OP_LESS:
      return reference < texel;
    case VK_COMPARE_OP_EQUAL:
      return reference == texel;
    case VK_COMPARE_OP_LESS_OR_EQUAL:
      return reference <= texel;
    case VK_COMPARE_OP_GREATER:
      return reference > texel;
    case VK_COMPARE_OP_NOT_EQUAL:
      return !(reference == texel);
    case VK_COMPARE_OP_GREATER_OR_EQUAL:
      return reference >= texel;
    case VK_COMPARE_OP_ALWAYS:
      return true;
    default:
      return false;
  }
}

/// Interpolates by the sampler's reduction mode.
float reduce(VkSamplerReductionMode mode, float weight, float a, float b) {
  if (mode == VK_SAMPLER_REDUCTION_MODE_MIN) return weight == 0.0f ? a : base::min_second(a, b);
  if (mode == VK_SAMPLER_REDUCTION_MODE_MAX) return weight == 0.0f ? a : base::max_second(a, b);
  return base::fma_exact(weight, b - a, a);
}

/// Along x comparisons are weighted by selection, so that equal results give it exactly.
void reduce_x(const LaneSample& lane, float weight, Texel& a, const Texel& b) {
  if (!lane.compare) return reduce_texel(lane, weight, a, b);
  const float second = float_of(b[0]) != 0.0f ? weight : 0.0f;
  const float first = float_of(a[0]) != 0.0f ? 1.0f - weight : 0.0f;
  a[0] = bits_of(second + first);
}

Texel sample_nearest(const LaneSample& lane, std::uint32_t level) {
  std::int32_t c[3] = {};
  for (std::uint32_t i = 0; i < lane.plan->dims; ++i) c[i] = nearest_texel(make_axis(lane, level, i), lane.coord[i]);
  return texel_or_border(lane, level, lane.layer + (lane.plan->cube ? lane.face : 0), c[0], c[1], c[2]);
}

Texel filter_slice(const LaneSample& lane, std::uint32_t level, const Taps taps[3], std::int32_t z) {
  const std::uint32_t layer = lane.layer + (lane.plan->cube ? lane.face : 0);
  Texel upper = texel_or_border(lane, level, layer, taps[0].first, taps[1].first, z);
  reduce_x(lane, taps[0].weight, upper, texel_or_border(lane, level, layer, taps[0].second, taps[1].first, z));
  if (lane.plan->dims == 1) return upper;
  Texel lower = texel_or_border(lane, level, layer, taps[0].first, taps[1].second, z);
  reduce_x(lane, taps[0].weight, lower, texel_or_border(lane, level, layer, taps[0].second, taps[1].second, z));
  reduce_texel(lane, taps[1].weight, upper, lower);
  return upper;
}

Texel sample_linear(const LaneSample& lane, std::uint32_t level) {
  Taps taps[3];
  find_taps(lane, level, taps);
  Texel result = filter_slice(lane, level, taps, taps[2].first);
  if (lane.plan->dims == 3) reduce_texel(lane, taps[2].weight, result, filter_slice(lane, level, taps, taps[2].second));
  return result;
}

/// LINEAR across the edges of a cube: texels of neighbouring faces, weights by thirds at a corner.
Texel sample_cube_linear(const LaneSample& lane, std::uint32_t level) {
  const auto size = static_cast<std::int32_t>(lane.plan->view->level[level].extent.width);
  const CubeTaps taps = cube_taps(lane.face, lane.coord[0], lane.coord[1], size);
  Texel texel[4];
  for (std::size_t i = 0; i < 4; ++i) {
    const CubeTexel& at = taps.texel[i];
    texel[i] = texel_or_border(lane, level, lane.layer + at.face, at.x, at.y, 0);
  }
  const bool average = lane.plan->sampler->reduction == VK_SAMPLER_REDUCTION_MODE_WEIGHTED_AVERAGE;
  if (taps.corner < 4 && average) {
    float weight[4];
    corner_weights(taps, weight);
    const std::size_t channels = lane.compare ? 1 : 4;
    for (std::size_t c = 0; c < channels; ++c) {
      float sum = weight[0] * float_of(texel[0][c]);
      for (std::size_t i = 1; i < 4; ++i) sum = weight[i] * float_of(texel[i][c]) + sum;
      texel[0][c] = bits_of(sum);
    }
    return texel[0];
  }
  reduce_x(lane, taps.weight_x, texel[0], texel[1]);
  reduce_x(lane, taps.weight_x, texel[2], texel[3]);
  reduce_texel(lane, taps.weight_y, texel[0], texel[2]);
  return texel[0];
}

}  // namespace

Axis make_axis(const LaneSample& lane, std::uint32_t level, std::uint32_t i) {
  const Extent& extent = lane.plan->view->level[level].extent;
  const std::uint32_t size[3] = {extent.width, extent.height, extent.depth};
  Axis axis;
  axis.address = lane.plan->address[i];
  axis.pot = lane.plan->pot[i];
  axis.normalized = !lane.plan->sampler->unnormalized;
  axis.size = static_cast<std::int32_t>(size[i]);
  axis.offset = lane.offset[i];
  axis.has_offset = lane.has_offset;
  return axis;
}

void find_taps(const LaneSample& lane, std::uint32_t level, Taps taps[3]) {
  for (std::uint32_t i = 0; i < lane.plan->dims; ++i) {
    const Axis axis = make_axis(lane, level, i);
    taps[i] = lane.plan->gather ? gather_texels(axis, lane.coord[i]) : linear_texels(axis, lane.coord[i]);
  }
}

void reduce_texel(const LaneSample& lane, float weight, Texel& a, const Texel& b) {
  const std::size_t channels = lane.compare ? 1 : 4;
  for (std::size_t c = 0; c < channels; ++c) {
    a[c] = bits_of(reduce(lane.plan->sampler->reduction, weight, float_of(a[c]), float_of(b[c])));
  }
}

Texel texel_or_border(const LaneSample& lane, std::uint32_t level, std::uint32_t layer, std::int32_t x, std::int32_t y,
                      std::int32_t z) {
  const ImageView& view = *lane.plan->view;
  const Extent& extent = view.level[level].extent;
  Texel texel = lane.plan->border;
  if (inside(x, extent.width) && inside(y, extent.height) && inside(z, extent.depth) && layer < view.layer_count) {
    fetch_texel(*lane.plan, level, layer, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                static_cast<std::uint32_t>(z), texel);
  }
  if (lane.compare) {
    texel[0] = bits_of(compare(lane.plan->sampler->compare_op, lane.reference, float_of(texel[0])) ? 1.0f : 0.0f);
  }
  return texel;
}

Texel sample_level(const LaneSample& lane, std::uint32_t level, bool linear) {
  if (lane.plan->seamless && linear) return sample_cube_linear(lane, level);
  return linear ? sample_linear(lane, level) : sample_nearest(lane, level);
}

}  // namespace vitrine::texel

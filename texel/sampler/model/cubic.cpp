// See texel/sampler/model/cubic.h.
#include "texel/sampler/model/cubic.h"

#include <limits>

namespace vitrine::texel {
namespace {

using base::bits_of;
using base::float_of;

/// What no texel changes: of a sum, a minimum, a maximum.
float start_of(VkSamplerReductionMode mode) {
  if (mode == VK_SAMPLER_REDUCTION_MODE_MIN) return std::numeric_limits<float>::infinity();
  if (mode == VK_SAMPLER_REDUCTION_MODE_MAX) return -std::numeric_limits<float>::infinity();
  return 0.0f;
}

float take_in(VkSamplerReductionMode mode, float weight, float value, float sum) {
  if (mode == VK_SAMPLER_REDUCTION_MODE_MIN) return weight == 0.0f ? sum : base::min_second(sum, value);
  if (mode == VK_SAMPLER_REDUCTION_MODE_MAX) return weight == 0.0f ? sum : base::max_second(sum, value);
  return sum + weight * value;
}

}  // namespace

Texel sample_cubic(const LaneSample& lane, std::uint32_t level) {
  const VkSamplerReductionMode mode = lane.plan->sampler->reduction;
  const CubicTaps x = cubic_texels(make_axis(lane, level, 0), lane.coord[0]);
  const CubicTaps y = cubic_texels(make_axis(lane, level, 1), lane.coord[1]);
  float sum[4], row[4];
  std::fill(std::begin(sum), std::end(sum), start_of(mode));
  for (std::size_t j = 0; j < 4; ++j) {
    std::fill(std::begin(row), std::end(row), start_of(mode));
    for (std::size_t i = 0; i < 4; ++i) {
      const Texel texel = texel_or_border(lane, level, lane.layer, x.at[i], y.at[j], 0);
      for (std::size_t c = 0; c < 4; ++c) row[c] = take_in(mode, x.weight[i], float_of(texel[c]), row[c]);
    }
    for (std::size_t c = 0; c < 4; ++c) sum[c] = take_in(mode, y.weight[j], row[c], sum[c]);
  }
  return {bits_of(sum[0]), bits_of(sum[1]), bits_of(sum[2]), bits_of(sum[3])};
}

}  // namespace vitrine::texel

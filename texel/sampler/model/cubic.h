// Cubic filtering of one lane (this device alone: Vulkan 1.3.239, Texel Filtering, VK_FILTER_CUBIC_EXT): sixteen texels
// with the weights of Catmull and Rom.
#pragma once

#include <algorithm>
#include <cmath>

#include "texel/sampler/model/level.h"

namespace vitrine::texel {

/// Four neighbours of one axis with their weights. Border coordinates may lie outside.
struct CubicTaps {
  std::int32_t at[4] = {};
  float weight[4] = {};
};

/// No coordinate is farther from the level, in texels: behind them there is nothing new, and integers hold them.
inline constexpr float kFarthestTexel = 1e6f;

/// i modulo n, from 0 to n - 1; |i| at most 2 * kFarthestTexel.
inline std::int32_t positive_modulo(std::int32_t i, std::int32_t n) {
  const auto quotient = static_cast<std::int32_t>(std::floor(static_cast<float>(i) / static_cast<float>(n)));
  std::int32_t rest = i - quotient * n;
  if (rest < 0) rest += n;  // the quotient has been rounded
  if (rest >= n) rest -= n;
  return rest;
}

/// Vulkan 1.3.239, Wrapping Operation, of an integer texel coordinate. Outside of the level only at a border.
inline std::int32_t wrapped_texel(Address address, std::int32_t i, std::int32_t size) {
  const std::int32_t last = size - 1;
  switch (address) {
    case Address::kRepeat:
      return positive_modulo(i, size);
    case Address::kMirror: {
      const std::int32_t folded = positive_modulo(i, 2 * size);
      return std::min(folded, 2 * size - 1 - folded);
    }
    case Address::kMirrorClamp:
      return std::min(i < 0 ? ~i : i, last);
    case Address::kClamp:
      return std::clamp(i, 0, last);
    case Address::kBorder:
      return i;
  }
  return 0;
}

/// The weights of the texels -1, 0, 1, 2 for a point that lies `a` behind texel 0.
inline void cubic_weights(float a, float weight[4]) {
  const float square = a * a;
  weight[0] = a * (a * (1.0f - 0.5f * a) - 0.5f);
  weight[1] = square * (1.5f * a - 2.5f) + 1.0f;
  weight[2] = a * (a * (2.0f - 1.5f * a) + 0.5f);
  weight[3] = square * (0.5f * a - 0.5f);
}

/// A coordinate without whole turns of the texture, so that its fraction keeps its bits.
inline float without_turns(const Axis& axis, float s) {
  if (axis.normalized && axis.address == Address::kRepeat) return s - std::floor(s);
  if (axis.normalized && axis.address == Address::kMirror) return s - 2.0f * std::floor(s * 0.5f);
  return s;
}

inline CubicTaps cubic_texels(const Axis& axis, float s) {
  float c = plus_offset(axis, scaled(axis, without_turns(axis, s))) - 0.5f;
  c = base::max_second(base::min_second(c, kFarthestTexel), -kFarthestTexel);
  const float floor = std::floor(c);
  const auto i = static_cast<std::int32_t>(floor);
  CubicTaps taps;
  for (std::int32_t k = 0; k < 4; ++k) taps.at[k] = wrapped_texel(axis.address, i - 1 + k, axis.size);
  cubic_weights(c - floor, taps.weight);
  return taps;
}

/// One level of a flat image: rows along x first, then what they give along y. The reduction modes MIN and MAX choose
/// among the texels whose weights are not 0.
Texel sample_cubic(const LaneSample& lane, std::uint32_t level);

}  // namespace vitrine::texel

// Lookups of one lane on one level, as values: nearest and linear, on cubes too, with comparison and border. What
// scalar.cpp and the anisotropic filter are made of.
#pragma once

#include <array>
#include <cstdint>

#include "texel/sampler/model/address.h"
#include "texel/sampler/plan.h"

namespace vitrine::texel {

struct LaneSample {
  const Plan* plan = nullptr;
  std::array<float, 3> coord{};
  std::array<std::int32_t, 3> offset{};
  bool has_offset = false;
  std::uint32_t face = 0;
  std::uint32_t layer = 0;  ///< of the view; the first face for cubes
  bool compare = false;
  float reference = 0;
};

/// The texel at (x, y, z), the border colour outside; with a comparison its result as 0 or 1 in component 0.
Texel texel_or_border(const LaneSample& lane, std::uint32_t level, std::uint32_t layer, std::int32_t x, std::int32_t y,
                      std::int32_t z);

/// How coordinate i meets the level's texels.
Axis make_axis(const LaneSample& lane, std::uint32_t level, std::uint32_t i);

/// Taps of all axes; unused axes stay at 0.
void find_taps(const LaneSample& lane, std::uint32_t level, Taps taps[3]);

/// Moves `a` towards `b` as the sampler's reduction mode says.
void reduce_texel(const LaneSample& lane, float weight, Texel& a, const Texel& b);

/// One level, filtered as values.
Texel sample_level(const LaneSample& lane, std::uint32_t level, bool linear);

}  // namespace vitrine::texel

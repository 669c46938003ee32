// What the scalar sampler knows about one lane, and the texels it reads.
#pragma once

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

/// The array layer of the view that a lane's last coordinate names; the first face for cubes.
std::uint32_t select_layer(const Plan& plan, const SampleRequest& request, std::size_t lane);

/// One level, filtered as values.
Texel sample_level(const LaneSample& lane, std::uint32_t level, bool linear);

}  // namespace vitrine::texel

// Which texels a lookup through a sampler certainly depends on (Vulkan 1.3.239, Texel Filtering).
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "base/function_ref.h"
#include "texel/sampler.h"

namespace vitrine::glass::sanitize {

/// A lookup of one lane.
struct Lookup {
  std::array<float, 3> at{};  ///< as given to the instruction, without the array layer
  float layer = 0;
  std::array<std::int32_t, 3> offset{};
  bool gather = false;
  std::optional<float> lod;  ///< explicit level of detail; none: from derivatives, any level
};

/// Calls f(address of a block) for texels around the lookup, all that it can read and a few more, from the nearest on
/// until f says false. True: f was true for all. False also where it is not known what the lookup reads: anisotropic
/// filters, borders, edges of cubes, conversions.
bool all_of_footprint(const texel::ImageView& view, const texel::Sampler& sampler, const Lookup& lookup,
                      base::FunctionRef<bool(const std::byte*)> f);

}  // namespace vitrine::glass::sanitize

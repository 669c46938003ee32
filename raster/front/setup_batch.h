// Setup of filled triangles in batches, those of a few pixels a vector at a time.
#pragma once

#include <cstdint>

#include "raster/front/setup.h"

namespace vitrine::raster {

/// Filled triangles of one chunk waiting to be set up together.
struct TriangleBatch {
  static constexpr std::uint32_t kSize = 16;
  std::uint32_t count = 0;
  alignas(64) std::int32_t x[3][kSize], y[3][kSize];  ///< snapped, by corner
  const Vertex* record[3][kSize];
  std::uint32_t id[kSize];
};

/// setup_triangle() of all of them in their order, those of a few pixels a vector at a time; empties the batch. Only
/// for plans with windows. context.id is not looked at.
void setup_triangles(SetupContext context, TriangleBatch& batch);

}  // namespace vitrine::raster

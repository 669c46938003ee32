// Vertex fetch (Vulkan 1.3.239, Vertex Input Address Calculation): attributes of one wave of vertices, decoded into
// registers. Out of bounds reads give 0 in the channels of the format (lavapipe-rasterization.md 10.3).
#pragma once

#include <cstdint>

#include "base/lanes.h"
#include "raster/primitive.h"

namespace vitrine::raster {

/// Vertices of one wave: what gl_VertexIndex and gl_InstanceIndex are, per lane.
struct VertexLanes {
  std::uint32_t count = 0;
  std::uint32_t vertex[base::kWaveWidth];    ///< index into per-vertex bindings (vertex offset applied)
  std::uint32_t instance[base::kWaveWidth];  ///< without first_instance
};

/// Fills the input registers of the bound vertex stage.
void fetch_vertices(const DrawRecord& draw, const VertexLanes& lanes, std::uint32_t view, StageRunner& runner);

}  // namespace vitrine::raster

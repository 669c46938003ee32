// Primitive assembly (Vulkan 1.3.239, Primitive Topologies): which positions of a run form its primitives, in which
// order (lavapipe-rasterization.md 10.1). Does not know vertices.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <vector>

#include "raster/primitive.h"

namespace vitrine::raster {

/// Corners of primitive `i` of a strip, list or fan, as positions from its start; `corners` of TopologyShape are set.
/// The provoking corner is the first, or the last of them, as `last` says.
struct Corners {
  std::uint32_t at[3];
};
Corners corners_of(VkPrimitiveTopology topology, bool last, std::uint32_t i);

/// All positions of primitive `i`, adjacent ones too, in the order a geometry shader sees them. `last_of_strip`: no
/// primitive follows in the strip.
struct InputVertices {
  std::uint32_t count;
  std::uint32_t at[6];
};
InputVertices input_vertices(VkPrimitiveTopology topology, bool last, std::uint32_t i, bool last_of_strip);

/// Positions a run needs: [0] for fans, then [low, high).
struct RunSpan {
  std::uint32_t low, high;
  bool center;
  std::uint32_t count() const { return high - low + (center ? 1 : 0); }
  /// Index of position p among those.
  std::uint32_t entry(std::uint32_t p) const { return center ? (p == 0 ? 0 : p - low + 1) : p - low; }
};
RunSpan run_span(const TopologyShape& shape, const Run& run);

/// Cuts one instance of a draw at restart indices and into stretches of at most `limit` positions, and appends them.
void append_runs(const DrawCall& draw, std::uint32_t instance, std::uint32_t limit, std::vector<Run>& runs);

/// Index `position` of the bound index buffer; 0 beyond its end.
std::uint32_t read_index(const DrawCall& draw, std::uint64_t position);

}  // namespace vitrine::raster

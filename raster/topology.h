// Primitive topologies (Vulkan 1.3.239, Primitive Topologies): the one table of what is known of each. How many
// positions (vertices, or indices) its primitives take, which of them are the corners, in which order, and which one is
// the provoking vertex (lavapipe-rasterization.md 10.1). Where a further primitive takes `step` more positions, a new
// topology is a row; others also concern all that counts in steps: assembly.cpp, chunk.cpp, plan/stages.cpp.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <span>

namespace vitrine::raster {

struct DrawCall;

/// How positions form primitives. Those are points, lines or triangles, as they are drawn, numbered (gl_PrimitiveID)
/// and counted by statistics; or patches.
struct TopologyShape {
  std::uint32_t first = 1;    ///< positions the first primitive needs
  std::uint32_t step = 1;     ///< positions each further primitive adds
  std::uint32_t corners = 1;  ///< the topology's class: 1 to 3, or a patch's control points; 0: nothing can be drawn
  bool fan = false;           ///< all primitives share position 0
  bool neighbours = false;    ///< primitives also need a position in front of and behind their own
};

/// Corner of a fan's primitives that is position 0, wherever the primitive starts.
inline constexpr std::uint8_t kFanCenter = 0xff;

/// Corners of a primitive, as positions from where it starts: at `step` times its number.
using CornerOrder = std::uint8_t[3];

/// A row of the table.
struct Topology {
  VkPrimitiveTopology name;
  TopologyShape shape;
  std::uint32_t inputs;             ///< vertices a geometry shader sees of a primitive, adjacent ones too
  CornerOrder even;                 ///< primitives 0, 2, 4, ..., provoking vertex first
  CornerOrder odd;                  ///< primitives 1, 3, 5, ...: strips of triangles turn every other one around
  CornerOrder even_last, odd_last;  ///< the same where the provoking vertex is the last one
};

/// All rows: every topology but the list of patches, whose shape is the state's.
std::span<const Topology> topologies();

/// The row of a topology, or of a list of points for those the table lacks.
const Topology& topology_of(VkPrimitiveTopology topology);

/// Whether the corners of its primitives are all positions, one after the other: lists without adjacent vertices.
bool is_list_in_order(VkPrimitiveTopology topology);

/// The shape of what a draw assembles: the table's, but for the control points of patches and for adjacent vertices
/// that only geometry shaders see. Patches without tessellation stages have no corners.
TopologyShape topology_shape(const DrawCall& draw);

/// Which corner of a primitive gives its flat values.
constexpr std::uint32_t provoking_corner(std::uint32_t corners, bool last) { return last ? corners - 1 : 0; }

/// Corners of primitive `i` of a strip, list or fan, as positions from its start; as many as TopologyShape::corners are
/// set. The provoking corner is the first, or the last of them, as `last` says.
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

}  // namespace vitrine::raster

// The table of topologies.
#include "raster/topology.h"

#include <algorithm>
#include <iterator>

#include "raster/draw.h"

namespace vitrine::raster {
namespace {

constexpr std::uint8_t kC = kFanCenter;

// name, {first, step, corners, fan}, inputs; corners of even and odd primitives, provoking vertex first; then last
constexpr Topology kTopologies[] = {
    {VK_PRIMITIVE_TOPOLOGY_POINT_LIST, {1, 1, 1}, 1, {0}, {0}, {0}, {0}},
    {VK_PRIMITIVE_TOPOLOGY_LINE_LIST, {2, 2, 2}, 2, {0, 1}, {0, 1}, {0, 1}, {0, 1}},
    {VK_PRIMITIVE_TOPOLOGY_LINE_STRIP, {2, 1, 2}, 2, {0, 1}, {0, 1}, {0, 1}, {0, 1}},
    {VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, {3, 3, 3}, 3, {0, 1, 2}, {0, 1, 2}, {0, 1, 2}, {0, 1, 2}},
    {VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, {3, 1, 3}, 3, {0, 1, 2}, {0, 2, 1}, {0, 1, 2}, {1, 0, 2}},
    {VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN, {3, 1, 3, true}, 3, {1, 2, kC}, {1, 2, kC}, {kC, 1, 2}, {kC, 1, 2}},
    {VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY, {4, 4, 2}, 4, {1, 2}, {1, 2}, {1, 2}, {1, 2}},
    {VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY, {4, 1, 2}, 4, {1, 2}, {1, 2}, {1, 2}, {1, 2}},
    {VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY, {6, 6, 3}, 6, {0, 2, 4}, {0, 2, 4}, {0, 2, 4}, {0, 2, 4}},
    {VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP_WITH_ADJACENCY, {6, 2, 3}, 6, {0, 2, 4}, {0, 4, 2}, {0, 2, 4}, {2, 0, 4}},
};

constexpr bool is_indexed_by_name() {
  for (std::size_t i = 0; i < std::size(kTopologies); ++i)
    if (kTopologies[i].name != static_cast<VkPrimitiveTopology>(i)) return false;
  return true;
}
static_assert(is_indexed_by_name());

/// Triangle strips with adjacency are irregular at both ends (Vulkan 1.3.239, Triangle Strips With Adjacency).
InputVertices strip_with_adjacency(bool last, std::uint32_t i, bool last_of_strip) {
  const std::uint32_t a = 2 * i, b = a + 2, c = a + 4;
  const std::uint32_t ab = i == 0 ? 1 : a - 2, bc = last_of_strip ? a + 5 : a + 6, ca = a + 3;
  if ((i & 1) == 0) return {6, {a, ab, b, bc, c, ca}};
  if (last) return {6, {b, ab, a, ca, c, bc}};
  return {6, {a, ca, c, bc, b, ab}};
}

}  // namespace

std::span<const Topology> topologies() { return kTopologies; }

const Topology& topology_of(VkPrimitiveTopology topology) {
  const auto index = static_cast<std::size_t>(topology);
  return kTopologies[index < std::size(kTopologies) ? index : 0];
}

bool is_list_in_order(VkPrimitiveTopology name) {
  return name == VK_PRIMITIVE_TOPOLOGY_POINT_LIST || name == VK_PRIMITIVE_TOPOLOGY_LINE_LIST ||
         name == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
}

TopologyShape topology_shape(const DrawCall& draw) {
  if (draw.state->topology == VK_PRIMITIVE_TOPOLOGY_PATCH_LIST) {
    const std::uint32_t points = draw.evaluation ? std::min(draw.state->patch_control_points, kMaxPatchVertices) : 0;
    return {std::max(points, 1u), std::max(points, 1u), points};
  }
  const Topology& topology = topology_of(draw.state->topology);
  if (topology.name != draw.state->topology) return {1, 1, 0};
  TopologyShape shape = topology.shape;
  shape.neighbours = topology.name == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP_WITH_ADJACENCY && draw.geometry != nullptr;
  return shape;
}

Corners corners_of(VkPrimitiveTopology name, bool last, std::uint32_t i) {
  const Topology& topology = topology_of(name);
  const bool odd = (i & 1) != 0;
  const CornerOrder& order = last ? (odd ? topology.odd_last : topology.even_last) : odd ? topology.odd : topology.even;
  const std::uint32_t start = i * topology.shape.step;
  Corners corners{};
  for (std::uint32_t c = 0; c < topology.shape.corners; ++c)
    corners.at[c] = order[c] == kFanCenter ? 0 : start + order[c];
  return corners;
}

InputVertices input_vertices(VkPrimitiveTopology name, bool last, std::uint32_t i, bool last_of_strip) {
  if (name == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP_WITH_ADJACENCY) return strip_with_adjacency(last, i, last_of_strip);
  const Topology& topology = topology_of(name);
  InputVertices vertices{topology.inputs, {}};
  if (topology.inputs == topology.shape.corners) {
    const Corners corners = corners_of(name, last, i);
    std::copy_n(corners.at, topology.inputs, vertices.at);
  } else {
    for (std::uint32_t v = 0; v < topology.inputs; ++v) vertices.at[v] = i * topology.shape.step + v;
  }
  return vertices;
}

}  // namespace vitrine::raster

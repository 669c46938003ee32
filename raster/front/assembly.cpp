// Primitive assembly: decomposition tables, primitive restart, cutting into runs.
#include "raster/front/assembly.h"

#include <algorithm>
#include <cstring>

namespace vitrine::raster {
namespace {

std::uint32_t index_size(VkIndexType type) {
  return type == VK_INDEX_TYPE_UINT32 ? 4 : type == VK_INDEX_TYPE_UINT16 ? 2 : 1;
}

std::uint32_t restart_value(VkIndexType type) {
  return type == VK_INDEX_TYPE_UINT32 ? 0xffffffffu : type == VK_INDEX_TYPE_UINT16 ? 0xffffu : 0xffu;
}

std::uint32_t primitives_in(const TopologyShape& shape, std::uint32_t positions) {
  return shape.corners == 0 || positions < shape.first ? 0 : (positions - shape.first) / shape.step + 1;
}

/// One strip of `positions` positions. Pieces hold an even number of primitives, so that strips keep their parity.
std::uint32_t append_strip(const TopologyShape& shape, const Run& strip, std::uint32_t positions, std::uint32_t limit,
                           std::vector<Run>& runs) {
  const std::uint32_t total = primitives_in(shape, positions);
  const std::uint32_t piece = std::max<std::uint32_t>(limit / shape.step & ~1u, 2);
  for (std::uint32_t begin = 0; begin < total; begin += piece) {
    Run run = strip;
    run.begin = begin;
    run.end = std::min(total, begin + piece);
    run.ends = run.end == total;
    runs.push_back(run);
  }
  return total;
}

}  // namespace

std::uint32_t read_index(const DrawCall& draw, std::uint64_t position) {
  const std::uint32_t size = index_size(draw.index_type);
  const std::uint64_t at = position * size;
  if (at + size > draw.index_bytes) return 0;
  std::uint32_t value = 0;
  std::memcpy(&value, draw.index_data + at, size);
  return value;
}

Corners corners_of(VkPrimitiveTopology topology, bool last, std::uint32_t i) {
  const bool odd = (i & 1) != 0;
  switch (topology) {
    case VK_PRIMITIVE_TOPOLOGY_POINT_LIST:
      return {{i, 0, 0}};
    case VK_PRIMITIVE_TOPOLOGY_LINE_LIST:
      return {{2 * i, 2 * i + 1, 0}};
    case VK_PRIMITIVE_TOPOLOGY_LINE_STRIP:
      return {{i, i + 1, 0}};
    case VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY:
      return {{4 * i + 1, 4 * i + 2, 0}};
    case VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY:
      return {{i + 1, i + 2, 0}};
    case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST:
      return {{3 * i, 3 * i + 1, 3 * i + 2}};
    case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP:
      if (!odd) return {{i, i + 1, i + 2}};
      if (last) return {{i + 1, i, i + 2}};
      return {{i, i + 2, i + 1}};
    case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN:
      if (last) return {{0, i + 1, i + 2}};
      return {{i + 1, i + 2, 0}};
    case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY:
      return {{6 * i, 6 * i + 2, 6 * i + 4}};
    case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP_WITH_ADJACENCY:
      if (!odd) return {{2 * i, 2 * i + 2, 2 * i + 4}};
      if (last) return {{2 * i + 2, 2 * i, 2 * i + 4}};
      return {{2 * i, 2 * i + 4, 2 * i + 2}};
    default:
      return {{0, 0, 0}};
  }
}

InputVertices input_vertices(VkPrimitiveTopology topology, bool last, std::uint32_t i, bool last_of_strip) {
  switch (topology) {
    case VK_PRIMITIVE_TOPOLOGY_LINE_LIST_WITH_ADJACENCY:
      return {4, {4 * i, 4 * i + 1, 4 * i + 2, 4 * i + 3, 0, 0}};
    case VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY:
      return {4, {i, i + 1, i + 2, i + 3, 0, 0}};
    case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY:
      return {6, {6 * i, 6 * i + 1, 6 * i + 2, 6 * i + 3, 6 * i + 4, 6 * i + 5}};
    case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP_WITH_ADJACENCY: {
      const std::uint32_t a = 2 * i, b = a + 2, c = a + 4;
      const std::uint32_t ab = i == 0 ? 1 : a - 2, bc = last_of_strip ? a + 5 : a + 6, ca = a + 3;
      if ((i & 1) == 0) return {6, {a, ab, b, bc, c, ca}};
      if (last) return {6, {b, ab, a, ca, c, bc}};
      return {6, {a, ca, c, bc, b, ab}};
    }
    default: {
      const Corners corners = corners_of(topology, last, i);
      const bool point = topology == VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
      const bool line = topology == VK_PRIMITIVE_TOPOLOGY_LINE_LIST || topology == VK_PRIMITIVE_TOPOLOGY_LINE_STRIP;
      return {point ? 1u : line ? 2u : 3u, {corners.at[0], corners.at[1], corners.at[2], 0, 0, 0}};
    }
  }
}

RunSpan run_span(const TopologyShape& shape, const Run& run) {
  if (shape.neighbours)
    return {run.begin == 0 ? 0 : run.begin * shape.step - 2,
            (run.end - 1) * shape.step + shape.first + (run.ends ? 0 : 1), false};
  if (shape.fan) return {run.begin + 1, run.end + 2, true};
  return {run.begin * shape.step, (run.end - 1) * shape.step + shape.first, false};
}

void append_runs(const DrawCall& draw, std::uint32_t instance, std::uint32_t limit, std::vector<Run>& runs) {
  const TopologyShape shape = topology_shape(draw);
  Run strip{0, 0, 0, instance, 0, true};
  if (!draw.index_data || !draw.state->primitive_restart) {
    append_strip(shape, strip, draw.count, limit, runs);
    return;
  }
  const std::uint32_t restart = restart_value(draw.index_type);
  std::uint32_t start = 0;
  for (std::uint32_t i = 0; i <= draw.count; ++i) {
    if (i < draw.count && read_index(draw, std::uint64_t{draw.first} + i) != restart) continue;
    strip.start = start;
    strip.first_id += append_strip(shape, strip, i - start, limit, runs);
    start = i + 1;
  }
}

}  // namespace vitrine::raster

// Decomposition of topologies, primitive restart and the cutting into runs (lavapipe-rasterization.md 10.1).
#include "raster/front/assembly.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <map>

namespace vitrine::raster {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// Corners as stream positions of every primitive of a draw, through runs of at most `limit` positions.
std::vector<Triangle> decompose(const DrawCall& draw, std::uint32_t limit) {
  std::vector<raster::Run> runs;
  RunCutter cutter(draw, topology_shape(draw), 0, piece_of(topology_shape(draw), limit), false);
  for (raster::Run run; cutter.next(run);) runs.push_back(run);
  const TopologyShape shape = topology_shape(draw);
  std::vector<Triangle> result;
  for (const Run& run : runs) {
    const RunSpan span = run_span(shape, run);
    for (std::uint32_t i = run.begin; i < run.end; ++i) {
      const Corners corners = corners_of(draw.state->topology, draw.state->provoking_vertex_last, i);
      Triangle at{};
      for (std::uint32_t c = 0; c < shape.corners; ++c) {
        EXPECT_LT(span.entry(corners.at[c]), span.count());
        at[c] = run.start + corners.at[c];
      }
      EXPECT_EQ(run.first_id + i, result.size());
      result.push_back(at);
    }
  }
  return result;
}

TEST(Assembly, StripsAlternateAndKeepTheProvokingCorner) {
  State state;
  state.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
  DrawCall draw;
  draw.state = &state;
  draw.count = 6;
  EXPECT_EQ((std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 5, 4}}), decompose(draw, 1000));
  state.provoking_vertex_last = true;
  EXPECT_EQ((std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {4, 3, 5}}), decompose(draw, 1000));
}

TEST(Assembly, FansKeepTheirCentre) {
  State state;
  state.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN;
  DrawCall draw;
  draw.state = &state;
  draw.count = 5;
  EXPECT_EQ((std::vector<Triangle>{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}}), decompose(draw, 1000));
  state.provoking_vertex_last = true;
  EXPECT_EQ((std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}), decompose(draw, 1000));
}

TEST(Assembly, CuttingIntoRunsChangesNothing) {
  State state;
  DrawCall draw;
  draw.state = &state;
  draw.count = 103;
  for (const Topology& topology : topologies()) {
    state.topology = topology.name;
    for (const bool last : {false, true}) {
      state.provoking_vertex_last = last;
      EXPECT_EQ(decompose(draw, 100000), decompose(draw, 8)) << topology.name;
    }
  }
}

/// Positions of every primitive as a geometry shader sees them, through runs of at most `limit` positions.
std::vector<std::array<std::uint32_t, 6>> input_positions(const DrawCall& draw, std::uint32_t limit) {
  std::vector<raster::Run> runs;
  RunCutter cutter(draw, topology_shape(draw), 0, piece_of(topology_shape(draw), limit), false);
  for (raster::Run run; cutter.next(run);) runs.push_back(run);
  TopologyShape shape = topology_shape(draw);
  shape.neighbours = draw.state->topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP_WITH_ADJACENCY;
  std::vector<std::array<std::uint32_t, 6>> result;
  for (const Run& run : runs) {
    const RunSpan span = run_span(shape, run);
    for (std::uint32_t i = run.begin; i < run.end; ++i) {
      const InputVertices vertices =
          input_vertices(draw.state->topology, draw.state->provoking_vertex_last, i, run.ends && i + 1 == run.end);
      std::array<std::uint32_t, 6>& at = result.emplace_back();
      for (std::uint32_t v = 0; v < vertices.count; ++v) {
        EXPECT_LT(span.entry(vertices.at[v]), span.count());
        at[v] = run.start + vertices.at[v];
      }
    }
  }
  return result;
}

TEST(Assembly, AdjacentStripsAlternate) {
  State state;
  state.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP_WITH_ADJACENCY;
  DrawCall draw;
  draw.state = &state;
  draw.count = 10;
  using Six = std::array<std::uint32_t, 6>;
  EXPECT_EQ((std::vector<Six>{{0, 1, 2, 6, 4, 3}, {2, 5, 6, 8, 4, 0}, {4, 2, 6, 9, 8, 7}}),
            input_positions(draw, 1000));
  state.provoking_vertex_last = true;
  EXPECT_EQ((std::vector<Six>{{0, 1, 2, 6, 4, 3}, {4, 0, 2, 5, 6, 8}, {4, 2, 6, 9, 8, 7}}),
            input_positions(draw, 1000));
}

TEST(Assembly, CuttingIntoRunsKeepsAdjacentVertices) {
  State state;
  DrawCall draw;
  draw.state = &state;
  draw.count = 103;
  for (const Topology& topology : topologies()) {
    state.topology = topology.name;
    EXPECT_EQ(input_positions(draw, 100000), input_positions(draw, 8)) << topology.name;
  }
}

TEST(Assembly, RestartSplitsStripsAndDropsIncompleteOnes) {
  State state;
  state.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
  state.primitive_restart = true;
  const std::array<std::uint16_t, 9> indices = {7, 8, 9, 0xffff, 1, 2, 0xffff, 3, 4};
  DrawCall draw;
  draw.state = &state;
  draw.index_data = reinterpret_cast<const std::byte*>(indices.data());
  draw.index_bytes = sizeof(indices);
  draw.count = 12;  // three positions beyond the buffer read index 0
  EXPECT_EQ((std::vector<Triangle>{{0, 1, 2}, {7, 8, 9}, {8, 10, 9}, {9, 10, 11}}), decompose(draw, 1000));
  EXPECT_EQ(0u, read_index(draw, 9));
}

// deviations.md, patch-numbers: the reference counts gl_PrimitiveID anew in what it works on at a time.
TEST(Assembly, NumbersPiecesAnewWhereAskedTo) {
  State state;
  state.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  DrawCall draw;
  draw.state = &state;
  draw.count = 3 * 10;
  for (const bool anew : {false, true}) {
    std::vector<raster::Run> runs;
    RunCutter cutter(draw, topology_shape(draw), 0, 4, anew);
    for (raster::Run run; cutter.next(run);) runs.push_back(run);
    ASSERT_EQ(runs.size(), 3u);
    for (const raster::Run& run : runs) EXPECT_EQ(run.first_id + run.begin, anew ? 0 : run.begin);
  }
}

}  // namespace
}  // namespace vitrine::raster

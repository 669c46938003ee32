// Every row of the table of topologies.
#include "raster/topology.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "raster/draw.h"

namespace vitrine::raster {
namespace {

/// Corners are positions of the primitive, the provoking one stays the first or the last when a primitive is turned
/// around, and a turned primitive has the corners it would have anyway.
TEST(Topology, CornersBelongToTheirPrimitive) {
  for (const Topology& topology : topologies()) {
    const VkPrimitiveTopology name = topology.name;
    const TopologyShape& shape = topology.shape;
    ASSERT_EQ(&topology_of(name), &topology);
    for (const bool last : {false, true})
      for (std::uint32_t i = 0; i < 4; ++i) {
        const Corners corners = corners_of(name, last, i);
        for (std::uint32_t c = 0; c < shape.corners; ++c) {
          EXPECT_LT(corners.at[c], i * shape.step + shape.first) << name;
          EXPECT_TRUE(shape.fan || corners.at[c] >= i * shape.step) << name;
        }
        if (shape.corners != 3) continue;
        Corners other = corners_of(name, !last, i);
        Corners sorted = corners;
        std::sort(sorted.at, sorted.at + 3);
        std::sort(other.at, other.at + 3);
        EXPECT_TRUE(std::equal(sorted.at, sorted.at + 3, other.at)) << name;
        const std::uint32_t provoking = corners.at[provoking_corner(3, last)];
        EXPECT_EQ(provoking, shape.fan ? i + (last ? 2 : 1) : last ? sorted.at[2] : sorted.at[0]) << name;
      }
  }
}

TEST(Topology, GeometryShadersSeeTheCornersAmongTheirVertices) {
  for (const Topology& topology : topologies())
    for (std::uint32_t i = 0; i < 3; ++i) {
      const InputVertices vertices = input_vertices(topology.name, false, i, true);
      const Corners corners = corners_of(topology.name, false, i);
      EXPECT_EQ(vertices.count, topology.inputs) << topology.name;
      for (std::uint32_t c = 0; c < topology.shape.corners; ++c)
        EXPECT_NE(std::find(vertices.at, vertices.at + vertices.count, corners.at[c]), vertices.at + vertices.count)
            << topology.name;
    }
}

}  // namespace
}  // namespace vitrine::raster

// Coverage by tiles and blocks against the edge functions of lavapipe-rasterization.md 3.2 in 64 bits, sample by
// sample.
#include "raster/tile/coverage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "base/simd.h"

namespace vitrine::raster {
namespace {

/// Coverage of the block whose first pixel is (x, y), relative to the tile.
base::LaneMask cover_block(const TileEdges& edges, std::uint32_t sample, int x, int y) {
  base::LaneMask lanes[64];
  std::uint32_t place = 0;
  while (lane_x(place) * kBlockSize != x || lane_y(place) * kBlockSize != y) ++place;
  cover_blocks(edges, sample, base::LaneMask{1} << place, lanes);
  return lanes[place];
}

bool inside(const Primitive& p, std::int64_t qx, std::int64_t qy) {
  for (int e = 0; e < 3; ++e) {
    const int n = (e + 1) % 3;
    const std::int64_t a = p.y[e] - p.y[n], b = p.x[e] - p.x[n];
    const std::int64_t rule = a < 0 || (a == 0 && b > 0) ? 1 : 0;
    if (a * (p.x[e] - qx) - b * (p.y[e] - qy) + rule <= 0) return false;
  }
  return true;
}

/// Corners around the tile, from fractions of a pixel to thousands of pixels away, on and off pixel centres.
Primitive random_triangle(std::mt19937& random) {
  Primitive p{};
  p.kind = PrimitiveKind::kTriangle;
  const int reach = 1 << (6 + random() % 15);
  const int step = random() % 3 == 0 ? 256 : random() % 2 ? 64 : 1;
  for (int i = 0; i < 3; ++i) {
    p.x[i] = (static_cast<int>(random() % (64 * 256)) + static_cast<int>(random() % (2 * reach)) - reach) / step * step;
    p.y[i] = (static_cast<int>(random() % (64 * 256)) + static_cast<int>(random() % (2 * reach)) - reach) / step * step;
  }
  const std::int64_t area =
      std::int64_t{p.x[0] - p.x[1]} * (p.y[2] - p.y[0]) - std::int64_t{p.x[2] - p.x[0]} * (p.y[0] - p.y[1]);
  if (area < 0) {
    std::swap(p.x[1], p.x[2]);
    std::swap(p.y[1], p.y[2]);
  }
  return p;
}

void compare_tile(const Primitive& p, int tile_x, int tile_y, std::uint32_t samples) {
  const SampleLocations& locations = standard_locations(samples);
  TileEdges edges;
  const bool touched = make_tile_edges(p, tile_x, tile_y, locations, edges);
  base::LaneMask any = 0, all = 0;
  if (touched) classify_blocks(edges, samples, any, all);
  for (std::uint32_t place = 0; place < 64; ++place) {
    const int bx = lane_x(place) * kBlockSize, by = lane_y(place) * kBlockSize;
    for (std::uint32_t s = 0; s < samples; ++s) {
      base::LaneMask expected = 0;
      for (std::uint32_t lane = 0; lane < 64; ++lane) {
        const std::int64_t px = tile_x + bx + lane_x(lane), py = tile_y + by + lane_y(lane);
        const std::int64_t sx = locations.x[s], sy = locations.y[s];
        if (inside(p, px * 256 + sx, py * 256 + sy)) expected |= base::LaneMask{1} << lane;
      }
      ASSERT_EQ(expected, touched ? cover_block(edges, s, bx, by) : 0)
          << "block " << bx << "," << by << " sample " << s;
      ASSERT_TRUE(expected == 0 || (any >> place & 1) != 0);
      ASSERT_TRUE(expected == base::kAllLanes || !touched || (all >> place & 1) == 0);
    }
  }
}

TEST(Coverage, EqualsEdgeFunctionsOfAllSizes) {
  base::select_simd_target();
  std::mt19937 random(7);
  for (int i = 0; i < 300; ++i) {
    const Primitive p = random_triangle(random);
    compare_tile(p, 0, 0, 1);
    compare_tile(p, 64, 128, 1);
    for (const std::uint32_t samples : {2u, 4u, 8u}) compare_tile(p, 0, 0, samples);
    if (HasFatalFailure()) return;
  }
}

TEST(Coverage, SharedEdgeIsCoveredOnce) {
  base::select_simd_target();
  std::mt19937 random(11);
  for (int i = 0; i < 200; ++i) {
    const Primitive p = random_triangle(random);
    Primitive q = p;  // the parallelogram's other half: shares the edge 1-2
    q.x[0] = p.x[1] + p.x[2] - p.x[0];
    q.y[0] = p.y[1] + p.y[2] - p.y[0];
    std::swap(q.x[1], q.x[2]);
    std::swap(q.y[1], q.y[2]);
    TileEdges a, b;
    if (!make_tile_edges(p, 0, 0, kSingleSample, a) || !make_tile_edges(q, 0, 0, kSingleSample, b)) continue;
    for (int y = 0; y < 64; y += 8)
      for (int x = 0; x < 64; x += 8) ASSERT_EQ(0u, cover_block(a, 0, x, y) & cover_block(b, 0, x, y));
  }
}

}  // namespace
}  // namespace vitrine::raster

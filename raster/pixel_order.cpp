// Lanes of a block inside a rectangle, from tables of half planes, and positions of its quads.
#include "raster/pixel_order.h"

#include <algorithm>
#include <array>

namespace vitrine::raster {
namespace {

constexpr std::array<base::LaneMask, 9> lanes_below(bool vertical) {
  std::array<base::LaneMask, 9> table{};
  for (int limit = 0; limit <= 8; ++limit)
    for (std::uint32_t lane = 0; lane < 64; ++lane)
      if ((vertical ? lane_y(lane) : lane_x(lane)) < limit) table[static_cast<std::size_t>(limit)] |= 1ull << lane;
  return table;
}
constexpr auto kLanesLeftOf = lanes_below(false);
constexpr auto kLanesAbove = lanes_below(true);

/// Positions of the quads of a block.
constexpr QuadPositions block_offsets() {
  QuadPositions offsets{};
  for (std::uint32_t q = 0; q < base::kQuadsPerWave; ++q) {
    offsets.x[q] = static_cast<std::uint16_t>(lane_x(4 * q));
    offsets.y[q] = static_cast<std::uint16_t>(lane_y(4 * q));
  }
  return offsets;
}
constexpr QuadPositions kBlockOffsets = block_offsets();

}  // namespace

base::LaneMask rect_lanes(int x0, int y0, int x1, int y1) {
  const auto at = [](int v) { return static_cast<std::size_t>(std::clamp(v, 0, 8)); };
  return kLanesLeftOf[at(x1 + 1)] & ~kLanesLeftOf[at(x0)] & kLanesAbove[at(y1 + 1)] & ~kLanesAbove[at(y0)];
}

void place_block(int x, int y, QuadPositions& out) {
  for (std::uint32_t q = 0; q < base::kQuadsPerWave; ++q) {
    out.x[q] = static_cast<std::uint16_t>(x + kBlockOffsets.x[q]);
    out.y[q] = static_cast<std::uint16_t>(y + kBlockOffsets.y[q]);
  }
}

}  // namespace vitrine::raster

// Coverage of a primitive inside one tile: exact edge functions (lavapipe-rasterization.md 3.2) in 32 bits.
//
// An edge has E = C - a*qx + b*qy with the sample q in 24.8 and is inside where E > 0. Samples are at whole pixels plus
// a constant, so E > 0 is the same as F >= 0 with F = floor((C - 1 - a*sx + b*sy) / 256) - a*px + b*py in whole pixels:
// eight bits less, exact. Edges that have the whole tile inside are dropped, so that F of the others fits 32 bits.
#pragma once

#include <cstdint>

#include "base/lanes.h"
#include "raster/primitive.h"

namespace vitrine::raster {

inline constexpr int kBlockSize = 8;

/// Edges of a primitive relative to the top-left pixel of a tile.
struct TileEdges {
  std::uint32_t count = 0;
  std::int32_t step_x[4];          ///< F one pixel to the right, minus F
  std::int32_t step_y[4];          ///< one pixel down
  std::int32_t f[kMaxSamples][4];  ///< [sample][edge], at the tile's first pixel
};

/// False if the tile is outside.
bool make_tile_edges(const Primitive& primitive, int tile_x, int tile_y, const SampleLocations& samples,
                     TileEdges& edges);

/// Covered pixels of the blocks of `places`: out[i] for the block at quad-ordered place i of the tile. Lanes are the
/// pixels of an 8x8 block in quads: quad q at (2*(q%4), 2*(q/4)), see base::kQuadSize.
void cover_blocks(const TileEdges& edges, std::uint32_t sample, base::LaneMask places, base::LaneMask out[64]);

/// Which of the tile's 64 blocks may be touched (`any`) and are covered completely in all samples (`all`). Bit i is the
/// block at quad-ordered place i.
void classify_blocks(const TileEdges& edges, std::uint32_t samples, base::LaneMask& any, base::LaneMask& all);

/// Covered pixels, in quad order, of the 8x8 window at (x, y) for a single-sampled triangle of positive area whose
/// corners lie within 32 pixels of there. `small`: only its first 4x4 pixels can be covered.
base::LaneMask cover_window(const std::int32_t corner_x[3], const std::int32_t corner_y[3], int x, int y, bool small);

/// Pixels of a window of 16x16: bit 16 * (y % 4) + x of word y / 4.
inline constexpr int kLargeWindow = 16;
struct LargeWindow {
  static constexpr std::size_t kWords = 4;
  std::uint64_t rows[kWords];
};

/// Covers the pixels of `rect` of the window at the first pixel of `edges`, of which there are at most three, those
/// that are not there zero; single-sampled. False if nothing is covered.
bool cover_large_window(const TileEdges& edges, const PixelRect& rect, LargeWindow& out);

/// Place of lane i in a block: x, y in [0, 8).
constexpr int lane_x(std::uint32_t lane) { return static_cast<int>((lane >> 2 & 3) * 2 + (lane & 1)); }
constexpr int lane_y(std::uint32_t lane) { return static_cast<int>((lane >> 4) * 2 + (lane >> 1 & 1)); }

/// Lanes of a block inside columns [x0, x1] and rows [y0, y1], each clamped to the block.
base::LaneMask rect_lanes(int x0, int y0, int x1, int y1);

}  // namespace vitrine::raster

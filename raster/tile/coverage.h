// Coverage of a primitive inside one tile: exact edge functions (lavapipe-rasterization.md 3.2) in 32 bits.
//
// An edge has E = C - a*qx + b*qy with the sample q in 24.8 and is inside where E > 0. Samples are at whole pixels plus
// a constant, so E > 0 is the same as F >= 0 with F = floor((C - 1 - a*sx + b*sy) / 256) - a*px + b*py in whole pixels:
// eight bits less, exact. Edges that have the whole tile inside are dropped, so that F of the others fits 32 bits.
#pragma once

#include <cstdint>

#include "base/lanes.h"
#include "raster/pixel_order.h"
#include "raster/primitive.h"

namespace vitrine::raster {

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

/// The same of every pixel that a triangle touches with more than an edge or a corner: all of its samples are covered
/// where the pixel's square is not wholly outside of an edge. What lies outside of the bounds is not looked at.
bool make_touched_edges(const Primitive& primitive, int tile_x, int tile_y, const SampleLocations& samples,
                        TileEdges& edges);

/// Columns and rows of the blocks with pixels of `rect`, which is in the tile, and their places.
inline PixelRect blocks_of(const PixelRect& rect) {
  return {rect.x0 / kBlockSize, rect.y0 / kBlockSize, rect.x1 / kBlockSize, rect.y1 / kBlockSize};
}
inline base::LaneMask places_of(const PixelRect& rect) {
  const auto [bx0, by0, bx1, by1] = blocks_of(rect);
  return rect_lanes(bx0, by0, bx1, by1);
}

/// Covered pixels of the blocks of `places`: out[i] for the block at quad-ordered place i of the tile. Lanes are in
/// quad order.
void cover_blocks(const TileEdges& edges, std::uint32_t sample, base::LaneMask places, base::LaneMask out[64]);

/// Which of the tile's 64 blocks may be touched (`any`) and are covered completely in all samples (`all`). Bit i is the
/// block at quad-ordered place i.
void classify_blocks(const TileEdges& edges, std::uint32_t samples, base::LaneMask& any, base::LaneMask& all);

/// Pixels of a window of 16x16: bit 16 * (y % 4) + x of word y / 4.
inline constexpr int kLargeWindow = 16;
struct LargeWindow {
  static constexpr std::size_t kWords = 4;
  std::uint64_t rows[kWords];
};

/// Covers the pixels of `rect` of the window at the first pixel of `edges`, of which there are at most three, those
/// that are not there zero; single-sampled. False if nothing is covered.
bool cover_large_window(const TileEdges& edges, const PixelRect& rect, LargeWindow& out);

}  // namespace vitrine::raster

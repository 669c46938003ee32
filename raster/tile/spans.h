// Small triangles beside packed waves: coverage of a window of 16x16 pixels, and waves of one primitive's quads as
// stretches that lie side by side, whose pixels are read and written a row at a time.
#pragma once

#include <cstdint>

#include "base/lanes.h"
#include "raster/tile/block.h"
#include "raster/tile/coverage.h"
#include "raster/tile/interpolate.h"

namespace vitrine::raster {

/// Quads side by side, in the lanes of a wave one after the other.
struct QuadSpan {
  std::uint8_t x, y;   ///< first pixel, in the window
  std::uint8_t first;  ///< quad of the wave
  std::uint8_t count;  ///< quads, at most 8
};

/// A wave of one primitive's quads in a window.
struct SpanWave {
  SpanWave(int window_x, int window_y) : x(window_x), y(window_y) {}

  int x, y;  ///< the window's first pixel
  std::uint32_t quads = 0, count = 0;
  std::uint64_t quad_x = 0, quad_y = 0;  ///< half the place in the window of every quad, four bits each
  std::uint64_t rows = 0;  ///< covered pixels: first the upper two of every quad, from bit 32 on the lower
  QuadSpan span[base::kQuadsPerWave];
};

/// SpanWave::rows to lanes: of the 32 two-bit units the first ones go to the even places.
constexpr base::LaneMask lanes_of_spans(std::uint64_t rows) {
  const auto swap = [&rows](base::LaneMask mask, int distance) {
    const base::LaneMask changed = (rows ^ rows >> distance) & mask;
    rows ^= changed | changed << distance;
  };
  swap(0x00000000ffff0000, 16);
  swap(0x0000ff000000ff00, 8);
  swap(0x00f000f000f000f0, 4);
  swap(0x0c0c0c0c0c0c0c0c, 2);
  return rows;
}

/// And back.
constexpr std::uint64_t rows_of_spans(base::LaneMask lanes) {
  const auto swap = [&lanes](base::LaneMask mask, int distance) {
    const base::LaneMask changed = (lanes ^ lanes >> distance) & mask;
    lanes ^= changed | changed << distance;
  };
  swap(0x0c0c0c0c0c0c0c0c, 2);
  swap(0x00f000f000f000f0, 4);
  swap(0x0000ff000000ff00, 8);
  swap(0x00000000ffff0000, 16);
  return lanes;
}

/// What evaluate_block() gives, at a wave's pixels moved by (center, center). Lanes of no quad are at the window's
/// first pixels.
void evaluate_spans(const PlaneSet& planes, const BlockVarying* varying, std::size_t count, const SpanWave& wave,
                    float center, const float* scale);

/// Depth test as in raster/tile/block.h of the window of 16x16 pixels whose first sample is (x, y): cuts its rows to
/// what passed. False: nothing did.
bool test_large_window_depths(const BlockDepthTest& test, const DepthPlane& plane, float x, float y,
                              const BlockPixels& pixels, LargeWindow& window);

struct TileWorker;

/// A triangle that lies in a window of 16x16 pixels of the worker's tile, covered, tested and shaded. `rect`: its
/// pixels in the tile; `edges`: its edges there. False: it has to go another way.
bool emit_large_window(TileWorker& worker, const Primitive& primitive, TileEdges& edges, const PixelRect& rect);

/// Shades and writes a wave, nothing of which is tested any more, and cuts its rows to what was written
/// (block_shade.cpp).
void shade_spans(TileWorker& worker, const Primitive& primitive, SpanWave& wave);

}  // namespace vitrine::raster

// Which pixel a lane of a wave is. Waves are made of quads, 2x2 pixels in the lanes 4q to 4q + 3; quads lie anywhere
// (QuadPositions), in a block (quad order), in a window at its corner, or side by side in spans. Attachments hold rows
// of pixels, so each of these has its counterpart in row order, and a way there and back.
#pragma once

#include <cstdint>

#include "base/lanes.h"

namespace vitrine::raster {

/// Pixels of a wave: quad q has its top-left pixel at (x[q], y[q]), framebuffer pixels.
struct QuadPositions {
  std::uint16_t x[base::kQuadsPerWave];
  std::uint16_t y[base::kQuadsPerWave];
};

/// A block: 8x8 pixels, as many as a wave has lanes.
inline constexpr int kBlockSize = 8;

/// Quad order: quad q of a block at (2*(q%4), 2*(q/4)). Place of lane i, x and y in [0, 8). The 64 blocks of a tile are
/// numbered the same way.
constexpr int lane_x(std::uint32_t lane) { return static_cast<int>((lane >> 2 & 3) * 2 + (lane & 1)); }
constexpr int lane_y(std::uint32_t lane) { return static_cast<int>((lane >> 4) * 2 + (lane >> 1 & 1)); }

/// Lanes of a block inside columns [x0, x1] and rows [y0, y1], each clamped to the block.
base::LaneMask rect_lanes(int x0, int y0, int x1, int y1);

/// Positions of the quads of the block at (x, y).
void place_block(int x, int y, QuadPositions& out);

/// Delta swap: exchanges the bits of `mask` with those `distance` above them.
template <class Bits>
constexpr Bits delta_swap(Bits bits, Bits mask, int distance) {
  const Bits changed = (bits ^ bits >> distance) & mask;
  return bits ^ (changed | changed << distance);
}

/// Quad order of a block to row order (lane 8*y + x): of each 16 bits, the two-bit units 0 1 2 3 4 5 6 7 (top and
/// bottom of four quads) become 0 2 4 6 1 3 5 7.
constexpr base::LaneMask rows_of_quads(base::LaneMask quads) {
  quads = delta_swap<base::LaneMask>(quads, 0x0c0c0c0c0c0c0c0c, 2);
  return delta_swap<base::LaneMask>(quads, 0x00f000f000f000f0, 4);
}

/// And back.
constexpr base::LaneMask quads_of_rows(base::LaneMask rows) {
  rows = delta_swap<base::LaneMask>(rows, 0x00f000f000f000f0, 4);
  return delta_swap<base::LaneMask>(rows, 0x0c0c0c0c0c0c0c0c, 2);
}

/// A window of 4x4 pixels is the first corner of a block: its lanes there, and its 16 lanes (four quads) without gaps.
inline constexpr base::LaneMask kSmallWindow = 0x00ff00ff;
constexpr std::uint32_t quads_of_small_window(base::LaneMask block) {
  return static_cast<std::uint32_t>((block & 0xff) | (block >> 8 & 0xff00));
}
constexpr base::LaneMask block_of_small_window(base::LaneMask quads) { return (quads & 0xff) | (quads & 0xff00) << 8; }

/// Quad order of those 16 lanes to row order (4*y + x), or back.
constexpr std::uint32_t transpose_window(std::uint32_t lanes) { return delta_swap<std::uint32_t>(lanes, 0x0c0c, 2); }

/// Quads side by side, in the lanes of a wave one after the other.
struct QuadSpan {
  std::uint8_t x, y;   ///< first pixel, in the window
  std::uint8_t first;  ///< quad of the wave
  std::uint8_t count;  ///< quads, at most 8
};

/// A wave of one primitive's quads in a window of 16x16 pixels.
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
  rows = delta_swap<base::LaneMask>(rows, 0x00000000ffff0000, 16);
  rows = delta_swap<base::LaneMask>(rows, 0x0000ff000000ff00, 8);
  rows = delta_swap<base::LaneMask>(rows, 0x00f000f000f000f0, 4);
  return delta_swap<base::LaneMask>(rows, 0x0c0c0c0c0c0c0c0c, 2);
}

/// And back.
constexpr std::uint64_t rows_of_spans(base::LaneMask lanes) {
  lanes = delta_swap<base::LaneMask>(lanes, 0x0c0c0c0c0c0c0c0c, 2);
  lanes = delta_swap<base::LaneMask>(lanes, 0x00f000f000f000f0, 4);
  lanes = delta_swap<base::LaneMask>(lanes, 0x0000ff000000ff00, 8);
  return delta_swap<base::LaneMask>(lanes, 0x00000000ffff0000, 16);
}

}  // namespace vitrine::raster

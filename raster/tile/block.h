// Whole 8x8 blocks of one primitive: the fast path beside packed waves. Attachments are read and written a row of eight
// pixels at a time, and colours that are the same all over a draw are encoded once. Same bits as the general path
// (tests compare them).
//
// Two orders of the 64 lanes of a block: quad order, in which waves are shaded (coverage.h), and row order, in which
// pixels lie in memory: lane 8*y + x.
#pragma once

#include <cstdint>

#include "base/lanes.h"
#include "raster/output/color.h"
#include "raster/output/depth_stencil.h"
#include "raster/tile/interpolate.h"

namespace vitrine::raster {

struct SpanWave;

/// Quad order to row order: of each 16 bits, the two-bit units 0 1 2 3 4 5 6 7 (top and bottom of four quads) become
/// 0 2 4 6 1 3 5 7.
constexpr base::LaneMask rows_of_quads(base::LaneMask quads) {
  const base::LaneMask inner = (quads ^ quads >> 2) & 0x0c0c0c0c0c0c0c0c;
  quads ^= inner | inner << 2;
  const base::LaneMask outer = (quads ^ quads >> 4) & 0x00f000f000f000f0;
  return quads ^ (outer | outer << 4);
}

/// And back.
constexpr base::LaneMask quads_of_rows(base::LaneMask rows) {
  const base::LaneMask outer = (rows ^ rows >> 4) & 0x00f000f000f000f0;
  rows ^= outer | outer << 4;
  const base::LaneMask inner = (rows ^ rows >> 2) & 0x0c0c0c0c0c0c0c0c;
  return rows ^ (inner | inner << 2);
}

/// The eight rows of a block of an attachment; all of them lie inside the image.
struct BlockPixels {
  std::byte* first;
  std::uint64_t pitch;  ///< bytes
};

/// Colours of a block as an attachment stores them, in an order that is the functions' own.
struct alignas(64) PackedBlock {
  std::uint32_t texel[base::kWaveWidth];
};

/// How blocks reach a colour attachment.
struct BlockColorFunctions {
  /// Four registers in quad order, converted: for colours that are written more than once.
  void (*pack)(const ColorWriter& writer, const base::WaveRegister* color, PackedBlock& out);
  /// Stores or blends the pixels of `rows` (row order).
  void (*write_packed)(const ColorWriter& writer, const PackedBlock& colors, const BlockPixels& pixels,
                       base::LaneMask rows);
  /// Both at once.
  void (*write)(const ColorWriter& writer, const base::WaveRegister* color, const BlockPixels& pixels,
                base::LaneMask rows);
  /// The last two for a wave of spans (raster/tile/spans.h); `pixels`: of the attachment, from (0, 0).
  void (*write_packed_spans)(const ColorWriter& writer, const PackedBlock& colors, const BlockPixels& pixels,
                             const SpanWave& wave);
  void (*write_spans)(const ColorWriter& writer, const base::WaveRegister* color, const BlockPixels& pixels,
                      const SpanWave& wave);
};

/// The block functions for this writer, or null (color_block.cpp).
const BlockColorFunctions* block_color_functions(const ColorWriter& writer);

/// A depth test of squares of pixels in one sample: the bits that evaluate_block_depth, clamp_depth and
/// test_depth_stencil give.
struct BlockDepthTest {
  DepthFormat format;
  VkCompareOp compare;
  bool write;
  const DepthRange* clamp;  ///< null: no depth clamp
  bool restricted = true;   ///< to [0, 1]
};

/// Tests lanes[i], in quad order, of the 8x8 blocks at quad-ordered places i of `places` and cuts them to what passed.
/// (x, y) is the first sample of the block at place 0, `pixels` are that block's. Returns the places where there were
/// lanes and none passed.
base::LaneMask test_block_depths(const BlockDepthTest& test, const DepthPlane& plane, float x, float y,
                                 const BlockPixels& pixels, base::LaneMask places, base::LaneMask* lanes);

/// A 4x4 window of one primitive, its first pixel at (x, y); bit 4*y + x of `rows` is a pixel of it.
struct DepthWindow {
  DepthPlane plane;
  int x, y;
  std::uint32_t rows;
};

/// The same for windows, one after the other: cuts their rows to what passed. `pixels`: of the attachment, from (0, 0).
void test_window_depths(const BlockDepthTest& test, const BlockPixels& pixels, DepthWindow* windows, std::size_t count);

/// Quad order of a window to row order, or back.
constexpr std::uint32_t transpose_window(std::uint32_t lanes) {
  const std::uint32_t inner = (lanes ^ lanes >> 2) & 0x0c0c;
  return lanes ^ (inner | inner << 2);
}

/// A plane to be evaluated over a block.
struct BlockVarying {
  std::uint32_t plane;
  float* out;  ///< 64 lanes, quad order
};

/// fma(dady, y, fma(dadx, x, a0)) of `count` planes, the first pixel at (x, y), quad order; times `scale` per lane if
/// given.
void evaluate_block(const PlaneSet& planes, const BlockVarying* varying, std::size_t count, float x, float y,
                    const float* scale);

}  // namespace vitrine::raster

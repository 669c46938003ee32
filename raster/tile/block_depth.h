// Depth tests of squares of pixels of one primitive, a row of the attachment at a time: blocks, and windows of 4x4 and
// 16x16 pixels. Same bits as lane by lane (tests compare them).
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/lanes.h"
#include "raster/output/block_pixels.h"
#include "raster/output/depth_stencil.h"
#include "raster/tile/coverage.h"
#include "raster/tile/interpolate.h"

namespace vitrine::raster {

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

/// The same for the window of 16x16 pixels whose first sample is (x, y): cuts its rows to
/// what passed. False: nothing did.
bool test_large_window_depths(const BlockDepthTest& test, const DepthPlane& plane, float x, float y,
                              const BlockPixels& pixels, LargeWindow& window);

}  // namespace vitrine::raster

// Coverage of small triangles, found where they are set up: all they cover lies in a window of 8x8 pixels, which is one
// bit set (raster/pixel_order.h: a block in quad order). Edge functions as in raster/tile/coverage.h, in 32 bits.
#pragma once

#include <cstdint>

#include "base/lanes.h"
#include "raster/pixel_order.h"
#include "raster/pixel_rect.h"

namespace vitrine::raster {

/// Covered pixels, in quad order, of the 8x8 window at (x, y) for a single-sampled triangle of positive area whose
/// corners lie within 32 pixels of there. `small`: only its first 4x4 pixels can be covered.
base::LaneMask cover_window(const std::int32_t corner_x[3], const std::int32_t corner_y[3], int x, int y, bool small);

/// Those of the covered pixels of a window at (x, y) that are not cut away: `bounds` is what the triangle may cover,
/// `visible` what of that lies in the draw region.
inline base::LaneMask cut_window(base::LaneMask window, int x, int y, const PixelRect& bounds,
                                 const PixelRect& visible) {
  if (visible == bounds) return window;
  return window & rect_lanes(visible.x0 - x, visible.y0 - y, visible.x1 - x, visible.y1 - y);
}

}  // namespace vitrine::raster

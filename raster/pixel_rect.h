// Rectangles of pixels: draw regions, bounds of primitives, parts of tiles.
#pragma once

#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <cstdint>

namespace vitrine::raster {

/// Pixels, all bounds inclusive; empty if x1 < x0 or y1 < y0.
struct PixelRect {
  int x0 = 0, y0 = 0, x1 = -1, y1 = -1;
  bool empty() const { return x1 < x0 || y1 < y0; }
  bool operator==(const PixelRect&) const = default;
};

inline PixelRect intersect(const PixelRect& a, const PixelRect& b) {
  return {a.x0 > b.x0 ? a.x0 : b.x0, a.y0 > b.y0 ? a.y0 : b.y0, a.x1 < b.x1 ? a.x1 : b.x1, a.y1 < b.y1 ? a.y1 : b.y1};
}

/// A rectangle of the API; it ends below `limit`, where arithmetic on pixels is safe.
inline PixelRect pixel_rect(const VkRect2D& rect, std::int64_t limit = std::int64_t{1} << 20) {
  const auto last = [limit](std::int32_t offset, std::uint32_t extent) {
    return static_cast<int>(std::min(std::int64_t{offset} + extent, limit)) - 1;
  };
  return {rect.offset.x, rect.offset.y, last(rect.offset.x, rect.extent.width),
          last(rect.offset.y, rect.extent.height)};
}

}  // namespace vitrine::raster

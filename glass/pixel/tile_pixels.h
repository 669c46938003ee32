// The watched texels of a tile of a pass.
#pragma once

#include "glass/pixel/pixels.h"
#include "raster/draw.h"

namespace vitrine::glass::pixel {

/// Attachments by number: colours, then these.
inline constexpr std::uint32_t kDepthSlot = raster::kMaxColorAttachments, kStencilSlot = kDepthSlot + 1;

struct PassTexel {
  Texel* texel = nullptr;
  std::uint32_t slot = 0;
  std::uint32_t layer = 0;  ///< of the attachment's view
};

/// A pixel of a tile with watched texels.
struct WatchedPixel {
  std::uint32_t x = 0, y = 0;
  std::vector<PassTexel> texels;
};

struct TilePixels {
  std::vector<WatchedPixel> pixels;
  std::array<std::uint32_t, 32> quads{};    ///< those with such pixels: bit x / 2 of row y / 2
  std::array<std::uint16_t, 64 * 64> at{};  ///< index in `pixels`, plus 1; 0: none

  const WatchedPixel* find(std::uint32_t x, std::uint32_t y) const {
    const std::uint16_t index = at[(y % 64) * 64 + x % 64];
    return index == 0 ? nullptr : &pixels[index - 1u];
  }
};

}  // namespace vitrine::glass::pixel

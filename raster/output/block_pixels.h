// Where the pixels of a block, or of a whole attachment, lie in memory.
#pragma once

#include <cstddef>
#include <cstdint>

namespace vitrine::raster {

/// Rows of pixels from one pixel on: those of a block, all of which lie inside the image, or of an attachment.
struct BlockPixels {
  std::byte* first;
  std::uint64_t pitch;  ///< bytes
};

}  // namespace vitrine::raster

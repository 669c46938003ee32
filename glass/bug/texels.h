// Texels as vkCmdCopyImageToBuffer packs them: how many bytes there are.
#pragma once

#include <cstdint>

#include "texel/view.h"

namespace vitrine::glass::bug {

/// Of layers of one level and aspect, rows and slices behind one another. 0: of images that are not packed (several
/// samples, several planes of colour).
std::uint64_t packed_bytes(const texel::ImageLayout& layout, VkImageAspectFlagBits aspect, std::uint32_t level,
                           std::uint32_t layers);

/// The blocks of a level along each axis, of a plane's format.
struct Blocks {
  std::uint32_t width = 0, height = 0, depth = 0;
  std::uint64_t count() const { return std::uint64_t{width} * height * depth; }
};
Blocks blocks_of(const texel::FormatDesc& format, const texel::Extent& extent);

}  // namespace vitrine::glass::bug

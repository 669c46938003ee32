// Texels as vkCmdCopyImageToBuffer packs them, sample after sample: how many bytes there are, and where they lie in
// images of several samples, which no command copies.
#pragma once

#include <cstdint>

#include "base/function_ref.h"
#include "texel/view.h"

namespace vitrine::glass::bug {

/// Of layers of one level and aspect, rows and slices behind one another; of several samples one behind the other. 0:
/// of images that are not packed (several planes of colour).
std::uint64_t packed_bytes(const texel::ImageLayout& layout, VkImageAspectFlagBits aspect, std::uint32_t level,
                           std::uint32_t layers);

/// The blocks of a level along each axis, of a plane's format.
struct Blocks {
  std::uint32_t width = 0, height = 0, depth = 0;
  std::uint64_t count() const { return std::uint64_t{width} * height * depth; }
};
Blocks blocks_of(const texel::FormatDesc& format, const texel::Extent& extent);

/// Calls f(offset in the image, bytes) for the rows of an image of several samples, in the order in which they are
/// packed.
void for_each_sample_row(const texel::ImageLayout& layout, VkImageAspectFlagBits aspect, std::uint32_t layer,
                         std::uint32_t layers, base::FunctionRef<void(std::uint64_t, std::uint64_t)> f);

}  // namespace vitrine::glass::bug

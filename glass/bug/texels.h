// Texels as vkCmdCopyImageToBuffer packs them: how many bytes there are.
#pragma once

#include <cstdint>

#include "texel/view.h"

namespace vitrine::glass::bug {

/// Of layers of one level and aspect, rows and slices behind one another. 0: of images that are not packed (several
/// samples, several planes of colour).
std::uint64_t packed_bytes(const texel::ImageLayout& layout, VkImageAspectFlagBits aspect, std::uint32_t level,
                           std::uint32_t layers);

}  // namespace vitrine::glass::bug

// See texels.h (Vulkan 1.3.239, Copy Commands: Buffer and Image Addressing).
#include "glass/bug/texels.h"

namespace vitrine::glass::bug {

Blocks blocks_of(const texel::FormatDesc& format, const texel::Extent& extent) {
  const auto blocks = [](std::uint32_t texels, std::uint32_t side) { return (texels + side - 1) / side; };
  return {blocks(extent.width, format.block_width), blocks(extent.height, format.block_height),
          blocks(extent.depth, format.block_depth)};
}

std::uint64_t packed_bytes(const texel::ImageLayout& layout, VkImageAspectFlagBits aspect, std::uint32_t level,
                           std::uint32_t layers) {
  const texel::FormatDesc& whole = texel::format_desc(layout.desc.format);
  if (whole.plane_count != 1 && !whole.is_depth_stencil()) return 0;
  if (level >= layout.desc.levels || !(whole.aspects & aspect)) return 0;
  const texel::PlaneLayout& plane = layout.plane[texel::plane_of_aspect(layout, aspect)];
  const texel::FormatDesc& format = texel::format_desc(plane.format);
  return blocks_of(format, plane.level[level].extent).count() * format.block_bytes * layers * layout.desc.samples;
}

void for_each_sample_row(const texel::ImageLayout& layout, VkImageAspectFlagBits aspect, std::uint32_t layer,
                         std::uint32_t layers, base::FunctionRef<void(std::uint64_t, std::uint64_t)> f) {
  const texel::PlaneLayout& plane = layout.plane[texel::plane_of_aspect(layout, aspect)];
  const texel::LevelLayout& level = plane.level[0];
  const std::uint64_t bytes = std::uint64_t{level.extent.width} * texel::format_desc(plane.format).block_bytes;
  for (std::uint32_t s = 0; s < layout.desc.samples; ++s)
    for (std::uint32_t l = layer; l < layer + layers; ++l)
      for (std::uint32_t y = 0; y < level.extent.height; ++y)
        f(plane.offset + l * plane.layer_stride + level.offset + s * level.sample_stride + y * level.row_pitch, bytes);
}

}  // namespace vitrine::glass::bug

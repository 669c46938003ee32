// See locate.h.
#include "glass/pixel/locate.h"

namespace vitrine::glass::pixel {
namespace {

std::byte* memory_of_plane(const ImagePlace& image, std::uint32_t plane) {
  std::byte* const memory = image.plane_memory != nullptr ? (*image.plane_memory)[plane] : *image.memory;
  return memory == nullptr ? nullptr : memory + image.layout->plane[plane].offset;
}

VkImageAspectFlags aspect_of_plane(const texel::ImageLayout& layout, std::uint32_t plane) {
  const texel::FormatDesc& format = texel::format_desc(layout.desc.format);
  if (format.is_depth_stencil())
    return format.has_depth() && plane == 0 ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_STENCIL_BIT;
  if (layout.plane_count > 1) return static_cast<VkImageAspectFlags>(VK_IMAGE_ASPECT_PLANE_0_BIT << plane);
  return VK_IMAGE_ASPECT_COLOR_BIT;
}

/// How often `stride` goes into `rest`, which keeps the remainder; a stride of 0 never does.
std::uint32_t take(std::uint64_t& rest, std::uint64_t stride) {
  if (stride == 0) return 0;
  const std::uint64_t count = rest / stride;
  rest -= count * stride;
  return static_cast<std::uint32_t>(count);
}

std::optional<TexelId> id_in_plane(const texel::ImageLayout& layout, std::uint32_t number, std::uint64_t offset) {
  const texel::PlaneLayout& plane = layout.plane[number];
  if (offset >= plane.size) return std::nullopt;
  TexelId id;
  id.aspect = aspect_of_plane(layout, number);
  if (layout.desc.layers > 1) id.layer = take(offset, plane.layer_stride);
  while (id.level + 1 < layout.desc.levels && plane.level[id.level + 1].offset <= offset) ++id.level;
  const texel::LevelLayout& level = plane.level[id.level];
  if (level.offset > offset) return std::nullopt;
  offset -= level.offset;
  if (layout.desc.samples > 1) id.sample = take(offset, level.sample_stride);
  if (level.extent.depth > 1) id.slice = take(offset, level.slice_pitch);
  const texel::FormatDesc& format = texel::format_desc(plane.format);
  id.y = take(offset, level.row_pitch) * format.block_height;
  id.x = take(offset, format.block_bytes) * format.block_width;
  const bool inside = id.layer < layout.desc.layers && id.x < level.extent.width && id.y < level.extent.height;
  return inside ? std::optional(id) : std::nullopt;
}

}  // namespace

const std::byte* address_of(const ImagePlace& image, const TexelId& id) {
  const texel::ImageLayout& layout = *image.layout;
  const std::uint32_t number = texel::plane_of_aspect(layout, static_cast<VkImageAspectFlagBits>(id.aspect));
  const texel::PlaneLayout& plane = layout.plane[number];
  const texel::LevelLayout& level = plane.level[id.level];
  const texel::FormatDesc& format = texel::format_desc(plane.format);
  const std::byte* const memory = memory_of_plane(image, number);
  if (memory == nullptr) return nullptr;
  return memory + level.offset + id.layer * plane.layer_stride + id.sample * level.sample_stride +
         id.slice * level.slice_pitch + id.y / format.block_height * level.row_pitch +
         std::uint64_t{id.x / format.block_width} * format.block_bytes;
}

std::optional<TexelId> id_at(const ImagePlace& image, const std::byte* address) {
  for (std::uint32_t plane = 0; plane < image.layout->plane_count; ++plane) {
    const std::byte* const first = memory_of_plane(image, plane);
    if (first == nullptr || address < first) continue;
    if (auto id = id_in_plane(*image.layout, plane, static_cast<std::uint64_t>(address - first))) return id;
  }
  return std::nullopt;
}

}  // namespace vitrine::glass::pixel

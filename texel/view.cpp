// Makes views of images: level and layer ranges, component mapping, compatible formats (Vulkan 1.3.239, Image Views).
#include "texel/view.h"

#include <algorithm>

#include "texel/swizzle.h"

namespace vitrine::texel {
namespace {

std::uint8_t resolve_component(VkComponentSwizzle swizzle, std::uint8_t identity) {
  if (swizzle == VK_COMPONENT_SWIZZLE_IDENTITY) return identity;
  if (swizzle == VK_COMPONENT_SWIZZLE_ZERO) return 4;
  if (swizzle == VK_COMPONENT_SWIZZLE_ONE) return 5;
  return static_cast<std::uint8_t>(swizzle - VK_COMPONENT_SWIZZLE_R);
}

/// A view whose blocks are texels of an image of larger blocks (BLOCK_TEXEL_VIEW_COMPATIBLE) counts blocks.
Extent convert_extent(Extent extent, const FormatDesc& from, const FormatDesc& to) {
  if (from.block_width == to.block_width && from.block_height == to.block_height) return extent;
  return {(extent.width + from.block_width - 1) / from.block_width * to.block_width,
          (extent.height + from.block_height - 1) / from.block_height * to.block_height, extent.depth};
}

bool is_3d(VkImageViewType type) { return type == VK_IMAGE_VIEW_TYPE_3D; }

}  // namespace

std::array<std::uint8_t, 4> resolve_swizzle(const VkComponentMapping& mapping) {
  return {resolve_component(mapping.r, 0), resolve_component(mapping.g, 1), resolve_component(mapping.b, 2),
          resolve_component(mapping.a, 3)};
}

ImageView make_image_view(const ImageLayout& layout, std::byte* memory, const ImageViewDesc& desc) {
  const PlaneLayout& plane = layout.plane[plane_of_aspect(layout, desc.aspect)];
  const FormatDesc& stored = format_desc(plane.format);
  ImageView view;
  // An aspect of a depth/stencil image is read as the plain format of its plane.
  view.format = stored.is_depth_stencil() ? &stored : &view_format_desc(desc.format);
  view.type = desc.type;
  view.level_count = std::min(desc.level_count, kMaxLevels - std::min(desc.base_level, kMaxLevels - 1));
  view.layer_count = desc.layer_count;
  view.samples = layout.desc.samples;
  view.base_level = desc.base_level;
  view.level0_extent = convert_extent(plane.level[0].extent, stored, *view.format);
  view.swizzle = resolve_swizzle(desc.components);
  for (std::uint32_t i = 0; i < view.level_count; ++i) {
    view.level[i] = plane.level[desc.base_level + i];
    view.level[i].extent = convert_extent(view.level[i].extent, stored, *view.format);
  }
  view.layer_stride = plane.layer_stride;
  if (layout.desc.type == VK_IMAGE_TYPE_3D && !is_3d(desc.type)) {
    // 2D views of a 3D image (2D_ARRAY_COMPATIBLE): slices are layers, and there is one level.
    view.layer_stride = view.level[0].slice_pitch;
    view.level[0].extent.depth = 1;
    view.level0_extent.depth = 1;
  }
  view.base = memory + plane.offset + desc.base_layer * view.layer_stride;
  return view;
}

ImageView make_sampled_plane(const ImageLayout& layout, std::byte* memory, const ImageViewDesc& desc,
                             std::uint32_t index) {
  const FormatDesc& format = format_desc(desc.format);
  ImageViewDesc own = desc;
  own.format = format.plane[index].format;
  if (format.plane_count > 1) own.aspect = static_cast<VkImageAspectFlagBits>(VK_IMAGE_ASPECT_PLANE_0_BIT << index);
  ImageView view = make_image_view(layout, memory, own);
  if (format.plane_count == 1) {
    // Views of a packed format lie on the same bytes and differ in how many texels those are.
    Extent extent = layout.desc.extent;
    extent.width = (extent.width + format.plane[index].width_divisor - 1) / format.plane[index].width_divisor;
    view.level0_extent = view.level[0].extent = extent;
  }
  return view;
}

ImageView make_word_view(const ImageView& view, bool high) {
  // By swizzle: the number is the only component, the others read 0, and alpha 1, whose high word is 0.
  static constexpr std::uint8_t kZero = 4, kOne = 5;
  static constexpr std::uint8_t kLow[] = {0, kZero, kZero, kOne, kZero, kOne};
  ImageView words = view;
  for (std::uint8_t& component : words.swizzle) {
    if (high)
      component = component == 0 ? 1 : kZero;
    else
      component = kLow[component];
  }
  return words;
}

}  // namespace vitrine::texel

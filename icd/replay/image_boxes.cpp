// See image_boxes.h.
#include "icd/replay/image_boxes.h"

#include <algorithm>
#include <optional>

namespace vitrine::icd {
namespace {

constexpr std::array kPlaneAspects{VK_IMAGE_ASPECT_PLANE_0_BIT, VK_IMAGE_ASPECT_PLANE_1_BIT,
                                   VK_IMAGE_ASPECT_PLANE_2_BIT};

/// The plane's aspect if `aspects` name the plane.
std::optional<VkImageAspectFlagBits> aspect_of_plane(const Image& image, std::uint32_t plane,
                                                     VkImageAspectFlags aspects) {
  const texel::FormatDesc& format = texel::format_desc(image.desc().format);
  if (!format.is_depth_stencil()) {
    const VkImageAspectFlagBits own = image.layout.plane_count > 1 ? kPlaneAspects[plane] : VK_IMAGE_ASPECT_COLOR_BIT;
    const bool named = aspects & (own | VK_IMAGE_ASPECT_COLOR_BIT);
    return named ? std::optional(own) : std::nullopt;
  }
  for (const auto aspect : {VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_ASPECT_STENCIL_BIT}) {
    const bool here = (format.aspects & aspect) && texel::plane_of_aspect(image.layout, aspect) == plane;
    if (here && (aspects & aspect)) return aspect;
  }
  return std::nullopt;
}

/// Calls f(view) for each plane of the image that `aspects` name, with all levels and layers.
template <class F>
void for_each_plane(const Image& image, VkImageAspectFlags aspects, F&& f) {
  if (!image.data) return;
  const VkImageViewType type =
      image.desc().type == VK_IMAGE_TYPE_3D ? VK_IMAGE_VIEW_TYPE_3D : VK_IMAGE_VIEW_TYPE_2D_ARRAY;
  for (std::uint32_t plane = 0; plane < image.layout.plane_count; ++plane) {
    const auto aspect = aspect_of_plane(image, plane, aspects);
    if (!aspect) continue;
    const VkImageSubresourceRange all{static_cast<VkImageAspectFlags>(*aspect), 0, image.desc().levels, 0,
                                      image.desc().layers};
    f(view_of_aspect(image, *aspect, type, image.layout.plane[plane].format, all));
  }
}

}  // namespace

void for_each_box(const Image& image, const VkImageSubresourceRange& recorded, BoxFunction f) {
  const VkImageSubresourceRange range = resolve_range(image, recorded);
  for_each_plane(image, range.aspectMask, [&](const texel::ImageView& view) {
    for (std::uint32_t i = 0; i < range.levelCount; ++i) {
      glass::TexelBox box{range.baseMipLevel + i, glass::kWholeArea};
      if (view.type != VK_IMAGE_VIEW_TYPE_3D) box.first_layer = range.baseArrayLayer, box.layers = range.layerCount;
      f(view, box);
    }
  });
}

void for_each_box(const Image& image, const VkImageSubresourceLayers& layers, const VkOffset3D& a, const VkOffset3D& b,
                  BoxFunction f) {
  for_each_plane(image, layers.aspectMask, [&](const texel::ImageView& view) {
    const auto low = [](std::int32_t p, std::int32_t q) { return std::min(p, q); };
    const auto size = [](std::int32_t p, std::int32_t q) { return static_cast<std::uint32_t>(std::abs(p - q)); };
    glass::TexelBox box{layers.mipLevel, {{low(a.x, b.x), low(a.y, b.y)}, {size(a.x, b.x), size(a.y, b.y)}}};
    if (view.type == VK_IMAGE_VIEW_TYPE_3D) {
      box.first_slice = static_cast<std::uint32_t>(low(a.z, b.z)), box.slices = size(a.z, b.z);
    } else {
      box.first_layer = layers.baseArrayLayer, box.layers = layers.layerCount;
    }
    f(view, box);
  });
}

}  // namespace vitrine::icd

// See layouts.h.
#include "glass/sync/layouts.h"

#include <algorithm>

namespace vitrine::glass::sync {
namespace {

constexpr VkImageAspectFlags kStencil = VK_IMAGE_ASPECT_STENCIL_BIT;

/// Layouts with several names, as the one of an aspect.
VkImageLayout of_aspect(VkImageLayout layout, bool stencil, bool depth) {
  switch (layout) {
    case VK_IMAGE_LAYOUT_ATTACHMENT_OPTIMAL:
      return stencil ? VK_IMAGE_LAYOUT_STENCIL_ATTACHMENT_OPTIMAL
             : depth ? VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL
                     : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    case VK_IMAGE_LAYOUT_READ_ONLY_OPTIMAL:
      return stencil ? VK_IMAGE_LAYOUT_STENCIL_READ_ONLY_OPTIMAL
             : depth ? VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL
                     : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    case VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL:
      return of_aspect(VK_IMAGE_LAYOUT_ATTACHMENT_OPTIMAL, stencil, true);
    case VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL:
      return of_aspect(VK_IMAGE_LAYOUT_READ_ONLY_OPTIMAL, stencil, true);
    case VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL:
      return stencil ? VK_IMAGE_LAYOUT_STENCIL_ATTACHMENT_OPTIMAL : VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL;
    case VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_STENCIL_READ_ONLY_OPTIMAL:
      return stencil ? VK_IMAGE_LAYOUT_STENCIL_READ_ONLY_OPTIMAL : VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    default:
      return layout;
  }
}

}  // namespace

template <class F>
void Layouts::for_each(const ImagePart& part, F&& f) {
  std::vector<VkImageLayout>& all = layouts_[part.image];
  const std::size_t plane = std::size_t{part.image_levels} * part.image_layers;
  all.resize(2 * plane, VK_IMAGE_LAYOUT_UNDEFINED);
  const VkImageSubresourceRange& range = part.range;
  const std::uint32_t levels = std::min(part.image_levels, range.baseMipLevel + range.levelCount);
  const std::uint32_t layers = std::min(part.image_layers, range.baseArrayLayer + range.layerCount);
  for (const bool stencil : {false, true}) {
    const VkImageAspectFlags aspects = range.aspectMask & (stencil ? kStencil : ~kStencil);
    if (aspects == 0) continue;
    for (std::uint32_t level = range.baseMipLevel; level < levels; ++level)
      for (std::uint32_t layer = range.baseArrayLayer; layer < layers; ++layer)
        f(all[(stencil ? plane : 0) + std::size_t{level} * part.image_layers + layer], stencil,
          (aspects & VK_IMAGE_ASPECT_DEPTH_BIT) != 0);
  }
}

std::optional<VkImageLayout> Layouts::other_than(const ImagePart& part, VkImageLayout layout) {
  const std::lock_guard lock(mutex_);
  std::optional<VkImageLayout> other;
  if (layout == VK_IMAGE_LAYOUT_UNDEFINED || layout == VK_IMAGE_LAYOUT_PREINITIALIZED) return other;
  if (shared_.contains(part.image)) return other;
  for_each(part, [&](VkImageLayout& has, bool stencil, bool depth) {
    if (!other && of_aspect(has, stencil, depth) != of_aspect(layout, stencil, depth)) other = has;
  });
  return other;
}

void Layouts::set(const ImagePart& part, VkImageLayout layout) {
  const std::lock_guard lock(mutex_);
  for_each(part, [&](VkImageLayout& has, bool, bool) { has = layout; });
}

void Layouts::share(const void* image) {
  const std::lock_guard lock(mutex_);
  shared_.insert(image);
}

void Layouts::forget(const void* image) {
  const std::lock_guard lock(mutex_);
  layouts_.erase(image);
  shared_.erase(image);
}

}  // namespace vitrine::glass::sync

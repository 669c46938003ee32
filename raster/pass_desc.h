// What a render pass instance draws to: attachments, render area, layers, views, samples.
#pragma once

#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <array>
#include <cstdint>

#include "raster/draw.h"
#include "texel/view.h"

namespace vitrine::raster {

/// Attachments are views of one mip level; view.level[0] is that level. format == null: unused attachment.
struct PassDesc {
  std::array<texel::ImageView, kMaxColorAttachments> color{};
  std::uint32_t color_count = 0;
  texel::ImageView depth;                          ///< the depth plane
  texel::ImageView stencil;                        ///< the stencil plane
  const texel::ImageView* shading_rate = nullptr;  ///< fragment shading rate attachment; lives until the flush
  VkExtent2D shading_rate_texel{8, 8};             ///< pixels for which a texel of it stands; whole blocks
  VkRect2D render_area{};
  std::uint32_t layers = 1;
  std::uint32_t view_mask = 0;
  std::uint32_t samples = 1;
  bool plain_image = false;  ///< color[0] is of a 2D image of one layer
};

/// Calls f(view) for the attachments that are drawn to.
template <class F>
void for_each_attachment(const PassDesc& desc, F&& f) {
  for (std::uint32_t i = 0; i < desc.color_count; ++i)
    if (desc.color[i].format) f(desc.color[i]);
  if (desc.depth.format) f(desc.depth);
  if (desc.stencil.format) f(desc.stencil);
}

/// Pixels that all attachments have: of a width and a height, the smallest of each.
inline VkExtent2D cut_to_attachments(const PassDesc& desc, VkExtent2D extent) {
  for_each_attachment(desc, [&](const texel::ImageView& view) {
    extent.width = std::min(extent.width, view.level[0].extent.width);
    extent.height = std::min(extent.height, view.level[0].extent.height);
  });
  return extent;
}

}  // namespace vitrine::raster

// What render pass instances and dynamic rendering have in common when they are replayed: the attachments of a scope,
// its resolves, and its end.
#pragma once

#include <bit>

#include "icd/replay/replay.h"

namespace vitrine::icd {

/// One plane of a depth/stencil attachment, whatever aspects its view names: "the aspectMask is ignored and both depth
/// and stencil image subresources are used" (VkFramebufferCreateInfo). Without that aspect: an unused attachment.
texel::ImageView depth_stencil_plane(const ImageView& view, VkImageAspectFlagBits aspect);

/// The shading rate attachment of a pass. `view`: null: none. `texel`: shadingRateAttachmentTexelSize.
void describe_shading_rate(const ImageView* view, VkExtent2D texel, raster::PassDesc& desc);

/// Calls f(first layer, layer count) for what a scope draws to: each of its views, or all layers.
template <class F>
void for_each_layer_range(std::uint32_t views, std::uint32_t layers, F f) {
  if (views == 0) f(0, layers);
  for (; views; views &= views - 1) f(static_cast<std::uint32_t>(std::countr_zero(views)), 1);
}

/// The part of `area` inside [0, width) x [0, height).
VkRect2D clip_area(const VkRect2D& area, std::uint32_t width, std::uint32_t height);

/// Flushes, and does the resolves of the scope.
void end_scope(ReplayState& state);

}  // namespace vitrine::icd

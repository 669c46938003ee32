// Replay of dynamic rendering (Vulkan 1.3.239, Render Pass: vkCmdBeginRendering). Store ops need nothing: attachments
// are in memory, which is also all that suspending and resuming takes.
#include <algorithm>

#include "icd/replay/scope.h"

namespace vitrine::icd {
namespace {

/// The area inside every attachment. Without attachments it is taken as it is.
VkRect2D clip_to_attachments(const CmdBeginRendering& command) {
  VkRect2D area = clip_area(command.area, INT32_MAX, INT32_MAX);
  const auto clip_to = [&](const RenderingAttachment& attachment) {
    if (!attachment.view) return;
    const texel::Extent& extent = attachment.view->view.level[0].extent;
    area = clip_area(area, extent.width, extent.height);
  };
  std::for_each(command.colors.begin(), command.colors.end(), clip_to);
  clip_to(command.depth);
  clip_to(command.stencil);
  return area;
}

DrawScope describe_scope(const CmdBeginRendering& command) {
  DrawScope scope;
  scope.area = clip_to_attachments(command);
  scope.layers = command.layers;
  scope.view_mask = command.view_mask;
  if (command.flags & VK_RENDERING_SUSPENDING_BIT) return scope;  // the one that ends it resolves
  for (const RenderingAttachment& color : command.colors) {
    scope.add_resolve({color.view, color.resolve, VK_IMAGE_ASPECT_COLOR_BIT, color.resolve_mode});
  }
  const RenderingAttachment &depth = command.depth, &stencil = command.stencil;
  scope.add_resolve({depth.view, depth.resolve, VK_IMAGE_ASPECT_DEPTH_BIT, depth.resolve_mode});
  scope.add_resolve({stencil.view, stencil.resolve, VK_IMAGE_ASPECT_STENCIL_BIT, stencil.resolve_mode});
  return scope;
}

raster::PassDesc describe_pass(const CmdBeginRendering& command, const DrawScope& scope) {
  raster::PassDesc desc;
  desc.color_count = std::min(static_cast<std::uint32_t>(command.colors.size()), raster::kMaxColorAttachments);
  desc.render_area = scope.area;
  desc.layers = scope.layers;
  desc.view_mask = scope.view_mask;
  const auto use = [&](const ImageView& view) { desc.samples = view.image->desc().samples; };
  for (std::uint32_t i = 0; i < desc.color_count; ++i) {
    const ImageView* view = command.colors[i].view;
    if (!view) continue;
    desc.color[i] = view->view;
    use(*view);
  }
  if (const ImageView* view = command.depth.view) {
    desc.depth = depth_stencil_plane(*view, VK_IMAGE_ASPECT_DEPTH_BIT);
    use(*view);
  }
  if (const ImageView* view = command.stencil.view) {
    desc.stencil = depth_stencil_plane(*view, VK_IMAGE_ASPECT_STENCIL_BIT);
    use(*view);
  }
  return desc;
}

bool is_cleared(const RenderingAttachment& attachment) {
  return attachment.view && attachment.load == VK_ATTACHMENT_LOAD_OP_CLEAR;
}

void clear_attachments(ReplayState& state, const CmdBeginRendering& command, std::uint32_t layer, std::uint32_t count) {
  const VkRect2D& area = state.scope.area;
  for (std::uint32_t i = 0; i < command.colors.size() && i < raster::kMaxColorAttachments; ++i) {
    const RenderingAttachment& color = command.colors[i];
    if (is_cleared(color)) state.pass->clear_color(i, color.clear.color, area, layer, count);
  }
  const auto clear_plane = [&](const RenderingAttachment& attachment, VkImageAspectFlagBits aspect) {
    if (is_cleared(attachment))
      state.pass->clear_depth_stencil(aspect, attachment.clear.depthStencil, area, layer, count);
  };
  clear_plane(command.depth, VK_IMAGE_ASPECT_DEPTH_BIT);
  clear_plane(command.stencil, VK_IMAGE_ASPECT_STENCIL_BIT);
}

}  // namespace

void execute(ReplayState& state, const CmdBeginRendering& command) {
  state.scope = describe_scope(command);
  state.pass.emplace(describe_pass(command, state.scope));
  if (command.flags & VK_RENDERING_RESUMING_BIT) return;  // the one that was suspended has loaded
  for_each_layer_range(command.view_mask, command.layers, [&](std::uint32_t layer, std::uint32_t count) {
    clear_attachments(state, command, layer, count);
  });
}

void execute(ReplayState& state, const CmdEndRendering&) {
  if (state.pass) end_scope(state);
}

}  // namespace vitrine::icd

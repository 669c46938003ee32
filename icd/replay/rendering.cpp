// Replay of dynamic rendering (Vulkan 1.3.239, Render Pass: vkCmdBeginRendering). Store ops need nothing: attachments
// are in memory, which is also all that suspending and resuming takes.
#include <algorithm>

#include "icd/replay/observed_replay.h"
#include "icd/replay/scope.h"
#include "icd/replay/sync_notes.h"
#include "icd/replay/texel_events.h"
#include "icd/replay/written.h"

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

std::uint32_t live_colors(const CmdBeginRendering& command) {
  std::uint32_t live = 0;
  for (std::size_t i = 0; i < std::min<std::size_t>(command.colors.size(), raster::kMaxColorAttachments); ++i)
    live |= (command.colors[i].view ? 1u : 0u) << i;
  return live;
}

DrawScope describe_scope(const CmdBeginRendering& command) {
  DrawScope scope;
  scope.area = clip_to_attachments(command);
  scope.layers = command.layers;
  scope.view_mask = command.view_mask;
  scope.live_colors = live_colors(command);
  scope.suspended = command.flags & VK_RENDERING_SUSPENDING_BIT;
  if (scope.suspended) return scope;  // the one that ends it resolves
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
  desc.render_area = scope.area;
  desc.layers = scope.layers;
  desc.view_mask = scope.view_mask;
  const auto use = [&](const ImageView& view) { desc.samples = view.image->desc().samples; };
  for (std::uint32_t i = 0; i < command.colors.size(); ++i) {
    const ImageView* view = command.colors[i].view;
    const std::uint32_t at = scope.locations.location(i);
    if (at != ColorLocations::kNone) desc.color_count = std::max(desc.color_count, at + 1);
    if (!view) continue;
    use(*view);
    if (at == ColorLocations::kNone) continue;
    desc.color[at] = view->view;
    if (at == 0) desc.plain_image = view->image->desc().type == VK_IMAGE_TYPE_2D && view->image->desc().layers == 1;
  }
  if (const ImageView* view = command.depth.view) {
    desc.depth = depth_stencil_plane(*view, VK_IMAGE_ASPECT_DEPTH_BIT);
    use(*view);
  }
  if (const ImageView* view = command.stencil.view) {
    desc.stencil = depth_stencil_plane(*view, VK_IMAGE_ASPECT_STENCIL_BIT);
    use(*view);
  }
  describe_shading_rate(command.shading_rate, command.shading_rate_texel, desc);
  return desc;
}

/// The command with the samples that stand for its attachments; `colors` takes the changed ones.
CmdBeginRendering with_transients(ReplayState& state, const CmdBeginRendering& recorded,
                                  std::array<RenderingAttachment, raster::kMaxColorAttachments>& colors) {
  CmdBeginRendering command = recorded;
  if (recorded.forced_samples <= 1) return command;
  const std::size_t count = std::min<std::size_t>(recorded.colors.size(), colors.size());
  std::copy_n(recorded.colors.begin(), count, colors.begin());
  const auto replace = [&](RenderingAttachment& attachment) {
    attachment.view = transient_of(state.transients, attachment.view, recorded.forced_samples);
  };
  std::for_each(colors.begin(), colors.begin() + static_cast<std::ptrdiff_t>(count), replace);
  replace(command.depth);
  replace(command.stencil);
  command.colors = {colors.data(), count};
  return command;
}

/// Adds what brings the samples of `command` to the attachments of `recorded`.
void resolve_transients(const CmdBeginRendering& recorded, const CmdBeginRendering& command, DrawScope& scope) {
  if (scope.suspended) return;
  const auto resolve = [&](const RenderingAttachment& drawn, const RenderingAttachment& single,
                           VkImageAspectFlagBits aspect, VkResolveModeFlagBits mode) {
    if (drawn.view != single.view) scope.add_resolve({drawn.view, single.view, aspect, mode});
  };
  for (std::size_t i = 0; i < command.colors.size(); ++i)
    resolve(command.colors[i], recorded.colors[i], VK_IMAGE_ASPECT_COLOR_BIT, VK_RESOLVE_MODE_AVERAGE_BIT);
  resolve(command.depth, recorded.depth, VK_IMAGE_ASPECT_DEPTH_BIT, recorded.depth.resolve_mode);
  resolve(command.stencil, recorded.stencil, VK_IMAGE_ASPECT_STENCIL_BIT, recorded.stencil.resolve_mode);
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

/// Calls f(part, attachment) for the attachments of a rendering instance, in each range of layers that it draws to.
template <class F>
void for_each_part(const ReplayState& state, const CmdBeginRendering& command, F&& f) {
  for_each_layer_range(command.view_mask, command.layers, [&](std::uint32_t layer, std::uint32_t layers) {
    const auto part_of = [&](const RenderingAttachment& attachment, VkImageAspectFlags aspects) {
      if (attachment.view) f(AttachmentPart{attachment.view, aspects, state.scope.area, layer, layers}, attachment);
    };
    for (const RenderingAttachment& color : command.colors) part_of(color, VK_IMAGE_ASPECT_COLOR_BIT);
    part_of(command.depth, VK_IMAGE_ASPECT_DEPTH_BIT);
    part_of(command.stencil, VK_IMAGE_ASPECT_STENCIL_BIT);
  });
}

/// Tells the shadow of device memory of load ops, and of store ops when the instance ends.
void note_loads(ReplayState& state, const CmdBeginRendering& command) {
  state.observed->rendering = &command;
  if (command.flags & VK_RENDERING_RESUMING_BIT) return;
  for_each_part(state, command, [&](const AttachmentPart& part, const RenderingAttachment& attachment) {
    note_load(state, part, attachment.load);
  });
}

void note_stores(ReplayState& state) {
  const CmdBeginRendering* command = std::exchange(state.observed->rendering, nullptr);
  if (!command || (command->flags & VK_RENDERING_SUSPENDING_BIT)) return;
  for_each_part(state, *command, [&](const AttachmentPart& part, const RenderingAttachment& attachment) {
    note_store(state, part, attachment.store);
  });
}

}  // namespace

void follow_locations(ReplayState& state, const ColorLocations& locations) {
  if (!state.rendering || state.scope.locations == locations) return;
  flush_pass(state);
  state.scope.locations = locations;
  std::array<RenderingAttachment, raster::kMaxColorAttachments> colors{};
  const raster::PassDesc desc = describe_pass(with_transients(state, *state.rendering, colors), state.scope);
  state.pass.emplace(desc);
  if (follows_attachments(state)) note_pass(state, desc);
  if (follows_hazards(state)) state.observed->synced.areas.fill({});
  if (watches_texels(state)) begin_watched_pass(state, desc);
}

void execute(ReplayState& state, const CmdBeginRendering& recorded) {
  if (!(recorded.flags & VK_RENDERING_RESUMING_BIT)) state.transients.clear();
  std::array<RenderingAttachment, raster::kMaxColorAttachments> colors{};
  const CmdBeginRendering command = with_transients(state, recorded, colors);
  state.rendering = &recorded;
  state.shaders.locations = {};
  state.dirty |= kDirtyShaders;
  state.scope = describe_scope(command);
  resolve_transients(recorded, command, state.scope);
  const raster::PassDesc desc = describe_pass(command, state.scope);
  state.pass.emplace(desc);
  if (follows_hazards(state) && !(command.flags & VK_RENDERING_RESUMING_BIT)) note_sync_rendering(state, recorded);
  if (follows_attachments(state)) {
    note_pass(state, desc);
    note_loads(state, recorded);
  }
  begin_observed_pass(state);
  if (watches_texels(state)) begin_watched_pass(state, desc);
  if (command.flags & VK_RENDERING_RESUMING_BIT) return;  // the one that was suspended has loaded
  for_each_layer_range(command.view_mask, command.layers, [&](std::uint32_t layer, std::uint32_t count) {
    clear_attachments(state, command, layer, count);
  });
  if (watches_texels(state)) finish_loads(state);
}

void execute(ReplayState& state, const CmdEndRendering&) {
  if (!state.pass) return;
  end_scope(state);
  state.rendering = nullptr;
  if (follows_attachments(state)) note_stores(state);
}

}  // namespace vitrine::icd

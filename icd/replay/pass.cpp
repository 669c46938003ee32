// Replay of render pass instances (Vulkan 1.3.239, Render Pass): one raster::Pass per subpass, load ops at the first
// use of an attachment, resolves and visibility at the end of a subpass. Store ops need nothing: attachments are in
// memory.
#include <algorithm>

#include "glass/session.h"
#include "icd/replay/scope.h"
#include "icd/replay/sync_notes.h"
#include "icd/replay/texel_events.h"
#include "icd/replay/written.h"
#include "texel/transfer.h"

namespace vitrine::icd {
namespace {

constexpr VkImageAspectFlags kAllButStencil = ~VkImageAspectFlags{VK_IMAGE_ASPECT_STENCIL_BIT};

const Subpass& current_subpass(const ReplayState& state) {
  return state.instance->render_pass->subpasses[state.subpass];
}

/// Null for VK_ATTACHMENT_UNUSED and beyond what the framebuffer has.
const ImageView* attachment_view(const ReplayState& state, std::uint32_t attachment) {
  const auto& views = state.instance->attachments;
  return attachment < views.size() ? views[attachment] : nullptr;
}

/// What is drawn to: the attachment, or the samples that stand for it.
const ImageView* drawn_view(ReplayState& state, std::uint32_t attachment) {
  return transient_of(state.transients, attachment_view(state, attachment), current_subpass(state).forced_samples);
}

raster::PassDesc describe_pass(ReplayState& state) {
  const Subpass& subpass = current_subpass(state);
  raster::PassDesc desc;
  desc.color_count = std::min(static_cast<std::uint32_t>(subpass.colors.size()), raster::kMaxColorAttachments);
  desc.render_area = state.scope.area;
  desc.layers = state.scope.layers;
  desc.view_mask = state.scope.view_mask;
  for (std::uint32_t i = 0; i < desc.color_count; ++i) {
    const ImageView* view = drawn_view(state, subpass.colors[i]);
    if (!view) continue;
    desc.color[i] = view->view;
    if (i == 0) desc.plain_image = view->image->desc().type == VK_IMAGE_TYPE_2D && view->image->desc().layers == 1;
    desc.samples = view->image->desc().samples;
  }
  if (const ImageView* view = drawn_view(state, subpass.depth_stencil)) {
    desc.depth = depth_stencil_plane(*view, VK_IMAGE_ASPECT_DEPTH_BIT);
    desc.stencil = depth_stencil_plane(*view, VK_IMAGE_ASPECT_STENCIL_BIT);
    desc.samples = view->image->desc().samples;
  }
  describe_shading_rate(attachment_view(state, subpass.shading_rate), subpass.shading_rate_texel, desc);
  return desc;
}

VkImageAspectFlags cleared_aspects(const Attachment& attachment) {
  const VkImageAspectFlags all = texel::format_desc(attachment.format).aspects;
  VkImageAspectFlags cleared = 0;
  if (attachment.load == VK_ATTACHMENT_LOAD_OP_CLEAR) cleared |= all & ~VK_IMAGE_ASPECT_STENCIL_BIT;
  if (attachment.stencil_load == VK_ATTACHMENT_LOAD_OP_CLEAR) cleared |= all & VK_IMAGE_ASPECT_STENCIL_BIT;
  return cleared;
}

/// Clears an attachment that its first subpass does not draw to (an input attachment, say): straight in memory.
void clear_in_memory(const ImageView& view, VkImageAspectFlags aspects, const VkClearValue& value, const VkRect2D& area,
                     std::uint32_t layer, std::uint32_t layer_count) {
  if (aspects & VK_IMAGE_ASPECT_COLOR_BIT) {
    texel::fill_view(view.view, 0, area, layer, layer_count, texel::encode_clear_color(*view.view.format, value.color));
  }
  if (aspects & VK_IMAGE_ASPECT_DEPTH_BIT) {
    const texel::ImageView plane = depth_stencil_plane(view, VK_IMAGE_ASPECT_DEPTH_BIT);
    texel::fill_view(plane, 0, area, layer, layer_count,
                     texel::encode_clear_depth(*plane.format, value.depthStencil.depth));
  }
  if (aspects & VK_IMAGE_ASPECT_STENCIL_BIT) {
    texel::fill_view(depth_stencil_plane(view, VK_IMAGE_ASPECT_STENCIL_BIT), 0, area, layer, layer_count,
                     texel::encode_clear_stencil(value.depthStencil.stencil));
  }
}

/// Tells the shadow of device memory of the load ops of an attachment, in views that no earlier subpass has used.
void note_loads(const ReplayState& state, std::uint32_t attachment, std::uint32_t views) {
  const Attachment& desc = state.instance->render_pass->attachments[attachment];
  const ImageView* view = attachment_view(state, attachment);
  if (!view) return;
  if (state.views_loaded[attachment] == 0) note_undefined(state, *view, desc.undefined_aspects);
  for_each_layer_range(views, state.scope.layers, [&](std::uint32_t layer, std::uint32_t layers) {
    note_load(state, {view, kAllButStencil, state.scope.area, layer, layers}, desc.load);
    note_load(state, {view, VK_IMAGE_ASPECT_STENCIL_BIT, state.scope.area, layer, layers}, desc.stencil_load);
  });
}

bool is_used(const RenderPass& pass, std::uint32_t attachment) {
  return std::any_of(pass.subpasses.begin(), pass.subpasses.end(), [&](const Subpass& subpass) {
    return std::find(subpass.first_uses.begin(), subpass.first_uses.end(), attachment) != subpass.first_uses.end();
  });
}

/// The same of the store ops of the instance that ends.
void note_stores(const ReplayState& state) {
  const RenderPass& pass = *state.instance->render_pass;
  for (std::uint32_t i = 0; i < pass.attachments.size(); ++i) {
    const ImageView* view = attachment_view(state, i);
    if (!view || !is_used(pass, i)) continue;
    for_each_layer_range(state.views_loaded[i], state.scope.layers, [&](std::uint32_t layer, std::uint32_t layers) {
      note_store(state, {view, kAllButStencil, state.scope.area, layer, layers}, pass.attachments[i].store);
      note_store(state, {view, VK_IMAGE_ASPECT_STENCIL_BIT, state.scope.area, layer, layers},
                 pass.attachments[i].stencil_store);
    });
  }
}

void load_attachment(ReplayState& state, std::uint32_t attachment) {
  const Subpass& subpass = current_subpass(state);
  const ImageView* view = attachment_view(state, attachment);
  const VkImageAspectFlags aspects = cleared_aspects(state.instance->render_pass->attachments[attachment]);
  const std::uint32_t views = subpass.view_mask & ~state.views_loaded[attachment];
  if (follows_attachments(state)) note_loads(state, attachment, views);
  state.views_loaded[attachment] |= subpass.view_mask;
  if (!view || !aspects || attachment >= state.instance->clear_values.size()) return;
  const VkClearValue& value = state.instance->clear_values[attachment];
  const VkRect2D& area = state.scope.area;
  const auto color = std::find(subpass.colors.begin(), subpass.colors.end(), attachment);
  for_each_layer_range(views, state.scope.layers, [&](std::uint32_t layer, std::uint32_t count) {
    if (color != subpass.colors.end()) {
      const auto index = static_cast<std::uint32_t>(color - subpass.colors.begin());
      if (index < raster::kMaxColorAttachments) state.pass->clear_color(index, value.color, area, layer, count);
    } else if (attachment == subpass.depth_stencil) {
      state.pass->clear_depth_stencil(aspects, value.depthStencil, area, layer, count);
    } else {
      clear_in_memory(*view, aspects, value, area, layer, count);
    }
  });
}

/// The scope of the current subpass.
DrawScope describe_scope(ReplayState& state) {
  const CmdBeginRenderPass& instance = *state.instance;
  const Subpass& subpass = current_subpass(state);
  DrawScope scope;
  scope.area = clip_area(instance.area, instance.framebuffer->width, instance.framebuffer->height);
  scope.layers = instance.framebuffer->layers;
  scope.view_mask = subpass.view_mask;
  for (std::size_t i = 0; i < subpass.resolves.size(); ++i) {
    scope.add_resolve({attachment_view(state, subpass.colors[i]), attachment_view(state, subpass.resolves[i]),
                       VK_IMAGE_ASPECT_COLOR_BIT, VK_RESOLVE_MODE_AVERAGE_BIT});
  }
  for (const std::uint32_t color : subpass.colors) {
    const ImageView *const drawn = drawn_view(state, color), *const single = attachment_view(state, color);
    if (drawn != single) scope.add_resolve({drawn, single, VK_IMAGE_ASPECT_COLOR_BIT, VK_RESOLVE_MODE_AVERAGE_BIT});
  }
  const ImageView* const source = drawn_view(state, subpass.depth_stencil);
  const ImageView* const single = attachment_view(state, subpass.depth_stencil);
  const ImageView* const target = source != single ? single : attachment_view(state, subpass.depth_stencil_resolve);
  scope.add_resolve({source, target, VK_IMAGE_ASPECT_DEPTH_BIT, subpass.depth_resolve_mode});
  scope.add_resolve({source, target, VK_IMAGE_ASPECT_STENCIL_BIT, subpass.stencil_resolve_mode});
  return scope;
}

void begin_subpass(ReplayState& state) {
  state.scope = describe_scope(state);
  const raster::PassDesc desc = describe_pass(state);
  state.pass.emplace(desc);
  if (follows_attachments(state)) note_pass(state, desc);
  if (follows_hazards(state)) note_sync_subpass(state);
  begin_observed_pass(state);
  if (watches_texels(state)) begin_watched_pass(state, desc);
  for (const std::uint32_t attachment : current_subpass(state).first_uses) load_attachment(state, attachment);
  if (watches_texels(state)) finish_loads(state);
}

void clear_rect(ReplayState& state, const VkClearAttachment& clear, const VkClearRect& rect) {
  // "If the render pass instance has multiview enabled, the clear applies to every view of the subpass."
  const std::uint32_t views = state.scope.view_mask;
  for_each_layer_range(views, rect.layerCount, [&](std::uint32_t layer, std::uint32_t count) {
    const std::uint32_t first = views ? layer : rect.baseArrayLayer;
    if (clear.aspectMask & VK_IMAGE_ASPECT_COLOR_BIT) {
      const std::uint32_t location = state.scope.locations.location(clear.colorAttachment);
      if (location == ColorLocations::kNone) return;
      state.pass->clear_color(location, clear.clearValue.color, rect.rect, first, count);
    } else {
      state.pass->clear_depth_stencil(clear.aspectMask, clear.clearValue.depthStencil, rect.rect, first, count);
    }
  });
}

}  // namespace

void reset_arena(ReplayState& state) {
  state.arena.reset();
  if (state.observed && !state.observed->commands.empty()) {
    glass::session().commands_done(&state.device);
    state.observed->commands.clear();
  }
  state.dirty = kDirtyAll;
}

void flush_pass(ReplayState& state) {
  if (state.pass) state.pass->flush();
  reset_arena(state);
  publish_queries(state);
}

void execute(ReplayState& state, const CmdBeginRenderPass& command) {
  state.instance = &command;
  state.subpass = 0;
  state.views_loaded.assign(command.render_pass->attachments.size(), 0);
  begin_subpass(state);
}

void execute(ReplayState& state, const CmdNextSubpass&) {
  if (!state.instance || state.subpass + 1 >= state.instance->render_pass->subpasses.size()) return;
  end_scope(state);
  ++state.subpass;
  begin_subpass(state);
}

void execute(ReplayState& state, const CmdEndRenderPass&) {
  if (!state.instance) return;
  end_scope(state);
  if (follows_attachments(state)) note_stores(state);
  if (follows_hazards(state)) note_sync_end(state);
  state.instance = nullptr;
}

void execute(ReplayState& state, const CmdClearAttachments& command) {
  if (!state.pass || state.suppressed) return;
  for (const VkClearAttachment& clear : command.attachments) {
    // What the last pipeline could not reach can be cleared all the same.
    const bool color = clear.aspectMask & VK_IMAGE_ASPECT_COLOR_BIT;
    if (color && state.scope.locations.location(clear.colorAttachment) == ColorLocations::kNone)
      follow_locations(state, {});
    for (const VkClearRect& rect : command.rects) clear_rect(state, clear, rect);
  }
}

}  // namespace vitrine::icd

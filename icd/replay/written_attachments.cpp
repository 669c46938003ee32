// What passes write and leave undefined (Vulkan 1.3.239, Render Pass: Load Operations, Store Operations). A draw counts
// as writing all of what its scissors leave of the attachments that its state lets it write: fragments are not
// followed.
#include <algorithm>

#include "icd/object/image.h"
#include "icd/replay/scope.h"
#include "icd/replay/sync_notes.h"
#include "icd/replay/texel_events.h"
#include "icd/replay/written.h"

namespace vitrine::icd {
namespace {

using glass::ByteState;

VkRect2D joined(const VkRect2D& a, const VkRect2D& b) {
  if (a.extent.width == 0 || a.extent.height == 0) return b;
  const auto end = [](std::int32_t offset, std::uint32_t extent) { return std::int64_t{offset} + extent; };
  const std::int32_t x = std::min(a.offset.x, b.offset.x), y = std::min(a.offset.y, b.offset.y);
  const std::int64_t x_end = std::max(end(a.offset.x, a.extent.width), end(b.offset.x, b.extent.width));
  const std::int64_t y_end = std::max(end(a.offset.y, a.extent.height), end(b.offset.y, b.extent.height));
  return {{x, y}, {static_cast<std::uint32_t>(x_end - x), static_cast<std::uint32_t>(y_end - y)}};
}

/// What both have; nothing where they are apart.
VkRect2D common(const VkRect2D& a, const VkRect2D& b) {
  const std::int64_t x = std::max(a.offset.x, b.offset.x), y = std::max(a.offset.y, b.offset.y);
  const auto end = [](std::int32_t offset, std::uint32_t extent) { return std::int64_t{offset} + extent; };
  const std::int64_t x_end = std::min(end(a.offset.x, a.extent.width), end(b.offset.x, b.extent.width));
  const std::int64_t y_end = std::min(end(a.offset.y, a.extent.height), end(b.offset.y, b.extent.height));
  if (x >= x_end || y >= y_end) return {};
  return {{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)},
          {static_cast<std::uint32_t>(x_end - x), static_cast<std::uint32_t>(y_end - y)}};
}

bool same(const VkRect2D& a, const VkRect2D& b) {
  return a.offset.x == b.offset.x && a.offset.y == b.offset.y && a.extent.width == b.extent.width &&
         a.extent.height == b.extent.height;
}

/// Calls f(first layer, layers) for those that the pass draws to.
template <class F>
void for_each_drawn_layer(const raster::PassDesc& desc, F&& f) {
  for_each_layer_range(desc.view_mask, desc.layers, f);
}

/// A draw writes `area` of an attachment; `drawn`: what earlier ones have, together.
void fill_drawn(const raster::PassDesc& desc, const texel::ImageView& view, const VkRect2D& area, VkRect2D& drawn) {
  if (!view.format || same(common(area, drawn), area)) return;
  for_each_drawn_layer(desc, [&](std::uint32_t layer, std::uint32_t layers) {
    glass::fill_shadow(view, {0, area, layer, layers}, ByteState::kWritten);
  });
  drawn = area;
}

bool writes(const raster::StencilFace& face) {
  constexpr VkStencilOp kKeep = VK_STENCIL_OP_KEEP;
  return face.write_mask != 0 && (face.fail != kKeep || face.pass != kKeep || face.depth_fail != kKeep);
}

void note_drawn(ReplayState& state) {
  ObservedPass& pass = state.observed->pass;
  const raster::State* fixed = state.draw.state;
  if (!state.pass || state.suppressed || !fixed || fixed->rasterizer_discard) return;
  const VkRect2D area = drawn_area(pass, *fixed);
  if (area.extent.width == 0) return;
  for (std::uint32_t i = 0; i < pass.desc.color_count; ++i)
    if (fixed->blend[i].write_mask != 0) fill_drawn(pass.desc, pass.desc.color[i], area, pass.drawn[i]);
  constexpr std::uint32_t kDepth = raster::kMaxColorAttachments;
  if (fixed->depth_test && fixed->depth_write) fill_drawn(pass.desc, pass.desc.depth, area, pass.drawn[kDepth]);
  if (icd::writes_stencil(*fixed)) fill_drawn(pass.desc, pass.desc.stencil, area, pass.drawn[kDepth + 1]);
}

/// Calls f(view) for what the aspects of an attachment are.
template <class F>
void for_each_aspect(const ImageView& view, VkImageAspectFlags aspects, F&& f) {
  const VkImageAspectFlags there = texel::format_desc(view.image->desc().format).aspects;
  if (!(there & (VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT))) {
    if (aspects & VK_IMAGE_ASPECT_COLOR_BIT) f(view.view);
    return;
  }
  for (const auto aspect : {VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_ASPECT_STENCIL_BIT})
    if (there & aspects & aspect) f(depth_stencil_plane(view, aspect));
}

void fill_part(const AttachmentPart& part, ByteState state) {
  if (!part.view) return;
  for_each_aspect(*part.view, part.aspects, [&](const texel::ImageView& view) {
    glass::fill_shadow(view, {0, part.area, part.layer, part.layers}, state);
  });
}

}  // namespace

VkRect2D drawn_area(const ObservedPass& pass, const raster::State& state) {
  VkRect2D area{};
  for (std::uint32_t i = 0; i < std::min(state.viewport_count, raster::kMaxViewports); ++i)
    area = joined(area, state.scissor[i]);
  return common(area, pass.desc.render_area);
}

bool writes_stencil(const raster::State& state) {
  return state.stencil_test && (writes(state.front) || writes(state.back));
}

void note_pass(ReplayState& state, const raster::PassDesc& desc) { state.observed->pass = {desc, {}}; }

void note_load(const ReplayState& state, const AttachmentPart& part, VkAttachmentLoadOp op) {
  if (!part.view) return;
  if (watches_texels(state)) note_texels_loaded(state, part, op);
  if (follows_hazards(state)) note_sync_load(state, part, op);
  if (op == VK_ATTACHMENT_LOAD_OP_CLEAR) fill_part(part, ByteState::kWritten);
  if (op == VK_ATTACHMENT_LOAD_OP_DONT_CARE) fill_part(part, discarded_state(*part.view->image));
}

void note_store(const ReplayState& state, const AttachmentPart& part, VkAttachmentStoreOp op) {
  if (watches_texels(state) && part.view) note_texels_stored(state, part, op);
  if (follows_hazards(state) && part.view) note_sync_store(state, part, op);
  if (part.view && op == VK_ATTACHMENT_STORE_OP_DONT_CARE) fill_part(part, discarded_state(*part.view->image));
}

void note_resolved(const ReplayState& state, const AttachmentPart& part, const texel::ImageView& source) {
  fill_part(part, ByteState::kWritten);
  if (follows_hazards(state)) note_sync_resolved(state, part);
  if (watches_texels(state)) note_texels_resolved(state, part, source);
}

void note_undefined(const ReplayState& state, const ImageView& view, VkImageAspectFlags aspects) {
  if (watches_texels(state) && aspects != 0)
    note_texels_undefined(state, {&view, aspects, glass::kWholeArea, 0, UINT32_MAX});
  fill_part({&view, aspects, glass::kWholeArea, 0, UINT32_MAX}, discarded_state(*view.image));
}

void note_written(ReplayState& state, const CmdClearAttachments& command) {
  if (!state.pass || state.suppressed) return;
  const raster::PassDesc& desc = state.observed->pass.desc;
  for (const VkClearAttachment& clear : command.attachments) {
    for (const VkClearRect& rect : command.rects) {
      const auto fill = [&](const texel::ImageView& view) {
        for_each_layer_range(state.scope.view_mask, rect.layerCount, [&](std::uint32_t layer, std::uint32_t layers) {
          const std::uint32_t first = state.scope.view_mask ? layer : rect.baseArrayLayer;
          glass::fill_shadow(view, {0, rect.rect, first, layers}, ByteState::kWritten);
        });
      };
      const bool color = clear.aspectMask & VK_IMAGE_ASPECT_COLOR_BIT;
      const std::uint32_t location = state.scope.locations.location(clear.colorAttachment);
      if (color && location < desc.color_count) fill(desc.color[location]);
      if (clear.aspectMask & VK_IMAGE_ASPECT_DEPTH_BIT) fill(desc.depth);
      if (clear.aspectMask & VK_IMAGE_ASPECT_STENCIL_BIT) fill(desc.stencil);
    }
  }
}

void note_written(ReplayState& state, const CmdDraw&) { note_drawn(state); }
void note_written(ReplayState& state, const CmdDrawIndexed&) { note_drawn(state); }
void note_written(ReplayState& state, const CmdDrawMulti&) { note_drawn(state); }
void note_written(ReplayState& state, const CmdDrawMultiIndexed&) { note_drawn(state); }
void note_written(ReplayState& state, const CmdDrawIndirect&) { note_drawn(state); }
void note_written(ReplayState& state, const CmdDrawByteCount&) { note_drawn(state); }

}  // namespace vitrine::icd

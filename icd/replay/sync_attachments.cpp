// What passes do to attachments, as the tool sync is told (Vulkan 1.3.239, Render Pass: Load Operations, Store
// Operations, Resolve Operations, with the stages and accesses named there). Draws count as writing what their scissors
// leave; inside of a subpass everything comes in rasterization order.
#include <algorithm>

#include "icd/object/image.h"
#include "icd/replay/scope.h"
#include "icd/replay/sync_notes.h"

namespace vitrine::icd {
namespace {

using glass::sync::Access;
using glass::sync::Stage;
using glass::sync::Tag;
using glass::sync::Use;

/// Planes of an attachment.
enum class Kind : std::uint8_t { kColor, kDepth, kStencil };

/// Of SyncedPass::areas.
constexpr std::size_t kRateSlot = raster::kMaxColorAttachments + 2;

constexpr const char* kNames[] = {"colour", "depth", "stencil"};

/// Calls f(view, kind) for what the aspects of an attachment are.
template <class F>
void for_each_plane(const ImageView& view, VkImageAspectFlags aspects, F&& f) {
  const VkImageAspectFlags there = texel::format_desc(view.image->desc().format).aspects;
  if (!(there & (VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT))) {
    if (aspects & VK_IMAGE_ASPECT_COLOR_BIT) f(view.view, Kind::kColor);
    return;
  }
  if (there & aspects & VK_IMAGE_ASPECT_DEPTH_BIT)
    f(depth_stencil_plane(view, VK_IMAGE_ASPECT_DEPTH_BIT), Kind::kDepth);
  if (there & aspects & VK_IMAGE_ASPECT_STENCIL_BIT)
    f(depth_stencil_plane(view, VK_IMAGE_ASPECT_STENCIL_BIT), Kind::kStencil);
}

Use read_of(Kind kind) {
  return kind == Kind::kColor ? Use{Stage::kColor, Access::kColorRead} : Use{Stage::kEarlyTests, Access::kDepthRead};
}
/// `stage`: of depth and stencil.
Use write_of(Kind kind, Stage stage) {
  return kind == Kind::kColor ? Use{Stage::kColor, Access::kColorWrite} : Use{stage, Access::kDepthWrite};
}

/// What one of a subpass's attachments is touched by.
struct Deed {
  Use use;
  std::uint64_t pass = 0;
  std::string what;
  Tag tag = 0;
  Tag since = ~Tag{0};
};

void touch(const ReplayState& state, Deed deed, std::vector<glass::sync::Range> ranges, std::string resource) {
  auto who = sync_who(state, std::move(deed.what), std::move(resource));
  state.observed->hazards->touch(deed.tag, {deed.use, deed.pass, std::move(ranges), std::move(who), {}, deed.since});
}

void touch_part(const ReplayState& state, const AttachmentPart& part, const texel::ImageView& plane, Deed deed) {
  std::vector<glass::sync::Range> ranges;
  add_texels(plane, {0, part.area, part.layer, part.layers}, ranges);
  touch(state, std::move(deed), std::move(ranges), sync_name(state.device, *part.view->image));
}

/// The colour attachment of a location.
std::size_t attachment_at(const DrawScope& scope, std::uint32_t location) {
  const auto& of = scope.locations.of;
  return static_cast<std::size_t>(std::find(of.begin(), of.end(), location) - of.begin());
}

/// Whether the last draw of the subpass has touched another area.
bool is_new(VkRect2D& before, const VkRect2D& area) {
  if (before.extent.width != 0 && before.offset.x == area.offset.x && before.offset.y == area.offset.y &&
      before.extent.width == area.extent.width && before.extent.height == area.extent.height)
    return false;
  before = area;
  return true;
}

/// A draw or clear writes an area of an attachment of the pass.
void touch_drawn(ReplayState& state, const texel::ImageView& plane, Kind kind, std::uint32_t slot, const VkRect2D& area,
                 const char* verb) {
  SyncedPass& synced = state.observed->synced;
  if (!plane.format) return;
  if (!is_new(synced.areas[slot], area)) return;  // an earlier draw of the subpass has written it
  synced.drawn[plane.base] = synced.number;
  std::vector<glass::sync::Range> ranges;
  const raster::PassDesc& desc = state.observed->pass.desc;
  for_each_layer_range(desc.view_mask, desc.layers, [&](std::uint32_t layer, std::uint32_t layers) {
    add_texels(plane, {0, area, layer, layers}, ranges);
  });
  std::string what = verb;
  what.append(kNames[static_cast<std::size_t>(kind)]).append(" attachment");
  if (kind == Kind::kColor) what.append(" ").append(std::to_string(attachment_at(state.scope, slot)));
  touch(state, {write_of(kind, Stage::kLateTests), synced.number, std::move(what), tag_of(state)}, std::move(ranges),
        {});
}

/// The texels of the shading rate attachment that stand for an area (Vulkan 1.3.239, Attachment Fragment Shading Rate).
void touch_rates(ReplayState& state, const raster::State& fixed, const VkRect2D& area) {
  const raster::PassDesc& desc = state.observed->pass.desc;
  if (!desc.shading_rate || fixed.rate_combiners[1] == VK_FRAGMENT_SHADING_RATE_COMBINER_OP_KEEP_KHR) return;
  const auto divide = [](std::int32_t first, std::uint32_t count, std::uint32_t size, std::int32_t& at,
                         std::uint32_t& texels) {
    const auto begin = static_cast<std::uint32_t>(first) / size;
    at = static_cast<std::int32_t>(begin);
    texels = (static_cast<std::uint32_t>(first) + count + size - 1) / size - begin;
  };
  VkRect2D texels{};
  divide(area.offset.x, area.extent.width, desc.shading_rate_texel.width, texels.offset.x, texels.extent.width);
  divide(area.offset.y, area.extent.height, desc.shading_rate_texel.height, texels.offset.y, texels.extent.height);
  if (!is_new(state.observed->synced.areas[kRateSlot], texels)) return;
  std::vector<glass::sync::Range> ranges;
  // An attachment of one layer stands for all of them.
  const bool layered = desc.shading_rate->layer_count > 1;
  for_each_layer_range(layered ? desc.view_mask : 0, layered ? desc.layers : 1,
                       [&](std::uint32_t layer, std::uint32_t layers) {
                         add_texels(*desc.shading_rate, {0, texels, layer, layers}, ranges);
                       });
  touch(state,
        {{Stage::kShadingRate, Access::kShadingRateRead},
         state.observed->synced.number,
         "read of fragment shading rate attachment",
         tag_of(state)},
        std::move(ranges), {});
}

void note_drawn(ReplayState& state) {
  const raster::State* fixed = state.draw.state;
  if (!state.pass || state.suppressed || !fixed || fixed->rasterizer_discard || !state.transients.empty()) return;
  const ObservedPass& pass = state.observed->pass;
  const VkRect2D area = drawn_area(pass, *fixed);
  if (area.extent.width == 0) return;
  touch_rates(state, *fixed, area);
  constexpr std::uint32_t kDepth = raster::kMaxColorAttachments;
  for (std::uint32_t i = 0; i < pass.desc.color_count; ++i)
    if (fixed->blend[i].write_mask != 0) touch_drawn(state, pass.desc.color[i], Kind::kColor, i, area, "write of ");
  if (fixed->depth_test && fixed->depth_write)
    touch_drawn(state, pass.desc.depth, Kind::kDepth, kDepth, area, "write of ");
  if (writes_stencil(*fixed)) touch_drawn(state, pass.desc.stencil, Kind::kStencil, kDepth + 1, area, "write of ");
}

}  // namespace

void note_sync_load(const ReplayState& state, const AttachmentPart& part, VkAttachmentLoadOp op) {
  if (op == VK_ATTACHMENT_LOAD_OP_NONE_EXT) return;
  SyncedPass& synced = state.observed->synced;
  const bool reads = op == VK_ATTACHMENT_LOAD_OP_LOAD;
  const char* const text = reads                               ? " attachment by load op LOAD"
                           : op == VK_ATTACHMENT_LOAD_OP_CLEAR ? " attachment by load op CLEAR"
                                                               : " attachment by load op DONT_CARE";
  for_each_plane(*part.view, part.aspects, [&](const texel::ImageView& plane, Kind kind) {
    if (!reads) synced.drawn[plane.base] = synced.number;
    std::string what = reads ? "read of " : "write of ";
    what.append(kNames[static_cast<std::size_t>(kind)]).append(text);
    const Use use = reads ? read_of(kind) : write_of(kind, Stage::kEarlyTests);
    touch_part(state, part, plane, {use, synced.number, std::move(what), tag_of(state)});
  });
}

void note_sync_store(const ReplayState& state, const AttachmentPart& part, VkAttachmentStoreOp op) {
  if (op == VK_ATTACHMENT_STORE_OP_NONE) return;
  for_each_plane(*part.view, part.aspects, [&](const texel::ImageView& plane, Kind kind) {
    // What nothing has written is not written back.
    const SyncedPass& synced = state.observed->synced;
    const auto found = synced.drawn.find(plane.base);
    if (found == synced.drawn.end()) return;
    std::string what = "write of ";
    what.append(kNames[static_cast<std::size_t>(kind)]).append(" attachment by its store op");
    touch_part(state, part, plane,
               {write_of(kind, Stage::kLateTests), found->second, std::move(what), tag_of(state), synced.begin});
  });
}

void note_sync_resolved(const ReplayState& state, const AttachmentPart& part) {
  SyncedPass& synced = state.observed->synced;
  // Depth and stencil are resolved in the stage of colours, too; and all before the dependencies of the next subpass.
  const Tag tag = tag_of(state, glass::sync::Part::kBefore) - 1;
  for_each_plane(*part.view, part.aspects, [&](const texel::ImageView& plane, Kind kind) {
    synced.drawn[plane.base] = synced.number;
    std::string what = "write of ";
    what.append(kNames[static_cast<std::size_t>(kind)]).append(" attachment by its resolve");
    touch_part(state, part, plane, {{Stage::kColor, Access::kColorWrite}, synced.number, std::move(what), tag});
  });
}

void note_sync(ReplayState& state, const CmdDraw&) { note_drawn(state); }
void note_sync(ReplayState& state, const CmdDrawIndexed&) { note_drawn(state); }
void note_sync(ReplayState& state, const CmdDrawMulti&) { note_drawn(state); }
void note_sync(ReplayState& state, const CmdDrawMultiIndexed&) { note_drawn(state); }

void note_sync(ReplayState& state, const CmdClearAttachments& command) {
  if (!state.pass || state.suppressed || !state.transients.empty()) return;
  const raster::PassDesc& desc = state.observed->pass.desc;
  constexpr std::uint32_t kDepth = raster::kMaxColorAttachments;
  for (const VkClearAttachment& clear : command.attachments) {
    for (const VkClearRect& rect : command.rects) {
      const std::uint32_t location = state.scope.locations.location(clear.colorAttachment);
      if ((clear.aspectMask & VK_IMAGE_ASPECT_COLOR_BIT) && location < desc.color_count)
        touch_drawn(state, desc.color[location], Kind::kColor, location, rect.rect, "clear of ");
      if (clear.aspectMask & VK_IMAGE_ASPECT_DEPTH_BIT)
        touch_drawn(state, desc.depth, Kind::kDepth, kDepth, rect.rect, "clear of ");
      if (clear.aspectMask & VK_IMAGE_ASPECT_STENCIL_BIT)
        touch_drawn(state, desc.stencil, Kind::kStencil, kDepth + 1, rect.rect, "clear of ");
    }
  }
}

}  // namespace vitrine::icd

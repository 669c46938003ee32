// What passes do to watched texels (Vulkan 1.3.239, Render Pass: Load Operations, Store Operations). Fragments are told
// of where they are drawn (glass/pixel/pass.h).
#include "icd/replay/texel_events.h"

#include "icd/object/image.h"
#include "icd/replay/scope.h"

namespace vitrine::icd {
namespace {

using TexelEvent = glass::pixel::Event;
using glass::pixel::EventKind;
using glass::pixel::Texel;
using glass::pixel::TexelId;

bool contains(const VkRect2D& area, const TexelId& id) {
  const auto inside = [](std::int64_t at, std::int64_t first, std::int64_t size) {
    return at >= first && at - first < size;
  };
  return inside(id.x, area.offset.x, area.extent.width) && inside(id.y, area.offset.y, area.extent.height);
}

/// The layer of the attachment's view that a texel is in: a slice of a 3D image.
std::int64_t layer_in(const ImageView& view, const TexelId& id) {
  const bool slices = view.image->desc().type == VK_IMAGE_TYPE_3D;
  return std::int64_t{slices ? id.slice : id.layer} - view.range.baseArrayLayer;
}

/// Calls f(texel) for the watched texels of a part of an attachment.
template <class F>
void for_each_texel(const ReplayState& state, const AttachmentPart& part, F&& f) {
  for (Texel* texel : state.observed->pixels->texels_of(part.view->image)) {
    const std::int64_t layer = layer_in(*part.view, texel->id) - part.layer;
    const bool inside = texel->id.level == part.view->range.baseMipLevel && (part.aspects & texel->id.aspect) != 0 &&
                        layer >= 0 && layer < part.layers && contains(part.area, texel->id);
    if (inside) f(*texel);
  }
}

/// Whether a clear names the attachment of a slot.
bool names_slot(const DrawScope& scope, const VkClearAttachment& clear, std::uint32_t slot) {
  if (slot == glass::pixel::kDepthSlot) return (clear.aspectMask & VK_IMAGE_ASPECT_DEPTH_BIT) != 0;
  if (slot == glass::pixel::kStencilSlot) return (clear.aspectMask & VK_IMAGE_ASPECT_STENCIL_BIT) != 0;
  return (clear.aspectMask & VK_IMAGE_ASPECT_COLOR_BIT) != 0 && scope.locations.location(clear.colorAttachment) == slot;
}

bool is_cleared(const ReplayState& state, const CmdClearAttachments& command, const glass::pixel::PassTexel& at) {
  for (const VkClearAttachment& clear : command.attachments) {
    for (const VkClearRect& rect : command.rects) {
      const bool layered = state.scope.view_mask != 0
                               ? (state.scope.view_mask >> at.layer & 1) != 0
                               : at.layer >= rect.baseArrayLayer && at.layer - rect.baseArrayLayer < rect.layerCount;
      if (layered && names_slot(state.scope, clear, at.slot) && contains(rect.rect, at.texel->id)) return true;
    }
  }
  return false;
}

}  // namespace

TexelEvent texel_event(const ReplayState& state, EventKind kind, std::string text) {
  const ObservedReplay& observed = *state.observed;
  TexelEvent event;
  event.kind = kind;
  event.text = std::move(text);
  event.address = address_of(observed);
  event.replaces = kind != EventKind::kLoad;
  return event;
}

void begin_watched_pass(ReplayState& state, const raster::PassDesc& desc) {
  state.observed->pixel_pass = glass::pixel::PassPixels::make(*state.observed->pixels, desc);
}

void note_texels_loaded(const ReplayState& state, const AttachmentPart& part, VkAttachmentLoadOp op) {
  const bool clears = op == VK_ATTACHMENT_LOAD_OP_CLEAR;
  const bool given_up = op == VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  const EventKind kind = clears ? EventKind::kClear : given_up ? EventKind::kUndefined : EventKind::kLoad;
  const char* const text = clears     ? "cleared by load op CLEAR"
                           : given_up ? "undefined by load op DONT_CARE"
                                      : "kept by the load op";
  for_each_texel(state, part, [&](Texel& texel) { state.observed->loaded.push_back({&texel, kind, text}); });
}

void note_texels_undefined(const ReplayState& state, const AttachmentPart& part) {
  for_each_texel(state, part, [&](Texel& texel) {
    state.observed->loaded.push_back({&texel, EventKind::kUndefined, "undefined by the initial layout UNDEFINED"});
  });
}

void finish_loads(ReplayState& state) {
  std::vector<LoadedTexel>& loaded = state.observed->loaded;
  if (loaded.empty()) return;
  flush_pass(state);
  glass::pixel::Pixels& pixels = *state.observed->pixels;
  for (const LoadedTexel& one : loaded) {
    // What comes before a clear in the list has seen what was there before it.
    TexelEvent event = texel_event(state, one.kind, one.text);
    if (one.kind == EventKind::kClear)
      pixels.add(*one.texel, std::move(event));
    else
      pixels.add_unchanged(*one.texel, std::move(event));
  }
  loaded.clear();
}

void note_texels_stored(const ReplayState& state, const AttachmentPart& part, VkAttachmentStoreOp op) {
  if (op != VK_ATTACHMENT_STORE_OP_DONT_CARE) return;
  for_each_texel(state, part, [&](Texel& texel) {
    state.observed->pixels->add(texel, texel_event(state, EventKind::kUndefined, "undefined by store op DONT_CARE"));
  });
}

void note_texels_resolved(const ReplayState& state, const AttachmentPart& part, const texel::ImageView& source) {
  for_each_texel(state, part, [&](Texel& texel) {
    TexelEvent event = texel_event(state, EventKind::kResolve, "resolved from the samples of an attachment");
    const std::int64_t layer = layer_in(*part.view, texel.id);
    for (std::uint32_t s = 0; layer < source.layer_count && s < source.samples; ++s) {
      const std::byte* const block = source.block(0, static_cast<std::uint32_t>(layer), s, texel.id.x, texel.id.y, 0);
      event.sources.push_back(
          state.observed->pixels->source_at(block, *source.format, 1 / static_cast<float>(source.samples)));
    }
    state.observed->pixels->add(texel, std::move(event));
  });
}

void note_texels(ReplayState& state, const CmdClearAttachments& command) {
  const std::shared_ptr<glass::pixel::PassPixels> pass = state.observed->pixel_pass;
  if (!state.pass || state.suppressed || !pass) return;
  std::vector<Texel*> cleared;
  for (const glass::pixel::PassTexel& at : pass->texels())
    if (is_cleared(state, command, at)) cleared.push_back(at.texel);
  if (cleared.empty()) return;
  flush_pass(state);
  for (Texel* texel : cleared) state.observed->pixels->add(*texel, texel_event(state, EventKind::kClear, "cleared"));
}

}  // namespace vitrine::icd

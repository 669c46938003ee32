// Dependencies as the tool sync is told of them: barriers, events, subpass dependencies and the layout transitions that
// they have (Vulkan 1.3.239, Synchronization and Cache Control; Render Pass: Subpass Dependencies).
#include <algorithm>

#include "icd/edge/diagnostics.h"
#include "icd/object/memory.h"
#include "icd/object/sync.h"
#include "icd/replay/sync_notes.h"

namespace vitrine::icd {
namespace {

using glass::sync::Barrier;
using glass::sync::Part;

constexpr VkAccessFlags2 kAttachmentAccesses =
    VK_ACCESS_2_INPUT_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT |
    VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT |
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
constexpr SubpassDependency kImplicitFirst{
    VK_SUBPASS_EXTERNAL, 0, VK_PIPELINE_STAGE_2_NONE, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, 0, kAttachmentAccesses};
constexpr SubpassDependency kImplicitLast{
    0, VK_SUBPASS_EXTERNAL, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_2_NONE, kAttachmentAccesses, 0};

std::shared_ptr<const glass::sync::Who> transition_of(const ReplayState& state, const Image& image, VkImageLayout from,
                                                      VkImageLayout to) {
  std::string what = "layout transition from ";
  what.append(layout_text(from)).append(" to ").append(layout_text(to));
  return sync_who(state, std::move(what), sync_name(state.device, image));
}

Barrier barrier_of(const ReplayState& state, const RecordedBarrier& b) {
  Barrier out;
  out.first = glass::sync::first_scope(b.first_stages, b.first_accesses);
  out.second = glass::sync::second_scope(b.second_stages, b.second_accesses);
  out.is_global = !b.buffer && !b.image;
  if (b.buffer && b.buffer->data) {
    const auto first = reinterpret_cast<std::uintptr_t>(b.buffer->data) + b.offset;
    append(out.ranges, first, first + b.buffer->resolve_range(b.offset, b.size));
  }
  if (b.image) {
    add_subresources(*b.image, b.range, out.ranges);
    if (b.from != b.to) out.who = transition_of(state, *b.image, b.from, b.to);
  }
  return out;
}

Barrier barrier_of(const SubpassDependency& d) {
  Barrier out;
  out.first = glass::sync::first_scope(d.first_stages, d.first_accesses);
  out.second = glass::sync::second_scope(d.second_stages, d.second_accesses);
  out.is_global = true;
  return out;
}

/// The dependencies of a render pass that end at a subpass, but for those that begin there.
std::vector<Barrier> dependencies_to(const RenderPass& pass, std::uint32_t subpass) {
  std::vector<Barrier> barriers;
  for (const SubpassDependency& d : pass.dependencies)
    if (d.second == subpass && d.first != subpass) barriers.push_back(barrier_of(d));
  return barriers;
}

void change_layout(const ReplayState& state, const Image& image, const VkImageSubresourceRange& range,
                   VkImageLayout from, VkImageLayout to) {
  // From UNDEFINED to UNDEFINED there is no transition (Vulkan 1.3.239, Image Layout Transitions), nor a new layout.
  if (from == VK_IMAGE_LAYOUT_UNDEFINED && to == from) return;
  use_layout(state, image, range, from);
  set_layout(state, image, range, to);
}

/// Adds the transition of an attachment, a part of the dependencies that are there.
void add_transition(const ReplayState& state, const ImageView* view, VkImageAspectFlags aspects, VkImageLayout from,
                    VkImageLayout to, std::span<const Barrier> sides, std::vector<Barrier>& transitions) {
  if (!view) return;
  VkImageSubresourceRange range = view->range;
  range.aspectMask = texel::format_desc(view->image->desc().format).aspects & aspects;
  if (range.aspectMask != 0) change_layout(state, *view->image, range, from, to);
  if (from == to) return;
  Barrier out;
  for (const Barrier& side : sides) out.more.emplace_back(side.first, side.second);
  add_subresources(*view->image, range, out.ranges);
  out.who = transition_of(state, *view->image, from, to);
  if (!out.ranges.empty()) transitions.push_back(std::move(out));
}

constexpr VkImageAspectFlags kStencil = VK_IMAGE_ASPECT_STENCIL_BIT;

void add_transitions(const ReplayState& state, std::uint32_t attachment, const AttachmentLayout& from,
                     const AttachmentLayout& to, std::span<const Barrier> sides, std::vector<Barrier>& transitions) {
  const auto& views = state.instance->attachments;
  const ImageView* view = attachment < views.size() ? views[attachment] : nullptr;
  add_transition(state, view, ~kStencil, from.main, to.main, sides, transitions);
  add_transition(state, view, kStencil, from.stencil, to.stencil, sides, transitions);
}

/// The layout of an attachment behind the subpasses before `end`; null: none of them uses it.
const AttachmentLayout* layout_before(const RenderPass& pass, std::uint32_t end, std::uint32_t attachment) {
  const AttachmentLayout* layout = nullptr;
  for (std::uint32_t s = 0; s < end; ++s)
    for (const AttachmentReference& r : pass.subpasses[s].layouts)
      if (r.attachment == attachment) layout = &r.layout;
  return layout;
}

/// Dependencies and transitions are one: what comes in front of transitions does not see them.
void depend(ReplayState& state, Part part, std::vector<Barrier> sides, std::vector<Barrier> transitions) {
  std::ranges::move(transitions, std::back_inserter(sides));
  state.observed->hazards->depend(tag_of(state, part), sides);
}

}  // namespace

void note_sync(ReplayState& state, const CmdDependency& command) {
  using Kind = CmdDependency::Kind;
  glass::sync::Hazards& hazards = *state.observed->hazards;
  state.observed->synced.areas.fill({});
  std::vector<Barrier> barriers;
  for (const RecordedBarrier& b : command.barriers) {
    barriers.push_back(barrier_of(state, b));
    if (b.image && command.kind != Kind::kSetEvent) change_layout(state, *b.image, b.range, b.from, b.to);
  }
  const glass::sync::Tag tag = tag_of(state, Part::kBefore);
  if (command.kind == Kind::kBarrier) return hazards.depend(tag, barriers);
  if (command.kind == Kind::kSetEvent) {
    glass::sync::Scope first;
    for (const Barrier& b : barriers) {
      first.executed |= b.first.executed;
      first.accessed |= b.first.accessed;
      first.accesses |= b.first.accesses;
    }
    return hazards.set_event(&from_handle<Event>(command.events[0]), tag, first);
  }
  std::vector<const void*> events;
  for (const VkEvent event : command.events) events.push_back(&from_handle<Event>(event));
  hazards.wait_events(events, tag, barriers);
}

void note_sync_subpass(ReplayState& state) {
  SyncedPass& synced = state.observed->synced;
  if (state.subpass == 0) {
    synced.drawn.clear();
    synced.begin = tag_of(state);
  }
  ++synced.number;
  synced.areas.fill({});
  const RenderPass& pass = *state.instance->render_pass;
  std::vector<Barrier> sides = dependencies_to(pass, state.subpass), transitions;
  const bool external = std::ranges::any_of(pass.dependencies, [&](const SubpassDependency& d) {
    return d.first == VK_SUBPASS_EXTERNAL && d.second == state.subpass;
  });
  std::vector<Barrier> first_sides = sides;
  if (!external) first_sides.push_back(barrier_of(kImplicitFirst));
  std::vector<std::uint32_t> seen;
  for (const AttachmentReference& r : pass.subpasses[state.subpass].layouts) {
    if (std::ranges::find(seen, r.attachment) != seen.end()) continue;
    seen.push_back(r.attachment);
    const AttachmentLayout* before = layout_before(pass, state.subpass, r.attachment);
    if (!before)
      add_transitions(state, r.attachment, pass.attachments[r.attachment].initial, r.layout, first_sides, transitions);
    else
      add_transitions(state, r.attachment, *before, r.layout, sides, transitions);
  }
  depend(state, Part::kBefore, external || transitions.empty() ? std::move(sides) : std::move(first_sides),
         std::move(transitions));
}

void note_sync_end(ReplayState& state) {
  const RenderPass& pass = *state.instance->render_pass;
  std::vector<Barrier> sides = dependencies_to(pass, VK_SUBPASS_EXTERNAL), transitions;
  std::vector<Barrier> last_sides = sides;
  if (last_sides.empty()) last_sides.push_back(barrier_of(kImplicitLast));
  const auto subpasses = static_cast<std::uint32_t>(pass.subpasses.size());
  for (std::uint32_t i = 0; i < pass.attachments.size(); ++i)
    if (const AttachmentLayout* before = layout_before(pass, subpasses, i))
      add_transitions(state, i, *before, pass.attachments[i].final, last_sides, transitions);
  depend(state, Part::kBehind, std::move(last_sides), std::move(transitions));
}

}  // namespace vitrine::icd

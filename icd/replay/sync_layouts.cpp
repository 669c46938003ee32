// Layouts that commands say images have, held against those that they have (Vulkan 1.3.239, Image Layouts).
#include "icd/object/image.h"
#include "icd/replay/sync_notes.h"

namespace vitrine::icd {

glass::sync::ImagePart part_of(const Image& image, const VkImageSubresourceRange& range) {
  return {&image, image.desc().levels, image.desc().layers, resolve_range(image, range)};
}

std::string layout_text(VkImageLayout layout) {
  switch (layout) {
#define LAYOUT(name)           \
  case VK_IMAGE_LAYOUT_##name: \
    return #name;
    LAYOUT(UNDEFINED)
    LAYOUT(GENERAL)
    LAYOUT(COLOR_ATTACHMENT_OPTIMAL)
    LAYOUT(DEPTH_STENCIL_ATTACHMENT_OPTIMAL)
    LAYOUT(DEPTH_STENCIL_READ_ONLY_OPTIMAL)
    LAYOUT(SHADER_READ_ONLY_OPTIMAL)
    LAYOUT(TRANSFER_SRC_OPTIMAL)
    LAYOUT(TRANSFER_DST_OPTIMAL)
    LAYOUT(PREINITIALIZED)
    LAYOUT(DEPTH_ATTACHMENT_OPTIMAL)
    LAYOUT(DEPTH_READ_ONLY_OPTIMAL)
    LAYOUT(STENCIL_ATTACHMENT_OPTIMAL)
    LAYOUT(STENCIL_READ_ONLY_OPTIMAL)
    LAYOUT(READ_ONLY_OPTIMAL)
    LAYOUT(ATTACHMENT_OPTIMAL)
    LAYOUT(PRESENT_SRC_KHR)
    LAYOUT(ATTACHMENT_FEEDBACK_LOOP_OPTIMAL_EXT)
#ifdef VK_KHR_dynamic_rendering_local_read
    LAYOUT(RENDERING_LOCAL_READ_KHR)
#endif
#undef LAYOUT
    default:
      return std::to_string(static_cast<int>(layout));
  }
}

void use_layout(const ReplayState& state, const Image& image, const VkImageSubresourceRange& range,
                VkImageLayout layout) {
  glass::sync::Hazards& hazards = *state.observed->hazards;
  const auto other = hazards.layouts().other_than(part_of(image, range), layout);
  if (!other) return;
  const std::shared_ptr<glass::sync::Who> who = sync_who(state, "use", sync_name(state.device, image));
  glass::Finding finding;
  finding.rule = &glass::rule("sync-wrong-layout");
  finding.address = who->address;
  finding.message.append("use of ").append(who->resource).append(" in layout ").append(layout_text(layout));
  finding.message.append(": it has layout ").append(layout_text(*other));
  finding.remedy = "a VkImageMemoryBarrier2 with\n        .oldLayout = VK_IMAGE_LAYOUT_";
  finding.remedy.append(layout_text(*other)).append(",\n        .newLayout = VK_IMAGE_LAYOUT_");
  finding.remedy.append(layout_text(layout)).append(",");
  hazards.report(tag_of(state), finding);
}

void set_layout(const ReplayState& state, const Image& image, const VkImageSubresourceRange& range,
                VkImageLayout layout) {
  state.observed->hazards->layouts().set(part_of(image, range), layout);
}

void execute(ReplayState&, const CmdUsedLayouts&) {}

void note_sync(ReplayState& state, const CmdUsedLayouts& command) {
  for (const UsedLayout& used : command.images) use_layout(state, *used.image, used.range, used.layout);
}

void note_sync_rendering(ReplayState& state, const CmdBeginRendering& command) {
  SyncedPass& synced = state.observed->synced;
  synced.drawn.clear();
  synced.begin = tag_of(state);
  synced.areas.fill({});
  ++synced.number;
  const auto use = [&](const RenderingAttachment& attachment, VkImageAspectFlags aspects) {
    for (const auto& [view, layout] :
         {std::pair(attachment.view, attachment.layout), std::pair(attachment.resolve, attachment.resolve_layout)}) {
      if (!view) continue;
      VkImageSubresourceRange range = view->range;
      range.aspectMask = aspects;
      use_layout(state, *view->image, range, layout);
    }
  };
  for (const RenderingAttachment& color : command.colors) use(color, VK_IMAGE_ASPECT_COLOR_BIT);
  use(command.depth, VK_IMAGE_ASPECT_DEPTH_BIT);
  use(command.stencil, VK_IMAGE_ASPECT_STENCIL_BIT);
}

}  // namespace vitrine::icd

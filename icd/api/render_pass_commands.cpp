// Recording render pass instances (Vulkan 1.3.239, Render Pass: Render Pass Commands).
#include "icd/command_buffer.h"
#include "icd/entry_points.h"
#include "icd/render_pass.h"
#include "icd/util.h"

namespace vitrine::icd {
namespace {

// Rough nanoseconds to clear and write back one pixel of a pass.
constexpr std::uint64_t kPixelsPerNanosecond = 4;

}  // namespace

namespace entry {

VKAPI_ATTR void VKAPI_CALL CmdBeginRenderPass(VkCommandBuffer buffer, const VkRenderPassBeginInfo* begin,
                                              VkSubpassContents contents) {
  VkSubpassBeginInfo info = make_struct<VkSubpassBeginInfo>();
  info.contents = contents;
  CmdBeginRenderPass2(buffer, begin, &info);
}

VKAPI_ATTR void VKAPI_CALL CmdBeginRenderPass2(VkCommandBuffer buffer, const VkRenderPassBeginInfo* begin,
                                               const VkSubpassBeginInfo*) {
  CommandBuffer& b = from_handle<CommandBuffer>(buffer);
  const Framebuffer& framebuffer = from_handle<Framebuffer>(begin->framebuffer);
  icd::CmdBeginRenderPass command{};
  command.render_pass = &from_handle<RenderPass>(begin->renderPass);
  command.framebuffer = &framebuffer;
  command.area = begin->renderArea;
  command.clear_values = b.arena.copy_array(begin->pClearValues, begin->clearValueCount);
  if (const auto* late = find_in_chain<VkRenderPassAttachmentBeginInfo>(begin->pNext); late && late->attachmentCount) {
    const auto views = b.arena.add_array<const ImageView*>(late->attachmentCount);
    for (std::uint32_t i = 0; i < late->attachmentCount; ++i) {
      views[i] = from_nullable<ImageView>(late->pAttachments[i]);
    }
    command.attachments = views;
  } else {
    command.attachments = framebuffer.attachments;
  }
  record(b, command);
  b.pass_pixels = std::uint64_t{begin->renderArea.extent.width} * begin->renderArea.extent.height * framebuffer.layers;
  b.cost += 1000 + b.pass_pixels / kPixelsPerNanosecond;
}

VKAPI_ATTR void VKAPI_CALL CmdNextSubpass(VkCommandBuffer buffer, VkSubpassContents) {
  record(buffer, icd::CmdNextSubpass{});
}

VKAPI_ATTR void VKAPI_CALL CmdNextSubpass2(VkCommandBuffer buffer, const VkSubpassBeginInfo*, const VkSubpassEndInfo*) {
  record(buffer, icd::CmdNextSubpass{});
}

VKAPI_ATTR void VKAPI_CALL CmdEndRenderPass(VkCommandBuffer buffer) { record(buffer, icd::CmdEndRenderPass{}); }

VKAPI_ATTR void VKAPI_CALL CmdEndRenderPass2(VkCommandBuffer buffer, const VkSubpassEndInfo*) {
  record(buffer, icd::CmdEndRenderPass{});
}

}  // namespace entry
}  // namespace vitrine::icd

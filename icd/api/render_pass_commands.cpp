// Recording render pass instances (Vulkan 1.3.239, Render Pass: Render Pass Commands).
#include "icd/edge/util.h"
#include "icd/entry_points.h"
#include "icd/object/render_pass.h"
#include "icd/record/command_buffer.h"

namespace vitrine::icd {
namespace {

// Rough nanoseconds to clear and write back one pixel of a pass.
constexpr std::uint64_t kPixelsPerNanosecond = 4;

void add_cost(CommandBuffer& buffer, const VkRect2D& area, std::uint32_t layers) {
  buffer.pass_pixels = std::uint64_t{area.extent.width} * area.extent.height * layers;
  buffer.cost += 1000 + buffer.pass_pixels / kPixelsPerNanosecond;
}

RenderingAttachment make_attachment(const VkRenderingAttachmentInfo* info) {
  RenderingAttachment out{};
  if (!info) return out;
  out.view = from_nullable<ImageView>(info->imageView);
  out.resolve_mode = info->resolveMode;
  if (info->resolveMode != VK_RESOLVE_MODE_NONE) out.resolve = from_nullable<ImageView>(info->resolveImageView);
  out.load = info->loadOp;
  out.store = info->storeOp;
  out.clear = info->clearValue;
  out.layout = info->imageLayout;
  out.resolve_layout = info->resolveImageLayout;
  return out;
}

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
  add_cost(b, begin->renderArea, framebuffer.layers);
}

VKAPI_ATTR void VKAPI_CALL CmdBeginRendering(VkCommandBuffer buffer, const VkRenderingInfo* info) {
  CommandBuffer& b = from_handle<CommandBuffer>(buffer);
  const auto colors = b.arena.add_array<RenderingAttachment>(info->colorAttachmentCount);
  for (std::uint32_t i = 0; i < info->colorAttachmentCount; ++i) {
    colors[i] = make_attachment(&info->pColorAttachments[i]);
  }
  const auto* rates = find_in_chain<VkRenderingFragmentShadingRateAttachmentInfoKHR>(info->pNext);
  record(b, icd::CmdBeginRendering{info->flags, info->renderArea, info->layerCount, info->viewMask,
                                   forced_samples(info->pNext), colors, make_attachment(info->pDepthAttachment),
                                   make_attachment(info->pStencilAttachment),
                                   rates ? from_nullable<ImageView>(rates->imageView) : nullptr,
                                   rates ? rates->shadingRateAttachmentTexelSize : VkExtent2D{}});
  add_cost(b, info->renderArea, info->layerCount);
}

VKAPI_ATTR void VKAPI_CALL CmdEndRendering(VkCommandBuffer buffer) { record(buffer, icd::CmdEndRendering{}); }

#ifdef VK_KHR_dynamic_rendering_local_read
// Both "must match the mappings provided to the bound pipeline" (Vulkan 1.4.309, vkCmdSetRenderingAttachmentLocations
// and vkCmdSetRenderingInputAttachmentIndices): draws take the locations from there, but those of shader objects; and
// input attachments from their descriptors, whatever index they have.
VKAPI_ATTR void VKAPI_CALL CmdSetRenderingAttachmentLocationsKHR(
    [[maybe_unused]] VkCommandBuffer buffer, [[maybe_unused]] const VkRenderingAttachmentLocationInfoKHR* info) {
#ifdef VK_EXT_shader_object
  record(buffer, icd::CmdSetColorLocations{color_locations(info)});
#endif
}

VKAPI_ATTR void VKAPI_CALL CmdSetRenderingInputAttachmentIndicesKHR(VkCommandBuffer,
                                                                    const VkRenderingInputAttachmentIndexInfoKHR*) {}
#endif

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

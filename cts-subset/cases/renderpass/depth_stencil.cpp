// Depth/stencil attachments of render pass 2: resolves, and layouts per aspect.
#include "cases/common/colored_vertices.h"
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

VkAttachmentDescription2 describe(const Image& image, VkAttachmentLoadOp load) {
  VkAttachmentDescription2 result{VK_STRUCTURE_TYPE_ATTACHMENT_DESCRIPTION_2};
  result.format = image.spec.format;
  result.samples = image.spec.samples;
  result.loadOp = result.stencilLoadOp = load;
  result.storeOp = result.stencilStoreOp = VK_ATTACHMENT_STORE_OP_STORE;
  result.initialLayout = result.finalLayout = VK_IMAGE_LAYOUT_GENERAL;
  return result;
}

VkAttachmentReference2 reference(uint32_t attachment, VkImageAspectFlags aspects) {
  return {VK_STRUCTURE_TYPE_ATTACHMENT_REFERENCE_2, nullptr, attachment, VK_IMAGE_LAYOUT_GENERAL, aspects};
}

/// Draws random triangles with depth and stencil writes.
VkPipeline triangles(Run& run, VkRenderPass pass, VkExtent2D extent, VkSampleCountFlagBits samples) {
  GraphicsSpec spec;
  spec.vertex = kColorVertex;
  spec.floats({4, 4});
  spec.depth.depthTestEnable = spec.depth.depthWriteEnable = spec.depth.stencilTestEnable = VK_TRUE;
  spec.depth.front = spec.depth.back = {
      VK_STENCIL_OP_INVERT, VK_STENCIL_OP_INCREMENT_AND_WRAP, VK_STENCIL_OP_KEEP, VK_COMPARE_OP_ALWAYS, 0xff, 0xff, 1};
  return make_pipeline(run, spec, pass, 0, 0, extent, samples);
}

Buffer random_triangles(Run& run) { return run.buffer_of(random_colored_vertices(run.random, 30)); }

void draw(Run& run, VkRenderPass pass, VkFramebuffer framebuffer, VkExtent2D extent, VkPipeline pipeline) {
  const Buffer vertices = random_triangles(run);
  run.once([&](VkCommandBuffer cmd) {
    const VkClearValue clears[2] = {clear_value(VK_FORMAT_D24_UNORM_S8_UINT, 0.9f, 0.25f, 0, 0), {}};
    VkRenderPassBeginInfo begin{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
    begin.renderPass = pass;
    begin.framebuffer = framebuffer;
    begin.renderArea = {{0, 0}, extent};
    begin.clearValueCount = 2;
    begin.pClearValues = clears;
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, vertices);
    vkCmdDraw(cmd, 30, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
}

void depth_stencil_resolve(Run& run, VkFormat format) {
  run.require(run.gpu.has("VK_KHR_depth_stencil_resolve"), "VK_KHR_depth_stencil_resolve");
  constexpr VkExtent2D kExtent{71, 53};
  ImageSpec spec;
  spec.format = format;
  spec.extent = {kExtent.width, kExtent.height, 1};
  spec.samples = VK_SAMPLE_COUNT_4_BIT;
  spec.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
  const Image source = run.image(spec);
  spec.samples = VK_SAMPLE_COUNT_1_BIT;
  const Image target = run.image(spec);
  const VkAttachmentDescription2 attachments[2] = {describe(source, VK_ATTACHMENT_LOAD_OP_CLEAR),
                                                   describe(target, VK_ATTACHMENT_LOAD_OP_DONT_CARE)};
  const VkAttachmentReference2 from = reference(0, source.aspects()), to = reference(1, target.aspects());
  VkSubpassDescriptionDepthStencilResolve resolve{VK_STRUCTURE_TYPE_SUBPASS_DESCRIPTION_DEPTH_STENCIL_RESOLVE};
  const bool depth = source.aspects() & VK_IMAGE_ASPECT_DEPTH_BIT,
             stencil = source.aspects() & VK_IMAGE_ASPECT_STENCIL_BIT;
  resolve.depthResolveMode = depth ? VK_RESOLVE_MODE_SAMPLE_ZERO_BIT : VK_RESOLVE_MODE_NONE;
  resolve.stencilResolveMode = stencil ? VK_RESOLVE_MODE_SAMPLE_ZERO_BIT : VK_RESOLVE_MODE_NONE;
  resolve.pDepthStencilResolveAttachment = &to;
  VkSubpassDescription2 subpass{VK_STRUCTURE_TYPE_SUBPASS_DESCRIPTION_2, &resolve};
  subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  subpass.pDepthStencilAttachment = &from;
  VkRenderPassCreateInfo2 info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO_2};
  info.attachmentCount = 2;
  info.pAttachments = attachments;
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  VkRenderPass pass;
  CTS_VK(CTS_COMMAND(run.gpu, CreateRenderPass2KHR)(run.device, &info, nullptr, &pass));
  run.own(pass, vkDestroyRenderPass);
  const VkFramebuffer framebuffer = make_framebuffer(run, pass, {source.view, target.view}, kExtent);
  draw(run, pass, framebuffer, kExtent, triangles(run, pass, kExtent, VK_SAMPLE_COUNT_4_BIT));
  run.out("resolved", target);
}
CTS_CASE("renderpass", "depth_stencil_resolve.d24_s8") { depth_stencil_resolve(run, VK_FORMAT_D24_UNORM_S8_UINT); }
CTS_CASE("renderpass", "depth_stencil_resolve.d32_s8") { depth_stencil_resolve(run, VK_FORMAT_D32_SFLOAT_S8_UINT); }

/// Depth and stencil of one image in layouts of their own, before, in and after the pass.
CTS_CASE("renderpass", "separate_depth_stencil_layouts") {
  run.require(run.gpu.extension_features.separateDepthStencilLayouts, "separateDepthStencilLayouts");
  constexpr VkExtent2D kExtent{64, 40};
  ImageSpec spec;
  spec.format = VK_FORMAT_D24_UNORM_S8_UINT;
  spec.extent = {kExtent.width, kExtent.height, 1};
  spec.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
  const Image image = run.image(spec);
  VkAttachmentDescriptionStencilLayout stencil{VK_STRUCTURE_TYPE_ATTACHMENT_DESCRIPTION_STENCIL_LAYOUT};
  stencil.stencilInitialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
  stencil.stencilFinalLayout = VK_IMAGE_LAYOUT_GENERAL;
  VkAttachmentDescription2 attachment = describe(image, VK_ATTACHMENT_LOAD_OP_CLEAR);
  attachment.pNext = &stencil;
  attachment.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
  VkAttachmentReferenceStencilLayout stencil_reference{VK_STRUCTURE_TYPE_ATTACHMENT_REFERENCE_STENCIL_LAYOUT};
  stencil_reference.stencilLayout = VK_IMAGE_LAYOUT_STENCIL_ATTACHMENT_OPTIMAL;
  VkAttachmentReference2 use = reference(0, image.aspects());
  use.pNext = &stencil_reference;
  use.layout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
  VkSubpassDescription2 subpass{VK_STRUCTURE_TYPE_SUBPASS_DESCRIPTION_2};
  subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  subpass.pDepthStencilAttachment = &use;
  VkRenderPassCreateInfo2 info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO_2};
  info.attachmentCount = 1;
  info.pAttachments = &attachment;
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  VkRenderPass pass;
  CTS_VK(CTS_COMMAND(run.gpu, CreateRenderPass2KHR)(run.device, &info, nullptr, &pass));
  run.own(pass, vkDestroyRenderPass);
  const VkFramebuffer framebuffer = make_framebuffer(run, pass, {image.view}, kExtent);
  draw(run, pass, framebuffer, kExtent, triangles(run, pass, kExtent, VK_SAMPLE_COUNT_1_BIT));
  run.out("depth_stencil", image);
}

}  // namespace
}  // namespace vitrine::cts

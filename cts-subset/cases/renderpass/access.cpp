// Fragments that read the attachment they write: in rasterization order as an input attachment, and as a sampled image
// in a feedback loop.
#include "cases/common/colored_vertices.h"
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

constexpr VkExtent2D kExtent{72, 56};

Buffer random_triangles(Run& run) { return run.buffer_of(random_colored_vertices(run.random, 48)); }

Image make_image(Run& run, VkFormat format, VkImageUsageFlags usage) {
  ImageSpec spec;
  spec.format = format;
  spec.extent = {kExtent.width, kExtent.height, 1};
  spec.usage = usage;
  const Image image = run.image(spec);
  run.fill_random(image);
  return image;
}

struct Pass {
  VkRenderPass pass;
  VkFramebuffer framebuffer;
};

/// One subpass that may read what it writes; attachments are loaded.
Pass make_pass(Run& run, const Image& color, const Image* depth, bool input, VkImageLayout layout,
               VkSubpassDescriptionFlags flags) {
  std::vector<VkAttachmentDescription> attachments;
  std::vector<VkImageView> views;
  for (const Image* image : {&color, depth}) {
    if (!image) continue;
    VkAttachmentDescription a{};
    a.format = image->spec.format;
    a.samples = VK_SAMPLE_COUNT_1_BIT;
    a.loadOp = a.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    a.storeOp = a.stencilStoreOp = VK_ATTACHMENT_STORE_OP_STORE;
    a.initialLayout = a.finalLayout = VK_IMAGE_LAYOUT_GENERAL;
    attachments.push_back(a);
    views.push_back(image->view);
  }
  const VkAttachmentReference color_reference{0, layout}, depth_reference{1, VK_IMAGE_LAYOUT_GENERAL};
  const VkAttachmentReference inputs[2] = {color_reference, depth_reference};
  VkSubpassDescription subpass{};
  subpass.flags = flags;
  subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  subpass.colorAttachmentCount = 1;
  subpass.pColorAttachments = &color_reference;
  subpass.pDepthStencilAttachment = depth ? &depth_reference : nullptr;
  subpass.inputAttachmentCount = input ? static_cast<uint32_t>(attachments.size()) : 0;
  subpass.pInputAttachments = inputs;
  VkSubpassDependency self{};
  self.srcStageMask = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
  self.dstStageMask = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;
  self.srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
  self.dstAccessMask = input ? VK_ACCESS_INPUT_ATTACHMENT_READ_BIT : VK_ACCESS_SHADER_READ_BIT;
  self.dependencyFlags = VK_DEPENDENCY_BY_REGION_BIT | (input ? 0 : VK_DEPENDENCY_FEEDBACK_LOOP_BIT_EXT);
  // Fragments sample the attachment in another layout than it has before the pass.
  VkSubpassDependency before{VK_SUBPASS_EXTERNAL, 0};
  before.srcStageMask = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
  before.dstStageMask = VK_PIPELINE_STAGE_ALL_GRAPHICS_BIT;
  before.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
  before.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  const VkSubpassDependency dependencies[2] = {self, before};
  VkRenderPassCreateInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
  info.attachmentCount = static_cast<uint32_t>(attachments.size());
  info.pAttachments = attachments.data();
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  info.dependencyCount = 2;
  info.pDependencies = dependencies;
  Pass result;
  result.pass = make_render_pass(run, info);
  result.framebuffer = make_framebuffer(run, result.pass, views, kExtent);
  return result;
}

void record(Run& run, const Pass& pass, const std::function<void(VkCommandBuffer)>& draws) {
  run.once([&](VkCommandBuffer cmd) {
    VkRenderPassBeginInfo begin{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
    begin.renderPass = pass.pass;
    begin.framebuffer = pass.framebuffer;
    begin.renderArea = {{0, 0}, kExtent};
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    draws(cmd);
    vkCmdEndRenderPass(cmd);
  });
}

/// Overlapping triangles of one draw, each of which changes what the one before wrote: the colour and, unless `second`
/// is 0, depth or stencil, which fragments read, too.
void rasterization_order(Run& run, VkImageAspectFlags second) {
  const bool depth = second == VK_IMAGE_ASPECT_DEPTH_BIT, stencil = second == VK_IMAGE_ASPECT_STENCIL_BIT;
  const auto& claimed = run.gpu.extension_features;
  run.require(claimed.rasterizationOrderColorAttachmentAccess && claimed.rasterizationOrderDepthAttachmentAccess &&
                  claimed.rasterizationOrderStencilAttachmentAccess,
              "rasterization order attachment access");
  const Image color = make_image(run, VK_FORMAT_R8G8B8A8_UNORM,
                                 VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT);
  std::optional<Image> own;
  if (second != 0)
    own = make_image(run, depth ? VK_FORMAT_D32_SFLOAT : VK_FORMAT_S8_UINT,
                     VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT);
  VkSubpassDescriptionFlags flags = VK_SUBPASS_DESCRIPTION_RASTERIZATION_ORDER_ATTACHMENT_COLOR_ACCESS_BIT_EXT;
  if (depth) flags |= VK_SUBPASS_DESCRIPTION_RASTERIZATION_ORDER_ATTACHMENT_DEPTH_ACCESS_BIT_EXT;
  if (stencil) flags |= VK_SUBPASS_DESCRIPTION_RASTERIZATION_ORDER_ATTACHMENT_STENCIL_ACCESS_BIT_EXT;
  const Pass pass = make_pass(run, color, own ? &*own : nullptr, true, VK_IMAGE_LAYOUT_GENERAL, flags);
  std::vector<Binding> bindings{input_attachment(0, color)};
  if (own) bindings.push_back(input_attachment(1, *own));
  const Resources res = run.resources(bindings);
  GraphicsSpec spec;
  spec.vertex = kColorVertex;
  spec.fragment = "layout(input_attachment_index = 0, binding = 0) uniform subpassInput before;\n";
  if (own)
    spec.fragment += std::string("layout(input_attachment_index = 1, binding = 1) uniform ") +
                     (stencil ? "usubpassInput" : "subpassInput") + " own;\n";
  spec.fragment += std::string(R"(
layout(location = 0) in vec4 passed;
layout(location = 0) out vec4 result;
void main() { result = fract(subpassLoad(before).yzwx * 1.7 + passed * 0.3)") +
                   (depth     ? " + subpassLoad(own).x"
                    : stencil ? " + float(subpassLoad(own).x) * 0.37"
                              : "") +
                   "); }\n";
  spec.layout = res.layout;
  spec.floats({4, 4});
  spec.blend.flags = VK_PIPELINE_COLOR_BLEND_STATE_CREATE_RASTERIZATION_ORDER_ATTACHMENT_ACCESS_BIT_EXT;
  spec.depth.depthTestEnable = spec.depth.depthWriteEnable = depth;
  spec.depth.depthCompareOp = VK_COMPARE_OP_ALWAYS;
  spec.depth.stencilTestEnable = stencil;
  spec.depth.front = spec.depth.back = {
      VK_STENCIL_OP_KEEP, VK_STENCIL_OP_INCREMENT_AND_WRAP, VK_STENCIL_OP_KEEP, VK_COMPARE_OP_ALWAYS, 0xff, 0xff, 0};
  if (depth)
    spec.depth.flags = VK_PIPELINE_DEPTH_STENCIL_STATE_CREATE_RASTERIZATION_ORDER_ATTACHMENT_DEPTH_ACCESS_BIT_EXT;
  if (stencil)
    spec.depth.flags = VK_PIPELINE_DEPTH_STENCIL_STATE_CREATE_RASTERIZATION_ORDER_ATTACHMENT_STENCIL_ACCESS_BIT_EXT;
  const VkPipeline pipeline = make_pipeline(run, spec, pass.pass, 0, 1, kExtent, VK_SAMPLE_COUNT_1_BIT);
  const Buffer vertices = random_triangles(run);
  record(run, pass, [&](VkCommandBuffer cmd) {
    bind_pipeline(cmd, pipeline);
    res.bind(cmd);
    bind_vertices(cmd, vertices);
    vkCmdDraw(cmd, 48, 1, 0, 0);
  });
  run.out("color", color);
  if (own) run.out("depth_stencil", *own);
}
CTS_RANDOM("renderpass", "rasterization_order.color", 4) { rasterization_order(run, 0); }
CTS_RANDOM("renderpass", "rasterization_order.depth", 4) { rasterization_order(run, VK_IMAGE_ASPECT_DEPTH_BIT); }
CTS_RANDOM("renderpass", "rasterization_order.stencil", 4) { rasterization_order(run, VK_IMAGE_ASPECT_STENCIL_BIT); }

/// Draws that sample the texel they write; a barrier between them.
CTS_CASE("renderpass", "feedback_loop.sampled") {
  run.require(run.gpu.extension_features.attachmentFeedbackLoopLayout, "attachmentFeedbackLoopLayout");
  const Image color = make_image(run, VK_FORMAT_R8G8B8A8_UNORM,
                                 VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                     VK_IMAGE_USAGE_ATTACHMENT_FEEDBACK_LOOP_BIT_EXT);
  const Pass pass = make_pass(run, color, nullptr, false, VK_IMAGE_LAYOUT_ATTACHMENT_FEEDBACK_LOOP_OPTIMAL_EXT, 0);
  Binding image = sampled(0, color, run.sampler(VK_FILTER_NEAREST));
  image.images[0].imageLayout = VK_IMAGE_LAYOUT_ATTACHMENT_FEEDBACK_LOOP_OPTIMAL_EXT;
  const Resources res = run.resources({image});
  GraphicsSpec spec;
  spec.vertex = kFullScreenVertex;
  spec.fragment = R"(
layout(binding = 0) uniform sampler2D before;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 result;
void main() { result = fract(texelFetch(before, ivec2(gl_FragCoord.xy), 0).yzwx * 1.7 + uv.xyxy * 0.3); })";
  spec.layout = res.layout;
  spec.flags = VK_PIPELINE_CREATE_COLOR_ATTACHMENT_FEEDBACK_LOOP_BIT_EXT;
  const VkPipeline pipeline = make_pipeline(run, spec, pass.pass, 0, 1, kExtent, VK_SAMPLE_COUNT_1_BIT);
  record(run, pass, [&](VkCommandBuffer cmd) {
    bind_pipeline(cmd, pipeline);
    res.bind(cmd);
    vkCmdDraw(cmd, 3, 1, 0, 0);
    VkMemoryBarrier written{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
    written.srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
    written.dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                         VK_DEPENDENCY_BY_REGION_BIT | VK_DEPENDENCY_FEEDBACK_LOOP_BIT_EXT, 1, &written, 0, nullptr, 0,
                         nullptr);
    vkCmdDraw(cmd, 3, 1, 0, 0);
  });
  run.out("color", color);
}

/// Draws of one triangle each that read the texels they cover, a barrier between them: as an input attachment, or in a
/// feedback loop. Fragments beside the triangle read what nobody writes.
void read_between_draws(Run& run, bool input) {
  if (!input) run.require(run.gpu.extension_features.attachmentFeedbackLoopLayout, "attachmentFeedbackLoopLayout");
  const Image color =
      make_image(run, VK_FORMAT_R8G8B8A8_UNORM,
                 VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                     (input ? VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT
                            : VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_ATTACHMENT_FEEDBACK_LOOP_BIT_EXT));
  const VkImageLayout layout = input ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_ATTACHMENT_FEEDBACK_LOOP_OPTIMAL_EXT;
  const Pass pass = make_pass(run, color, nullptr, input, layout, 0);
  Binding image = input ? input_attachment(0, color) : sampled(0, color, run.sampler(VK_FILTER_NEAREST));
  image.images[0].imageLayout = layout;
  const Resources res = run.resources({image});
  const std::string code = input ? "layout(input_attachment_index = 0, binding = 0) uniform subpassInput before;\n"
                                   "vec4 own() { return subpassLoad(before); }\n"
                                 : "layout(binding = 0) uniform sampler2D before;\n"
                                   "vec4 own() { return textureLod(before, gl_FragCoord.xy / vec2(72, 56), 0); }\n";
  GraphicsSpec spec;
  spec.vertex = kColorVertex;
  spec.fragment = code + R"(
layout(location = 0) in vec4 passed;
layout(location = 0) out vec4 result;
void main() { result = fract(own().yzwx * 1.7 + passed * 0.3); })";
  spec.layout = res.layout;
  spec.floats({4, 4});
  if (!input) spec.flags = VK_PIPELINE_CREATE_COLOR_ATTACHMENT_FEEDBACK_LOOP_BIT_EXT;
  const VkPipeline pipeline = make_pipeline(run, spec, pass.pass, 0, 1, kExtent, VK_SAMPLE_COUNT_1_BIT);
  const Buffer vertices = random_triangles(run);
  record(run, pass, [&](VkCommandBuffer cmd) {
    bind_pipeline(cmd, pipeline);
    res.bind(cmd);
    bind_vertices(cmd, vertices);
    for (uint32_t first = 0; first < 48; first += 3) {
      vkCmdDraw(cmd, 3, 1, first, 0);
      VkMemoryBarrier written{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
      written.srcAccessMask = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
      written.dstAccessMask = input ? VK_ACCESS_INPUT_ATTACHMENT_READ_BIT : VK_ACCESS_SHADER_READ_BIT;
      vkCmdPipelineBarrier(
          cmd, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
          VK_DEPENDENCY_BY_REGION_BIT | (input ? 0u : VkDependencyFlags{VK_DEPENDENCY_FEEDBACK_LOOP_BIT_EXT}), 1,
          &written, 0, nullptr, 0, nullptr);
    }
  });
  run.out("color", color);
}
CTS_RANDOM("renderpass", "feedback_loop.random_triangles", 4) { read_between_draws(run, false); }
CTS_RANDOM("renderpass", "input_attachment.random_triangles_between_barriers", 4) { read_between_draws(run, true); }

}  // namespace
}  // namespace vitrine::cts

// The depth bounds test, which the reference lacks: there the fragment shader compares the depth that is stored, in a
// copy of the attachment, and discards. Both happen before the stencil and depth tests, which write nothing then.
#include "cases/common/colored_vertices.h"
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

constexpr VkExtent2D kExtent{69, 58};
constexpr uint32_t kVertices = 36;

Image make_image(Run& run, VkFormat format, VkImageUsageFlags usage) {
  ImageSpec spec;
  spec.format = format;
  spec.extent = {kExtent.width, kExtent.height, 1};
  spec.usage = usage;
  return run.image(spec);
}

Buffer random_triangles(Run& run) { return run.buffer_of(random_colored_vertices(run.random, kVertices)); }

VkRenderPass make_pass(Run& run, const Image& color, const Image& depth) {
  VkAttachmentDescription attachments[2]{};
  for (const Image* image : {&color, &depth}) {
    VkAttachmentDescription& a = attachments[image == &depth];
    a.format = image->spec.format;
    a.samples = VK_SAMPLE_COUNT_1_BIT;
    a.loadOp = a.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    a.initialLayout = a.finalLayout = VK_IMAGE_LAYOUT_GENERAL;
  }
  const VkAttachmentReference color_reference{0, VK_IMAGE_LAYOUT_GENERAL}, depth_reference{1, VK_IMAGE_LAYOUT_GENERAL};
  VkSubpassDescription subpass{};
  subpass.colorAttachmentCount = 1;
  subpass.pColorAttachments = &color_reference;
  subpass.pDepthStencilAttachment = &depth_reference;
  VkRenderPassCreateInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
  info.attachmentCount = 2;
  info.pAttachments = attachments;
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  return make_render_pass(run, info);
}

CTS_RANDOM("pipeline", "random_depth_bounds", 30) {
  Random& random = run.random;
  const bool tests = run.gpu.features.depthBounds;
  if (&run.gpu == &gpus().device) run.require(tests, "depthBounds");
  const VkFormat format = random.pick({VK_FORMAT_D16_UNORM, VK_FORMAT_X8_D24_UNORM_PACK32, VK_FORMAT_D32_SFLOAT,
                                       VK_FORMAT_D24_UNORM_S8_UINT, VK_FORMAT_D32_SFLOAT_S8_UINT});
  const Image color = make_image(run, VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
  const Image depth = make_image(run, format, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
  Image stored = make_image(run, format, VK_IMAGE_USAGE_SAMPLED_BIT);
  run.fill_random(color);
  run.fill_random(depth);
  stored.view = run.image_view(stored, VK_IMAGE_VIEW_TYPE_2D, format, {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 1, 0, 1});
  float low = random.chance(0.2f) ? 0 : random.unit(), high = random.chance(0.2f) ? 1 : random.unit();
  if (low > high) std::swap(low, high);
  const Resources res = run.resources({sampled(0, stored, run.sampler(VK_FILTER_NEAREST))}, 8);
  GraphicsSpec spec;
  spec.vertex = kColorVertex;
  spec.fragment = std::string("#define IN_SHADER ") + (tests ? "0" : "1") + R"(
layout(binding = 0) uniform sampler2D stored;
layout(push_constant) uniform Bounds { float low, high; };
layout(location = 0) in vec4 passed;
layout(location = 0) out vec4 result;
void main() {
#if IN_SHADER
  float z = texelFetch(stored, ivec2(gl_FragCoord.xy), 0).x;
  if (z < low || z > high) discard;
#endif
  result = passed;
})";
  spec.layout = res.layout;
  spec.floats({4, 4});
  VkPipelineColorBlendAttachmentState blend{};
  blend.blendEnable = VK_TRUE;
  blend.srcColorBlendFactor = blend.srcAlphaBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
  blend.dstColorBlendFactor = blend.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
  blend.colorWriteMask = 0xf;
  spec.blends = {blend};
  spec.depth.depthTestEnable = random.chance(0.7f);
  spec.depth.depthCompareOp = static_cast<VkCompareOp>(random.below(8));
  spec.depth.stencilTestEnable = (depth.aspects() & VK_IMAGE_ASPECT_STENCIL_BIT) != 0;
  spec.depth.front = spec.depth.back = {VK_STENCIL_OP_INVERT,
                                        VK_STENCIL_OP_INCREMENT_AND_WRAP,
                                        VK_STENCIL_OP_DECREMENT_AND_WRAP,
                                        VK_COMPARE_OP_NOT_EQUAL,
                                        0x0f,
                                        0xff,
                                        random.below(16)};
  spec.depth.depthBoundsTestEnable = tests;
  spec.depth.minDepthBounds = low;
  spec.depth.maxDepthBounds = high;
  const bool dynamic = random.chance(0.5f);
  if (dynamic && tests) {
    spec.dynamic = {VK_DYNAMIC_STATE_DEPTH_BOUNDS, VK_DYNAMIC_STATE_DEPTH_BOUNDS_TEST_ENABLE};
    spec.depth.depthBoundsTestEnable = VK_FALSE;
  }
  const VkRenderPass pass = make_pass(run, color, depth);
  const VkFramebuffer framebuffer = make_framebuffer(run, pass, {color.view, depth.view}, kExtent);
  const VkPipeline pipeline = make_pipeline(run, spec, pass, 0, 1, kExtent, VK_SAMPLE_COUNT_1_BIT);
  const Buffer vertices = random_triangles(run);
  run.once([&](VkCommandBuffer cmd) {
    const VkImageCopy region{depth.layers(), {}, stored.layers(), {}, {kExtent.width, kExtent.height, 1}};
    vkCmdCopyImage(cmd, depth.handle, VK_IMAGE_LAYOUT_GENERAL, stored.handle, VK_IMAGE_LAYOUT_GENERAL, 1, &region);
    run.barrier(cmd);
    VkRenderPassBeginInfo begin{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
    begin.renderPass = pass;
    begin.framebuffer = framebuffer;
    begin.renderArea = {{0, 0}, kExtent};
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    bind_pipeline(cmd, pipeline);
    res.bind(cmd);
    const float bounds[] = {low, high};
    vkCmdPushConstants(cmd, res.layout, VK_SHADER_STAGE_ALL, 0, 8, bounds);
    if (dynamic && tests) {
      vkCmdSetDepthBounds(cmd, low, high);
      CTS_COMMAND(run.gpu, CmdSetDepthBoundsTestEnableEXT)(cmd, VK_TRUE);
    }
    bind_vertices(cmd, vertices);
    vkCmdDraw(cmd, kVertices, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  run.out("color", color);
  run.out("depth_stencil", depth);
}

}  // namespace
}  // namespace vitrine::cts

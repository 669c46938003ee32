// Depth and stencil attachments in read-only layouts: tested against, and read by the fragments of the same subpass, as
// input attachments or sampled images; and operations that leave attachments alone (VK_EXT_load_store_op_none).
#include "cases/common/colored_vertices.h"
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

constexpr VkExtent2D kExtent{71, 53};
constexpr uint32_t kVertices = 36;

Image make_image(Run& run, VkFormat format, VkImageUsageFlags usage) {
  ImageSpec spec;
  spec.format = format;
  spec.extent = {kExtent.width, kExtent.height, 1};
  spec.usage = usage;
  const Image image = run.image(spec);
  run.fill_random(image);
  return image;
}

Buffer random_triangles(Run& run) { return run.buffer_of(random_colored_vertices(run.random, kVertices)); }

/// What a load and store op of each attachment may be.
struct Ops {
  VkAttachmentLoadOp load;
  VkAttachmentStoreOp store;
};
constexpr Ops kKeep{VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_STORE_OP_STORE};

/// One subpass of a colour and a depth/stencil attachment, which may be an input attachment, too.
struct Pass {
  const Image& color;
  const Image& depth;
  VkImageLayout depth_layout;
  bool input;
  Ops color_ops = kKeep, depth_ops = kKeep, stencil_ops = kKeep;

  VkRenderPass make(Run& run) const {
    VkAttachmentDescription attachments[2]{};
    for (const Image* image : {&color, &depth}) {
      VkAttachmentDescription& a = attachments[image == &depth];
      const Ops& ops = image == &depth ? depth_ops : color_ops;
      a.format = image->spec.format;
      a.samples = VK_SAMPLE_COUNT_1_BIT;
      a.loadOp = ops.load;
      a.storeOp = ops.store;
      a.stencilLoadOp = stencil_ops.load;
      a.stencilStoreOp = stencil_ops.store;
      a.initialLayout = a.finalLayout = VK_IMAGE_LAYOUT_GENERAL;
    }
    const VkAttachmentReference color_reference{0, VK_IMAGE_LAYOUT_GENERAL}, depth_reference{1, depth_layout};
    VkSubpassDescription subpass{};
    subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &color_reference;
    subpass.pDepthStencilAttachment = &depth_reference;
    subpass.inputAttachmentCount = input;
    subpass.pInputAttachments = &depth_reference;
    // Fragments sample the attachment in another layout than it has before the pass.
    VkSubpassDependency before{VK_SUBPASS_EXTERNAL, 0};
    before.srcStageMask = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    before.dstStageMask = VK_PIPELINE_STAGE_ALL_GRAPHICS_BIT;
    before.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    before.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    VkRenderPassCreateInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
    info.dependencyCount = 1;
    info.pDependencies = &before;
    info.attachmentCount = 2;
    info.pAttachments = attachments;
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    return make_render_pass(run, info);
  }
};

void draw(Run& run, VkRenderPass pass, const Image& color, const Image& depth, const GraphicsSpec& spec,
          const Resources* res) {
  const VkFramebuffer framebuffer = make_framebuffer(run, pass, {color.view, depth.view}, kExtent);
  const VkPipeline pipeline = make_pipeline(run, spec, pass, 0, 1, kExtent, VK_SAMPLE_COUNT_1_BIT);
  const Buffer vertices = random_triangles(run);
  run.once([&](VkCommandBuffer cmd) {
    VkRenderPassBeginInfo begin{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
    begin.renderPass = pass;
    begin.framebuffer = framebuffer;
    begin.renderArea = {{0, 0}, kExtent};
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    bind_pipeline(cmd, pipeline);
    if (res) res->bind(cmd);
    bind_vertices(cmd, vertices);
    vkCmdDraw(cmd, kVertices, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  run.out("color", color);
  run.out("depth_stencil", depth);
}

void read_only(Run& run, VkFormat format, VkImageAspectFlagBits aspect, bool input) {
  const Image color = make_image(run, VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
  const Image depth = make_image(
      run, format,
      VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT);
  constexpr VkImageLayout kLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
  Image readable = depth;
  readable.view =
      run.image_view(depth, VK_IMAGE_VIEW_TYPE_2D, format, {static_cast<VkImageAspectFlags>(aspect), 0, 1, 0, 1});
  Binding binding = input ? input_attachment(0, readable) : sampled(0, readable, run.sampler(VK_FILTER_NEAREST));
  binding.images[0].imageLayout = kLayout;
  const Resources res = run.resources({binding});
  const bool stencil = aspect == VK_IMAGE_ASPECT_STENCIL_BIT;
  const std::string prefix = stencil ? "u" : "";
  GraphicsSpec spec;
  spec.vertex = kColorVertex;
  spec.fragment =
      (input ? "layout(input_attachment_index = 0, binding = 0) uniform " + prefix + "subpassInput before;\n"
             : "layout(binding = 0) uniform " + prefix + "sampler2D before;\n") +
      "layout(location = 0) in vec4 passed;\nlayout(location = 0) out vec4 result;\nvoid main() {\n"
      "  float value = float(" +
      (input ? "subpassLoad(before)" : "texelFetch(before, ivec2(gl_FragCoord.xy), 0)") + ".x)" +
      (stencil ? " / 255.0" : "") + ";\n  result = fract(passed + vec4(value, 2 * value, 3 * value, 1));\n}\n";
  spec.layout = res.layout;
  spec.floats({4, 4});
  spec.depth.depthTestEnable = (depth.aspects() & VK_IMAGE_ASPECT_DEPTH_BIT) != 0;
  spec.depth.depthWriteEnable = VK_FALSE;
  spec.depth.depthCompareOp = VK_COMPARE_OP_LESS;
  spec.depth.stencilTestEnable = (depth.aspects() & VK_IMAGE_ASPECT_STENCIL_BIT) != 0;
  spec.depth.front = spec.depth.back = {
      VK_STENCIL_OP_KEEP, VK_STENCIL_OP_KEEP, VK_STENCIL_OP_KEEP, VK_COMPARE_OP_GREATER, 0xff, 0, 100};
  draw(run, Pass{color, depth, kLayout, input}.make(run), color, depth, spec, &res);
}

const bool kRegistered = [] {
  struct Case {
    const char* name;
    VkFormat format;
    VkImageAspectFlagBits aspect;
  };
  static constexpr Case kCases[] = {
      {"d16", VK_FORMAT_D16_UNORM, VK_IMAGE_ASPECT_DEPTH_BIT},
      {"x8_d24", VK_FORMAT_X8_D24_UNORM_PACK32, VK_IMAGE_ASPECT_DEPTH_BIT},
      {"d32", VK_FORMAT_D32_SFLOAT, VK_IMAGE_ASPECT_DEPTH_BIT},
      {"s8", VK_FORMAT_S8_UINT, VK_IMAGE_ASPECT_STENCIL_BIT},
      {"d24_of_d24_s8", VK_FORMAT_D24_UNORM_S8_UINT, VK_IMAGE_ASPECT_DEPTH_BIT},
      {"s8_of_d24_s8", VK_FORMAT_D24_UNORM_S8_UINT, VK_IMAGE_ASPECT_STENCIL_BIT},
      {"d32_of_d32_s8", VK_FORMAT_D32_SFLOAT_S8_UINT, VK_IMAGE_ASPECT_DEPTH_BIT},
      {"s8_of_d32_s8", VK_FORMAT_D32_SFLOAT_S8_UINT, VK_IMAGE_ASPECT_STENCIL_BIT},
  };
  for (const Case& c : kCases)
    for (const bool input : {false, true})
      AddCase("renderpass", std::string(input ? "read_only.input." : "read_only.sampled.") + c.name,
              [&c, input](Run& run) { read_only(run, c.format, c.aspect, input); });
  return true;
}();

/// Which attachments a subpass leaves alone.
void op_none(Run& run, bool color_too, bool depth_too, bool stencil_too) {
  const bool none = run.gpu.has("VK_EXT_load_store_op_none");
  if (&run.gpu == &gpus().device) run.require(none, "VK_EXT_load_store_op_none");
  const Ops ops = none ? Ops{VK_ATTACHMENT_LOAD_OP_NONE_EXT, VK_ATTACHMENT_STORE_OP_NONE} : kKeep;
  const Image color = make_image(run, VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
  const Image depth = make_image(run, VK_FORMAT_D24_UNORM_S8_UINT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
  Pass pass{color, depth, VK_IMAGE_LAYOUT_GENERAL, false};
  if (color_too) pass.color_ops = ops;
  if (depth_too) pass.depth_ops = ops;
  if (stencil_too) pass.stencil_ops = ops;
  GraphicsSpec spec;
  spec.vertex = kColorVertex;
  spec.fragment = kColorFragment;
  spec.floats({4, 4});
  VkPipelineColorBlendAttachmentState blend{};
  blend.colorWriteMask = color_too ? 0 : 0xf;
  spec.blends = {blend};
  spec.depth.depthTestEnable = spec.depth.depthWriteEnable = !depth_too;
  spec.depth.depthCompareOp = VK_COMPARE_OP_LESS;
  spec.depth.stencilTestEnable = !stencil_too;
  spec.depth.front = spec.depth.back = {
      VK_STENCIL_OP_INVERT, VK_STENCIL_OP_INCREMENT_AND_WRAP, VK_STENCIL_OP_KEEP, VK_COMPARE_OP_ALWAYS, 0xff, 0xff, 1};
  draw(run, pass.make(run), color, depth, spec, nullptr);
}
CTS_CASE("renderpass", "load_store_op_none.color") { op_none(run, true, false, false); }
CTS_CASE("renderpass", "load_store_op_none.depth") { op_none(run, false, true, false); }
CTS_CASE("renderpass", "load_store_op_none.stencil") { op_none(run, false, false, true); }
CTS_CASE("renderpass", "load_store_op_none.depth_stencil") { op_none(run, false, true, true); }

}  // namespace
}  // namespace vitrine::cts

// Input attachments, one thing each: loaded from before the render pass or written by the subpass before.
#include "harness/case.h"
#include "harness/execute.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

/// Subpass 0 (only if `written`) draws into A; the last subpass reads A at its own pixel and writes it to B.
void input(Run& run, VkFormat format, bool written) {
  const FormatInfo& info = format_info(format);
  if (info.numeric == Numeric::kSrgb)
    run.require(!written || reference_cpu().srgb_comparable, "a comparable sRGB encoding");
  const std::string prefix = info.numeric == Numeric::kUint ? "u" : info.numeric == Numeric::kSint ? "i" : "";
  ImageSpec spec;
  spec.format = format;
  spec.extent = {70, 66, 1};
  spec.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT;
  const Image a = run.image(spec);
  run.fill_random(a);
  spec.format = prefix == "u"   ? VK_FORMAT_R32G32B32A32_UINT
                : prefix == "i" ? VK_FORMAT_R32G32B32A32_SINT
                                : VK_FORMAT_R32G32B32A32_SFLOAT;
  const Image b = run.image(spec);

  std::vector<VkAttachmentDescription> attachments;
  for (const Image* image : {&a, &b})
    attachments.push_back({0, image->spec.format, VK_SAMPLE_COUNT_1_BIT,
                           image == &a ? VK_ATTACHMENT_LOAD_OP_LOAD : VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                           VK_ATTACHMENT_STORE_OP_STORE, VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                           VK_ATTACHMENT_STORE_OP_DONT_CARE, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_GENERAL});
  const VkAttachmentReference references[] = {{0, VK_IMAGE_LAYOUT_GENERAL}, {1, VK_IMAGE_LAYOUT_GENERAL}};
  VkSubpassDescription write{}, read{};
  write.colorAttachmentCount = read.colorAttachmentCount = read.inputAttachmentCount = 1;
  write.pColorAttachments = read.pInputAttachments = &references[0];
  read.pColorAttachments = &references[1];
  std::vector<VkSubpassDescription> subpasses;
  if (written) subpasses.push_back(write);
  subpasses.push_back(read);
  const VkSubpassDependency dependency{0,
                                       1,
                                       VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                                       VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                                       VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
                                       VK_ACCESS_INPUT_ATTACHMENT_READ_BIT,
                                       VK_DEPENDENCY_BY_REGION_BIT};
  VkRenderPassCreateInfo info_pass{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
  info_pass.attachmentCount = 2;
  info_pass.pAttachments = attachments.data();
  info_pass.subpassCount = static_cast<uint32_t>(subpasses.size());
  info_pass.pSubpasses = subpasses.data();
  info_pass.dependencyCount = written ? 1 : 0;
  info_pass.pDependencies = &dependency;
  const VkRenderPass pass = make_render_pass(run, info_pass);
  const VkFramebuffer framebuffer = make_framebuffer(run, pass, {a.view, b.view}, {70, 66});

  const Resources res = run.resources({input_attachment(0, a)});
  std::vector<VkPipeline> pipelines;
  for (uint32_t i = 0; i < subpasses.size(); ++i) {
    const bool reads = i + 1 == subpasses.size();
    GraphicsSpec graphics;
    graphics.layout = res.layout;
    graphics.vertex = kFullScreenVertex;
    graphics.fragment = reads ? "layout(input_attachment_index = 0, binding = 0) uniform " + prefix +
                                    "subpassInput a;\nlayout(location = 0) out " + prefix +
                                    "vec4 result;\nvoid main() { result = subpassLoad(a); }\n"
                              : "layout(location = 0) in vec2 uv;\nlayout(location = 0) out " + prefix +
                                    "vec4 result;\nvoid main() { result = " + prefix + "vec4(vec4(uv, uv.yx * 0.5) * " +
                                    (prefix.empty() ? "0.8" : "120.0") + "); }\n";
    pipelines.push_back(make_pipeline(run, graphics, pass, i, 1, {70, 66}, VK_SAMPLE_COUNT_1_BIT));
  }
  run.once([&](VkCommandBuffer cmd) {
    VkRenderPassBeginInfo begin{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
    begin.renderPass = pass;
    begin.framebuffer = framebuffer;
    begin.renderArea = {{0, 0}, {70, 66}};
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    for (uint32_t i = 0; i < pipelines.size(); ++i) {
      if (i) vkCmdNextSubpass(cmd, VK_SUBPASS_CONTENTS_INLINE);
      bind_pipeline(cmd, pipelines[i]);
      res.bind(cmd);
      vkCmdDraw(cmd, 3, 1, 0, 0);
    }
    vkCmdEndRenderPass(cmd);
  });
  run.out("a", a);
  run.out("b", b);
  for (Output& output : run.outputs) output.nan_bits_free = true;
}

const bool kRegistered = [] {
  for (const VkFormat format : {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_B8G8R8A8_SRGB, VK_FORMAT_A2B10G10R10_UNORM_PACK32,
                                VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R8G8B8A8_UINT,
                                VK_FORMAT_R32G32_SINT, VK_FORMAT_R5G6B5_UNORM_PACK16})
    for (const bool written : {false, true})
      AddCase("renderpass",
              std::string("input_attachment.") + (written ? "written." : "loaded.") + format_info(format).name,
              [=](Run& run) { input(run, format, written); });
  return true;
}();

/// One of three input attachments, whose number is the draw's or the fragment's. The reference, which takes constants
/// alone, chooses among them.
void input_array(Run& run, bool nonuniform) {
  const auto& indexing = run.gpu.extension_features;
  const bool has =
      indexing.shaderInputAttachmentArrayDynamicIndexing && indexing.shaderInputAttachmentArrayNonUniformIndexing;
  constexpr uint32_t kInputs = 3;
  ImageSpec spec;
  spec.extent = {70, 66, 1};
  spec.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT;
  std::vector<Image> images;
  Binding inputs{};
  std::vector<VkAttachmentDescription> attachments;
  std::vector<VkAttachmentReference> references;
  std::vector<VkImageView> views;
  for (uint32_t i = 0; i <= kInputs; ++i) {
    images.push_back(run.image(spec));
    run.fill_random(images[i]);
    attachments.push_back({0, spec.format, VK_SAMPLE_COUNT_1_BIT, VK_ATTACHMENT_LOAD_OP_LOAD,
                           VK_ATTACHMENT_STORE_OP_STORE, VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                           VK_ATTACHMENT_STORE_OP_DONT_CARE, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_GENERAL});
    references.push_back({i, VK_IMAGE_LAYOUT_GENERAL});
    views.push_back(images[i].view);
    if (i == 0)
      inputs = input_attachment(0, images[i]);
    else if (i < kInputs)
      inputs.images.push_back(input_attachment(0, images[i]).images[0]);
  }
  VkSubpassDescription subpass{};
  subpass.inputAttachmentCount = kInputs;
  subpass.pInputAttachments = references.data();
  subpass.colorAttachmentCount = 1;
  subpass.pColorAttachments = &references[kInputs];
  VkRenderPassCreateInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
  info.attachmentCount = kInputs + 1;
  info.pAttachments = attachments.data();
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  const VkRenderPass pass = make_render_pass(run, info);
  const VkFramebuffer framebuffer = make_framebuffer(run, pass, views, {70, 66});
  const Resources res = run.resources({inputs}, 16);
  GraphicsSpec graphics;
  graphics.layout = res.layout;
  graphics.vertex = kFullScreenVertex;
  graphics.fragment = std::string("#extension GL_EXT_nonuniform_qualifier : require\n") +
                      "layout(input_attachment_index = 0, binding = 0) uniform subpassInput a[3];\n"
                      "layout(push_constant) uniform P { int k; } p;\n"
                      "layout(location = 0) out vec4 result;\n"
                      "void main() {\n  int k = p.k;\n" +
                      (nonuniform ? "  k = (int(gl_FragCoord.x) / 3 + int(gl_FragCoord.y) + k) % 3;\n" : "") +
                      (!has         ? "  result = k == 0 ? subpassLoad(a[0]) : k == 1 ? subpassLoad(a[1]) : "
                                      "subpassLoad(a[2]);\n"
                       : nonuniform ? "  result = subpassLoad(a[nonuniformEXT(k)]);\n"
                                    : "  result = subpassLoad(a[k]);\n") +
                      "}\n";
  const VkPipeline pipeline = make_pipeline(run, graphics, pass, 0, 1, {70, 66}, VK_SAMPLE_COUNT_1_BIT);
  const int32_t number = run.random.between(1, 2);
  run.once([&](VkCommandBuffer cmd) {
    VkRenderPassBeginInfo begin{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
    begin.renderPass = pass;
    begin.framebuffer = framebuffer;
    begin.renderArea = {{0, 0}, {70, 66}};
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    bind_pipeline(cmd, pipeline);
    res.bind(cmd);
    vkCmdPushConstants(cmd, res.layout, VK_SHADER_STAGE_ALL, 0, 4, &number);
    vkCmdDraw(cmd, 3, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  run.out("result", images[kInputs]);
}
CTS_CASE("renderpass", "input_attachment.array.dynamic") { input_array(run, false); }
CTS_CASE("renderpass", "input_attachment.array.nonuniform") { input_array(run, true); }

/// An input attachment that is the depth attachment as well: a fragment reads what was there before its own depth.
void read_own_depth(Run& run) {
  ImageSpec spec;
  spec.format = VK_FORMAT_D32_SFLOAT;
  spec.extent = {70, 66, 1};
  spec.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT;
  const Image depth = run.image(spec);
  spec.format = VK_FORMAT_R32_SFLOAT;
  spec.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  const Image color = run.image(spec);
  std::vector<VkAttachmentDescription> attachments;
  for (const Image* image : {&depth, &color})
    attachments.push_back({0, image->spec.format, VK_SAMPLE_COUNT_1_BIT, VK_ATTACHMENT_LOAD_OP_CLEAR,
                           VK_ATTACHMENT_STORE_OP_STORE, VK_ATTACHMENT_LOAD_OP_DONT_CARE,
                           VK_ATTACHMENT_STORE_OP_DONT_CARE, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_GENERAL});
  const VkAttachmentReference references[] = {{0, VK_IMAGE_LAYOUT_GENERAL}, {1, VK_IMAGE_LAYOUT_GENERAL}};
  VkSubpassDescription subpass{};
  subpass.colorAttachmentCount = subpass.inputAttachmentCount = 1;
  subpass.pInputAttachments = subpass.pDepthStencilAttachment = &references[0];
  subpass.pColorAttachments = &references[1];
  constexpr VkPipelineStageFlags kTests =
      VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
  const VkSubpassDependency dependency{0,
                                       0,
                                       kTests,
                                       VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
                                       VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
                                       VK_ACCESS_INPUT_ATTACHMENT_READ_BIT,
                                       VK_DEPENDENCY_BY_REGION_BIT};
  VkRenderPassCreateInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
  info.attachmentCount = 2;
  info.pAttachments = attachments.data();
  info.subpassCount = info.dependencyCount = 1;
  info.pSubpasses = &subpass;
  info.pDependencies = &dependency;
  const VkRenderPass pass = make_render_pass(run, info);
  const VkFramebuffer framebuffer = make_framebuffer(run, pass, {depth.view, color.view}, {70, 66});

  const Resources res = run.resources({input_attachment(0, depth)});
  GraphicsSpec graphics;
  graphics.layout = res.layout;
  graphics.vertex = kFullScreenVertex;
  graphics.fragment = R"(
layout(input_attachment_index = 0, binding = 0) uniform subpassInput depth;
layout(location = 0) out float result;
void main() { result = subpassLoad(depth).x * 8.0 + gl_FragCoord.z + gl_FragCoord.x * 0.01; })";
  graphics.depth.depthTestEnable = graphics.depth.depthWriteEnable = VK_TRUE;
  graphics.depth.depthCompareOp = VK_COMPARE_OP_ALWAYS;
  graphics.dynamic = {VK_DYNAMIC_STATE_VIEWPORT};
  const VkPipeline pipeline = make_pipeline(run, graphics, pass, 0, 1, {70, 66}, VK_SAMPLE_COUNT_1_BIT);
  run.once([&](VkCommandBuffer cmd) {
    VkClearValue clears[2] = {};
    clears[0].depthStencil.depth = 0.875f;
    VkRenderPassBeginInfo begin{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
    begin.renderPass = pass;
    begin.framebuffer = framebuffer;
    begin.renderArea = {{0, 0}, {70, 66}};
    begin.clearValueCount = 2;
    begin.pClearValues = clears;
    vkCmdBeginRenderPass(cmd, &begin, VK_SUBPASS_CONTENTS_INLINE);
    bind_pipeline(cmd, pipeline);
    res.bind(cmd);
    for (const float nearest : {0.25f, 0.5f}) {
      const VkViewport viewport{0, 0, 70, 66, nearest, 1.0f};
      vkCmdSetViewport(cmd, 0, 1, &viewport);
      VkMemoryBarrier barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
      barrier.srcAccessMask = VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
      barrier.dstAccessMask = VK_ACCESS_INPUT_ATTACHMENT_READ_BIT;
      vkCmdPipelineBarrier(cmd, kTests, VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_DEPENDENCY_BY_REGION_BIT, 1, &barrier,
                           0, nullptr, 0, nullptr);
      vkCmdDraw(cmd, 3, 1, 0, 0);
    }
    vkCmdEndRenderPass(cmd);
  });
  run.out("depth", depth);
  run.out("color", color);
  run.may_be_blank();
}

CTS_CASE("renderpass", "input_attachment.own_depth") { read_own_depth(run); }

}  // namespace
}  // namespace vitrine::cts

// Render targets and graphics pipelines of the cases.
#include "harness/graphics.h"

#include <algorithm>
#include <cstdlib>

#include "harness/execute.h"
#include "harness/shader.h"

namespace vitrine::cts {
namespace {

VkAttachmentDescription attachment(VkFormat format, VkSampleCountFlagBits samples, VkAttachmentLoadOp load) {
  VkAttachmentDescription result{};
  result.format = format;
  result.samples = samples;
  result.loadOp = result.stencilLoadOp = load;
  result.storeOp = result.stencilStoreOp = VK_ATTACHMENT_STORE_OP_STORE;
  result.initialLayout = result.finalLayout = VK_IMAGE_LAYOUT_GENERAL;
  return result;
}

VkRenderPass make_pass(Run& run, const TargetSpec& spec) {
  std::vector<VkAttachmentDescription> attachments;
  std::vector<VkAttachmentReference> colors, resolves;
  const auto add = [&](VkFormat format, VkSampleCountFlagBits samples, VkAttachmentLoadOp load) {
    attachments.push_back(attachment(format, samples, load));
    return VkAttachmentReference{static_cast<uint32_t>(attachments.size() - 1), VK_IMAGE_LAYOUT_GENERAL};
  };
  for (const VkFormat format : spec.colors) colors.push_back(add(format, spec.samples, spec.load));
  if (spec.resolve)
    for (const VkFormat format : spec.colors)
      resolves.push_back(add(format, VK_SAMPLE_COUNT_1_BIT, VK_ATTACHMENT_LOAD_OP_DONT_CARE));
  VkAttachmentReference depth{};
  VkSubpassDescription subpass{};
  subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  subpass.colorAttachmentCount = static_cast<uint32_t>(colors.size());
  subpass.pColorAttachments = colors.data();
  subpass.pResolveAttachments = spec.resolve ? resolves.data() : nullptr;
  if (spec.depth) {
    depth = add(spec.depth, spec.samples, spec.load);
    subpass.pDepthStencilAttachment = &depth;
  }
  VkRenderPassMultiviewCreateInfo views{VK_STRUCTURE_TYPE_RENDER_PASS_MULTIVIEW_CREATE_INFO};
  views.subpassCount = 1;
  views.pViewMasks = &spec.view_mask;
  VkRenderPassCreateInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO, spec.view_mask ? &views : nullptr};
  info.attachmentCount = static_cast<uint32_t>(attachments.size());
  info.pAttachments = attachments.data();
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  return make_render_pass(run, info);
}

/// CTS_WINDOW_TARGETS: single colours without depth have the format of windows, which the reference draws by a way of
/// its own (lavapipe-rasterization.md 9).
TargetSpec as_window(TargetSpec spec) {
  static const bool asked = std::getenv("CTS_WINDOW_TARGETS") != nullptr;
  if (!asked || spec.colors.size() != 1 || spec.depth != VK_FORMAT_UNDEFINED) return spec;
  if (spec.samples != VK_SAMPLE_COUNT_1_BIT || spec.layers != 1) return spec;
  const VkFormat format = spec.colors[0];
  if (format == VK_FORMAT_R8G8B8A8_UNORM || format == VK_FORMAT_R16G16B16A16_SFLOAT ||
      format == VK_FORMAT_R32G32B32A32_SFLOAT)
    spec.colors[0] = VK_FORMAT_B8G8R8A8_UNORM;
  return spec;
}

}  // namespace

const char kFullScreenVertex[] = R"(
layout(location = 0) out vec2 uv;
void main() {
  uv = vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2);
  gl_Position = vec4(uv * 2.0 - 1.0, 0.5, 1.0);
})";

const char kColorVertex[] = R"(
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 passed;
void main() {
  passed = color;
  gl_Position = position;
  gl_PointSize = 1.0;
})";

const char kColorFragment[] = R"(
layout(location = 0) in vec4 passed;
layout(location = 0) out vec4 result;
void main() { result = passed; })";

VkClearValue clear_value(VkFormat format, float r, float g, float b, float a) {
  VkClearValue value{};
  const FormatInfo& info = format_info(format);
  const float channels[] = {r, g, b, a};
  if (info.numeric == Numeric::kDepth) {
    value.depthStencil = {r, static_cast<uint32_t>(g * 255.0f)};
  } else {
    for (int c = 0; c < 4; ++c) {
      if (info.numeric == Numeric::kUint)
        value.color.uint32[c] = static_cast<uint32_t>(channels[c] * 100.0f);
      else if (info.numeric == Numeric::kSint)
        value.color.int32[c] = static_cast<int32_t>(channels[c] * 100.0f);
      else
        value.color.float32[c] = channels[c];
    }
  }
  return value;
}

Target make_target(Run& run, const TargetSpec& described, bool probe) {
  const TargetSpec spec = as_window(described);
  for (const VkFormat format : spec.colors)
    if (!probe && format_info(format).numeric == Numeric::kSrgb)
      run.require(reference_cpu().srgb_comparable, "a comparable sRGB encoding");
  Target target;
  target.spec = spec;
  ImageSpec image;
  image.extent = {spec.width, spec.height, 1};
  image.samples = spec.samples;
  image.layers = spec.layers;
  if (spec.layers > 1) image.view = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
  const VkFormatFeatureFlags sampled = VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT;
  std::vector<VkImageView> views;
  for (const VkFormat format : spec.colors) {
    image.format = format;
    image.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    if (run.gpu.features_of(format) & sampled) image.usage |= VK_IMAGE_USAGE_SAMPLED_BIT;
    target.colors.push_back(run.image(image));
    views.push_back(target.colors.back().view);
    target.clears.push_back(clear_value(format, 0.1f, 0.2f, 0.3f, 0.4f));
  }
  if (spec.resolve) {
    image.samples = VK_SAMPLE_COUNT_1_BIT;
    for (const VkFormat format : spec.colors) {
      image.format = format;
      image.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
      target.resolves.push_back(run.image(image));
      views.push_back(target.resolves.back().view);
      target.clears.push_back({});
    }
    image.samples = spec.samples;
  }
  if (spec.depth) {
    image.format = spec.depth;
    image.flags = spec.depth_flags;
    image.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    if (run.gpu.features_of(spec.depth) & sampled) image.usage |= VK_IMAGE_USAGE_SAMPLED_BIT;
    target.depth = run.image(image);
    views.push_back(target.depth->view);
    target.clears.push_back(clear_value(spec.depth, 1.0f, 0.0f, 0.0f, 0.0f));
  }
  target.pass = make_pass(run, spec);
  target.framebuffer =
      make_framebuffer(run, target.pass, views, {spec.width, spec.height}, spec.view_mask ? 1 : spec.layers);
  return target;
}

VkRenderPass make_render_pass(Run& run, const VkRenderPassCreateInfo& info) {
  VkRenderPass pass;
  CTS_VK(vkCreateRenderPass(run.device, &info, nullptr, &pass));
  return run.own(pass, vkDestroyRenderPass);
}

VkFramebuffer make_framebuffer(Run& run, VkRenderPass pass, const std::vector<VkImageView>& views, VkExtent2D extent,
                               uint32_t layers) {
  VkFramebufferCreateInfo info{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
  info.renderPass = pass;
  info.attachmentCount = static_cast<uint32_t>(views.size());
  info.pAttachments = views.data();
  info.width = extent.width;
  info.height = extent.height;
  info.layers = layers;
  VkFramebuffer framebuffer;
  CTS_VK(vkCreateFramebuffer(run.device, &info, nullptr, &framebuffer));
  return run.own(framebuffer, vkDestroyFramebuffer);
}

VkQueryPool make_query_pool(Run& run, VkQueryType type, uint32_t count, VkQueryPipelineStatisticFlags statistics) {
  VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
  info.queryType = type;
  info.queryCount = count;
  info.pipelineStatistics = statistics;
  VkQueryPool pool;
  CTS_VK(vkCreateQueryPool(run.device, &info, nullptr, &pool));
  return run.own(pool, vkDestroyQueryPool);
}

void Target::begin(VkCommandBuffer cmd, VkSubpassContents contents) const { begin(cmd, rect(), contents); }

void Target::begin(VkCommandBuffer cmd, VkRect2D area, VkSubpassContents contents) const {
  VkRenderPassBeginInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
  info.renderPass = pass;
  info.framebuffer = framebuffer;
  info.renderArea = area;
  info.clearValueCount = static_cast<uint32_t>(clears.size());
  info.pClearValues = clears.data();
  vkCmdBeginRenderPass(cmd, &info, contents);
}

Target make_target_of(Run& run, const Image& image, uint32_t layers) {
  Target target;
  target.spec.colors = {image.spec.format};
  target.spec.width = image.spec.extent.width;
  target.spec.height = image.spec.extent.height;
  target.spec.load = VK_ATTACHMENT_LOAD_OP_LOAD;
  VkAttachmentDescription attachment{};
  attachment.format = image.spec.format;
  attachment.samples = VK_SAMPLE_COUNT_1_BIT;
  attachment.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
  attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  attachment.initialLayout = attachment.finalLayout = VK_IMAGE_LAYOUT_GENERAL;
  const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_GENERAL};
  VkSubpassDescription subpass{};
  subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  subpass.colorAttachmentCount = 1;
  subpass.pColorAttachments = &reference;
  VkRenderPassCreateInfo pass{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
  pass.attachmentCount = pass.subpassCount = 1;
  pass.pAttachments = &attachment;
  pass.pSubpasses = &subpass;
  target.pass = make_render_pass(run, pass);
  target.framebuffer =
      make_framebuffer(run, target.pass, {image.view}, {target.spec.width, target.spec.height}, layers);
  target.colors = {image};
  return target;
}

void out_target(Run& run, const Target& target) {
  for (size_t i = 0; i < target.colors.size(); ++i) run.out("color" + std::to_string(i), target.colors[i]);
  for (size_t i = 0; i < target.resolves.size(); ++i) run.out("resolve" + std::to_string(i), target.resolves[i]);
  if (target.depth) {
    const size_t first = run.outputs.size();
    run.out("depth", *target.depth);
    for (size_t i = first; i < run.outputs.size(); ++i) run.outputs[i].may_be_blank = true;
  }
}

GraphicsSpec::GraphicsSpec() {
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  raster.lineWidth = 1.0f;
  raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
  multisample.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  depth.depthCompareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
  depth.maxDepthBounds = 1.0f;
}

void GraphicsSpec::floats(const std::vector<uint32_t>& components, VkVertexInputRate rate) {
  constexpr VkFormat kFormats[] = {VK_FORMAT_R32_SFLOAT, VK_FORMAT_R32G32_SFLOAT, VK_FORMAT_R32G32B32_SFLOAT,
                                   VK_FORMAT_R32G32B32A32_SFLOAT};
  const auto binding = static_cast<uint32_t>(bindings.size());
  uint32_t offset = 0;
  for (const uint32_t count : components) {
    attributes.push_back({static_cast<uint32_t>(attributes.size()), binding, kFormats[count - 1], offset});
    offset += count * 4;
  }
  bindings.push_back({binding, offset, rate});
}

VkPipeline make_pipeline(Run& run, const GraphicsSpec& spec, const Target& target) {
  return make_pipeline(run, spec, target.pass, 0, static_cast<uint32_t>(target.colors.size()),
                       {target.spec.width, target.spec.height}, target.spec.samples);
}

VkPipeline make_pipeline(Run& run, const GraphicsSpec& spec, VkRenderPass pass, uint32_t subpass, uint32_t colors,
                         VkExtent2D extent, VkSampleCountFlagBits samples) {
  run.inputs.pipeline(spec);
  std::vector<VkPipelineShaderStageCreateInfo> stages;
  const auto stage = [&](VkShaderStageFlagBits bit, VkShaderModule module, const VkSpecializationInfo* special) {
    stages.push_back({VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, nullptr, 0, bit, module, "main", special});
  };
  stage(VK_SHADER_STAGE_VERTEX_BIT,
        spec.vertex_module ? spec.vertex_module : run.shader(VK_SHADER_STAGE_VERTEX_BIT, spec.vertex),
        spec.vertex_special);
  const auto between = [&](VkShaderStageFlagBits bit, const std::string& text) {
    if (!text.empty()) stage(bit, run.shader(bit, text), nullptr);
  };
  between(VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, spec.control);
  between(VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, spec.evaluation);
  between(VK_SHADER_STAGE_GEOMETRY_BIT, spec.geometry);
  if (spec.fragment_module || !spec.fragment.empty())
    stage(VK_SHADER_STAGE_FRAGMENT_BIT,
          spec.fragment_module ? spec.fragment_module : run.shader(VK_SHADER_STAGE_FRAGMENT_BIT, spec.fragment),
          spec.fragment_special);

  VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
                                             spec.input_next};
  input.vertexBindingDescriptionCount = static_cast<uint32_t>(spec.bindings.size());
  input.pVertexBindingDescriptions = spec.bindings.data();
  input.vertexAttributeDescriptionCount = static_cast<uint32_t>(spec.attributes.size());
  input.pVertexAttributeDescriptions = spec.attributes.data();

  const VkViewport whole{0.0f, 0.0f, static_cast<float>(extent.width), static_cast<float>(extent.height), 0.0f, 1.0f};
  const VkRect2D everything{{0, 0}, extent};
  VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO, spec.viewport_next};
  viewport.viewportCount = spec.viewports.empty() ? 1 : static_cast<uint32_t>(spec.viewports.size());
  viewport.pViewports = spec.viewports.empty() ? &whole : spec.viewports.data();
  viewport.scissorCount = spec.scissors.empty() ? 1 : static_cast<uint32_t>(spec.scissors.size());
  viewport.pScissors = spec.scissors.empty() ? &everything : spec.scissors.data();

  const auto is_dynamic = [&](VkDynamicState state) {
    return std::find(spec.dynamic.begin(), spec.dynamic.end(), state) != spec.dynamic.end();
  };
  if (is_dynamic(VK_DYNAMIC_STATE_VIEWPORT_WITH_COUNT)) viewport.viewportCount = 0;
  if (is_dynamic(VK_DYNAMIC_STATE_SCISSOR_WITH_COUNT)) viewport.scissorCount = 0;

  VkPipelineMultisampleStateCreateInfo multisample = spec.multisample;
  multisample.rasterizationSamples = samples;
  VkPipelineColorBlendAttachmentState opaque{};
  opaque.colorWriteMask = 0xf;
  std::vector<VkPipelineColorBlendAttachmentState> blends = spec.blends;
  blends.resize(colors, blends.empty() ? opaque : blends.back());
  VkPipelineColorBlendStateCreateInfo blend = spec.blend;
  blend.attachmentCount = colors;
  blend.pAttachments = blends.data();

  VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
  dynamic.dynamicStateCount = static_cast<uint32_t>(spec.dynamic.size());
  dynamic.pDynamicStates = spec.dynamic.data();

  VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, spec.next};
  info.flags = spec.flags;
  info.stageCount = static_cast<uint32_t>(stages.size());
  info.pStages = stages.data();
  info.pVertexInputState = &input;
  info.pInputAssemblyState = &spec.assembly;
  info.pTessellationState = spec.control.empty() ? nullptr : &spec.tessellation;
  info.pViewportState = &viewport;
  info.pRasterizationState = &spec.raster;
  info.pMultisampleState = &multisample;
  info.pDepthStencilState = &spec.depth;
  info.pColorBlendState = &blend;
  info.pDynamicState = spec.dynamic.empty() ? nullptr : &dynamic;
  info.layout = spec.layout ? spec.layout : run.resources({}).layout;
  info.renderPass = pass;
  info.subpass = subpass;
  VkPipeline result;
  CTS_VK(vkCreateGraphicsPipelines(run.device, spec.cache, 1, &info, nullptr, &result));
  return run.own(result, vkDestroyPipeline);
}

void bind_pipeline(VkCommandBuffer cmd, VkPipeline pipeline) {
  vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
}

void bind_vertices(VkCommandBuffer cmd, const Buffer& buffer, uint32_t binding) {
  const VkDeviceSize offset = 0;
  vkCmdBindVertexBuffers(cmd, binding, 1, &buffer.handle, &offset);
}

void draw_once(Run& run, const Target& target, VkPipeline pipeline, const Resources* resources, uint32_t vertices) {
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    if (resources && resources->set) resources->bind(cmd);
    vkCmdDraw(cmd, vertices, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
}

}  // namespace vitrine::cts

// Pipeline libraries: the four parts of a graphics pipeline made apart and linked.
#include "cases/common/colored_vertices.h"
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

const char kVertex[] = R"(
layout(set = 0, binding = 0) uniform A { vec4 scale[2]; };
layout(constant_id = 3) const float kShift = 0.0;
layout(location = 0) in vec4 position;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 passed;
void main() { passed = color; gl_Position = position * scale[1] + vec4(kShift, 0.0, 0.0, 0.0); })";
const char kFragment[] = R"(
layout(set = 1, binding = 0) uniform B { vec4 tint; };
layout(constant_id = 4) const float kFactor = 1.0;
layout(location = 0) in vec4 passed;
layout(location = 0) out vec4 result;
void main() { result = passed * tint * kFactor; })";

/// The state of a graphics pipeline as Vulkan's structures, random where it shows.
struct State {
  VkVertexInputBindingDescription binding{0, 32, VK_VERTEX_INPUT_RATE_VERTEX};
  VkVertexInputAttributeDescription attributes[2] = {{0, 0, VK_FORMAT_R32G32B32A32_SFLOAT, 0},
                                                     {1, 0, VK_FORMAT_R32G32B32A32_SFLOAT, 16}};
  VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  VkViewport viewport{0, 0, 64, 64, 0, 1};
  VkRect2D scissor{{0, 0}, {64, 64}};
  VkPipelineViewportStateCreateInfo viewports{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
  VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
  VkPipelineMultisampleStateCreateInfo multisample{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
  VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
  VkPipelineColorBlendAttachmentState attachment{};
  VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
  VkDynamicState dynamic_state = VK_DYNAMIC_STATE_BLEND_CONSTANTS;
  VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
  float shift, factor;
  VkSpecializationMapEntry entries[2] = {{3, 0, 4}, {4, 0, 4}};
  VkSpecializationInfo special[2];
  VkPipelineShaderStageCreateInfo stages[2];

  State(Run& run, VkSampleCountFlagBits samples) {
    Random& random = run.random;
    input.vertexBindingDescriptionCount = 1;
    input.pVertexBindingDescriptions = &binding;
    input.vertexAttributeDescriptionCount = 2;
    input.pVertexAttributeDescriptions = attributes;
    assembly.topology = random.pick({VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP});
    viewports.viewportCount = viewports.scissorCount = 1;
    viewports.pViewports = &viewport;
    viewports.pScissors = &scissor;
    raster.lineWidth = 1;
    raster.cullMode = random.pick({VK_CULL_MODE_NONE, VK_CULL_MODE_BACK_BIT});
    multisample.rasterizationSamples = samples;
    multisample.alphaToCoverageEnable = random.chance(0.3f);
    depth.depthTestEnable = depth.depthWriteEnable = VK_TRUE;
    depth.depthCompareOp = random.pick({VK_COMPARE_OP_LESS, VK_COMPARE_OP_GREATER_OR_EQUAL});
    attachment = {VK_TRUE,
                  VK_BLEND_FACTOR_CONSTANT_COLOR,
                  VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA,
                  VK_BLEND_OP_ADD,
                  VK_BLEND_FACTOR_ONE,
                  VK_BLEND_FACTOR_ONE,
                  VK_BLEND_OP_MAX,
                  0xf};
    blend.attachmentCount = 1;
    blend.pAttachments = &attachment;
    dynamic.dynamicStateCount = 1;
    dynamic.pDynamicStates = &dynamic_state;
    shift = random.real(-0.3f, 0.3f);
    factor = random.real(0.5f, 1.5f);
    special[0] = {1, &entries[0], 4, &shift};
    special[1] = {1, &entries[1], 4, &factor};
    const VkShaderStageFlagBits bits[2] = {VK_SHADER_STAGE_VERTEX_BIT, VK_SHADER_STAGE_FRAGMENT_BIT};
    const char* texts[2] = {kVertex, kFragment};
    for (int i = 0; i < 2; ++i)
      stages[i] = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                   nullptr,
                   0,
                   bits[i],
                   run.shader(bits[i], texts[i]),
                   "main",
                   &special[i]};
  }
};

VkPipelineLayout make_layout(Run& run, VkDescriptorSetLayout first, VkDescriptorSetLayout second) {
  const VkDescriptorSetLayout sets[2] = {first, second};
  VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  info.flags = VK_PIPELINE_LAYOUT_CREATE_INDEPENDENT_SETS_BIT_EXT;
  info.setLayoutCount = 2;
  info.pSetLayouts = sets;
  VkPipelineLayout layout;
  CTS_VK(vkCreatePipelineLayout(run.device, &info, nullptr, &layout));
  return run.own(layout, vkDestroyPipelineLayout);
}

VkPipeline create(Run& run, const VkGraphicsPipelineCreateInfo& info) {
  VkPipeline pipeline;
  CTS_VK(vkCreateGraphicsPipelines(run.device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline));
  return run.own(pipeline, vkDestroyPipeline);
}

/// One library with the given part of the state.
VkPipeline make_part(Run& run, const State& s, VkGraphicsPipelineLibraryFlagBitsEXT part, VkPipelineLayout layout,
                     VkRenderPass pass) {
  VkGraphicsPipelineLibraryCreateInfoEXT library{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_LIBRARY_CREATE_INFO_EXT};
  library.flags = part;
  VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &library};
  info.flags = VK_PIPELINE_CREATE_LIBRARY_BIT_KHR;
  switch (part) {
    case VK_GRAPHICS_PIPELINE_LIBRARY_VERTEX_INPUT_INTERFACE_BIT_EXT:
      info.pVertexInputState = &s.input;
      info.pInputAssemblyState = &s.assembly;
      break;
    case VK_GRAPHICS_PIPELINE_LIBRARY_PRE_RASTERIZATION_SHADERS_BIT_EXT:
      info.stageCount = 1;
      info.pStages = &s.stages[0];
      info.pViewportState = &s.viewports;
      info.pRasterizationState = &s.raster;
      info.layout = layout;
      info.renderPass = pass;
      break;
    case VK_GRAPHICS_PIPELINE_LIBRARY_FRAGMENT_SHADER_BIT_EXT:
      info.stageCount = 1;
      info.pStages = &s.stages[1];
      info.pMultisampleState = &s.multisample;
      info.pDepthStencilState = &s.depth;
      info.layout = layout;
      info.renderPass = pass;
      break;
    default:
      info.pMultisampleState = &s.multisample;
      info.pColorBlendState = &s.blend;
      info.pDynamicState = &s.dynamic;
      info.renderPass = pass;
  }
  return create(run, info);
}

VkPipeline link(Run& run, const std::vector<VkPipeline>& libraries, VkPipelineLayout layout) {
  VkPipelineLibraryCreateInfoKHR list{VK_STRUCTURE_TYPE_PIPELINE_LIBRARY_CREATE_INFO_KHR};
  list.libraryCount = static_cast<uint32_t>(libraries.size());
  list.pLibraries = libraries.data();
  VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &list};
  info.layout = layout;
  return create(run, info);
}

void library(Run& run) {
  run.require(run.gpu.extension_features.graphicsPipelineLibrary, "graphicsPipelineLibrary");
  TargetSpec target_spec;
  target_spec.depth = VK_FORMAT_D32_SFLOAT;
  target_spec.samples = run.random.chance(0.4f) ? VK_SAMPLE_COUNT_4_BIT : VK_SAMPLE_COUNT_1_BIT;
  const Target target = make_target(run, target_spec);
  const Buffer scale = run.buffer_of<float>({0, 0, 0, 0, 0.8f, 0.9f, 1, 1}),
               tint = run.buffer_of<float>({1, 0.7f, 0.5f, 0.9f});
  const Resources first = run.resources({uniform_buffer(0, scale)}), second = run.resources({uniform_buffer(0, tint)});
  const VkPipelineLayout layout = make_layout(run, first.set_layout, second.set_layout);
  const State state(run, target_spec.samples);
  const VkPipeline input = make_part(run, state, VK_GRAPHICS_PIPELINE_LIBRARY_VERTEX_INPUT_INTERFACE_BIT_EXT,
                                     VK_NULL_HANDLE, VK_NULL_HANDLE);
  const VkPipeline before =
      make_part(run, state, VK_GRAPHICS_PIPELINE_LIBRARY_PRE_RASTERIZATION_SHADERS_BIT_EXT, layout, target.pass);
  const VkPipeline shader =
      make_part(run, state, VK_GRAPHICS_PIPELINE_LIBRARY_FRAGMENT_SHADER_BIT_EXT, layout, target.pass);
  const VkPipeline output = make_part(run, state, VK_GRAPHICS_PIPELINE_LIBRARY_FRAGMENT_OUTPUT_INTERFACE_BIT_EXT,
                                      VK_NULL_HANDLE, target.pass);
  const VkPipeline pipeline = link(run, {input, before, shader, output}, layout);
  const Buffer vertices = run.buffer_of(random_colored_vertices(run.random, 36));
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    const VkDescriptorSet sets[2] = {first.set, second.set};
    vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0, 2, sets, 0, nullptr);
    bind_vertices(cmd, vertices);
    const float constants[4] = {0.9f, 0.6f, 0.3f, 1.0f};
    vkCmdSetBlendConstants(cmd, constants);
    vkCmdDraw(cmd, 36, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
  out_target(run, target);
  run.may_be_blank();
}

CTS_RANDOM("pipeline", "library.linked", 8) { library(run); }

}  // namespace
}  // namespace vitrine::cts

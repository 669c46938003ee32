// Pipelines of a run: any state that goes with what they draw to.
#include "tests/fuzz/api_run.h"

namespace vitrine::fuzz {

using icd::make_struct;

VkPipelineShaderStageCreateInfo Run::stage(VkShaderStageFlagBits bit, VkShaderModule module) {
  auto info = make_struct<VkPipelineShaderStageCreateInfo>();
  info.stage = bit;
  info.module = module;
  info.pName = "main";
  return info;
}

VkShaderModule Run::one_of(const std::vector<VkShaderModule>& list) {
  return list[c_.below(static_cast<std::uint32_t>(list.size()))];
}

bool Run::has_stencil() const {
  return depth_.format == VK_FORMAT_D24_UNORM_S8_UINT || depth_.format == VK_FORMAT_D32_SFLOAT_S8_UINT;
}

void Run::make_graphics() {
  const bool tessellated = c_.one_in(5);
  const bool geometry = c_.one_in(5);
  std::vector<VkPipelineShaderStageCreateInfo> stages{stage(VK_SHADER_STAGE_VERTEX_BIT, one_of(w_.vertex))};
  if (tessellated) {
    stages.push_back(stage(VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, one_of(w_.control)));
    stages.push_back(stage(VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, one_of(w_.evaluation)));
  }
  if (geometry) stages.push_back(stage(VK_SHADER_STAGE_GEOMETRY_BIT, one_of(w_.geometry)));
  stages.push_back(stage(VK_SHADER_STAGE_FRAGMENT_BIT, one_of(w_.fragment)));

  const VkVertexInputBindingDescription bindings[] = {
      {0, c_.below(9) * 4, VK_VERTEX_INPUT_RATE_VERTEX},
      {1, c_.below(9) * 4, static_cast<VkVertexInputRate>(c_.below(2))}};
  constexpr VkFormat kAttributes[] = {VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R8G8B8A8_SNORM,
                                      VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_A2B10G10R10_UNORM_PACK32,
                                      VK_FORMAT_R32G32_SFLOAT};
  const VkVertexInputAttributeDescription attributes[] = {{0, c_.below(2), c_.of(kAttributes), c_.below(9) * 4},
                                                          {1, 1, c_.of(kAttributes), c_.below(3) * 4}};
  auto input = make_struct<VkPipelineVertexInputStateCreateInfo>();
  input.vertexBindingDescriptionCount = input.vertexAttributeDescriptionCount = 2;
  input.pVertexBindingDescriptions = bindings;
  input.pVertexAttributeDescriptions = attributes;

  auto assembly = make_struct<VkPipelineInputAssemblyStateCreateInfo>();
  constexpr VkPrimitiveTopology kTriangles[] = {
      VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN};
  assembly.topology = tessellated ? VK_PRIMITIVE_TOPOLOGY_PATCH_LIST
                      : geometry  ? c_.of(kTriangles)
                                  : static_cast<VkPrimitiveTopology>(c_.below(10));
  const bool strip = assembly.topology == VK_PRIMITIVE_TOPOLOGY_LINE_STRIP ||
                     assembly.topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP ||
                     assembly.topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN ||
                     assembly.topology == VK_PRIMITIVE_TOPOLOGY_LINE_STRIP_WITH_ADJACENCY ||
                     assembly.topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP_WITH_ADJACENCY;
  assembly.primitiveRestartEnable = strip && c_.one_in(2);
  auto tessellation = make_struct<VkPipelineTessellationStateCreateInfo>();
  tessellation.patchControlPoints = c_.between(1, 5);

  VkViewport viewports[2];
  VkRect2D scissors[2];
  for (std::size_t i = 0; i < 2; ++i) {
    viewports[i] = {static_cast<float>(c_.below(400)) - 200,
                    static_cast<float>(c_.below(400)) - 200,
                    static_cast<float>(c_.between(1, c_.one_in(6) ? 16384 : 200)),
                    (c_.one_in(4) ? -1.0f : 1.0f) * static_cast<float>(c_.between(1, 200)),
                    static_cast<float>(c_.below(3)) / 2,
                    static_cast<float>(c_.below(3)) / 2};
    scissors[i] = {{static_cast<std::int32_t>(c_.below(40)), static_cast<std::int32_t>(c_.below(40))},
                   {side() * 2, side() * 2}};
  }
  auto viewport = make_struct<VkPipelineViewportStateCreateInfo>();
  viewport.viewportCount = viewport.scissorCount = geometry ? 2 : 1;
  viewport.pViewports = viewports;
  viewport.pScissors = scissors;

  auto rasterization = make_struct<VkPipelineRasterizationStateCreateInfo>();
  rasterization.depthClampEnable = c_.one_in(3);
  rasterization.polygonMode = static_cast<VkPolygonMode>(c_.one_in(2) ? 0 : c_.below(3));
  rasterization.cullMode = c_.below(4);
  rasterization.frontFace = static_cast<VkFrontFace>(c_.below(2));
  rasterization.depthBiasEnable = c_.one_in(3);
  rasterization.depthBiasConstantFactor = static_cast<float>(c_.below(9)) - 4;
  rasterization.depthBiasSlopeFactor = static_cast<float>(c_.below(9)) - 4;
  rasterization.lineWidth = static_cast<float>(c_.between(1, 8));
  auto multisample = make_struct<VkPipelineMultisampleStateCreateInfo>();
  multisample.rasterizationSamples = samples_;
  multisample.sampleShadingEnable = c_.one_in(4);
  multisample.minSampleShading = 1;
  multisample.alphaToCoverageEnable = c_.one_in(5);
  auto depth = make_struct<VkPipelineDepthStencilStateCreateInfo>();
  depth.depthTestEnable = c_.one_in(2);
  depth.depthWriteEnable = c_.one_in(2);
  depth.depthCompareOp = static_cast<VkCompareOp>(c_.below(8));
  depth.stencilTestEnable = c_.one_in(3);
  depth.front = depth.back = {static_cast<VkStencilOp>(c_.below(8)),
                              static_cast<VkStencilOp>(c_.below(8)),
                              static_cast<VkStencilOp>(c_.below(8)),
                              static_cast<VkCompareOp>(c_.below(8)),
                              0xff,
                              0xff,
                              c_.below(256)};
  VkPipelineColorBlendAttachmentState attachment{};
  attachment.blendEnable = c_.one_in(2);
  attachment.srcColorBlendFactor = static_cast<VkBlendFactor>(c_.below(15));
  attachment.dstColorBlendFactor = static_cast<VkBlendFactor>(c_.below(15));
  attachment.colorBlendOp = static_cast<VkBlendOp>(c_.below(5));
  attachment.srcAlphaBlendFactor = static_cast<VkBlendFactor>(c_.below(15));
  attachment.dstAlphaBlendFactor = static_cast<VkBlendFactor>(c_.below(15));
  attachment.alphaBlendOp = static_cast<VkBlendOp>(c_.below(5));
  attachment.colorWriteMask = c_.below(16);
  auto blend = make_struct<VkPipelineColorBlendStateCreateInfo>();
  blend.attachmentCount = 1;
  blend.pAttachments = &attachment;
  auto rendering = make_struct<VkPipelineRenderingCreateInfo>();
  rendering.colorAttachmentCount = 1;
  rendering.pColorAttachmentFormats = &target_.format;
  rendering.depthAttachmentFormat = depth_.format;
  if (has_stencil()) rendering.stencilAttachmentFormat = depth_.format;
  auto info = make_struct<VkGraphicsPipelineCreateInfo>(&rendering);
  info.stageCount = static_cast<std::uint32_t>(stages.size());
  info.pStages = stages.data();
  info.pVertexInputState = &input;
  info.pInputAssemblyState = &assembly;
  info.pTessellationState = &tessellation;
  info.pViewportState = &viewport;
  info.pRasterizationState = &rasterization;
  info.pMultisampleState = &multisample;
  info.pDepthStencilState = &depth;
  info.pColorBlendState = &blend;
  info.layout = w_.layout;
  demand(VK_CALL(CreateGraphicsPipelines)(w_.device, w_.pipelines, 1, &info, nullptr, &graphics_) == VK_SUCCESS,
         "a pipeline");
}

void Run::make_compute() {
  auto info = make_struct<VkComputePipelineCreateInfo>();
  info.stage = stage(VK_SHADER_STAGE_COMPUTE_BIT, one_of(w_.compute));
  info.layout = w_.layout;
  demand(VK_CALL(CreateComputePipelines)(w_.device, w_.pipelines, 1, &info, nullptr, &compute_) == VK_SUCCESS,
         "a compute pipeline");
}

}  // namespace vitrine::fuzz

// Resources that do not match the shader, which no valid application has: descriptor sets of another layout than the
// pipeline's, sets, push constants and vertex buffers that were never bound. Never a crash; what does not match is as
// if it were null.
#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "tests/icd/resources_fixture.h"

namespace vitrine::icd::test {
namespace {

using MismatchedResources = ResourceTest;

std::array<VkDescriptorType, kKinds> rotated(std::uint32_t by) {
  auto types = kTypes;
  std::rotate(types.begin(), types.begin() + by, types.end());
  return types;
}

VKAPI_ATTR VkBool32 VKAPI_CALL remember(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                        const VkDebugUtilsMessengerCallbackDataEXT* data, void* heard) {
  *static_cast<std::string*>(heard) = data->pMessage;
  return VK_FALSE;
}

TEST_F(MismatchedResources, PipelinesOfOtherKindsAreRefusedWithAReason) {
  std::string heard;
  auto info = make_struct<VkDebugUtilsMessengerCreateInfoEXT>();
  info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT;
  info.pfnUserCallback = &remember;
  info.pUserData = &heard;
  VkDebugUtilsMessengerEXT messenger;
  ASSERT_EQ(VK_CALL(CreateDebugUtilsMessengerEXT)(instance, &info, nullptr, &messenger), VK_SUCCESS);
  for (std::uint32_t by = 1; by < kKinds; ++by) {
    heard.clear();
    EXPECT_EQ(make_compute(make_layout(make_set_layout_of(rotated(by)))), VkPipeline{VK_NULL_HANDLE}) << by;
    EXPECT_NE(heard.find("descriptor set 0, binding "), std::string::npos) << heard;
  }
  auto swapped = kTypes;
  std::swap(swapped[1], swapped[5]);
  EXPECT_EQ(make_compute(make_layout(make_set_layout_of(swapped))), VkPipeline{VK_NULL_HANDLE});
  const bool names_both =
      heard.find("storage buffer") != std::string::npos && heard.find("storage image") != std::string::npos;
  EXPECT_TRUE(names_both) << heard;
  EXPECT_EQ(make_compute(make_layout(make_set_layout({kTypes[0]}))), VkPipeline{VK_NULL_HANDLE}) << "bindings missing";
  EXPECT_NE(heard.find("is not in the pipeline layout"), std::string::npos) << heard;
  VK_CALL(DestroyDebugUtilsMessengerEXT)(instance, messenger, nullptr);
}

TEST_F(MismatchedResources, SetsOfOtherLayoutsAreAsIfNull) {
  const VkDescriptorSetLayout sound = make_set_layout_of(kTypes);
  const VkPipelineLayout layout = make_layout(sound);
  const VkPipeline pipeline = make_compute(layout);
  ASSERT_NE(pipeline, VkPipeline{VK_NULL_HANDLE});
  dispatch(pipeline, layout, make_full_set(sound, kTypes), output);
  for (std::uint32_t i = 0; i < kKinds; ++i) EXPECT_EQ(result.floats[i], 1.0f) << i;
  for (std::uint32_t by = 1; by < kKinds; ++by) {
    const auto types = rotated(by);
    const VkDescriptorSetLayout other = make_set_layout_of(types);
    dispatch(pipeline, make_layout(other), make_full_set(other, types), output);
    for (std::uint32_t i = 0; i < kKinds; ++i)
      EXPECT_TRUE(result.floats[i] == 0.0f || result.floats[i] == 1.0f) << by << ": " << i << ", " << result.floats[i];
    dispatch(pipeline, layout, make_full_set(other, types), output);  // bound with a layout that is not the set's, too
  }
  // Fewer descriptors than the shader's bindings, and dynamic buffers without their offsets.
  const auto few = {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC};
  const VkDescriptorSetLayout small = make_set_layout_of(few);
  dispatch(pipeline, make_layout(small), make_full_set(small, few), output);
  for (std::uint32_t i = 0; i < kKinds; ++i) EXPECT_EQ(result.floats[i], 0.0f) << i;
}

TEST_F(MismatchedResources, NothingBoundReadsZeroAndDropsStores) {
  const VkPipelineLayout layout = make_layout(make_set_layout_of(kTypes));
  const VkPipeline pipeline = make_compute(layout);
  ASSERT_NE(pipeline, VkPipeline{VK_NULL_HANDLE});
  dispatch(pipeline, layout, VK_NULL_HANDLE, output);
  for (std::uint32_t i = 0; i <= kKinds; ++i) EXPECT_EQ(result.floats[i], 0.0f) << i;
  dispatch(pipeline, layout, VK_NULL_HANDLE, VK_NULL_HANDLE);
  for (std::uint32_t i = 0; i <= kKinds; ++i) EXPECT_EQ(result.floats[i], -1.0f) << i;
}

TEST_F(MismatchedResources, DynamicOffsetsMayBeTooFewTooManyOrTooFar) {
  auto types = kTypes;
  types[0] = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC;
  types[1] = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC;
  const VkDescriptorSetLayout set_layout = make_set_layout_of(types);
  const VkPipelineLayout layout = make_layout(set_layout);
  const VkPipeline pipeline = make_compute(layout);
  ASSERT_NE(pipeline, VkPipeline{VK_NULL_HANDLE});
  const VkDescriptorSet sets[] = {make_full_set(set_layout, types), output};
  const std::uint32_t offsets[] = {~0u, kBytes, 0, ~0u, 3, 1u << 31};
  for (std::uint32_t count = 0; count <= std::size(offsets); ++count) {
    const VkCommandBuffer commands = begin();
    VK_CALL(CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    VK_CALL(CmdBindDescriptorSets)
    (commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 2, sets, count, offsets);
    VK_CALL(CmdDispatch)(commands, 1, 1, 1);
    run(commands);
    EXPECT_EQ(result.floats[0], count == 0 ? 1.0f : 0.0f) << count;
    EXPECT_EQ(result.floats[1], count <= 1 ? 1.0f : 0.0f) << count;
  }
}

TEST_F(MismatchedResources, DrawsWithNothingBoundDoNotCrash) {
  const VkShaderModule modules[] = {make_module(kUnboundVertexWords), make_module(kUnboundFragmentWords)};
  std::array<VkPipelineShaderStageCreateInfo, 2> stages;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    stages[i] = make_struct<VkPipelineShaderStageCreateInfo>();
    stages[i].stage = i == 0 ? VK_SHADER_STAGE_VERTEX_BIT : VK_SHADER_STAGE_FRAGMENT_BIT;
    stages[i].module = modules[i];
    stages[i].pName = "main";
  }
  const VkVertexInputBindingDescription bindings[] = {{0, 16, VK_VERTEX_INPUT_RATE_VERTEX},
                                                      {7, 16, VK_VERTEX_INPUT_RATE_INSTANCE}};
  const VkVertexInputAttributeDescription attributes[] = {{0, 0, VK_FORMAT_R32G32B32A32_SFLOAT, 0},
                                                          {1, 7, VK_FORMAT_R8G8B8A8_UINT, 12}};
  auto input = make_struct<VkPipelineVertexInputStateCreateInfo>();
  input.vertexBindingDescriptionCount = input.vertexAttributeDescriptionCount = 2;
  input.pVertexBindingDescriptions = bindings;
  input.pVertexAttributeDescriptions = attributes;
  auto assembly = make_struct<VkPipelineInputAssemblyStateCreateInfo>();
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
  const VkViewport area{0, 0, kSize, kSize, 0, 1};
  const VkRect2D scissor{{0, 0}, {kSize, kSize}};
  auto viewport = make_struct<VkPipelineViewportStateCreateInfo>();
  viewport.viewportCount = viewport.scissorCount = 1;
  viewport.pViewports = &area;
  viewport.pScissors = &scissor;
  auto rasterization = make_struct<VkPipelineRasterizationStateCreateInfo>();
  rasterization.lineWidth = 1;
  auto samples = make_struct<VkPipelineMultisampleStateCreateInfo>();
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  VkPipelineColorBlendAttachmentState blend_attachment{};
  blend_attachment.colorWriteMask = VK_COLOR_COMPONENT_R_BIT;
  auto blend = make_struct<VkPipelineColorBlendStateCreateInfo>();
  blend.attachmentCount = 1;
  blend.pAttachments = &blend_attachment;
  const VkFormat format = VK_FORMAT_R32_SFLOAT;
  auto rendering = make_struct<VkPipelineRenderingCreateInfo>();
  rendering.colorAttachmentCount = 1;
  rendering.pColorAttachmentFormats = &format;
  auto info = make_struct<VkGraphicsPipelineCreateInfo>(&rendering);
  info.stageCount = 2;
  info.pStages = stages.data();
  info.pVertexInputState = &input;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewport;
  info.pRasterizationState = &rasterization;
  info.pMultisampleState = &samples;
  info.pColorBlendState = &blend;
  const VkDescriptorSetLayout sound = make_set_layout_of(kTypes);
  info.layout = make_layout(sound);
  VkPipeline pipeline = VK_NULL_HANDLE;
  ASSERT_EQ(VK_CALL(CreateGraphicsPipelines)(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline), VK_SUCCESS);
  pipelines.push_back(pipeline);
  for (const VkShaderModule module : modules) VK_CALL(DestroyShaderModule)(device, module, nullptr);

  auto attachment = make_struct<VkRenderingAttachmentInfo>();
  attachment.imageView = view;
  attachment.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
  attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
  attachment.clearValue.color.float32[0] = 2;
  auto scope = make_struct<VkRenderingInfo>();
  scope.renderArea = scissor;
  scope.layerCount = scope.colorAttachmentCount = 1;
  scope.pColorAttachments = &attachment;
  for (std::uint32_t by = 0; by < kKinds; ++by) {  // 0: no set at all
    const VkCommandBuffer commands = begin();
    VK_CALL(CmdBeginRendering)(commands, &scope);
    VK_CALL(CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    if (by != 0) {
      const auto types = rotated(by);
      const VkDescriptorSetLayout other = make_set_layout_of(types);
      const VkDescriptorSet set = make_full_set(other, types);
      VK_CALL(CmdBindDescriptorSets)
      (commands, VK_PIPELINE_BIND_POINT_GRAPHICS, make_layout(other), 0, 1, &set, 0, nullptr);
      const VkDeviceSize offset = kBytes - 4;  // too little for one vertex
      VK_CALL(CmdBindVertexBuffers)(commands, 0, 1, &data.buffer, &offset);
    }
    VK_CALL(CmdDraw)(commands, 100, 3, 0, 0);
    VK_CALL(CmdDrawIndexed)(commands, 100, 3, 0, 0, 0);
    VK_CALL(CmdEndRendering)(commands);
    run(commands);
  }
}

}  // namespace
}  // namespace vitrine::icd::test

// Create infos become raster::State: what is dynamic or without effect is never read.
#include <gtest/gtest.h>

#include "icd/edge/util.h"
#include "icd/object/pipeline.h"
#include "icd/object/render_pass.h"

namespace vitrine::icd {
namespace {

/// A create info with the plainest state, to be changed before use. The pointers marked invalid must not be followed.
struct Info {
  Info() : subpass(HostMemory()) {
    rasterization.lineWidth = 1;
    multisample.rasterizationSamples = VK_SAMPLE_COUNT_4_BIT;
    viewports.viewportCount = viewports.scissorCount = 1;
    viewports.pViewports = &viewport;
    viewports.pScissors = &scissor;
    info.pVertexInputState = &vertex_input;
    info.pInputAssemblyState = &assembly;
    info.pRasterizationState = &rasterization;
    info.pViewportState = &viewports;
    info.pMultisampleState = &multisample;
    info.pDepthStencilState = invalid<VkPipelineDepthStencilStateCreateInfo>();
    info.pColorBlendState = invalid<VkPipelineColorBlendStateCreateInfo>();
  }
  template <class T>
  static const T* invalid() {
    return reinterpret_cast<const T*>(std::uintptr_t{8});
  }
  void fill(Pipeline& pipeline) { fill_static_state(pipeline, info, subpass, kAllPipelineParts); }

  VkViewport viewport{1, 2, 30, 40, 0, 1};
  VkRect2D scissor{{5, 6}, {7, 8}};
  VkPipelineVertexInputStateCreateInfo vertex_input = make_struct<VkPipelineVertexInputStateCreateInfo>();
  VkPipelineInputAssemblyStateCreateInfo assembly = make_struct<VkPipelineInputAssemblyStateCreateInfo>();
  VkPipelineRasterizationStateCreateInfo rasterization = make_struct<VkPipelineRasterizationStateCreateInfo>();
  VkPipelineViewportStateCreateInfo viewports = make_struct<VkPipelineViewportStateCreateInfo>();
  VkPipelineMultisampleStateCreateInfo multisample = make_struct<VkPipelineMultisampleStateCreateInfo>();
  VkGraphicsPipelineCreateInfo info = make_struct<VkGraphicsPipelineCreateInfo>();
  Subpass subpass;
};

TEST(PipelineState, WithoutAttachmentsTheirStateIsNotRead) {
  Info info;
  Pipeline pipeline{HostMemory()};
  info.fill(pipeline);
  EXPECT_EQ(pipeline.state.samples, 4u);
  EXPECT_EQ(pipeline.state.viewport[0].width, 30.0f);
  EXPECT_EQ(pipeline.state.scissor[0].extent.height, 8u);
  EXPECT_FALSE(pipeline.state.depth_test);
  EXPECT_FALSE(pipeline.state.blend[0].enable);
  EXPECT_TRUE(pipeline.dynamic.none());
}

TEST(PipelineState, RasterizerDiscardMakesTheRestVoid) {
  Info info;
  info.rasterization.rasterizerDiscardEnable = VK_TRUE;
  info.info.pViewportState = Info::invalid<VkPipelineViewportStateCreateInfo>();
  info.info.pMultisampleState = Info::invalid<VkPipelineMultisampleStateCreateInfo>();
  info.subpass.colors.push_back(0);
  info.subpass.depth_stencil = 1;
  Pipeline pipeline{HostMemory()};
  info.fill(pipeline);
  EXPECT_TRUE(pipeline.state.rasterizer_discard);
}

TEST(PipelineState, DynamicViewportsAndScissorsAreNotRead) {
  Info info;
  info.viewports.viewportCount = info.viewports.scissorCount = 3;
  info.viewports.pViewports = Info::invalid<VkViewport>();
  info.viewports.pScissors = Info::invalid<VkRect2D>();
  const VkDynamicState states[] = {VK_DYNAMIC_STATE_SCISSOR, VK_DYNAMIC_STATE_VIEWPORT,
                                   VK_DYNAMIC_STATE_STENCIL_REFERENCE};
  VkPipelineDynamicStateCreateInfo dynamic = make_struct<VkPipelineDynamicStateCreateInfo>();
  dynamic.dynamicStateCount = 3;
  dynamic.pDynamicStates = states;
  info.info.pDynamicState = &dynamic;
  Pipeline pipeline{HostMemory()};
  info.fill(pipeline);
  DynamicStates expected;
  for (const auto s : {DynamicState::kViewport, DynamicState::kScissor, DynamicState::kStencilReference}) {
    expected.set(s);
  }
  EXPECT_EQ(pipeline.dynamic, expected);
  EXPECT_EQ(pipeline.state.viewport_count, 3u);
}

TEST(PipelineState, StencilValuesAreBytes) {
  Info info;
  VkPipelineDepthStencilStateCreateInfo depth = make_struct<VkPipelineDepthStencilStateCreateInfo>();
  depth.depthWriteEnable = VK_TRUE;
  depth.stencilTestEnable = VK_TRUE;
  depth.back.reference = 0x1ff;
  info.info.pDepthStencilState = &depth;
  info.subpass.depth_stencil = 0;
  Pipeline pipeline{HostMemory()};
  info.fill(pipeline);
  EXPECT_TRUE(pipeline.state.stencil_test);
  EXPECT_EQ(pipeline.state.back.reference, 0xff);
}

TEST(PipelineState, VertexInputOutOfLimitsIsCut) {
  Info info;
  const VkVertexInputBindingDescription bindings[] = {{3, 20, VK_VERTEX_INPUT_RATE_INSTANCE},
                                                      {99, 4, VK_VERTEX_INPUT_RATE_VERTEX}};
  const std::vector<VkVertexInputAttributeDescription> attributes(40, {1, 3, VK_FORMAT_R32_SFLOAT, 4});
  info.vertex_input.vertexBindingDescriptionCount = 2;
  info.vertex_input.pVertexBindingDescriptions = bindings;
  info.vertex_input.vertexAttributeDescriptionCount = 40;
  info.vertex_input.pVertexAttributeDescriptions = attributes.data();
  Pipeline pipeline{HostMemory()};
  info.fill(pipeline);
  EXPECT_TRUE(pipeline.streams[3].used && pipeline.streams[3].per_instance);
  EXPECT_EQ(pipeline.streams[3].stride, 20u);
  EXPECT_EQ(pipeline.state.attribute_count, raster::kMaxVertexAttributes);
}

}  // namespace
}  // namespace vitrine::icd

// Draws of a device with VK_KHR_maintenance5, described by a few values; their shaders are chained to the stages.
#pragma once

#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "tests/icd/maintenance5_fixture.h"

#ifdef VK_KHR_maintenance6
namespace vitrine::icd::test {

inline constexpr std::uint32_t kSide = 16;  ///< pixels of the target
inline constexpr char kCover[] =
    "void main() { vec2 p = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 4 - 1; gl_Position = vec4(p, 0.5, 1); }";

/// What a draw of this file is: three vertices without attributes, or others by `record`.
struct Draw {
  std::string vertex = kCover, fragment;  ///< without a fragment shader nothing is rasterized
  VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
  VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  VkPolygonMode polygon_mode = VK_POLYGON_MODE_FILL;
  VkSampleMask sample_mask = ~0u;
  bool alpha_to_coverage = false, blends = false, as_library = false;
  float depth_bias = 0;                 ///< the constant
  const void* rasterization = nullptr;  ///< chained to that state
  std::vector<VkDynamicState> dynamic;
  VkImageView depth = VK_NULL_HANDLE;  ///< of D32_SFLOAT; nothing is tested against it
  bool has_attribute = false;          ///< binding 0, one 32-bit integer a vertex
};

class Maintenance5Draws : public Maintenance5Device {
 protected:
  void SetUp() override {
    Maintenance5Device::SetUp();
    const VkDescriptorSetLayoutBinding bindings[] = {
        {0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_ALL, nullptr},
        {1, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_ALL, nullptr}};
    auto shape = make_struct<VkDescriptorSetLayoutCreateInfo>();
    shape.bindingCount = 2;
    shape.pBindings = bindings;
    ASSERT_EQ(VK_GET(instance, CreateDescriptorSetLayout)(device, &shape, nullptr, &set_layout), VK_SUCCESS);
    const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1},
                                          {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1}};
    auto pool_info = make_struct<VkDescriptorPoolCreateInfo>();
    pool_info.maxSets = 1;
    pool_info.poolSizeCount = 2;
    pool_info.pPoolSizes = sizes;
    ASSERT_EQ(VK_GET(instance, CreateDescriptorPool)(device, &pool_info, nullptr, &descriptor_pool), VK_SUCCESS);
    auto allocate = make_struct<VkDescriptorSetAllocateInfo>();
    allocate.descriptorPool = descriptor_pool;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &set_layout;
    ASSERT_EQ(VK_GET(instance, AllocateDescriptorSets)(device, &allocate, &set), VK_SUCCESS);
    const VkPushConstantRange range{VK_SHADER_STAGE_ALL, 0, 4};
    auto info = make_struct<VkPipelineLayoutCreateInfo>();
    info.setLayoutCount = 1;
    info.pSetLayouts = &set_layout;
    info.pushConstantRangeCount = 1;
    info.pPushConstantRanges = &range;
    ASSERT_EQ(VK_GET(instance, CreatePipelineLayout)(device, &info, nullptr, &layout), VK_SUCCESS);
    results = make_bytes(256);
    const VkDescriptorBufferInfo buffer{results.buffer, 0, VK_WHOLE_SIZE};
    write_set(0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, &buffer, nullptr);
  }

  void TearDown() override {
    VK_GET(instance, DestroySampler)(device, sampler, nullptr);
    VK_GET(instance, DestroyPipelineLayout)(device, layout, nullptr);
    VK_GET(instance, DestroyDescriptorPool)(device, descriptor_pool, nullptr);
    VK_GET(instance, DestroyDescriptorSetLayout)(device, set_layout, nullptr);
    Maintenance5Device::TearDown();
  }

  void write_set(std::uint32_t binding, VkDescriptorType type, const VkDescriptorBufferInfo* buffer,
                 const VkDescriptorImageInfo* image) {
    auto write = make_struct<VkWriteDescriptorSet>();
    write.dstSet = set;
    write.dstBinding = binding;
    write.descriptorCount = 1;
    write.descriptorType = type;
    write.pBufferInfo = buffer;
    write.pImageInfo = image;
    VK_GET(instance, UpdateDescriptorSets)(device, 1, &write, 0, nullptr);
  }

  /// Lets binding 1 sample `picture`, filtered and with a white border.
  void sample(const Picture& picture) {
    auto info = make_struct<VkSamplerCreateInfo>();
    info.magFilter = VK_FILTER_LINEAR;
    info.addressModeU = info.addressModeV = info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
    info.borderColor = VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE;
    VK_GET(instance, DestroySampler)(device, sampler, nullptr);
    ASSERT_EQ(VK_GET(instance, CreateSampler)(device, &info, nullptr, &sampler), VK_SUCCESS);
    const VkDescriptorImageInfo image{sampler, picture.view, VK_IMAGE_LAYOUT_GENERAL};
    write_set(1, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, nullptr, &image);
  }

  /// Every stage's words are chained to it (Vulkan 1.4.309, VkPipelineShaderStageCreateInfo); there is no module.
  VkPipeline make_pipeline(const Draw& draw) {
    const bool rasterizes = !draw.fragment.empty();
    const auto vertex_words = compile(VK_SHADER_STAGE_VERTEX_BIT, draw.vertex);
    const auto fragment_words = compile(VK_SHADER_STAGE_FRAGMENT_BIT, rasterizes ? draw.fragment : "void main() {}");
    auto vertex = module_info(vertex_words), fragment = module_info(fragment_words);
    std::array<VkPipelineShaderStageCreateInfo, 2> stages{make_struct<VkPipelineShaderStageCreateInfo>(&vertex),
                                                          make_struct<VkPipelineShaderStageCreateInfo>(&fragment)};
    stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT;
    stages[1].stage = VK_SHADER_STAGE_FRAGMENT_BIT;
    stages[0].pName = stages[1].pName = "main";
    const VkVertexInputBindingDescription binding{0, 4, VK_VERTEX_INPUT_RATE_VERTEX};
    const VkVertexInputAttributeDescription attribute{0, 0, VK_FORMAT_R32_UINT, 0};
    auto input = make_struct<VkPipelineVertexInputStateCreateInfo>();
    input.vertexBindingDescriptionCount = input.vertexAttributeDescriptionCount = draw.has_attribute;
    input.pVertexBindingDescriptions = &binding;
    input.pVertexAttributeDescriptions = &attribute;
    auto assembly = make_struct<VkPipelineInputAssemblyStateCreateInfo>();
    assembly.topology = draw.topology;
    const VkViewport area{0, 0, kSide, kSide, 0, 1};
    const VkRect2D scissor{{0, 0}, {kSide, kSide}};
    auto viewport = make_struct<VkPipelineViewportStateCreateInfo>();
    viewport.viewportCount = viewport.scissorCount = 1;
    viewport.pViewports = &area;
    viewport.pScissors = &scissor;
    auto rasterization = make_struct<VkPipelineRasterizationStateCreateInfo>();
    rasterization.pNext = draw.rasterization;
    rasterization.depthBiasEnable = VK_TRUE;
    rasterization.depthBiasConstantFactor = draw.depth_bias;
    rasterization.lineWidth = 1;
    rasterization.polygonMode = draw.polygon_mode;
    rasterization.rasterizerDiscardEnable = !rasterizes;
    auto multisample = make_struct<VkPipelineMultisampleStateCreateInfo>();
    multisample.rasterizationSamples = draw.samples;
    multisample.pSampleMask = &draw.sample_mask;
    multisample.alphaToCoverageEnable = draw.alpha_to_coverage;
    VkPipelineColorBlendAttachmentState attachment{};
    attachment.colorWriteMask = 0xf;
    attachment.blendEnable = draw.blends;
    attachment.srcColorBlendFactor = attachment.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    attachment.dstColorBlendFactor = attachment.dstAlphaBlendFactor = VK_BLEND_FACTOR_DST_ALPHA;
    auto blend = make_struct<VkPipelineColorBlendStateCreateInfo>();
    blend.attachmentCount = 1;
    blend.pAttachments = &attachment;
    auto rendering = make_struct<VkPipelineRenderingCreateInfo>();
    rendering.colorAttachmentCount = 1;
    rendering.pColorAttachmentFormats = &draw.format;
    if (draw.depth) rendering.depthAttachmentFormat = VK_FORMAT_D32_SFLOAT;
    auto parts = make_struct<VkGraphicsPipelineLibraryCreateInfoEXT>(&rendering);
    parts.flags = 0xf;
    auto flags =
        make_struct<VkPipelineCreateFlags2CreateInfoKHR>(draw.as_library ? static_cast<void*>(&parts) : &rendering);
    if (draw.as_library) flags.flags = VK_PIPELINE_CREATE_2_LIBRARY_BIT_KHR;
    auto info = make_struct<VkGraphicsPipelineCreateInfo>(&flags);
    info.stageCount = 2;
    info.pStages = stages.data();
    info.pVertexInputState = &input;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &rasterization;
    info.pMultisampleState = &multisample;
    const auto depth = make_struct<VkPipelineDepthStencilStateCreateInfo>();
    if (draw.depth) info.pDepthStencilState = &depth;
    info.pColorBlendState = &blend;
    auto dynamic = make_struct<VkPipelineDynamicStateCreateInfo>();
    dynamic.dynamicStateCount = static_cast<std::uint32_t>(draw.dynamic.size());
    dynamic.pDynamicStates = draw.dynamic.data();
    info.pDynamicState = &dynamic;
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    EXPECT_EQ(VK_GET(instance, CreateGraphicsPipelines)(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
              VK_SUCCESS);
    return pipeline;
  }

  /// Runs what `record` records with the draw's pipeline bound, into a target that holds `clear`.
  template <class Record>
  Picture render(const Draw& draw, Record record, VkClearColorValue clear = {}, VkPipeline linked = VK_NULL_HANDLE) {
    const Picture target = make_picture(VK_IMAGE_TYPE_2D, draw.format, {kSide, kSide, 1}, 1, draw.samples);
    const VkPipeline pipeline = linked ? linked : make_pipeline(draw);
    run([&](VkCommandBuffer commands) {
      auto attachment = make_struct<VkRenderingAttachmentInfo>();
      attachment.imageView = target.view;
      attachment.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
      attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
      attachment.clearValue.color = clear;
      auto info = make_struct<VkRenderingInfo>();
      info.renderArea = {{0, 0}, {kSide, kSide}};
      info.layerCount = 1;
      info.colorAttachmentCount = 1;
      info.pColorAttachments = &attachment;
      auto depth = make_struct<VkRenderingAttachmentInfo>();
      depth.imageView = draw.depth;
      depth.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
      if (draw.depth) info.pDepthAttachment = &depth;
      VK_GET(instance, CmdBeginRenderingKHR)(commands, &info);
      VK_GET(instance, CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
      VK_GET(instance, CmdBindDescriptorSets)
      (commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0, 1, &set, 0, nullptr);
      record(commands);
      VK_GET(instance, CmdEndRenderingKHR)(commands);
    });
    if (!linked) VK_GET(instance, DestroyPipeline)(device, pipeline, nullptr);
    return target;
  }
  Picture render(const Draw& draw, VkClearColorValue clear = {}) {
    return render(
        draw,
        [&](VkCommandBuffer commands) {
          VK_GET(instance, CmdDraw)
          (commands, 3, 1, 0, 0);
        },
        clear);
  }

  static std::uint32_t texel(const Picture& picture, std::uint32_t x, std::uint32_t y, std::uint32_t bytes) {
    std::uint32_t value = 0;
    std::memcpy(&value, picture.row(0, y) + x * bytes, bytes);
    return value;
  }
  static std::vector<std::uint32_t> texels(const Picture& picture, std::uint32_t bytes) {
    std::vector<std::uint32_t> out;
    for (std::uint32_t i = 0; i < kSide * kSide; ++i) out.push_back(texel(picture, i % kSide, i / kSide, bytes));
    return out;
  }
  std::vector<std::uint32_t> words(std::size_t count) const {
    std::vector<std::uint32_t> out(count);
    std::memcpy(out.data(), results.data, count * 4);
    return out;
  }

  VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
  VkDescriptorPool descriptor_pool = VK_NULL_HANDLE;
  VkDescriptorSet set = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkSampler sampler = VK_NULL_HANDLE;
  Bytes results;
};

}  // namespace vitrine::icd::test
#endif

// The objects of the tests of what has been written: see written_memory_fixture.h.
#include "tests/icd/written_memory_fixture.h"

namespace vitrine::icd::test {
namespace {

constexpr std::array kTypes{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                            VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER};

}  // namespace

void WrittenMemory::listen() {
  auto info = make_struct<VkDebugUtilsMessengerCreateInfoEXT>();
  info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
  info.pfnUserCallback = [](VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                            const VkDebugUtilsMessengerCallbackDataEXT* data, void* self) -> VkBool32 {
    auto& test = *static_cast<WrittenMemory*>(self);
    test.found.emplace_back(data->pMessageIdName);
    test.text = data->pMessage;
    return VK_FALSE;
  };
  info.pUserData = this;
  ASSERT_EQ(VK_CALL(CreateDebugUtilsMessengerEXT)(instance, &info, nullptr, &messenger), VK_SUCCESS);
}

void WrittenMemory::make(Memory& memory) {
  auto allocate = make_struct<VkMemoryAllocateInfo>();
  allocate.allocationSize = kBytes;
  ASSERT_EQ(VK_CALL(AllocateMemory)(device, &allocate, nullptr, &memory.memory), VK_SUCCESS);
  auto info = make_struct<VkBufferCreateInfo>();
  info.size = kBytes;
  info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  ASSERT_EQ(VK_CALL(CreateBuffer)(device, &info, nullptr, &memory.buffer), VK_SUCCESS);
  ASSERT_EQ(VK_CALL(BindBufferMemory)(device, memory.buffer, memory.memory, 0), VK_SUCCESS);
}

void WrittenMemory::make_image() {
  auto info = make_struct<VkImageCreateInfo>();
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = VK_FORMAT_R32_UINT;
  info.extent = {kSize, kSize, 1};
  info.mipLevels = info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
               VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  ASSERT_EQ(VK_CALL(CreateImage)(device, &info, nullptr, &image), VK_SUCCESS);
  VkMemoryRequirements needs;
  VK_CALL(GetImageMemoryRequirements)(device, image, &needs);
  auto allocate = make_struct<VkMemoryAllocateInfo>();
  allocate.allocationSize = needs.size;
  ASSERT_EQ(VK_CALL(AllocateMemory)(device, &allocate, nullptr, &image_memory), VK_SUCCESS);
  ASSERT_EQ(VK_CALL(BindImageMemory)(device, image, image_memory, 0), VK_SUCCESS);
  auto view_info = make_struct<VkImageViewCreateInfo>();
  view_info.image = image;
  view_info.viewType = VK_IMAGE_VIEW_TYPE_2D;
  view_info.format = info.format;
  view_info.subresourceRange = kAll;
  ASSERT_EQ(VK_CALL(CreateImageView)(device, &view_info, nullptr, &view), VK_SUCCESS);
  const auto sampler_info = make_struct<VkSamplerCreateInfo>();
  ASSERT_EQ(VK_CALL(CreateSampler)(device, &sampler_info, nullptr, &sampler), VK_SUCCESS);
}

void WrittenMemory::make_set() {
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  std::vector<VkDescriptorPoolSize> sizes;
  for (const VkDescriptorType type : kTypes) {
    bindings.push_back({static_cast<std::uint32_t>(bindings.size()), type, 1, VK_SHADER_STAGE_ALL, nullptr});
    sizes.push_back({type, 1});
  }
  auto info = make_struct<VkDescriptorSetLayoutCreateInfo>();
  info.bindingCount = static_cast<std::uint32_t>(bindings.size());
  info.pBindings = bindings.data();
  ASSERT_EQ(VK_CALL(CreateDescriptorSetLayout)(device, &info, nullptr, &set_layout), VK_SUCCESS);
  auto layout_info = make_struct<VkPipelineLayoutCreateInfo>();
  layout_info.setLayoutCount = 1;
  layout_info.pSetLayouts = &set_layout;
  ASSERT_EQ(VK_CALL(CreatePipelineLayout)(device, &layout_info, nullptr, &layout), VK_SUCCESS);
  auto pool_info = make_struct<VkDescriptorPoolCreateInfo>();
  pool_info.maxSets = 1;
  pool_info.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
  pool_info.pPoolSizes = sizes.data();
  ASSERT_EQ(VK_CALL(CreateDescriptorPool)(device, &pool_info, nullptr, &descriptor_pool), VK_SUCCESS);
  auto allocate = make_struct<VkDescriptorSetAllocateInfo>();
  allocate.descriptorPool = descriptor_pool;
  allocate.descriptorSetCount = 1;
  allocate.pSetLayouts = &set_layout;
  ASSERT_EQ(VK_CALL(AllocateDescriptorSets)(device, &allocate, &set), VK_SUCCESS);
  write_set();
}

void WrittenMemory::write_set() {
  const VkDescriptorImageInfo texture{sampler, view, VK_IMAGE_LAYOUT_GENERAL};
  for (std::uint32_t binding = 0; binding < kTypes.size(); ++binding) {
    const VkDescriptorBufferInfo range{binding == 0 ? input.buffer : result.buffer, 0, VK_WHOLE_SIZE};
    auto info = make_struct<VkWriteDescriptorSet>();
    info.dstSet = set;
    info.dstBinding = binding;
    info.descriptorCount = 1;
    info.descriptorType = kTypes[binding];
    info.pBufferInfo = &range;
    info.pImageInfo = &texture;
    VK_CALL(UpdateDescriptorSets)(device, 1, &info, 0, nullptr);
  }
}

VkPipelineShaderStageCreateInfo WrittenMemory::stage_of(VkShaderStageFlagBits stage, const std::string& glsl) {
  std::string log;
  const auto words = vitrine::test::compile_glsl(stage, glsl, vitrine::test::VulkanVersion::k12, log);
  EXPECT_FALSE(words.empty()) << log << glsl;
  auto module_info = make_struct<VkShaderModuleCreateInfo>();
  module_info.codeSize = words.size() * sizeof words[0];
  module_info.pCode = words.data();
  auto info = make_struct<VkPipelineShaderStageCreateInfo>();
  info.stage = stage;
  info.pName = "main";
  EXPECT_EQ(VK_CALL(CreateShaderModule)(device, &module_info, nullptr, &info.module), VK_SUCCESS);
  return info;
}

void WrittenMemory::run_render_pass(VkCommandBuffer commands, VkAttachmentLoadOp load, VkAttachmentStoreOp store,
                                    VkImageLayout initial) {
  VkAttachmentDescription attachment{};
  attachment.format = VK_FORMAT_R32_UINT;
  attachment.samples = VK_SAMPLE_COUNT_1_BIT;
  attachment.loadOp = load;
  attachment.storeOp = store;
  attachment.initialLayout = initial;
  attachment.finalLayout = VK_IMAGE_LAYOUT_GENERAL;
  const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_GENERAL};
  VkSubpassDescription subpass{};
  subpass.colorAttachmentCount = 1;
  subpass.pColorAttachments = &reference;
  auto info = make_struct<VkRenderPassCreateInfo>();
  info.attachmentCount = 1;
  info.pAttachments = &attachment;
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  auto begin = make_struct<VkRenderPassBeginInfo>();
  ASSERT_EQ(VK_CALL(CreateRenderPass)(device, &info, nullptr, &begin.renderPass), VK_SUCCESS);
  render_passes.push_back(begin.renderPass);
  auto framebuffer = make_struct<VkFramebufferCreateInfo>();
  framebuffer.renderPass = begin.renderPass;
  framebuffer.attachmentCount = 1;
  framebuffer.pAttachments = &view;
  framebuffer.width = framebuffer.height = kSize;
  framebuffer.layers = 1;
  ASSERT_EQ(VK_CALL(CreateFramebuffer)(device, &framebuffer, nullptr, &begin.framebuffer), VK_SUCCESS);
  framebuffers.push_back(begin.framebuffer);
  const VkClearValue value{};
  begin.renderArea.extent = {kSize, kSize};
  begin.clearValueCount = 1;
  begin.pClearValues = &value;
  VK_CALL(CmdBeginRenderPass)(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
  VK_CALL(CmdEndRenderPass)(commands);
}

void WrittenMemory::draw(VkCommandBuffer commands) {
  const std::array stages{
      stage_of(VK_SHADER_STAGE_VERTEX_BIT,
               "#version 450\nvoid main() { gl_Position = vec4(vec2(gl_VertexIndex % 2, gl_VertexIndex / 2) * 4.0 - "
               "1.0, 0.0, 1.0); }"),
      stage_of(VK_SHADER_STAGE_FRAGMENT_BIT,
               "#version 450\nlayout(location = 0) out uint c;\nvoid main() { c = 1u; }")};
  auto vertices = make_struct<VkPipelineVertexInputStateCreateInfo>();
  auto assembly = make_struct<VkPipelineInputAssemblyStateCreateInfo>();
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  const VkViewport viewport{0, 0, kSize, kSize, 0, 1};
  const VkRect2D scissor{{0, 0}, {kSize, kSize}};
  auto viewports = make_struct<VkPipelineViewportStateCreateInfo>();
  viewports.viewportCount = viewports.scissorCount = 1;
  viewports.pViewports = &viewport;
  viewports.pScissors = &scissor;
  auto raster = make_struct<VkPipelineRasterizationStateCreateInfo>();
  raster.lineWidth = 1;
  auto samples = make_struct<VkPipelineMultisampleStateCreateInfo>();
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  VkPipelineColorBlendAttachmentState write{};
  write.colorWriteMask = VK_COLOR_COMPONENT_R_BIT;
  auto blend = make_struct<VkPipelineColorBlendStateCreateInfo>();
  blend.attachmentCount = 1;
  blend.pAttachments = &write;
  const VkFormat format = VK_FORMAT_R32_UINT;
  auto rendering = make_struct<VkPipelineRenderingCreateInfo>();
  rendering.colorAttachmentCount = 1;
  rendering.pColorAttachmentFormats = &format;
  auto info = make_struct<VkGraphicsPipelineCreateInfo>(&rendering);
  info.stageCount = 2;
  info.pStages = stages.data();
  info.pVertexInputState = &vertices;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewports;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &samples;
  info.pColorBlendState = &blend;
  info.layout = layout;
  VkPipeline pipeline = VK_NULL_HANDLE;
  ASSERT_EQ(VK_CALL(CreateGraphicsPipelines)(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline), VK_SUCCESS);
  pipelines.push_back(pipeline);
  for (const auto& stage : stages) VK_CALL(DestroyShaderModule)(device, stage.module, nullptr);
  VK_CALL(CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
  VK_CALL(CmdDraw)(commands, 3, 1, 0, 0);
}

}  // namespace vitrine::icd::test

// The objects of the tests of sync: see sync_scene.h.
#include <array>
#include <sstream>

#include "tests/icd/sync_scene.h"

namespace vitrine::icd::test {
namespace {

constexpr VkDeviceSize kBytes = 256;
constexpr std::uint32_t kSize = 8;
constexpr std::array kTypes{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,        VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                            VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,        VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
                            VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,         VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                            VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,         VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                            VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER};

}  // namespace

SyncScene::SyncScene() {
  EXPECT_EQ(create_instance(&instance, nullptr, {VK_EXT_DEBUG_UTILS_EXTENSION_NAME}), VK_SUCCESS);
  std::uint32_t count = 1;
  EXPECT_EQ(VK_CALL(EnumeratePhysicalDevices)(instance, &count, &physical_device_), VK_SUCCESS);
  EXPECT_EQ(create_device(instance, physical_device_, &device), VK_SUCCESS);
  VK_CALL(GetDeviceQueue)(device, 0, 0, &queue_);
  auto info = make_struct<VkDebugUtilsMessengerCreateInfoEXT>();
  info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
  info.pfnUserCallback = [](VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                            const VkDebugUtilsMessengerCallbackDataEXT* data, void* self) -> VkBool32 {
    auto& scene = *static_cast<SyncScene*>(self);
    scene.found_.emplace_back(data->pMessageIdName);
    scene.text_ = data->pMessage;
    return VK_FALSE;
  };
  info.pUserData = this;
  EXPECT_EQ(VK_CALL(CreateDebugUtilsMessengerEXT)(instance, &info, nullptr, &messenger_), VK_SUCCESS);
  for (const char* const one : {"A", "B", "C"}) make_buffer(one);
  for (const char* const one : {"M", "N"}) make_image(one, VK_FORMAT_R8G8B8A8_UNORM, VK_SAMPLE_COUNT_1_BIT);
  make_image("S", VK_FORMAT_R8G8B8A8_UNORM, VK_SAMPLE_COUNT_4_BIT);
  make_image("D", VK_FORMAT_D32_SFLOAT, VK_SAMPLE_COUNT_1_BIT);
  make_image("L", VK_FORMAT_R8G8B8A8_UNORM, VK_SAMPLE_COUNT_1_BIT, 2);
  make_image("R", VK_FORMAT_R8_UINT, VK_SAMPLE_COUNT_1_BIT);
  make_image("X", VK_FORMAT_R8G8B8A8_UNORM, VK_SAMPLE_COUNT_1_BIT, 1, true);
  make_set();
  const auto pool_info = make_struct<VkCommandPoolCreateInfo>();
  EXPECT_EQ(VK_CALL(CreateCommandPool)(device, &pool_info, nullptr, &pool_), VK_SUCCESS);
  const auto event_info = make_struct<VkEventCreateInfo>();
  EXPECT_EQ(VK_CALL(CreateEvent)(device, &event_info, nullptr, &event_), VK_SUCCESS);
  auto query_info = make_struct<VkQueryPoolCreateInfo>();
  query_info.queryType = VK_QUERY_TYPE_TIMESTAMP;
  query_info.queryCount = 1;
  EXPECT_EQ(VK_CALL(CreateQueryPool)(device, &query_info, nullptr, &queries_), VK_SUCCESS);
  begin();
  to_general();
  submit();
  EXPECT_EQ(VK_CALL(QueueWaitIdle)(queue_), VK_SUCCESS);
}

SyncScene::~SyncScene() {
  VK_CALL(QueueWaitIdle)(queue_);
  VK_CALL(DestroyCommandPool)(device, pool_, nullptr);
  VK_CALL(DestroyQueryPool)(device, queries_, nullptr);
  VK_CALL(DestroyEvent)(device, event_, nullptr);
  for (const VkPipeline p : pipelines_) VK_CALL(DestroyPipeline)(device, p, nullptr);
  for (const VkFramebuffer f : framebuffers_) VK_CALL(DestroyFramebuffer)(device, f, nullptr);
  for (const VkRenderPass p : passes_) VK_CALL(DestroyRenderPass)(device, p, nullptr);
  for (const VkSemaphore s : semaphores_) VK_CALL(DestroySemaphore)(device, s, nullptr);
  VK_CALL(DestroyPipelineLayout)(device, layout_, nullptr);
  VK_CALL(DestroyDescriptorPool)(device, descriptors_, nullptr);
  VK_CALL(DestroyDescriptorSetLayout)(device, set_layout_, nullptr);
  VK_CALL(DestroySampler)(device, sampler_, nullptr);
  for (const auto& [name, one] : images_) {
    VK_CALL(DestroyImageView)(device, one.view, nullptr);
    VK_CALL(DestroyImage)(device, one.image, nullptr);
    VK_CALL(FreeMemory)(device, one.memory, nullptr);
  }
  for (const auto& [name, one] : buffers_) {
    VK_CALL(DestroyBuffer)(device, one.buffer, nullptr);
    VK_CALL(FreeMemory)(device, one.memory, nullptr);
  }
  VK_CALL(DestroyDevice)(device, nullptr);
  VK_CALL(DestroyDebugUtilsMessengerEXT)(instance, messenger_, nullptr);
  VK_CALL(DestroyInstance)(instance, nullptr);
}

template <class H>
void SyncScene::name(VkObjectType type, H handle, const char* text) {
  auto info = make_struct<VkDebugUtilsObjectNameInfoEXT>();
  info.objectType = type;
  info.objectHandle = reinterpret_cast<std::uint64_t>(handle);
  info.pObjectName = text;
  EXPECT_EQ(VK_CALL(SetDebugUtilsObjectNameEXT)(device, &info), VK_SUCCESS);
}

void SyncScene::make_buffer(const char* text) {
  Buffer made;
  auto allocate = make_struct<VkMemoryAllocateInfo>();
  allocate.allocationSize = kBytes;
  EXPECT_EQ(VK_CALL(AllocateMemory)(device, &allocate, nullptr, &made.memory), VK_SUCCESS);
  auto info = make_struct<VkBufferCreateInfo>();
  info.size = kBytes;
  info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
               VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT |
               VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
  EXPECT_EQ(VK_CALL(CreateBuffer)(device, &info, nullptr, &made.buffer), VK_SUCCESS);
  EXPECT_EQ(VK_CALL(BindBufferMemory)(device, made.buffer, made.memory, 0), VK_SUCCESS);
  void* mapped = nullptr;
  EXPECT_EQ(VK_CALL(MapMemory)(device, made.memory, 0, VK_WHOLE_SIZE, 0, &mapped), VK_SUCCESS);
  // Arguments of draws and dispatches of something.
  for (std::uint32_t i = 0; i < kBytes / 4; ++i) static_cast<std::uint32_t*>(mapped)[i] = i == 0 ? 3 : 1;
  name(VK_OBJECT_TYPE_BUFFER, made.buffer, text);
  buffers_[text] = made;
}

void SyncScene::make_image(const char* text, VkFormat format, VkSampleCountFlagBits samples, std::uint32_t levels,
                           bool exported) {
  Image made;
  const bool depth = format == VK_FORMAT_D32_SFLOAT, single = samples == VK_SAMPLE_COUNT_1_BIT;
  const VkImageUsageFlags rates = VK_IMAGE_USAGE_FRAGMENT_SHADING_RATE_ATTACHMENT_BIT_KHR;
  made.format = format;
  if (depth) made.aspect = VK_IMAGE_ASPECT_DEPTH_BIT;
  auto info = make_struct<VkImageCreateInfo>();
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format;
  info.extent = {kSize, kSize, 1};
  info.mipLevels = levels;
  info.arrayLayers = 1;
  info.samples = samples;
  info.usage =
      VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
      (depth ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT : VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT) |
      (single && !depth && levels == 1 ? VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT : 0) |
      (format == VK_FORMAT_R8_UINT ? rates : 0);
  EXPECT_EQ(VK_CALL(CreateImage)(device, &info, nullptr, &made.image), VK_SUCCESS);
  VkMemoryRequirements needs;
  VK_CALL(GetImageMemoryRequirements)(device, made.image, &needs);
  auto handles = make_struct<VkExportMemoryAllocateInfo>();
  handles.handleTypes = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
  auto allocate = make_struct<VkMemoryAllocateInfo>(exported ? &handles : nullptr);
  allocate.allocationSize = needs.size;
  EXPECT_EQ(VK_CALL(AllocateMemory)(device, &allocate, nullptr, &made.memory), VK_SUCCESS);
  EXPECT_EQ(VK_CALL(BindImageMemory)(device, made.image, made.memory, 0), VK_SUCCESS);
  auto view_info = make_struct<VkImageViewCreateInfo>();
  view_info.image = made.image;
  view_info.viewType = VK_IMAGE_VIEW_TYPE_2D;
  view_info.format = format;
  view_info.subresourceRange = {made.aspect, 0, levels, 0, 1};
  EXPECT_EQ(VK_CALL(CreateImageView)(device, &view_info, nullptr, &made.view), VK_SUCCESS);
  name(VK_OBJECT_TYPE_IMAGE, made.image, text);
  images_[text] = made;
}

void SyncScene::make_set() {
  const auto sampler_info = make_struct<VkSamplerCreateInfo>();
  EXPECT_EQ(VK_CALL(CreateSampler)(device, &sampler_info, nullptr, &sampler_), VK_SUCCESS);
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  std::vector<VkDescriptorPoolSize> sizes;
  for (const VkDescriptorType type : kTypes) {
    bindings.push_back({static_cast<std::uint32_t>(bindings.size()), type, 1, VK_SHADER_STAGE_ALL, nullptr});
    sizes.push_back({type, 1});
  }
  auto info = make_struct<VkDescriptorSetLayoutCreateInfo>();
  info.bindingCount = static_cast<std::uint32_t>(bindings.size());
  info.pBindings = bindings.data();
  EXPECT_EQ(VK_CALL(CreateDescriptorSetLayout)(device, &info, nullptr, &set_layout_), VK_SUCCESS);
  auto layout_info = make_struct<VkPipelineLayoutCreateInfo>();
  layout_info.setLayoutCount = 1;
  layout_info.pSetLayouts = &set_layout_;
  EXPECT_EQ(VK_CALL(CreatePipelineLayout)(device, &layout_info, nullptr, &layout_), VK_SUCCESS);
  auto pool_info = make_struct<VkDescriptorPoolCreateInfo>();
  pool_info.maxSets = 1;
  pool_info.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
  pool_info.pPoolSizes = sizes.data();
  EXPECT_EQ(VK_CALL(CreateDescriptorPool)(device, &pool_info, nullptr, &descriptors_), VK_SUCCESS);
  auto allocate = make_struct<VkDescriptorSetAllocateInfo>();
  allocate.descriptorPool = descriptors_;
  allocate.descriptorSetCount = 1;
  allocate.pSetLayouts = &set_layout_;
  EXPECT_EQ(VK_CALL(AllocateDescriptorSets)(device, &allocate, &set_), VK_SUCCESS);
  for (std::uint32_t binding = 0; binding < kTypes.size(); ++binding) {
    constexpr const char* kNames[] = {"A", "B", "C", "A", "M", "M", "N", "N", "L"};
    const VkBuffer buffer = binding < 4 ? buffers_.at(kNames[binding]).buffer : VK_NULL_HANDLE;
    const VkImageView view = binding < 4 ? VK_NULL_HANDLE : images_.at(kNames[binding]).view;
    const VkDescriptorBufferInfo range{buffer, 0, VK_WHOLE_SIZE};
    const VkDescriptorImageInfo texture{sampler_, view, VK_IMAGE_LAYOUT_GENERAL};
    auto write = make_struct<VkWriteDescriptorSet>();
    write.dstSet = set_;
    write.dstBinding = binding;
    write.descriptorCount = 1;
    write.descriptorType = kTypes[binding];
    write.pBufferInfo = &range;
    write.pImageInfo = &texture;
    VK_CALL(UpdateDescriptorSets)(device, 1, &write, 0, nullptr);
  }
}

void SyncScene::to_general() {
  std::vector<VkImageMemoryBarrier> barriers;
  for (const auto& [name, one] : images_) {
    auto b = make_struct<VkImageMemoryBarrier>();
    b.newLayout = VK_IMAGE_LAYOUT_GENERAL;
    b.image = one.image;
    b.subresourceRange = {one.aspect, 0, VK_REMAINING_MIP_LEVELS, 0, 1};
    barriers.push_back(b);
  }
  VK_CALL(CmdPipelineBarrier)
  (commands_, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0, nullptr,
   static_cast<std::uint32_t>(barriers.size()), barriers.data());
}

VkPipelineShaderStageCreateInfo SyncScene::stage_of(VkShaderStageFlagBits stage, const std::string& glsl) {
  std::string log;
  const auto words = vitrine::test::compile_glsl(stage, glsl, vitrine::test::VulkanVersion::k12, log,
                                                 vitrine::test::DebugInfo::kLines);
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

VkPipeline SyncScene::draw_pipeline(const std::string& vertex, const std::string& fragment, VkRenderPass pass,
                                    bool attributes) {
  const std::array stages{stage_of(VK_SHADER_STAGE_VERTEX_BIT, vertex),
                          stage_of(VK_SHADER_STAGE_FRAGMENT_BIT, fragment)};
  const VkVertexInputBindingDescription binding{0, 4, VK_VERTEX_INPUT_RATE_VERTEX};
  const VkVertexInputAttributeDescription attribute{0, 0, VK_FORMAT_R32_UINT, 0};
  auto vertices = make_struct<VkPipelineVertexInputStateCreateInfo>();
  vertices.vertexBindingDescriptionCount = vertices.vertexAttributeDescriptionCount = attributes;
  vertices.pVertexBindingDescriptions = &binding;
  vertices.pVertexAttributeDescriptions = &attribute;
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
  auto depth = make_struct<VkPipelineDepthStencilStateCreateInfo>();
  depth.depthTestEnable = depth.depthWriteEnable = has_depth_;
  depth.depthCompareOp = VK_COMPARE_OP_ALWAYS;
  VkPipelineColorBlendAttachmentState write{};
  write.colorWriteMask = VK_COLOR_COMPONENT_R_BIT;
  auto blend = make_struct<VkPipelineColorBlendStateCreateInfo>();
  blend.attachmentCount = has_depth_ ? 0 : 1;
  blend.pAttachments = &write;
  const VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
  auto rendering = make_struct<VkPipelineRenderingCreateInfo>();
  rendering.colorAttachmentCount = has_depth_ ? 0 : 1;
  rendering.pColorAttachmentFormats = &format;
  rendering.depthAttachmentFormat = has_depth_ ? VK_FORMAT_D32_SFLOAT : VK_FORMAT_UNDEFINED;
  auto rates = make_struct<VkPipelineFragmentShadingRateStateCreateInfoKHR>();
  rates.fragmentSize = {1, 1};
  if (has_rates_) rates.combinerOps[1] = VK_FRAGMENT_SHADING_RATE_COMBINER_OP_REPLACE_KHR;
  rendering.pNext = &rates;
  auto info = make_struct<VkGraphicsPipelineCreateInfo>(pass ? nullptr : &rendering);
  if (!pass) info.flags = VK_PIPELINE_CREATE_RENDERING_FRAGMENT_SHADING_RATE_ATTACHMENT_BIT_KHR;
  info.stageCount = 2;
  info.pStages = stages.data();
  info.pVertexInputState = &vertices;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewports;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &samples;
  info.pDepthStencilState = &depth;
  info.pColorBlendState = &blend;
  info.layout = layout_;
  info.renderPass = pass;
  info.subpass = pass ? 1 : 0;
  VkPipeline pipeline = VK_NULL_HANDLE;
  EXPECT_EQ(VK_CALL(CreateGraphicsPipelines)(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline), VK_SUCCESS);
  pipelines_.push_back(pipeline);
  for (const auto& stage : stages) VK_CALL(DestroyShaderModule)(device, stage.module, nullptr);
  return pipeline;
}

void SyncScene::begin() {
  auto allocate = make_struct<VkCommandBufferAllocateInfo>();
  allocate.commandPool = pool_;
  allocate.commandBufferCount = 1;
  EXPECT_EQ(VK_CALL(AllocateCommandBuffers)(device, &allocate, &commands_), VK_SUCCESS);
  const auto info = make_struct<VkCommandBufferBeginInfo>();
  EXPECT_EQ(VK_CALL(BeginCommandBuffer)(commands_, &info), VK_SUCCESS);
}

void SyncScene::submit(VkSemaphore signal, std::uint64_t value, VkFence fence) {
  EXPECT_EQ(VK_CALL(EndCommandBuffer)(commands_), VK_SUCCESS);
  auto values = make_struct<VkTimelineSemaphoreSubmitInfo>();
  values.waitSemaphoreValueCount = values.signalSemaphoreValueCount = 1;
  values.pWaitSemaphoreValues = &wait_value_;
  values.pSignalSemaphoreValues = &value;
  auto info = make_struct<VkSubmitInfo>(&values);
  info.waitSemaphoreCount = wait_ ? 1 : 0;
  info.pWaitSemaphores = &wait_;
  info.pWaitDstStageMask = &wait_stages_;
  info.commandBufferCount = 1;
  info.pCommandBuffers = &commands_;
  info.signalSemaphoreCount = signal ? 1 : 0;
  info.pSignalSemaphores = &signal;
  EXPECT_EQ(VK_CALL(QueueSubmit)(queue_, 1, &info, fence), VK_SUCCESS);
  wait_ = VK_NULL_HANDLE;
  begin();
}

std::vector<std::string> SyncScene::run(const std::string& script) {
  std::string line;
  std::istringstream lines(script);
  while (std::getline(lines, line, ';')) {
    Words words;
    std::istringstream text(line);
    for (std::string word; text >> word;) words.push_back(word);
    if (!words.empty()) command(words);
  }
  submit();
  EXPECT_EQ(VK_CALL(QueueWaitIdle)(queue_), VK_SUCCESS);
  std::vector<std::string> rules;
  for (const std::string& one : found_)
    if (rules.empty() || rules.back() != one) rules.push_back(one);
  return rules;
}

void expect_hazard(const PlantedHazard& planted) {
  {
    SyncScene scene;
    EXPECT_EQ(scene.run(planted.fault), std::vector<std::string>{planted.rule}) << planted.name << "\n" << scene.text();
  }
  SyncScene scene;
  EXPECT_EQ(scene.run(planted.twin), std::vector<std::string>{}) << planted.name << ", the twin\n" << scene.text();
}

}  // namespace vitrine::icd::test

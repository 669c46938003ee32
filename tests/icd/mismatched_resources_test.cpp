// Resources that do not match the shader, which no valid application has: descriptor sets of another layout than the
// pipeline's, sets, push constants and vertex buffers that were never bound. Never a crash; what does not match is as
// if it were null.
#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "tests/icd/fixture.h"
#include "tests/icd/resource_shaders.h"

namespace vitrine::icd::test {
namespace {

#define VK_CALL(name) VK_GET(instance, name)

constexpr std::uint32_t kKinds = 8;
/// What the shaders declare in set 0, by binding.
constexpr std::array<VkDescriptorType, kKinds> kTypes{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
                                                      VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                                      VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                                      VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
                                                      VK_DESCRIPTOR_TYPE_SAMPLER,
                                                      VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
                                                      VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,
                                                      VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER};

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

class MismatchedResources : public DeviceTest {
 protected:
  static constexpr VkDeviceSize kBytes = 4096;  ///< of each resource's memory
  static constexpr std::uint32_t kSize = 16;    ///< of the image

  void SetUp() override {
    DeviceTest::SetUp();
    data = make_buffer();
    result = make_buffer();
    make_image();
    auto view_info = make_struct<VkBufferViewCreateInfo>();
    view_info.buffer = data.buffer;
    view_info.format = VK_FORMAT_R32_SFLOAT;
    view_info.range = VK_WHOLE_SIZE;
    ASSERT_EQ(VK_CALL(CreateBufferView)(device, &view_info, nullptr, &texels), VK_SUCCESS);
    const auto sampler_info = make_struct<VkSamplerCreateInfo>();
    ASSERT_EQ(VK_CALL(CreateSampler)(device, &sampler_info, nullptr, &sampler), VK_SUCCESS);
    make_pool();
    output_layout = make_set_layout({VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
    output = make_set(output_layout);
    write(output, 0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, result.buffer);
    VK_CALL(GetDeviceQueue)(device, 0, 0, &queue);
    const auto command_pool_info = make_struct<VkCommandPoolCreateInfo>();
    ASSERT_EQ(VK_CALL(CreateCommandPool)(device, &command_pool_info, nullptr, &command_pool), VK_SUCCESS);
  }

  void TearDown() override {
    VK_CALL(DestroyCommandPool)(device, command_pool, nullptr);
    for (const VkPipeline p : pipelines) VK_CALL(DestroyPipeline)(device, p, nullptr);
    for (const VkPipelineLayout l : layouts) VK_CALL(DestroyPipelineLayout)(device, l, nullptr);
    VK_CALL(DestroyDescriptorPool)(device, descriptor_pool, nullptr);
    for (const VkDescriptorSetLayout l : set_layouts) VK_CALL(DestroyDescriptorSetLayout)(device, l, nullptr);
    VK_CALL(DestroySampler)(device, sampler, nullptr);
    VK_CALL(DestroyBufferView)(device, texels, nullptr);
    VK_CALL(DestroyImageView)(device, view, nullptr);
    VK_CALL(DestroyImage)(device, image, nullptr);
    for (const Memory& m : memories) {
      VK_CALL(DestroyBuffer)(device, m.buffer, nullptr);
      VK_CALL(FreeMemory)(device, m.memory, nullptr);
    }
    DeviceTest::TearDown();
  }

  struct Memory {
    VkBuffer buffer = VK_NULL_HANDLE;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    float* floats = nullptr;
  };

  Memory make_memory() {
    Memory m;
    auto allocate = make_struct<VkMemoryAllocateInfo>();
    allocate.allocationSize = kBytes;
    EXPECT_EQ(VK_CALL(AllocateMemory)(device, &allocate, nullptr, &m.memory), VK_SUCCESS);
    void* mapped = nullptr;
    EXPECT_EQ(VK_CALL(MapMemory)(device, m.memory, 0, VK_WHOLE_SIZE, 0, &mapped), VK_SUCCESS);
    m.floats = static_cast<float*>(mapped);
    std::fill_n(m.floats, kBytes / sizeof(float), 1.0f);
    return m;
  }

  Memory make_buffer() {
    Memory m = make_memory();
    auto info = make_struct<VkBufferCreateInfo>();
    info.size = kBytes;
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
                 VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT;
    EXPECT_EQ(VK_CALL(CreateBuffer)(device, &info, nullptr, &m.buffer), VK_SUCCESS);
    EXPECT_EQ(VK_CALL(BindBufferMemory)(device, m.buffer, m.memory, 0), VK_SUCCESS);
    memories.push_back(m);
    return m;
  }

  void make_image() {
    auto info = make_struct<VkImageCreateInfo>();
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = VK_FORMAT_R32_SFLOAT;
    info.extent = {kSize, kSize, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.tiling = VK_IMAGE_TILING_LINEAR;
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    ASSERT_EQ(VK_CALL(CreateImage)(device, &info, nullptr, &image), VK_SUCCESS);
    const Memory m = make_memory();
    memories.push_back(m);
    ASSERT_EQ(VK_CALL(BindImageMemory)(device, image, m.memory, 0), VK_SUCCESS);
    auto view_info = make_struct<VkImageViewCreateInfo>();
    view_info.image = image;
    view_info.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view_info.format = info.format;
    view_info.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    ASSERT_EQ(VK_CALL(CreateImageView)(device, &view_info, nullptr, &view), VK_SUCCESS);
  }

  void make_pool() {
    std::vector<VkDescriptorPoolSize> sizes;
    for (const VkDescriptorType type : kTypes) sizes.push_back({type, 64});
    sizes.push_back({VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC, 64});
    sizes.push_back({VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC, 64});
    auto info = make_struct<VkDescriptorPoolCreateInfo>();
    info.maxSets = 64;
    info.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
    info.pPoolSizes = sizes.data();
    ASSERT_EQ(VK_CALL(CreateDescriptorPool)(device, &info, nullptr, &descriptor_pool), VK_SUCCESS);
  }

  template <class Types>
  VkDescriptorSetLayout make_set_layout_of(const Types& types) {
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (const VkDescriptorType type : types)
      bindings.push_back({static_cast<std::uint32_t>(bindings.size()), type, 1, VK_SHADER_STAGE_ALL, nullptr});
    auto info = make_struct<VkDescriptorSetLayoutCreateInfo>();
    info.bindingCount = static_cast<std::uint32_t>(bindings.size());
    info.pBindings = bindings.data();
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    EXPECT_EQ(VK_CALL(CreateDescriptorSetLayout)(device, &info, nullptr, &layout), VK_SUCCESS);
    set_layouts.push_back(layout);
    return layout;
  }
  VkDescriptorSetLayout make_set_layout(std::initializer_list<VkDescriptorType> types) {
    return make_set_layout_of(types);
  }

  VkDescriptorSet make_set(VkDescriptorSetLayout layout) {
    auto allocate = make_struct<VkDescriptorSetAllocateInfo>();
    allocate.descriptorPool = descriptor_pool;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &layout;
    VkDescriptorSet set = VK_NULL_HANDLE;
    EXPECT_EQ(VK_CALL(AllocateDescriptorSets)(device, &allocate, &set), VK_SUCCESS);
    return set;
  }

  void write(VkDescriptorSet set, std::uint32_t binding, VkDescriptorType type, VkBuffer buffer) {
    const VkDescriptorBufferInfo range{buffer, 0, VK_WHOLE_SIZE};
    const VkDescriptorImageInfo texture{sampler, view, VK_IMAGE_LAYOUT_GENERAL};
    auto info = make_struct<VkWriteDescriptorSet>();
    info.dstSet = set;
    info.dstBinding = binding;
    info.descriptorCount = 1;
    info.descriptorType = type;
    info.pBufferInfo = &range;
    info.pImageInfo = &texture;
    info.pTexelBufferView = &texels;
    VK_CALL(UpdateDescriptorSets)(device, 1, &info, 0, nullptr);
  }

  /// A set whose binding i has types[i], each with a resource that holds ones.
  template <class Types>
  VkDescriptorSet make_full_set(VkDescriptorSetLayout layout, const Types& types) {
    const VkDescriptorSet set = make_set(layout);
    std::uint32_t binding = 0;
    for (const VkDescriptorType type : types) write(set, binding++, type, data.buffer);
    return set;
  }

  VkPipelineLayout make_layout(VkDescriptorSetLayout inputs) {
    const VkDescriptorSetLayout sets[] = {inputs, output_layout};
    const VkPushConstantRange range{VK_SHADER_STAGE_ALL, 0, 4};
    auto info = make_struct<VkPipelineLayoutCreateInfo>();
    info.setLayoutCount = 2;
    info.pSetLayouts = sets;
    info.pushConstantRangeCount = 1;
    info.pPushConstantRanges = &range;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    EXPECT_EQ(VK_CALL(CreatePipelineLayout)(device, &info, nullptr, &layout), VK_SUCCESS);
    layouts.push_back(layout);
    return layout;
  }

  template <std::size_t N>
  VkShaderModule make_module(const std::uint32_t (&words)[N]) {
    auto info = make_struct<VkShaderModuleCreateInfo>();
    info.codeSize = sizeof words;
    info.pCode = words;
    VkShaderModule module = VK_NULL_HANDLE;
    EXPECT_EQ(VK_CALL(CreateShaderModule)(device, &info, nullptr, &module), VK_SUCCESS);
    return module;
  }

  /// Null if it cannot be made.
  VkPipeline make_compute(VkPipelineLayout layout) {
    const VkShaderModule module = make_module(kEveryResourceWords);
    auto info = make_struct<VkComputePipelineCreateInfo>();
    info.stage = make_struct<VkPipelineShaderStageCreateInfo>();
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = module;
    info.stage.pName = "main";
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    const VkResult made = VK_CALL(CreateComputePipelines)(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline);
    EXPECT_EQ(made == VK_SUCCESS, pipeline != VK_NULL_HANDLE);
    VK_CALL(DestroyShaderModule)(device, module, nullptr);
    pipelines.push_back(pipeline);
    return pipeline;
  }

  VkCommandBuffer begin() {
    auto allocate = make_struct<VkCommandBufferAllocateInfo>();
    allocate.commandPool = command_pool;
    allocate.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    EXPECT_EQ(VK_CALL(AllocateCommandBuffers)(device, &allocate, &commands), VK_SUCCESS);
    const auto info = make_struct<VkCommandBufferBeginInfo>();
    EXPECT_EQ(VK_CALL(BeginCommandBuffer)(commands, &info), VK_SUCCESS);
    return commands;
  }

  void run(VkCommandBuffer commands) {
    ASSERT_EQ(VK_CALL(EndCommandBuffer)(commands), VK_SUCCESS);
    auto info = make_struct<VkSubmitInfo>();
    info.commandBufferCount = 1;
    info.pCommandBuffers = &commands;
    ASSERT_EQ(VK_CALL(QueueSubmit)(queue, 1, &info, VK_NULL_HANDLE), VK_SUCCESS);
    ASSERT_EQ(VK_CALL(QueueWaitIdle)(queue), VK_SUCCESS);
  }

  /// Binds what is not null with `layout`, and dispatches.
  void dispatch(VkPipeline pipeline, VkPipelineLayout layout, VkDescriptorSet inputs, VkDescriptorSet out) {
    std::fill_n(result.floats, kKinds + 1, -1.0f);
    const VkCommandBuffer commands = begin();
    VK_CALL(CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    const auto bind = VK_CALL(CmdBindDescriptorSets);
    if (inputs) bind(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &inputs, 0, nullptr);
    if (out) bind(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 1, 1, &out, 0, nullptr);
    VK_CALL(CmdDispatch)(commands, 1, 1, 1);
    run(commands);
  }

  Memory data, result;
  VkImage image = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
  VkBufferView texels = VK_NULL_HANDLE;
  VkSampler sampler = VK_NULL_HANDLE;
  VkDescriptorPool descriptor_pool = VK_NULL_HANDLE;
  VkDescriptorSetLayout output_layout = VK_NULL_HANDLE;
  VkDescriptorSet output = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  VkCommandPool command_pool = VK_NULL_HANDLE;
  std::vector<Memory> memories;
  std::vector<VkDescriptorSetLayout> set_layouts;
  std::vector<VkPipelineLayout> layouts;
  std::vector<VkPipeline> pipelines;
};

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

// A device with a resource of every kind, and compute shaders and draws that use them.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "tests/icd/fixture.h"
#include "tests/icd/resource_shaders.h"

namespace vitrine::icd::test {

#define VK_CALL(name) VK_GET(instance, name)

inline constexpr std::uint32_t kKinds = 8;
/// What the shaders declare in set 0, by binding.
inline constexpr std::array<VkDescriptorType, kKinds> kTypes{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
                                                             VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                                             VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                                             VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
                                                             VK_DESCRIPTOR_TYPE_SAMPLER,
                                                             VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
                                                             VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,
                                                             VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER};

class ResourceTest : public DeviceTest {
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

  VkPipelineLayout make_layout(VkDescriptorSetLayout inputs, std::uint32_t push_bytes = 4) {
    const VkDescriptorSetLayout sets[] = {inputs, output_layout};
    const VkPushConstantRange range{VK_SHADER_STAGE_ALL, 0, push_bytes};
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

  /// With the shader that uses every resource. Null if it cannot be made.
  VkPipeline make_compute(VkPipelineLayout layout) { return make_compute_of(layout, kEveryResourceWords); }
  template <std::size_t N>
  VkPipeline make_compute_of(VkPipelineLayout layout, const std::uint32_t (&words)[N]) {
    const VkShaderModule module = make_module(words);
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

}  // namespace vitrine::icd::test

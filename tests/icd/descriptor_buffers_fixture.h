// A device with VK_EXT_descriptor_buffer and what goes with it, and compute shaders whose sets lie in a buffer.
#pragma once

#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "tests/glsl/compile.h"
#include "tests/icd/resources_fixture.h"

namespace vitrine::icd::test {

inline const std::vector<const char*> kDescriptorBufferExtensions{
    VK_EXT_DESCRIPTOR_BUFFER_EXTENSION_NAME, VK_EXT_MUTABLE_DESCRIPTOR_TYPE_EXTENSION_NAME,
    VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME, VK_EXT_ROBUSTNESS_2_EXTENSION_NAME,
    VK_EXT_INLINE_UNIFORM_BLOCK_EXTENSION_NAME};

/// Buffers with sets in them, at multiples of kSetBytes.
class DescriptorBuffers : public ResourceTest {
 protected:
  static constexpr VkDeviceSize kSetBytes = 1024;

  void make_device() override {
    auto buffers = make_struct<VkPhysicalDeviceDescriptorBufferFeaturesEXT>();
    buffers.descriptorBuffer = buffers.descriptorBufferPushDescriptors = VK_TRUE;
    auto mutables = make_struct<VkPhysicalDeviceMutableDescriptorTypeFeaturesEXT>(&buffers);
    mutables.mutableDescriptorType = VK_TRUE;
    auto robustness = make_struct<VkPhysicalDeviceRobustness2FeaturesEXT>(&mutables);
    robustness.nullDescriptor = VK_TRUE;
    auto blocks = make_struct<VkPhysicalDeviceInlineUniformBlockFeatures>(&robustness);
    blocks.inlineUniformBlock = VK_TRUE;
    auto indexing = make_struct<VkPhysicalDeviceDescriptorIndexingFeatures>(&blocks);
    indexing.descriptorBindingVariableDescriptorCount = indexing.runtimeDescriptorArray = VK_TRUE;
    auto addresses = make_struct<VkPhysicalDeviceBufferDeviceAddressFeatures>(&indexing);
    addresses.bufferDeviceAddress = VK_TRUE;
    auto features = make_struct<VkPhysicalDeviceFeatures2>(&addresses);
    features.features.shaderStorageBufferArrayDynamicIndexing = VK_TRUE;
    ASSERT_EQ(create_device(instance, physical_device, &device, nullptr, &features, kDescriptorBufferExtensions),
              VK_SUCCESS);
  }

  void SetUp() override {
    ResourceTest::SetUp();
    descriptors = make_buffer();
    std::memset(descriptors.floats, 0, kBytes);
    for (std::uint32_t i = 0; i < kBytes / sizeof(float); ++i) data.floats[i] = static_cast<float>(i + 2);
    auto* const texel = memories[2].floats;  // of the image
    std::fill_n(texel, kBytes / sizeof(float), 7.0f);
  }

  VkDeviceAddress address_of(const Memory& memory) {
    auto info = make_struct<VkBufferDeviceAddressInfo>();
    info.buffer = memory.buffer;
    return VK_CALL(GetBufferDeviceAddress)(device, &info);
  }

  VkDescriptorSetLayout make_buffer_layout(const std::vector<VkDescriptorSetLayoutBinding>& bindings,
                                           VkDescriptorSetLayoutCreateFlags flags = 0, const void* next = nullptr) {
    auto info = make_struct<VkDescriptorSetLayoutCreateInfo>(const_cast<void*>(next));
    info.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_DESCRIPTOR_BUFFER_BIT_EXT | flags;
    info.bindingCount = static_cast<std::uint32_t>(bindings.size());
    info.pBindings = bindings.data();
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    EXPECT_EQ(VK_CALL(CreateDescriptorSetLayout)(device, &info, nullptr, &layout), VK_SUCCESS);
    set_layouts.push_back(layout);
    return layout;
  }
  template <class Types>
  VkDescriptorSetLayout make_buffer_layout_of(const Types& types) {
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (const VkDescriptorType type : types)
      bindings.push_back({static_cast<std::uint32_t>(bindings.size()), type, 1, VK_SHADER_STAGE_ALL, nullptr});
    return make_buffer_layout(bindings);
  }

  std::byte* place(VkDescriptorSetLayout layout, std::uint32_t set, std::uint32_t binding) {
    VkDeviceSize offset = 0;
    VK_CALL(GetDescriptorSetLayoutBindingOffsetEXT)(device, layout, binding, &offset);
    return reinterpret_cast<std::byte*>(descriptors.floats) + set * kSetBytes + offset;
  }

  std::size_t size_of(VkDescriptorType type) {
    auto properties = make_struct<VkPhysicalDeviceDescriptorBufferPropertiesEXT>();
    auto all = make_struct<VkPhysicalDeviceProperties2>(&properties);
    VK_CALL(GetPhysicalDeviceProperties2)(physical_device, &all);
    switch (type) {
      case VK_DESCRIPTOR_TYPE_SAMPLER:
        return properties.samplerDescriptorSize;
      case VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER:
        return properties.combinedImageSamplerDescriptorSize;
      case VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE:
        return properties.sampledImageDescriptorSize;
      case VK_DESCRIPTOR_TYPE_STORAGE_IMAGE:
        return properties.storageImageDescriptorSize;
      case VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER:
        return properties.uniformTexelBufferDescriptorSize;
      case VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER:
        return properties.storageTexelBufferDescriptorSize;
      case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER:
        return properties.uniformBufferDescriptorSize;
      case VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT:
        return properties.inputAttachmentDescriptorSize;
      default:
        return properties.storageBufferDescriptorSize;
    }
  }

  /// A descriptor of `memory`, or of the image and the sampler.
  void get(VkDescriptorType type, void* out, const Memory& memory, VkDeviceSize range = kBytes) {
    auto bytes = make_struct<VkDescriptorAddressInfoEXT>();
    bytes.address = address_of(memory);
    bytes.range = range;
    bytes.format = VK_FORMAT_R32_SFLOAT;
    const VkDescriptorImageInfo texture{sampler, view, VK_IMAGE_LAYOUT_GENERAL};
    auto info = make_struct<VkDescriptorGetInfoEXT>();
    info.type = type;
    switch (type) {
      case VK_DESCRIPTOR_TYPE_SAMPLER:
        info.data.pSampler = &sampler;
        break;
      case VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER:
      case VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE:
      case VK_DESCRIPTOR_TYPE_STORAGE_IMAGE:
      case VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT:
        info.data.pSampledImage = &texture;
        break;
      default:
        info.data.pStorageBuffer = &bytes;
    }
    VK_CALL(GetDescriptorEXT)(device, &info, size_of(type), out);
  }

  /// Set `number` of `out` for the results, set 0 at `set`.
  void bind(VkCommandBuffer commands, VkPipelineLayout layout, std::uint32_t set, std::uint32_t out) {
    auto info = make_struct<VkDescriptorBufferBindingInfoEXT>();
    info.address = address_of(descriptors);
    info.usage = VK_BUFFER_USAGE_RESOURCE_DESCRIPTOR_BUFFER_BIT_EXT | VK_BUFFER_USAGE_SAMPLER_DESCRIPTOR_BUFFER_BIT_EXT;
    VK_CALL(CmdBindDescriptorBuffersEXT)(commands, 1, &info);
    const std::uint32_t indices[] = {0, 0};
    const VkDeviceSize offsets[] = {set * kSetBytes, out * kSetBytes};
    VK_CALL(CmdSetDescriptorBufferOffsetsEXT)
    (commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 2, indices, offsets);
  }

  void dispatch_from_buffer(VkPipeline pipeline, VkPipelineLayout layout, std::uint32_t set = 0,
                            std::uint32_t out = 3) {
    std::fill_n(result.floats, kBytes / sizeof(float), -1.0f);
    const VkCommandBuffer commands = begin();
    VK_CALL(CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    bind(commands, layout, set, out);
    VK_CALL(CmdDispatch)(commands, 1, 1, 1);
    run(commands);
  }

  /// A layout of `inputs` and of a set with the results, which is written at set 3 of the buffer.
  VkPipelineLayout make_buffer_pipeline_layout(VkDescriptorSetLayout inputs) {
    const VkDescriptorSetLayout out = make_buffer_layout_of(std::array{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
    get(VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, place(out, 3, 0), result);
    const VkDescriptorSetLayout sets[] = {inputs, out};
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

  VkPipeline compile_compute(VkPipelineLayout layout, const std::string& text) {
    std::string log;
    const auto words = vitrine::test::compile_glsl(VK_SHADER_STAGE_COMPUTE_BIT, "#version 450\n" + text,
                                                   vitrine::test::VulkanVersion::k11, log);
    EXPECT_FALSE(words.empty()) << log;
    auto module_info = make_struct<VkShaderModuleCreateInfo>();
    module_info.codeSize = words.size() * 4;
    module_info.pCode = words.data();
    VkShaderModule module = VK_NULL_HANDLE;
    EXPECT_EQ(VK_CALL(CreateShaderModule)(device, &module_info, nullptr, &module), VK_SUCCESS);
    auto info = make_struct<VkComputePipelineCreateInfo>();
    info.flags = VK_PIPELINE_CREATE_DESCRIPTOR_BUFFER_BIT_EXT;
    info.stage = make_struct<VkPipelineShaderStageCreateInfo>();
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = module;
    info.stage.pName = "main";
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    EXPECT_EQ(VK_CALL(CreateComputePipelines)(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline), VK_SUCCESS);
    VK_CALL(DestroyShaderModule)(device, module, nullptr);
    pipelines.push_back(pipeline);
    return pipeline;
  }

  Memory descriptors;
};

}  // namespace vitrine::icd::test

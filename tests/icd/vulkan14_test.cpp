// Vulkan 1.4 as a whole, by the names of the core: what it asks for is there without any extension. With older headers
// the device is one of 1.3, and none of this is built.
#include <array>
#include <cstring>
#include <string>

#include "tests/icd/compute_fixture.h"
#include "tests/icd/shaders.h"

#ifdef VK_API_VERSION_1_4
namespace vitrine::icd::test {
namespace {

#define VK_CALL(name) VK_GET(instance, name)

class Vulkan14 : public ComputeTest {
 protected:
  void make_device() override {
    auto features = make_struct<VkPhysicalDeviceVulkan14Features>();
    auto all = make_struct<VkPhysicalDeviceFeatures2>(&features);
    VK_CALL(GetPhysicalDeviceFeatures2)(physical_device, &all);
    ASSERT_EQ(create_device(instance, physical_device, &device, nullptr, &all), VK_SUCCESS);
  }
  template <class T>
  T properties() {
    auto out = make_struct<T>();
    auto whole = make_struct<VkPhysicalDeviceProperties2>(&out);
    VK_CALL(GetPhysicalDeviceProperties2)(physical_device, &whole);
    return out;
  }
};

TEST_F(Vulkan14, IsWhatTheDeviceSays) {
  VkPhysicalDeviceProperties properties;
  VK_CALL(GetPhysicalDeviceProperties)(physical_device, &properties);
  EXPECT_GE(properties.apiVersion, VK_API_VERSION_1_4);
  std::uint32_t version = 0;
  ASSERT_EQ(VK_GET(nullptr, EnumerateInstanceVersion)(&version), VK_SUCCESS);
  EXPECT_GE(version, VK_API_VERSION_1_4);
}

/// Vulkan 1.4.309, Versions: "Vulkan 1.4 also requires support for the following updated limits".
TEST_F(Vulkan14, LimitsAreThoseOfTheVersion) {
  VkPhysicalDeviceProperties properties;
  VK_CALL(GetPhysicalDeviceProperties)(physical_device, &properties);
  const VkPhysicalDeviceLimits& l = properties.limits;
  const auto version = this->properties<VkPhysicalDeviceVulkan14Properties>();
  const struct {
    const char* name;
    std::uint64_t value, least;
  } rows[] = {{"maxImageDimension1D", l.maxImageDimension1D, 8192},
              {"maxImageDimension2D", l.maxImageDimension2D, 8192},
              {"maxImageDimension3D", l.maxImageDimension3D, 512},
              {"maxImageDimensionCube", l.maxImageDimensionCube, 8192},
              {"maxImageArrayLayers", l.maxImageArrayLayers, 2048},
              {"maxUniformBufferRange", l.maxUniformBufferRange, 65536},
              {"maxPushConstantsSize", l.maxPushConstantsSize, 256},
              {"maxBoundDescriptorSets", l.maxBoundDescriptorSets, 7},
              {"maxPerStageDescriptorUniformBuffers", l.maxPerStageDescriptorUniformBuffers, 15},
              {"maxPerStageResources", l.maxPerStageResources, 200},
              {"maxDescriptorSetUniformBuffers", l.maxDescriptorSetUniformBuffers, 90},
              {"maxDescriptorSetStorageBuffers", l.maxDescriptorSetStorageBuffers, 96},
              {"maxDescriptorSetStorageImages", l.maxDescriptorSetStorageImages, 144},
              {"maxFragmentCombinedOutputResources", l.maxFragmentCombinedOutputResources, 16},
              {"maxComputeWorkGroupInvocations", l.maxComputeWorkGroupInvocations, 256},
              {"maxComputeWorkGroupSize x", l.maxComputeWorkGroupSize[0], 256},
              {"maxComputeWorkGroupSize y", l.maxComputeWorkGroupSize[1], 256},
              {"maxComputeWorkGroupSize z", l.maxComputeWorkGroupSize[2], 64},
              {"subTexelPrecisionBits", l.subTexelPrecisionBits, 8},
              {"mipmapPrecisionBits", l.mipmapPrecisionBits, 6},
              {"maxViewportDimensions x", l.maxViewportDimensions[0], 7680},
              {"maxViewportDimensions y", l.maxViewportDimensions[1], 7680},
              {"maxFramebufferWidth", l.maxFramebufferWidth, 7680},
              {"maxFramebufferHeight", l.maxFramebufferHeight, 7680},
              {"maxColorAttachments", l.maxColorAttachments, 8},
              {"timestampComputeAndGraphics", l.timestampComputeAndGraphics, 1},
              {"standardSampleLocations", l.standardSampleLocations, 1},
              {"maxPushDescriptors", version.maxPushDescriptors, 32},
              {"maxVertexAttribDivisor", version.maxVertexAttribDivisor, 1}};
  for (const auto& row : rows) EXPECT_GE(row.value, row.least) << row.name;
  EXPECT_LE(l.bufferImageGranularity, 4096u);
  EXPECT_GE(l.maxSamplerLodBias, 14);
  EXPECT_GE(l.pointSizeRange[1], 256 - l.pointSizeGranularity);
  EXPECT_LE(l.pointSizeGranularity, 0.125f);
  EXPECT_LE(l.lineWidthGranularity, 0.5f);
}

/// Those of the structures that the version is made of.
TEST_F(Vulkan14, PropertiesAreThoseOfTheParts) {
  const auto all = properties<VkPhysicalDeviceVulkan14Properties>();
  EXPECT_EQ(all.lineSubPixelPrecisionBits,
            properties<VkPhysicalDeviceLineRasterizationPropertiesKHR>().lineSubPixelPrecisionBits);
  const auto divisor = properties<VkPhysicalDeviceVertexAttributeDivisorPropertiesKHR>();
  EXPECT_EQ(all.maxVertexAttribDivisor, divisor.maxVertexAttribDivisor);
  EXPECT_EQ(all.supportsNonZeroFirstInstance, divisor.supportsNonZeroFirstInstance);
  EXPECT_EQ(all.maxPushDescriptors, properties<VkPhysicalDevicePushDescriptorPropertiesKHR>().maxPushDescriptors);
  EXPECT_TRUE(all.dynamicRenderingLocalReadDepthStencilAttachments);
  EXPECT_TRUE(all.dynamicRenderingLocalReadMultisampledAttachments);
  EXPECT_EQ(all.defaultRobustnessImages,
            properties<VkPhysicalDevicePipelineRobustnessPropertiesEXT>().defaultRobustnessImages);
  const auto copies = properties<VkPhysicalDeviceHostImageCopyPropertiesEXT>();
  EXPECT_EQ(all.copySrcLayoutCount, copies.copySrcLayoutCount);
  EXPECT_GT(all.copyDstLayoutCount, 0u);
  EXPECT_EQ(std::memcmp(all.optimalTilingLayoutUUID, copies.optimalTilingLayoutUUID, VK_UUID_SIZE), 0);
  std::array<VkImageLayout, 2> layouts{VK_IMAGE_LAYOUT_MAX_ENUM, VK_IMAGE_LAYOUT_MAX_ENUM};
  auto asked = make_struct<VkPhysicalDeviceVulkan14Properties>();
  asked.copySrcLayoutCount = 2;
  asked.pCopySrcLayouts = layouts.data();
  auto whole = make_struct<VkPhysicalDeviceProperties2>(&asked);
  VK_CALL(GetPhysicalDeviceProperties2)(physical_device, &whole);
  EXPECT_EQ(asked.pCopySrcLayouts, layouts.data());
  EXPECT_EQ(asked.copySrcLayoutCount, 2u);
  EXPECT_NE(layouts[1], VK_IMAGE_LAYOUT_MAX_ENUM);
}

/// Vulkan 1.4.309, Versions: rotations within clusters are required, too.
TEST_F(Vulkan14, SubgroupsRotate) {
  const VkSubgroupFeatureFlags all =
      VK_SUBGROUP_FEATURE_CLUSTERED_BIT | VK_SUBGROUP_FEATURE_ROTATE_BIT | VK_SUBGROUP_FEATURE_ROTATE_CLUSTERED_BIT;
  EXPECT_EQ(properties<VkPhysicalDeviceSubgroupProperties>().supportedOperations & all, all);
}

TEST_F(Vulkan14, CommandsHaveTheirNames) {
  for (const char* name :
       {"vkCmdSetLineStipple", "vkMapMemory2", "vkUnmapMemory2", "vkCmdBindIndexBuffer2",
        "vkGetRenderingAreaGranularity", "vkGetDeviceImageSubresourceLayout", "vkGetImageSubresourceLayout2",
        "vkCmdPushDescriptorSet", "vkCmdPushDescriptorSetWithTemplate", "vkCmdSetRenderingAttachmentLocations",
        "vkCmdSetRenderingInputAttachmentIndices", "vkCmdBindDescriptorSets2", "vkCmdPushConstants2",
        "vkCmdPushDescriptorSet2", "vkCmdPushDescriptorSetWithTemplate2", "vkCopyMemoryToImage", "vkCopyImageToMemory",
        "vkCopyImageToImage", "vkTransitionImageLayout"}) {
    EXPECT_NE(VK_CALL(GetInstanceProcAddr)(instance, name), nullptr) << name;
  }
}

/// The feature that came with the version does what the extension does.
TEST_F(Vulkan14, DescriptorsArePushedWithoutTheExtension) {
  const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT,
                                             nullptr};
  auto shape = make_struct<VkDescriptorSetLayoutCreateInfo>();
  shape.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT;
  shape.bindingCount = 1;
  shape.pBindings = &binding;
  VkDescriptorSetLayout pushed = VK_NULL_HANDLE;
  ASSERT_EQ(VK_CALL(CreateDescriptorSetLayout)(device, &shape, nullptr, &pushed), VK_SUCCESS);
  auto layout_info = make_struct<VkPipelineLayoutCreateInfo>();
  layout_info.setLayoutCount = 1;
  layout_info.pSetLayouts = &pushed;
  VkPipelineLayout pushing = VK_NULL_HANDLE;
  ASSERT_EQ(VK_CALL(CreatePipelineLayout)(device, &layout_info, nullptr, &pushing), VK_SUCCESS);
  auto info = make_struct<VkComputePipelineCreateInfo>();
  info.stage = stage(VK_SHADER_STAGE_COMPUTE_BIT, kComputeWords);
  info.layout = pushing;
  VkPipeline pipeline = VK_NULL_HANDLE;
  ASSERT_EQ(VK_CALL(CreateComputePipelines)(device, cache, 1, &info, nullptr, &pipeline), VK_SUCCESS);
  auto buffer_info = make_struct<VkBufferCreateInfo>();
  buffer_info.size = 4096;
  buffer_info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  VkBuffer buffer = VK_NULL_HANDLE;
  ASSERT_EQ(VK_CALL(CreateBuffer)(device, &buffer_info, nullptr, &buffer), VK_SUCCESS);
  auto allocate = make_struct<VkMemoryAllocateInfo>();
  allocate.allocationSize = 4096;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  ASSERT_EQ(VK_CALL(AllocateMemory)(device, &allocate, nullptr, &memory), VK_SUCCESS);
  ASSERT_EQ(VK_CALL(BindBufferMemory)(device, buffer, memory, 0), VK_SUCCESS);
  auto map = make_struct<VkMemoryMapInfo>();
  map.memory = memory;
  map.size = VK_WHOLE_SIZE;
  void* data = nullptr;
  ASSERT_EQ(VK_CALL(MapMemory2)(device, &map, &data), VK_SUCCESS);
  const VkDescriptorBufferInfo range{buffer, 0, VK_WHOLE_SIZE};
  auto write = make_struct<VkWriteDescriptorSet>();
  write.descriptorCount = 1;
  write.descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  write.pBufferInfo = &range;
  run([&](VkCommandBuffer commands) {
    VK_CALL(CmdBindPipeline)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    VK_CALL(CmdPushDescriptorSet)(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pushing, 0, 1, &write);
    VK_CALL(CmdDispatch)(commands, 1, 1, 1);
  });
  std::uint32_t words[4];
  std::memcpy(words, data, sizeof words);
  EXPECT_EQ(words[3], 10u);
  VK_CALL(DestroyPipeline)(device, pipeline, nullptr);
  VK_CALL(DestroyPipelineLayout)(device, pushing, nullptr);
  VK_CALL(DestroyDescriptorSetLayout)(device, pushed, nullptr);
  VK_CALL(DestroyBuffer)(device, buffer, nullptr);
  VK_CALL(FreeMemory)(device, memory, nullptr);
}

}  // namespace
}  // namespace vitrine::icd::test
#endif

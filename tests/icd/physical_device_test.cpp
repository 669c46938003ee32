// Physical devices: identity, features, limits, queue families, memory, formats.
#include <bit>
#include <cstring>
#include <string>

#include "icd/registry/registry.h"
#include "icd/version.h"
#include "tests/icd/fixture.h"
#include "texel/capabilities.h"
#include "texel/view.h"

namespace vitrine::icd::test {
namespace {

using PhysicalDevice = DeviceTest;
using Formats = DeviceTest;

TEST_F(PhysicalDevice, SaysWhatItIs) {
  VkPhysicalDeviceProperties properties;
  VK_GET(instance, GetPhysicalDeviceProperties)(physical_device, &properties);
  EXPECT_STREQ(properties.deviceName, "Vitrine") << "the same on every machine";
  EXPECT_EQ(properties.driverVersion, kDriverVersion);
  EXPECT_EQ(properties.deviceType, VK_PHYSICAL_DEVICE_TYPE_CPU);
  EXPECT_GE(properties.apiVersion, VK_API_VERSION_1_1);
  EXPECT_EQ(properties.limits.maxPushConstantsSize, 256u);
}

TEST_F(PhysicalDevice, PropertiesChainAgreesWithThePlainQuery) {
  VkPhysicalDeviceProperties plain;
  VK_GET(instance, GetPhysicalDeviceProperties)(physical_device, &plain);
  auto ids = make_struct<VkPhysicalDeviceIDProperties>();
  auto subgroup = make_struct<VkPhysicalDeviceSubgroupProperties>(&ids);
  auto maintenance3 = make_struct<VkPhysicalDeviceMaintenance3Properties>(&subgroup);
  auto chain = make_struct<VkPhysicalDeviceProperties2>(&maintenance3);
  VK_GET(instance, GetPhysicalDeviceProperties2)(physical_device, &chain);
  EXPECT_EQ(std::memcmp(&plain.limits, &chain.properties.limits, sizeof plain.limits), 0);
  EXPECT_STREQ(plain.deviceName, chain.properties.deviceName);
  EXPECT_EQ(subgroup.subgroupSize, 64u);
  EXPECT_TRUE(subgroup.supportedOperations & VK_SUBGROUP_FEATURE_BASIC_BIT);
  EXPECT_TRUE(subgroup.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT);
  EXPECT_GE(maintenance3.maxMemoryAllocationSize, 1u << 30);
  EXPECT_EQ(ids.deviceLUIDValid, VK_FALSE);
  EXPECT_NE(std::memcmp(ids.deviceUUID, ids.driverUUID, VK_UUID_SIZE), 0);
}

TEST_F(PhysicalDevice, FeaturesChainAgreesWithThePlainQuery) {
  VkPhysicalDeviceFeatures plain;
  VK_GET(instance, GetPhysicalDeviceFeatures)(physical_device, &plain);
  auto chain = make_struct<VkPhysicalDeviceFeatures2>();
  VK_GET(instance, GetPhysicalDeviceFeatures2)(physical_device, &chain);
  EXPECT_EQ(std::memcmp(&plain, &chain.features, sizeof plain), 0);
  EXPECT_EQ(plain.robustBufferAccess, VK_TRUE);
  EXPECT_EQ(plain.sparseBinding, VK_FALSE);
}

TEST_F(PhysicalDevice, NamesItsDriverAndAlignments) {
  auto core = make_struct<VkPhysicalDeviceVulkan12Properties>();
  auto driver = make_struct<VkPhysicalDeviceDriverProperties>(&core);
  auto texel_buffers = make_struct<VkPhysicalDeviceTexelBufferAlignmentProperties>(&driver);
  auto chain = make_struct<VkPhysicalDeviceProperties2>(&texel_buffers);
  VK_GET(instance, GetPhysicalDeviceProperties2)(physical_device, &chain);
  EXPECT_STREQ(driver.driverName, "Vitrine");
  EXPECT_EQ(std::string(driver.driverInfo).rfind(std::string(kDriverVersionText) + ", ", 0), 0u) << driver.driverInfo;
  EXPECT_STREQ(driver.driverInfo, core.driverInfo);
  EXPECT_EQ(driver.conformanceVersion.major, 1u) << "wgpu hides devices that name no version";
  EXPECT_EQ(texel_buffers.uniformTexelBufferOffsetAlignmentBytes, 16u);
  std::uint32_t count = 3;
  EXPECT_EQ(VK_GET(instance, GetPhysicalDeviceToolPropertiesEXT)(physical_device, &count, nullptr), VK_SUCCESS);
  EXPECT_EQ(count, 0u);
}

TEST_F(PhysicalDevice, PlacesSamplesAlikeInEveryPixel) {
  auto locations = make_struct<VkPhysicalDeviceSampleLocationsPropertiesEXT>();
  auto chain = make_struct<VkPhysicalDeviceProperties2>(&locations);
  VK_GET(instance, GetPhysicalDeviceProperties2)(physical_device, &chain);
  EXPECT_EQ(locations.sampleLocationSampleCounts & ~chain.properties.limits.framebufferColorSampleCounts, 0u);
  for (std::uint32_t samples = 1; samples <= 64; samples *= 2) {
    auto properties = make_struct<VkMultisamplePropertiesEXT>();
    VK_GET(instance, GetPhysicalDeviceMultisamplePropertiesEXT)
    (physical_device, static_cast<VkSampleCountFlagBits>(samples), &properties);
    const std::uint32_t side = locations.sampleLocationSampleCounts & samples ? 1 : 0;
    EXPECT_EQ(properties.maxSampleLocationGridSize.width, side) << samples;
    EXPECT_EQ(properties.maxSampleLocationGridSize.height, side) << samples;
  }
}

TEST_F(PhysicalDevice, OneUniversalQueueFamily) {
  std::uint32_t count = 0;
  VK_GET(instance, GetPhysicalDeviceQueueFamilyProperties)(physical_device, &count, nullptr);
  ASSERT_EQ(count, 1u);
  auto family = make_struct<VkQueueFamilyProperties2>();
  VK_GET(instance, GetPhysicalDeviceQueueFamilyProperties2)(physical_device, &count, &family);
  EXPECT_EQ(family.queueFamilyProperties.queueFlags & 7u,
            VkQueueFlags{VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT | VK_QUEUE_TRANSFER_BIT});
  EXPECT_EQ(family.queueFamilyProperties.queueCount, 1u);
}

TEST_F(PhysicalDevice, QueuesAreServedLikeOtherProcesses) {
  auto priorities = make_struct<VkQueueFamilyGlobalPriorityPropertiesKHR>();
  auto family = make_struct<VkQueueFamilyProperties2>(&priorities);
  std::uint32_t count = 1;
  VK_GET(instance, GetPhysicalDeviceQueueFamilyProperties2)(physical_device, &count, &family);
  ASSERT_EQ(priorities.priorityCount, 2u);
  EXPECT_EQ(priorities.priorities[0], VK_QUEUE_GLOBAL_PRIORITY_LOW_KHR);
  EXPECT_EQ(priorities.priorities[1], VK_QUEUE_GLOBAL_PRIORITY_MEDIUM_KHR);
  const auto create = [&](VkQueueGlobalPriorityKHR wanted) {
    auto global = make_struct<VkDeviceQueueGlobalPriorityCreateInfoKHR>();
    global.globalPriority = wanted;
    const float priority = 1;
    auto queue = make_struct<VkDeviceQueueCreateInfo>(&global);
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    auto info = make_struct<VkDeviceCreateInfo>();
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    VkDevice other = VK_NULL_HANDLE;
    const VkResult result = VK_GET(instance, CreateDevice)(physical_device, &info, nullptr, &other);
    if (result == VK_SUCCESS) VK_GET(instance, DestroyDevice)(other, nullptr);
    return result;
  };
  EXPECT_EQ(create(VK_QUEUE_GLOBAL_PRIORITY_LOW_KHR), VK_SUCCESS);
  EXPECT_EQ(create(VK_QUEUE_GLOBAL_PRIORITY_REALTIME_KHR), VK_ERROR_NOT_PERMITTED_KHR);
}

TEST_F(PhysicalDevice, OneMemoryTypeIsEverything) {
  VkPhysicalDeviceMemoryProperties memory;
  VK_GET(instance, GetPhysicalDeviceMemoryProperties)(physical_device, &memory);
  EXPECT_EQ(memory.memoryTypeCount, 1u);
  EXPECT_EQ(memory.memoryHeapCount, 1u);
  EXPECT_EQ(memory.memoryTypes[0].propertyFlags, 0xfu);
  EXPECT_GT(memory.memoryHeaps[0].size, 1u << 20);
}

TEST_F(PhysicalDevice, ExternalHandlesOfOtherSystemsAreUnsupported) {
  auto buffer_info = make_struct<VkPhysicalDeviceExternalBufferInfo>();
  buffer_info.handleType = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_WIN32_BIT;
  auto buffer = make_struct<VkExternalBufferProperties>();
  VK_GET(instance, GetPhysicalDeviceExternalBufferProperties)(physical_device, &buffer_info, &buffer);
  EXPECT_EQ(buffer.externalMemoryProperties.externalMemoryFeatures, 0u);
  auto semaphore_info = make_struct<VkPhysicalDeviceExternalSemaphoreInfo>();
  semaphore_info.handleType = VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_WIN32_BIT;
  auto semaphore = make_struct<VkExternalSemaphoreProperties>();
  VK_GET(instance, GetPhysicalDeviceExternalSemaphoreProperties)(physical_device, &semaphore_info, &semaphore);
  EXPECT_EQ(semaphore.externalSemaphoreFeatures, 0u);
  // A sync file is signalled once: there are none of timelines.
  auto type = make_struct<VkSemaphoreTypeCreateInfo>();
  type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
  semaphore_info.pNext = &type;
  semaphore_info.handleType = VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_SYNC_FD_BIT;
  VK_GET(instance, GetPhysicalDeviceExternalSemaphoreProperties)(physical_device, &semaphore_info, &semaphore);
  EXPECT_EQ(semaphore.externalSemaphoreFeatures, 0u);
}

TEST_F(PhysicalDevice, UnclaimedFeatureIsRefused) {
  auto features = make_struct<VkPhysicalDeviceFeatures2>();
  features.features.sparseBinding = VK_TRUE;
  VkDevice other = VK_NULL_HANDLE;
  EXPECT_EQ(create_device(instance, physical_device, &other, nullptr, &features), VK_ERROR_FEATURE_NOT_PRESENT);
}

struct Required {
  VkFormat format;
  VkFormatFeatureFlags features;
};

/// Vulkan 1.3.239, Required Format Support: the mandatory optimal-tiling features of the colour formats most used.
TEST_F(Formats, MandatoryImageFeaturesAreClaimed) {
  constexpr VkFormatFeatureFlags kSampled = VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT | VK_FORMAT_FEATURE_BLIT_SRC_BIT;
  constexpr VkFormatFeatureFlags kFiltered = kSampled | VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
  constexpr VkFormatFeatureFlags kTarget = VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT | VK_FORMAT_FEATURE_BLIT_DST_BIT;
  constexpr VkFormatFeatureFlags kBlended = kTarget | VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT;
  constexpr VkFormatFeatureFlags kStorage = VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT;
  constexpr Required kTable[] = {
      {VK_FORMAT_R5G6B5_UNORM_PACK16, kFiltered | kBlended},
      {VK_FORMAT_A1R5G5B5_UNORM_PACK16, kFiltered | kBlended},
      {VK_FORMAT_B4G4R4A4_UNORM_PACK16, kFiltered},
      {VK_FORMAT_R8_UNORM, kFiltered | kBlended},
      {VK_FORMAT_R8_SNORM, kFiltered},
      {VK_FORMAT_R8_UINT, kSampled | kTarget},
      {VK_FORMAT_R8G8_UNORM, kFiltered | kBlended},
      {VK_FORMAT_R8G8B8A8_UNORM, kFiltered | kBlended | kStorage},
      {VK_FORMAT_R8G8B8A8_SNORM, kFiltered | kStorage},
      {VK_FORMAT_R8G8B8A8_UINT, kSampled | kTarget | kStorage},
      {VK_FORMAT_R8G8B8A8_SRGB, kFiltered | kBlended},
      {VK_FORMAT_B8G8R8A8_UNORM, kFiltered | kBlended},
      {VK_FORMAT_B8G8R8A8_SRGB, kFiltered | kBlended},
      {VK_FORMAT_A8B8G8R8_UNORM_PACK32, kFiltered | kBlended},
      {VK_FORMAT_A8B8G8R8_SRGB_PACK32, kFiltered | kBlended},
      {VK_FORMAT_A2B10G10R10_UNORM_PACK32, kFiltered | kBlended},
      {VK_FORMAT_A2B10G10R10_UINT_PACK32, kSampled | kTarget},
      {VK_FORMAT_R16_UINT, kSampled | kTarget},
      {VK_FORMAT_R16_SFLOAT, kFiltered | kBlended},
      {VK_FORMAT_R16G16_SFLOAT, kFiltered | kBlended},
      {VK_FORMAT_R16G16B16A16_SFLOAT, kFiltered | kBlended | kStorage},
      {VK_FORMAT_R32_UINT, kSampled | kTarget | kStorage | VK_FORMAT_FEATURE_STORAGE_IMAGE_ATOMIC_BIT},
      {VK_FORMAT_R32_SINT, kSampled | kTarget | kStorage | VK_FORMAT_FEATURE_STORAGE_IMAGE_ATOMIC_BIT},
      {VK_FORMAT_R32_SFLOAT, kSampled | kTarget | kStorage},
      {VK_FORMAT_R32G32B32A32_SFLOAT, kSampled | kTarget | kStorage},
      {VK_FORMAT_R32G32B32A32_UINT, kSampled | kTarget | kStorage},
      {VK_FORMAT_B10G11R11_UFLOAT_PACK32, kFiltered},
      {VK_FORMAT_E5B9G9R9_UFLOAT_PACK32, kFiltered},
      {VK_FORMAT_D16_UNORM, kSampled | VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT},
      {VK_FORMAT_D32_SFLOAT, kSampled | VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT},
      {VK_FORMAT_D24_UNORM_S8_UINT, VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT},
  };
  for (const Required& row : kTable) {
    VkFormatProperties properties;
    VK_GET(instance, GetPhysicalDeviceFormatProperties)(physical_device, row.format, &properties);
    EXPECT_EQ(properties.optimalTilingFeatures & row.features, row.features) << "format " << row.format;
  }
}

TEST_F(Formats, MandatoryBufferFeaturesAreClaimed) {
  constexpr VkFormatFeatureFlags kVertex = VK_FORMAT_FEATURE_VERTEX_BUFFER_BIT;
  constexpr VkFormatFeatureFlags kTexels = VK_FORMAT_FEATURE_UNIFORM_TEXEL_BUFFER_BIT;
  constexpr VkFormatFeatureFlags kStores = VK_FORMAT_FEATURE_STORAGE_TEXEL_BUFFER_BIT;
  constexpr Required kTable[] = {
      {VK_FORMAT_R8_UNORM, kVertex | kTexels},
      {VK_FORMAT_R8G8B8A8_UNORM, kVertex | kTexels | kStores},
      {VK_FORMAT_B8G8R8A8_UNORM, kVertex | kTexels},
      {VK_FORMAT_A2B10G10R10_UNORM_PACK32, kVertex | kTexels},
      {VK_FORMAT_R16G16B16A16_SFLOAT, kVertex | kTexels | kStores},
      {VK_FORMAT_R32_UINT, kVertex | kTexels | kStores | VK_FORMAT_FEATURE_STORAGE_TEXEL_BUFFER_ATOMIC_BIT},
      {VK_FORMAT_R32G32B32_SFLOAT, kVertex},
      {VK_FORMAT_R32G32B32A32_SFLOAT, kVertex | kTexels | kStores},
  };
  for (const Required& row : kTable) {
    VkFormatProperties properties;
    VK_GET(instance, GetPhysicalDeviceFormatProperties)(physical_device, row.format, &properties);
    EXPECT_EQ(properties.bufferFeatures & row.features, row.features) << "format " << row.format;
  }
}

struct Backing {
  VkFormatFeatureFlags feature;
  bool (*can)(const texel::FormatDesc& format);
};

/// A claim that the texel room cannot keep is a wrong picture waiting.
TEST_F(Formats, ClaimsDoNotExceedWhatTexelDoes) {
  constexpr Backing kImage[] = {
      {VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT, texel::can_sample},
      // Of a combined format the depth aspect is filtered.
      {VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT,
       [](const texel::FormatDesc& format) {
         return (texel::can_sample(format) && !format.is_integer()) || format.has_stencil();
       }},
      {VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_CUBIC_BIT_EXT,
       [](const texel::FormatDesc& format) {
         return ((texel::can_sample(format) && !format.is_integer()) || format.has_stencil()) &&
                !format.requires_conversion();
       }},
      {VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT, texel::can_store},
      {VK_FORMAT_FEATURE_STORAGE_IMAGE_ATOMIC_BIT,
       [](const texel::FormatDesc& format) {
         return format.format == VK_FORMAT_R32_UINT || format.format == VK_FORMAT_R32_SINT ||
                format.format == VK_FORMAT_R32_SFLOAT || format.format == VK_FORMAT_R64_UINT ||
                format.format == VK_FORMAT_R64_SINT;
       }},
      {VK_FORMAT_FEATURE_TRANSFER_SRC_BIT, [](const texel::FormatDesc& format) { return format.block_bytes != 0; }},
      {VK_FORMAT_FEATURE_BLIT_SRC_BIT, texel::can_sample},
      {VK_FORMAT_FEATURE_BLIT_DST_BIT, texel::can_encode},
      {VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT, texel::can_encode},
      {VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT,
       [](const texel::FormatDesc& format) { return format.is_depth_stencil(); }},
  };
  constexpr Backing kBuffer[] = {
      {VK_FORMAT_FEATURE_VERTEX_BUFFER_BIT,
       [](const texel::FormatDesc& format) {
         return format.plain || (format.channel_count != 0 && format.channel[0].bits == 64 && format.is_integer());
       }},
      {VK_FORMAT_FEATURE_UNIFORM_TEXEL_BUFFER_BIT, texel::can_decode},
      {VK_FORMAT_FEATURE_STORAGE_TEXEL_BUFFER_BIT, texel::can_store},
  };
  for (const FormatClaim& claim : format_claims()) {
    texel::ImageDesc desc;
    desc.format = claim.format;
    texel::ImageLayout layout;
    ASSERT_TRUE(texel::make_image_layout(desc, layout)) << texel::format_desc(claim.format).name;
    // Depth and stencil of a combined format are planes of their own.
    for (std::uint32_t plane = 0; plane < layout.plane_count; ++plane) {
      const texel::FormatDesc& format = texel::view_format_desc(layout.plane[plane].format);
      for (const Backing& row : kImage) {
        const bool claimed = claim.properties.optimalTilingFeatures & row.feature;
        EXPECT_TRUE(!claimed || row.can(format)) << format.name << " image feature " << row.feature;
      }
      for (const Backing& row : kBuffer) {
        const bool claimed = claim.properties.bufferFeatures & row.feature;
        EXPECT_TRUE(!claimed || row.can(format)) << format.name << " buffer feature " << row.feature;
      }
    }
  }
}

TEST_F(Formats, WideFeaturesContainTheNarrowOnes) {
  for (const VkFormat format : {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_D32_SFLOAT, VK_FORMAT_UNDEFINED}) {
    auto wide = make_struct<VkFormatProperties3>();
    auto properties = make_struct<VkFormatProperties2>(&wide);
    VK_GET(instance, GetPhysicalDeviceFormatProperties2)(physical_device, format, &properties);
    const VkFormatProperties& narrow = properties.formatProperties;
    EXPECT_EQ(wide.optimalTilingFeatures & 0x7fffffffu, narrow.optimalTilingFeatures);
    EXPECT_EQ(wide.linearTilingFeatures & 0x7fffffffu, narrow.linearTilingFeatures);
    EXPECT_EQ(wide.bufferFeatures & 0x7fffffffu, narrow.bufferFeatures);
    const bool stored = narrow.bufferFeatures & VK_FORMAT_FEATURE_STORAGE_TEXEL_BUFFER_BIT;
    EXPECT_EQ((wide.bufferFeatures & VK_FORMAT_FEATURE_2_STORAGE_WRITE_WITHOUT_FORMAT_BIT) != 0, stored);
    EXPECT_EQ((wide.optimalTilingFeatures & VK_FORMAT_FEATURE_2_SAMPLED_IMAGE_DEPTH_COMPARISON_BIT) != 0,
              format == VK_FORMAT_D32_SFLOAT);
  }
}

TEST_F(Formats, CubesMayBeLargerThanOtherImages) {
  const auto query = VK_GET(instance, GetPhysicalDeviceImageFormatProperties);
  VkPhysicalDeviceProperties device_properties;
  VK_GET(instance, GetPhysicalDeviceProperties)(physical_device, &device_properties);
  VkImageFormatProperties out;
  for (const VkImageCreateFlags flags :
       {VkImageCreateFlags{0}, VkImageCreateFlags{VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT}}) {
    ASSERT_EQ(query(physical_device, VK_FORMAT_R8_UNORM, VK_IMAGE_TYPE_2D, VK_IMAGE_TILING_OPTIMAL,
                    VK_IMAGE_USAGE_SAMPLED_BIT, flags, &out),
              VK_SUCCESS);
    const VkPhysicalDeviceLimits& limits = device_properties.limits;
    EXPECT_EQ(out.maxExtent.width, flags ? limits.maxImageDimensionCube : limits.maxImageDimension2D);
    EXPECT_EQ(out.maxMipLevels, static_cast<std::uint32_t>(std::bit_width(out.maxExtent.width)));
  }
}

TEST_F(Formats, ImagePropertiesFollowFeatures) {
  const auto query = VK_GET(instance, GetPhysicalDeviceImageFormatProperties);
  VkImageFormatProperties out;
  EXPECT_EQ(query(physical_device, VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_TYPE_2D, VK_IMAGE_TILING_OPTIMAL,
                  VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, 0, &out),
            VK_SUCCESS);
  EXPECT_EQ(out.sampleCounts, VkSampleCountFlags{15});  // 1, 2, 4, 8
  EXPECT_EQ(out.maxMipLevels, static_cast<std::uint32_t>(std::bit_width(out.maxExtent.width)));
  EXPECT_GE(out.maxResourceSize, VkDeviceSize{1} << 31);
  EXPECT_EQ(query(physical_device, VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_TYPE_2D, VK_IMAGE_TILING_OPTIMAL,
                  VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, 0, &out),
            VK_ERROR_FORMAT_NOT_SUPPORTED);
  EXPECT_EQ(out.maxMipLevels, 0u);
  EXPECT_EQ(query(physical_device, VK_FORMAT_D32_SFLOAT, VK_IMAGE_TYPE_2D, VK_IMAGE_TILING_LINEAR,
                  VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, 0, &out),
            VK_ERROR_FORMAT_NOT_SUPPORTED);
  EXPECT_EQ(query(physical_device, VK_FORMAT_D32_SFLOAT, VK_IMAGE_TYPE_2D, VK_IMAGE_TILING_LINEAR,
                  VK_IMAGE_USAGE_SAMPLED_BIT, 0, &out),
            VK_SUCCESS);
  EXPECT_EQ(query(physical_device, VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_TYPE_2D, VK_IMAGE_TILING_OPTIMAL,
                  VK_IMAGE_USAGE_SAMPLED_BIT, VK_IMAGE_CREATE_SPARSE_BINDING_BIT, &out),
            VK_ERROR_FORMAT_NOT_SUPPORTED);
  EXPECT_EQ(query(physical_device, static_cast<VkFormat>(0x7ffffff0), VK_IMAGE_TYPE_2D, VK_IMAGE_TILING_OPTIMAL,
                  VK_IMAGE_USAGE_SAMPLED_BIT, 0, &out),
            VK_ERROR_FORMAT_NOT_SUPPORTED);
}

}  // namespace
}  // namespace vitrine::icd::test

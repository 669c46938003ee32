// Memory, buffers, images and the small objects: binding, absurd sizes, and every allocation failing in turn.
#include <array>
#include <cstring>
#include <limits>

#include "tests/icd/fixture.h"

namespace vitrine::icd::test {
namespace {

using Memory = DeviceTest;
using Device = DeviceTest;

VkImageCreateInfo image_info(std::uint32_t width, std::uint32_t height) {
  VkImageCreateInfo info = make_struct<VkImageCreateInfo>();
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = VK_FORMAT_R8G8B8A8_UNORM;
  info.extent = {width, height, 1};
  info.mipLevels = 1;
  info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  return info;
}

VkResult allocate(VkInstance instance, VkDevice device, VkDeviceSize size, VkDeviceMemory* memory,
                  const VkAllocationCallbacks* allocator = nullptr) {
  VkMemoryAllocateInfo info = make_struct<VkMemoryAllocateInfo>();
  info.allocationSize = size;
  return VK_GET(instance, AllocateMemory)(device, &info, allocator, memory);
}

TEST_F(Memory, IsZeroAndMapped) {
  VkDeviceMemory memory;
  ASSERT_EQ(allocate(instance, device, 100000, &memory), VK_SUCCESS);
  void* data = nullptr;
  ASSERT_EQ(VK_GET(instance, MapMemory)(device, memory, 64, VK_WHOLE_SIZE, 0, &data), VK_SUCCESS);
  for (std::size_t i = 0; i < 1000; ++i) ASSERT_EQ(static_cast<unsigned char*>(data)[i], 0);
  std::memset(data, 0xab, 100000 - 64);
  VK_GET(instance, UnmapMemory)(device, memory);
  VK_GET(instance, FreeMemory)(device, memory, nullptr);
}

TEST_F(Memory, AbsurdSizesAreErrors) {
  VkDeviceMemory memory = VK_NULL_HANDLE;
  for (const VkDeviceSize size : {VkDeviceSize{1} << 62, std::numeric_limits<VkDeviceSize>::max()}) {
    EXPECT_EQ(allocate(instance, device, size, &memory), VK_ERROR_OUT_OF_DEVICE_MEMORY);
    VkBufferCreateInfo info = make_struct<VkBufferCreateInfo>();
    info.size = size;
    VkBuffer buffer = VK_NULL_HANDLE;
    EXPECT_EQ(VK_GET(instance, CreateBuffer)(device, &info, nullptr, &buffer), VK_ERROR_OUT_OF_DEVICE_MEMORY);
  }
  constexpr std::uint32_t kHuge = std::numeric_limits<std::uint32_t>::max();
  VkImageCreateInfo info = image_info(kHuge, kHuge);
  info.arrayLayers = kHuge;
  VkImage image = VK_NULL_HANDLE;
  EXPECT_EQ(VK_GET(instance, CreateImage)(device, &info, nullptr, &image), VK_ERROR_OUT_OF_DEVICE_MEMORY);
  info = image_info(16, 16);
  info.mipLevels = kHuge;
  EXPECT_EQ(VK_GET(instance, CreateImage)(device, &info, nullptr, &image), VK_ERROR_OUT_OF_DEVICE_MEMORY);
  info = image_info(16, 16);
  info.format = static_cast<VkFormat>(0x7ffffff0);
  EXPECT_EQ(VK_GET(instance, CreateImage)(device, &info, nullptr, &image), VK_ERROR_OUT_OF_DEVICE_MEMORY);
}

TEST_F(Memory, BindingBeyondTheAllocationIsAnError) {
  VkDeviceMemory memory;
  ASSERT_EQ(allocate(instance, device, 1000, &memory), VK_SUCCESS);
  VkBufferCreateInfo info = make_struct<VkBufferCreateInfo>();
  info.size = 900;
  VkBuffer buffer;
  ASSERT_EQ(VK_GET(instance, CreateBuffer)(device, &info, nullptr, &buffer), VK_SUCCESS);
  EXPECT_EQ(VK_GET(instance, BindBufferMemory)(device, buffer, memory, 128), VK_ERROR_OUT_OF_DEVICE_MEMORY);
  EXPECT_EQ(VK_GET(instance, BindBufferMemory)(device, buffer, memory, ~VkDeviceSize{0} - 100),
            VK_ERROR_OUT_OF_DEVICE_MEMORY);
  EXPECT_EQ(VK_GET(instance, BindBufferMemory)(device, buffer, memory, 64), VK_SUCCESS);
  VK_GET(instance, DestroyBuffer)(device, buffer, nullptr);
  VK_GET(instance, FreeMemory)(device, memory, nullptr);
}

TEST_F(Memory, RequirementsOfBothQueriesAgree) {
  const VkImageCreateInfo info = image_info(33, 17);
  VkImage image;
  ASSERT_EQ(VK_GET(instance, CreateImage)(device, &info, nullptr, &image), VK_SUCCESS);
  VkMemoryRequirements plain;
  VK_GET(instance, GetImageMemoryRequirements)(device, image, &plain);
  auto dedicated = make_struct<VkMemoryDedicatedRequirements>();
  dedicated.requiresDedicatedAllocation = VK_TRUE;
  auto second = make_struct<VkMemoryRequirements2>(&dedicated);
  auto query = make_struct<VkImageMemoryRequirementsInfo2>();
  query.image = image;
  VK_GET(instance, GetImageMemoryRequirements2)(device, &query, &second);
  EXPECT_EQ(plain.size, second.memoryRequirements.size);
  EXPECT_EQ(plain.alignment, second.memoryRequirements.alignment);
  EXPECT_GE(plain.size, 33u * 17 * 4);
  EXPECT_EQ(plain.memoryTypeBits, 1u);
  EXPECT_EQ(dedicated.requiresDedicatedAllocation, VK_FALSE);
  VK_GET(instance, DestroyImage)(device, image, nullptr);
}

TEST_F(Memory, ImagesNeedNoMoreThanTheirRows) {
  const VkImageCreateInfo info = image_info(256, 256);
  VkImage image;
  ASSERT_EQ(VK_GET(instance, CreateImage)(device, &info, nullptr, &image), VK_SUCCESS);
  VkMemoryRequirements requirements;
  VK_GET(instance, GetImageMemoryRequirements)(device, image, &requirements);
  // The reference's size: captures of applications on it allocate that much.
  EXPECT_EQ(requirements.size, 256u * 256 * 4);
  VkDeviceMemory memory;
  ASSERT_EQ(allocate(instance, device, requirements.size, &memory), VK_SUCCESS);
  EXPECT_EQ(VK_GET(instance, BindImageMemory)(device, image, memory, 0), VK_SUCCESS);
  VK_GET(instance, DestroyImage)(device, image, nullptr);
  VK_GET(instance, FreeMemory)(device, memory, nullptr);
}

TEST_F(Memory, LinearImageLayoutIsReadable) {
  VkImageCreateInfo info = image_info(33, 17);
  info.tiling = VK_IMAGE_TILING_LINEAR;
  VkImage image;
  ASSERT_EQ(VK_GET(instance, CreateImage)(device, &info, nullptr, &image), VK_SUCCESS);
  const VkImageSubresource subresource{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0};
  VkSubresourceLayout layout;
  VK_GET(instance, GetImageSubresourceLayout)(device, image, &subresource, &layout);
  VkMemoryRequirements requirements;
  VK_GET(instance, GetImageMemoryRequirements)(device, image, &requirements);
  EXPECT_GE(layout.rowPitch, 33u * 4);
  EXPECT_LE(layout.offset + layout.size, requirements.size);
  EXPECT_GE(layout.size, layout.rowPitch * 16 + 33 * 4);
  VK_GET(instance, DestroyImage)(device, image, nullptr);
}

/// Depth and stencil of a linear image are found one after the other.
TEST_F(Memory, AspectsOfALinearImageLieApart) {
  VkImageCreateInfo info = image_info(33, 17);
  info.format = VK_FORMAT_D32_SFLOAT_S8_UINT;
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  info.tiling = VK_IMAGE_TILING_LINEAR;
  VkImage image;
  ASSERT_EQ(VK_GET(instance, CreateImage)(device, &info, nullptr, &image), VK_SUCCESS);
  VkSubresourceLayout depth, stencil;
  const VkImageSubresource depth_of{VK_IMAGE_ASPECT_DEPTH_BIT, 0, 0}, stencil_of{VK_IMAGE_ASPECT_STENCIL_BIT, 0, 0};
  VK_GET(instance, GetImageSubresourceLayout)(device, image, &depth_of, &depth);
  VK_GET(instance, GetImageSubresourceLayout)(device, image, &stencil_of, &stencil);
  VkMemoryRequirements requirements;
  VK_GET(instance, GetImageMemoryRequirements)(device, image, &requirements);
  EXPECT_GE(depth.rowPitch, 33u * 4);
  EXPECT_GE(stencil.rowPitch, 33u);
  EXPECT_LE(depth.offset + depth.size, stencil.offset);
  EXPECT_LE(stencil.offset + stencil.size, requirements.size);
  VK_GET(instance, DestroyImage)(device, image, nullptr);
}

TEST_F(Device, QueueIsTheOneOfTheFamily) {
  VkQueue queue = VK_NULL_HANDLE;
  VK_GET(instance, GetDeviceQueue)(device, 0, 0, &queue);
  EXPECT_NE(queue, VkQueue{});
  auto info = make_struct<VkDeviceQueueInfo2>();
  VkQueue same = VK_NULL_HANDLE;
  VK_GET(instance, GetDeviceQueue2)(device, &info, &same);
  EXPECT_EQ(queue, same);
}

TEST_F(Device, CommandsOfTheDeviceNeedItsExtensions) {
  const auto get = VK_GET(instance, GetDeviceProcAddr);
  EXPECT_NE(get(device, "vkCreateBuffer"), nullptr);
  EXPECT_NE(get(device, "vkSetDebugUtilsObjectNameEXT"), nullptr) << "its instance extension is enabled";
  EXPECT_EQ(get(device, "vkBindBufferMemory2KHR"), nullptr) << "its device extension is not enabled";
  EXPECT_NE(get(device, "vkBindBufferMemory2"), nullptr);
  EXPECT_EQ(get(device, "vkCreateDevice"), nullptr) << "not a device command";
}

TEST(DeviceCommands, OfDebugUtilsNeedTheInstancesExtension) {
  VkInstance instance;
  ASSERT_EQ(create_instance(&instance), VK_SUCCESS);
  std::uint32_t count = 1;
  VkPhysicalDevice physical_device;
  ASSERT_EQ(VK_GET(instance, EnumeratePhysicalDevices)(instance, &count, &physical_device), VK_SUCCESS);
  VkDevice device;
  ASSERT_EQ(create_device(instance, physical_device, &device), VK_SUCCESS);
  for (const char* name : {"vkSetDebugUtilsObjectNameEXT", "vkQueueBeginDebugUtilsLabelEXT",
                           "vkCmdBeginDebugUtilsLabelEXT", "vkCmdInsertDebugUtilsLabelEXT"})
    EXPECT_EQ(VK_GET(instance, GetDeviceProcAddr)(device, name), nullptr) << name;
  VK_GET(instance, DestroyDevice)(device, nullptr);
  VK_GET(instance, DestroyInstance)(instance, nullptr);
}

TEST_F(Device, PipelineCacheDataIsAHeader) {
  const VkPipelineCacheCreateInfo info = make_struct<VkPipelineCacheCreateInfo>();
  VkPipelineCache cache;
  ASSERT_EQ(VK_GET(instance, CreatePipelineCache)(device, &info, nullptr, &cache), VK_SUCCESS);
  const auto get = VK_GET(instance, GetPipelineCacheData);
  std::size_t size = 0;
  EXPECT_EQ(get(device, cache, &size, nullptr), VK_SUCCESS);
  ASSERT_EQ(size, sizeof(VkPipelineCacheHeaderVersionOne));
  VkPipelineCacheHeaderVersionOne header{};
  EXPECT_EQ(get(device, cache, &size, &header), VK_SUCCESS);
  EXPECT_EQ(header.headerSize, 32u);
  size = 31;
  EXPECT_EQ(get(device, cache, &size, &header), VK_INCOMPLETE);
  EXPECT_EQ(size, 0u);
  VK_GET(instance, DestroyPipelineCache)(device, cache, nullptr);
}

/// Everything below a device that this test makes; members stay null after the first failure.
struct Everything {
  VkDevice device = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkBuffer buffer = VK_NULL_HANDLE;
  VkBufferView buffer_view = VK_NULL_HANDLE;
  VkImage image = VK_NULL_HANDLE;
  VkImageView image_view = VK_NULL_HANDLE;
  VkSampler sampler = VK_NULL_HANDLE;
  VkFence fence = VK_NULL_HANDLE;
  VkSemaphore semaphore = VK_NULL_HANDLE;
  VkEvent event = VK_NULL_HANDLE;
  VkPipelineCache cache = VK_NULL_HANDLE;
};

#define VK_TRY(call)                                         \
  do {                                                       \
    const VkResult result_of_call = (call);                  \
    if (result_of_call != VK_SUCCESS) return result_of_call; \
  } while (false)

VkResult make_resources(VkInstance instance, const VkAllocationCallbacks* allocator, Everything& all) {
  VK_TRY(allocate(instance, all.device, 1 << 20, &all.memory, allocator));
  VkBufferCreateInfo buffer = make_struct<VkBufferCreateInfo>();
  buffer.size = 256;
  VK_TRY(VK_GET(instance, CreateBuffer)(all.device, &buffer, allocator, &all.buffer));
  VK_TRY(VK_GET(instance, BindBufferMemory)(all.device, all.buffer, all.memory, 0));
  VkBufferViewCreateInfo buffer_view = make_struct<VkBufferViewCreateInfo>();
  buffer_view.buffer = all.buffer;
  buffer_view.format = VK_FORMAT_R32_UINT;
  buffer_view.range = VK_WHOLE_SIZE;
  VK_TRY(VK_GET(instance, CreateBufferView)(all.device, &buffer_view, allocator, &all.buffer_view));
  const VkImageCreateInfo image = image_info(16, 16);
  VK_TRY(VK_GET(instance, CreateImage)(all.device, &image, allocator, &all.image));
  VK_TRY(VK_GET(instance, BindImageMemory)(all.device, all.image, all.memory, 4096));
  VkImageViewCreateInfo image_view = make_struct<VkImageViewCreateInfo>();
  image_view.image = all.image;
  image_view.viewType = VK_IMAGE_VIEW_TYPE_2D;
  image_view.format = image.format;
  image_view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS};
  return VK_GET(instance, CreateImageView)(all.device, &image_view, allocator, &all.image_view);
}

VkResult make_everything(VkInstance instance, VkPhysicalDevice physical_device, const VkAllocationCallbacks* allocator,
                         Everything& all) {
  VK_TRY(create_device(instance, physical_device, &all.device, allocator));
  VK_TRY(make_resources(instance, allocator, all));
  const VkSamplerCreateInfo sampler = make_struct<VkSamplerCreateInfo>();
  VK_TRY(VK_GET(instance, CreateSampler)(all.device, &sampler, allocator, &all.sampler));
  const VkFenceCreateInfo fence = make_struct<VkFenceCreateInfo>();
  VK_TRY(VK_GET(instance, CreateFence)(all.device, &fence, allocator, &all.fence));
  const VkSemaphoreCreateInfo semaphore = make_struct<VkSemaphoreCreateInfo>();
  VK_TRY(VK_GET(instance, CreateSemaphore)(all.device, &semaphore, allocator, &all.semaphore));
  const VkEventCreateInfo event = make_struct<VkEventCreateInfo>();
  VK_TRY(VK_GET(instance, CreateEvent)(all.device, &event, allocator, &all.event));
  const VkPipelineCacheCreateInfo cache = make_struct<VkPipelineCacheCreateInfo>();
  return VK_GET(instance, CreatePipelineCache)(all.device, &cache, allocator, &all.cache);
}

void destroy_everything(VkInstance instance, const VkAllocationCallbacks* allocator, const Everything& all) {
  if (!all.device) return;
  VK_GET(instance, DestroyPipelineCache)(all.device, all.cache, allocator);
  VK_GET(instance, DestroyEvent)(all.device, all.event, allocator);
  VK_GET(instance, DestroySemaphore)(all.device, all.semaphore, allocator);
  VK_GET(instance, DestroyFence)(all.device, all.fence, allocator);
  VK_GET(instance, DestroySampler)(all.device, all.sampler, allocator);
  VK_GET(instance, DestroyImageView)(all.device, all.image_view, allocator);
  VK_GET(instance, DestroyImage)(all.device, all.image, allocator);
  VK_GET(instance, DestroyBufferView)(all.device, all.buffer_view, allocator);
  VK_GET(instance, DestroyBuffer)(all.device, all.buffer, allocator);
  VK_GET(instance, FreeMemory)(all.device, all.memory, allocator);
  VK_GET(instance, DestroyDevice)(all.device, allocator);
}

TEST_F(Device, EveryFailingAllocationIsAnErrorAndLeaksNothing) {
  CountingAllocator allocator;
  std::size_t n = 0;
  for (; n < 1000; ++n) {
    allocator.fail_after(n);
    Everything all;
    const VkResult result = make_everything(instance, physical_device, allocator.callbacks(), all);
    destroy_everything(instance, allocator.callbacks(), all);
    ASSERT_EQ(allocator.live(), 0u) << "after failing allocation " << n;
    if (result == VK_SUCCESS) break;
    ASSERT_EQ(result, VK_ERROR_OUT_OF_HOST_MEMORY) << "allocation " << n;
  }
  EXPECT_GE(n, 11u) << "fewer allocations than objects";
  EXPECT_LT(n, 1000u);
}

}  // namespace
}  // namespace vitrine::icd::test

// Device memory and binding (Vulkan 1.3.239, Memory Allocation: Device Memory; Resource Creation: Resource Memory
// Association).
#include "icd/memory.h"

#include <sys/mman.h>

#include "icd/diagnostics.h"
#include "icd/entry_points.h"
#include "icd/image.h"
#include "icd/util.h"

namespace vitrine::icd {
namespace {

constexpr VkDeviceSize kTailBytes = 64;
constexpr VkDeviceSize kResourceAlignment = 64;

}  // namespace

DeviceMemory::DeviceMemory(const HostMemory& m, VkDeviceSize bytes) : Object(m), size(bytes) {
  // NORESERVE: a large allocation that is never touched costs address space only.
  void* mapping =
      mmap(nullptr, size + kTailBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (mapping != MAP_FAILED) data = static_cast<std::byte*>(mapping);
}

DeviceMemory::~DeviceMemory() {
  if (data) munmap(data, size + kTailBytes);
}

namespace entry {

VKAPI_ATTR VkResult VKAPI_CALL AllocateMemory(VkDevice device, const VkMemoryAllocateInfo* info,
                                              const VkAllocationCallbacks* allocator, VkDeviceMemory* memory) {
  Device& d = from_handle<Device>(device);
  const VkPhysicalDeviceMemoryProperties& properties = d.physical_device.memory_properties;
  if (info->memoryTypeIndex >= properties.memoryTypeCount || info->allocationSize > properties.memoryHeaps[0].size) {
    report_error(d, ref(d), "memory", "allocation is larger than the heap");
    return VK_ERROR_OUT_OF_DEVICE_MEMORY;
  }
  Owned<DeviceMemory> object(create_object<DeviceMemory>(d.memory, allocator, info->allocationSize));
  if (!object->data) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
  *memory = to_handle(object.release());
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL FreeMemory(VkDevice, VkDeviceMemory memory, const VkAllocationCallbacks*) {
  destroy_handle<DeviceMemory>(memory);
}

VKAPI_ATTR VkResult VKAPI_CALL MapMemory(VkDevice, VkDeviceMemory memory, VkDeviceSize offset, VkDeviceSize,
                                         VkMemoryMapFlags, void** data) {
  const DeviceMemory& m = from_handle<DeviceMemory>(memory);
  if (offset > m.size) return VK_ERROR_MEMORY_MAP_FAILED;
  *data = m.data + offset;
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL UnmapMemory(VkDevice, VkDeviceMemory) {}

VKAPI_ATTR VkResult VKAPI_CALL FlushMappedMemoryRanges(VkDevice, std::uint32_t, const VkMappedMemoryRange*) {
  return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL InvalidateMappedMemoryRanges(VkDevice, std::uint32_t, const VkMappedMemoryRange*) {
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL GetDeviceMemoryCommitment(VkDevice, VkDeviceMemory memory, VkDeviceSize* bytes) {
  *bytes = from_handle<DeviceMemory>(memory).size;
}

VKAPI_ATTR void VKAPI_CALL GetBufferMemoryRequirements(VkDevice device, VkBuffer buffer, VkMemoryRequirements* out) {
  VkBufferMemoryRequirementsInfo2 info = make_struct<VkBufferMemoryRequirementsInfo2>();
  info.buffer = buffer;
  VkMemoryRequirements2 requirements = make_struct<VkMemoryRequirements2>();
  GetBufferMemoryRequirements2(device, &info, &requirements);
  *out = requirements.memoryRequirements;
}

VKAPI_ATTR void VKAPI_CALL GetBufferMemoryRequirements2(VkDevice, const VkBufferMemoryRequirementsInfo2* info,
                                                        VkMemoryRequirements2* out) {
  const Buffer& buffer = from_handle<Buffer>(info->buffer);
  const VkDeviceSize size = (buffer.size + kResourceAlignment - 1) & ~(kResourceAlignment - 1);
  out->memoryRequirements = {size, kResourceAlignment, 1};
  if (auto* dedicated = find_in_out_chain<VkMemoryDedicatedRequirements>(out->pNext)) {
    dedicated->prefersDedicatedAllocation = VK_FALSE;
    dedicated->requiresDedicatedAllocation = VK_FALSE;
  }
}

VKAPI_ATTR void VKAPI_CALL GetImageMemoryRequirements(VkDevice device, VkImage image, VkMemoryRequirements* out) {
  VkImageMemoryRequirementsInfo2 info = make_struct<VkImageMemoryRequirementsInfo2>();
  info.image = image;
  VkMemoryRequirements2 requirements = make_struct<VkMemoryRequirements2>();
  GetImageMemoryRequirements2(device, &info, &requirements);
  *out = requirements.memoryRequirements;
}

VKAPI_ATTR void VKAPI_CALL GetImageMemoryRequirements2(VkDevice, const VkImageMemoryRequirementsInfo2* info,
                                                       VkMemoryRequirements2* out) {
  const texel::ImageLayout& layout = from_handle<Image>(info->image).layout;
  out->memoryRequirements = {layout.size, layout.alignment, 1};
  if (auto* dedicated = find_in_out_chain<VkMemoryDedicatedRequirements>(out->pNext)) {
    dedicated->prefersDedicatedAllocation = VK_FALSE;
    dedicated->requiresDedicatedAllocation = VK_FALSE;
  }
}

VKAPI_ATTR void VKAPI_CALL GetImageSparseMemoryRequirements(VkDevice, VkImage, std::uint32_t* count,
                                                            VkSparseImageMemoryRequirements*) {
  *count = 0;
}

VKAPI_ATTR void VKAPI_CALL GetImageSparseMemoryRequirements2(VkDevice, const VkImageSparseMemoryRequirementsInfo2*,
                                                             std::uint32_t* count, VkSparseImageMemoryRequirements2*) {
  *count = 0;
}

VKAPI_ATTR VkResult VKAPI_CALL BindBufferMemory(VkDevice device, VkBuffer buffer, VkDeviceMemory memory,
                                                VkDeviceSize offset) {
  VkBindBufferMemoryInfo info = make_struct<VkBindBufferMemoryInfo>();
  info.buffer = buffer;
  info.memory = memory;
  info.memoryOffset = offset;
  return BindBufferMemory2(device, 1, &info);
}

VKAPI_ATTR VkResult VKAPI_CALL BindBufferMemory2(VkDevice, std::uint32_t count, const VkBindBufferMemoryInfo* infos) {
  for (std::uint32_t i = 0; i < count; ++i) {
    Buffer& buffer = from_handle<Buffer>(infos[i].buffer);
    const DeviceMemory& memory = from_handle<DeviceMemory>(infos[i].memory);
    if (infos[i].memoryOffset > memory.size || buffer.size > memory.size - infos[i].memoryOffset) {
      return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    }
    buffer.data = memory.data + infos[i].memoryOffset;
  }
  return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL BindImageMemory(VkDevice device, VkImage image, VkDeviceMemory memory,
                                               VkDeviceSize offset) {
  VkBindImageMemoryInfo info = make_struct<VkBindImageMemoryInfo>();
  info.image = image;
  info.memory = memory;
  info.memoryOffset = offset;
  return BindImageMemory2(device, 1, &info);
}

VKAPI_ATTR VkResult VKAPI_CALL BindImageMemory2(VkDevice, std::uint32_t count, const VkBindImageMemoryInfo* infos) {
  for (std::uint32_t i = 0; i < count; ++i) {
    Image& image = from_handle<Image>(infos[i].image);
    if (const auto* swapchain = find_in_chain<VkBindImageMemorySwapchainInfoKHR>(infos[i].pNext);
        swapchain && swapchain->swapchain) {
      image.data =
          swapchain_image_memory ? swapchain_image_memory(swapchain->swapchain, swapchain->imageIndex) : nullptr;
      if (!image.data) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
      continue;
    }
    const DeviceMemory& memory = from_handle<DeviceMemory>(infos[i].memory);
    if (infos[i].memoryOffset > memory.size || image.layout.size > memory.size - infos[i].memoryOffset) {
      return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    }
    image.data = memory.data + infos[i].memoryOffset;
  }
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL GetDeviceGroupPeerMemoryFeatures(VkDevice, std::uint32_t, std::uint32_t, std::uint32_t,
                                                            VkPeerMemoryFeatureFlags* features) {
  *features = 0;
}

}  // namespace entry
}  // namespace vitrine::icd

// Device memory and binding (Vulkan 1.3.239, Memory Allocation: Device Memory; Resource Creation: Resource Memory
// Association).
#include "icd/object/memory.h"

#include <algorithm>

#include "base/shake.h"
#include "glass/bug/capture.h"
#include "glass/memory_shadow.h"
#include "glass/session.h"
#include "glass/sync/sync.h"
#include "icd/edge/diagnostics.h"
#include "icd/edge/util.h"
#include "icd/entry_points.h"
#include "icd/object/address_book.h"
#include "icd/object/image.h"
#include "icd/object/memory_report.h"
#include "spirv/addresses.h"
#include "texel/layout.h"

namespace vitrine::icd {
namespace {

constexpr VkDeviceSize kResourceAlignment = 64;

/// What an image takes of its memory. The layout ends with room for reading beyond the last texel, which every
/// allocation has of its own.
VkDeviceSize bytes_of(const texel::ImageLayout& layout) { return layout.size - std::min(layout.size, kTailBytes); }

/// What binding a part of an image takes: all of it, or the plane of a disjoint one.
VkDeviceSize bytes_of(const texel::ImageLayout& layout, VkImageAspectFlagBits aspect) {
  return layout.desc.disjoint ? texel::end_of(layout.plane[texel::plane_of_aspect(layout, aspect)]) : bytes_of(layout);
}

void write_requirements(VkDeviceSize size, VkDeviceSize alignment, VkMemoryRequirements2& out) {
  out.memoryRequirements = {(size + alignment - 1) & ~(alignment - 1), alignment, 1};
  if (auto* dedicated = find_in_out_chain<VkMemoryDedicatedRequirements>(out.pNext)) {
    dedicated->prefersDedicatedAllocation = VK_FALSE;
    dedicated->requiresDedicatedAllocation = VK_FALSE;
  }
}

/// A disjoint image counts as bound when its last plane is.
void bind_image(Image& image, VkImageAspectFlagBits aspect, std::byte* memory) {
  image.plane_data[texel::plane_of_aspect(image.layout, aspect)] = memory;
  const auto last = image.plane_data.begin() + (image.desc().disjoint ? image.layout.plane_count : 1);
  if (std::find(image.plane_data.begin(), last, nullptr) == last) image.data = image.plane_data[0];
}

/// Captured commands that follow addresses are run again with memory at the same ones (docs/glass/bugfile.md).
Placement placement_of(const VkMemoryAllocateInfo& info) {
  const auto* again = find_in_chain<VkMemoryOpaqueCaptureAddressAllocateInfo>(info.pNext);
  if (again && again->opaqueCaptureAddress) return {static_cast<std::uintptr_t>(again->opaqueCaptureAddress), false};
  const auto* flags = find_in_chain<VkMemoryAllocateFlagsInfo>(info.pNext);
  if (!flags) return {};
  const bool addressed = flags->flags & VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
  const bool captured = flags->flags & VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_CAPTURE_REPLAY_BIT;
  return {0, captured || (addressed && glass::bug::captures())};
}

/// The application says that it has written mapped memory, or is about to read it: told to the tool sync.
void tell_host_access(Device& device, std::span<const VkMappedMemoryRange> ranges, bool write) {
  glass::sync::Hazards* const hazards = glass::sync::hazards_of(&device);
  if (!hazards) return;
  for (const VkMappedMemoryRange& range : ranges) {
    const DeviceMemory& memory = from_handle<DeviceMemory>(range.memory);
    if (range.offset >= memory.size) continue;
    const std::string name = name_of(device.physical_device.instance, ref(memory));
    auto who = glass::sync::host(write, write ? "vkFlushMappedMemoryRanges" : "vkInvalidateMappedMemoryRanges",
                                 name.empty() ? "device memory" : "device memory '" + name + "'");
    who->base = reinterpret_cast<std::uintptr_t>(memory.data);
    const std::uintptr_t first = who->base + range.offset;
    hazards->host_access({first, first + std::min(range.size, memory.size - range.offset)}, write, who);
  }
}

/// The object and its bytes: a file of somebody's, the application's pages, a file of its own, or plain memory.
VkResult make_memory(Device& d, const VkMemoryAllocateInfo& info, const VkAllocationCallbacks* allocator,
                     DeviceMemory*& out) {
  const VkPhysicalDeviceMemoryProperties& properties = d.physical_device.memory_properties;
  if (info.memoryTypeIndex >= properties.memoryTypeCount || info.allocationSize > properties.memoryHeaps[0].size) {
    report_error(d, ref(d), "memory", "allocation is larger than the heap");
    return VK_ERROR_OUT_OF_DEVICE_MEMORY;
  }
  if (base::fails_now()) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
  const auto* file = find_in_chain<VkImportMemoryFdInfoKHR>(info.pNext);
  const auto* pages = find_in_chain<VkImportMemoryHostPointerInfoEXT>(info.pNext);
  const auto* exported = find_in_chain<VkExportMemoryAllocateInfo>(info.pNext);
  if ((file && file->handleType) || (pages && pages->handleType) || (exported && exported->handleTypes)) {
    Owned<DeviceMemory> object(create_object<DeviceMemory>(d.memory, allocator, info.allocationSize));
    if (file && file->handleType) {
      if (!object->map_file(file->fd)) return VK_ERROR_INVALID_EXTERNAL_HANDLE;
    } else if (pages && pages->handleType) {
      if (!object->use_host_pages(pages->pHostPointer)) return VK_ERROR_INVALID_EXTERNAL_HANDLE;
    } else if (!object->map_new_file()) {
      return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    }
    object->imported = (file && file->handleType) || (pages && pages->handleType);
    out = object.release();
    return VK_SUCCESS;
  }
  const Placement placement = placement_of(info);
  Owned<DeviceMemory> object(
      create_object<DeviceMemory>(d.memory, allocator, info.allocationSize, allocated_bytes(), placement));
  if (!object->data) return placement.address ? VK_ERROR_INVALID_OPAQUE_CAPTURE_ADDRESS : VK_ERROR_OUT_OF_DEVICE_MEMORY;
  out = object.release();
  return VK_SUCCESS;
}

VkResult bind(Device& device, const VkBindBufferMemoryInfo& info) {
  Buffer& buffer = from_handle<Buffer>(info.buffer);
  const DeviceMemory& memory = from_handle<DeviceMemory>(info.memory);
  if (info.memoryOffset > memory.size || buffer.size > memory.size - info.memoryOffset) {
    return VK_ERROR_OUT_OF_DEVICE_MEMORY;
  }
  buffer.data = memory.data + info.memoryOffset;
  enter_address(device, {buffer.data, buffer.size, buffer.data, ref(memory)}, buffer);
  report_binding(device, ref(buffer), buffer.data, buffer.size, VK_DEVICE_ADDRESS_BINDING_TYPE_BIND_EXT);
  return VK_SUCCESS;
}

VkResult bind(Device& device, const VkBindImageMemoryInfo& info) {
  Image& image = from_handle<Image>(info.image);
  if (const auto* swapchain = find_in_chain<VkBindImageMemorySwapchainInfoKHR>(info.pNext);
      swapchain && swapchain->swapchain) {
    image.data = swapchain_image_memory(swapchain->swapchain, swapchain->imageIndex);
    return image.data ? VK_SUCCESS : VK_ERROR_OUT_OF_DEVICE_MEMORY;
  }
  const DeviceMemory& memory = from_handle<DeviceMemory>(info.memory);
  const auto* part = find_in_chain<VkBindImagePlaneMemoryInfo>(info.pNext);
  const VkImageAspectFlagBits aspect = part ? part->planeAspect : VK_IMAGE_ASPECT_COLOR_BIT;
  const VkDeviceSize bytes = bytes_of(image.layout, aspect);
  if (info.memoryOffset > memory.size || bytes > memory.size - info.memoryOffset) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
  std::byte* const data = memory.data + info.memoryOffset;
  bind_image(image, aspect, data);
  if (memory.file >= 0 || memory.imported) glass::sync::share_image(&device, &image);
  report_binding(device, ref(image), data, bytes, VK_DEVICE_ADDRESS_BINDING_TYPE_BIND_EXT);
  return VK_SUCCESS;
}

/// Binds whatever can be bound; the first failure is the result, and each one's own is where its chain asks for it
/// (Vulkan 1.4.309, VkBindMemoryStatus).
template <class Info>
VkResult bind_all(Device& device, std::span<const Info> infos) {
  VkResult result = VK_SUCCESS;
  for (const Info& info : infos) {
    const VkResult one = bind(device, info);
#ifdef VK_KHR_maintenance6
    if (const auto* status = find_in_chain<VkBindMemoryStatusKHR>(info.pNext)) *status->pResult = one;
#endif
    if (result == VK_SUCCESS) result = one;
  }
  return result;
}

}  // namespace

void report_unbinding(Device& device, const Image& image) {
  const bool disjoint = image.desc().disjoint;
  for (std::uint32_t i = 0; i < (disjoint ? image.layout.plane_count : 1u); ++i) {
    report_binding(device, ref(image), image.plane_data[i],
                   disjoint ? texel::end_of(image.layout.plane[i]) : bytes_of(image.layout),
                   VK_DEVICE_ADDRESS_BINDING_TYPE_UNBIND_EXT);
  }
}

namespace entry {

VKAPI_ATTR VkResult VKAPI_CALL AllocateMemory(VkDevice device, const VkMemoryAllocateInfo* info,
                                              const VkAllocationCallbacks* allocator, VkDeviceMemory* memory) {
  Device& d = from_handle<Device>(device);
  DeviceMemory* object = nullptr;
  if (const VkResult result = make_memory(d, *info, allocator, object); result != VK_SUCCESS) {
    report_failed_allocation(d, *info);
    return result;
  }
  spirv::add_addresses(object->data, object->size);
  enter_address(d, {object->data, object->size, object->data, {}}, *object);
  report_memory(d, *object, /*begins=*/true);
  *memory = to_handle(object);
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL FreeMemory(VkDevice device, VkDeviceMemory memory, const VkAllocationCallbacks*) {
  if (const auto* object = from_nullable<DeviceMemory>(memory)) {
    report_memory(from_handle<Device>(device), *object, /*begins=*/false);
    leave_address(from_handle<Device>(device), object);
    spirv::remove_addresses(object->data);
  }
  destroy_handle<DeviceMemory>(memory);
}

/// All memory is the host's, which pages as it sees fit.
VKAPI_ATTR void VKAPI_CALL SetDeviceMemoryPriorityEXT(VkDevice, VkDeviceMemory, float) {}

VKAPI_ATTR VkResult VKAPI_CALL MapMemory(VkDevice, VkDeviceMemory memory, VkDeviceSize offset, VkDeviceSize size,
                                         VkMemoryMapFlags, void** data) {
  const DeviceMemory& m = from_handle<DeviceMemory>(memory);
  if (offset > m.size) return VK_ERROR_MEMORY_MAP_FAILED;
  *data = m.data + offset;
  if (glass::session().shadows_memory()) {
    if (glass::ShadowRegion* shadow = glass::find_shadow(m.data))
      shadow->map(shadow->first() + offset, std::min(size, m.size - offset));
  }
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL UnmapMemory(VkDevice, VkDeviceMemory) {}

#ifdef VK_KHR_map_memory2
// Vulkan 1.4.309, VK_KHR_map_memory2: the same with structures, for others to extend.
VKAPI_ATTR VkResult VKAPI_CALL MapMemory2KHR(VkDevice device, const VkMemoryMapInfoKHR* info, void** data) {
  return MapMemory(device, info->memory, info->offset, info->size, info->flags, data);
}

VKAPI_ATTR VkResult VKAPI_CALL UnmapMemory2KHR(VkDevice device, const VkMemoryUnmapInfoKHR* info) {
  UnmapMemory(device, info->memory);
  return VK_SUCCESS;
}
#endif

VKAPI_ATTR VkResult VKAPI_CALL FlushMappedMemoryRanges(VkDevice device, std::uint32_t count,
                                                       const VkMappedMemoryRange* ranges) {
  tell_host_access(from_handle<Device>(device), {ranges, count}, true);
  return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL InvalidateMappedMemoryRanges(VkDevice device, std::uint32_t count,
                                                            const VkMappedMemoryRange* ranges) {
  tell_host_access(from_handle<Device>(device), {ranges, count}, false);
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
  write_requirements(from_handle<Buffer>(info->buffer).size, kResourceAlignment, *out);
}

VKAPI_ATTR void VKAPI_CALL GetDeviceBufferMemoryRequirements(VkDevice, const VkDeviceBufferMemoryRequirements* info,
                                                             VkMemoryRequirements2* out) {
  write_requirements(info->pCreateInfo->size, kResourceAlignment, *out);
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
  const auto* plane = find_in_chain<VkImagePlaneMemoryRequirementsInfo>(info->pNext);
  const VkImageAspectFlagBits aspect = plane ? plane->planeAspect : VK_IMAGE_ASPECT_COLOR_BIT;
  write_requirements(bytes_of(layout, aspect), layout.alignment, *out);
}

VKAPI_ATTR void VKAPI_CALL GetDeviceImageMemoryRequirements(VkDevice device,
                                                            const VkDeviceImageMemoryRequirements* info,
                                                            VkMemoryRequirements2* out) {
  Image image(from_handle<Device>(device).memory);
  init_image(image, *info->pCreateInfo);
  write_requirements(bytes_of(image.layout, info->planeAspect), image.layout.alignment, *out);
}

VKAPI_ATTR void VKAPI_CALL GetDeviceImageSparseMemoryRequirements(VkDevice, const VkDeviceImageMemoryRequirements*,
                                                                  std::uint32_t* count,
                                                                  VkSparseImageMemoryRequirements2*) {
  *count = 0;
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

VKAPI_ATTR VkResult VKAPI_CALL BindBufferMemory2(VkDevice device, std::uint32_t count,
                                                 const VkBindBufferMemoryInfo* infos) {
  return bind_all(from_handle<Device>(device), std::span(infos, count));
}

VKAPI_ATTR VkResult VKAPI_CALL BindImageMemory(VkDevice device, VkImage image, VkDeviceMemory memory,
                                               VkDeviceSize offset) {
  VkBindImageMemoryInfo info = make_struct<VkBindImageMemoryInfo>();
  info.image = image;
  info.memory = memory;
  info.memoryOffset = offset;
  return BindImageMemory2(device, 1, &info);
}

VKAPI_ATTR VkResult VKAPI_CALL BindImageMemory2(VkDevice device, std::uint32_t count,
                                                const VkBindImageMemoryInfo* infos) {
  return bind_all(from_handle<Device>(device), std::span(infos, count));
}

VKAPI_ATTR void VKAPI_CALL GetDeviceGroupPeerMemoryFeatures(VkDevice, std::uint32_t, std::uint32_t, std::uint32_t,
                                                            VkPeerMemoryFeatureFlags* features) {
  *features = 0;
}

}  // namespace entry
}  // namespace vitrine::icd

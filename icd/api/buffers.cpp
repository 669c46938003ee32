// Buffers and buffer views (Vulkan 1.3.239, Resource Creation: Buffers, Buffer Views).
#include "icd/edge/util.h"
#include "icd/entry_points.h"
#include "icd/object/address_book.h"
#include "icd/object/memory.h"
#include "icd/properties.h"

namespace vitrine::icd {
namespace {

// An allocation can be no larger, so neither can a buffer.
constexpr VkDeviceSize kMaxBufferSize = kClaimedPhysicalDeviceMaintenance3Properties.maxMemoryAllocationSize;

/// Of a create info, or those that its chain puts in their place. There are none here beyond the first 32.
VkBufferUsageFlags usage_of(const VkBufferCreateInfo& info) {
#ifdef VK_KHR_maintenance5
  if (const auto* wide = find_in_chain<VkBufferUsageFlags2CreateInfoKHR>(info.pNext)) {
    return static_cast<VkBufferUsageFlags>(wide->usage);
  }
#endif
  return info.usage;
}

}  // namespace

namespace entry {

VKAPI_ATTR VkResult VKAPI_CALL CreateBuffer(VkDevice device, const VkBufferCreateInfo* info,
                                            const VkAllocationCallbacks* allocator, VkBuffer* buffer) {
  if (info->size > kMaxBufferSize) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
  Buffer* object = create_object<Buffer>(from_handle<Device>(device).memory, allocator);
  object->flags = info->flags;
  object->usage = usage_of(*info);
  object->size = info->size;
  *buffer = to_handle(object);
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL DestroyBuffer(VkDevice device, VkBuffer buffer, const VkAllocationCallbacks*) {
  if (const auto* object = from_nullable<Buffer>(buffer)) {
    leave_address(from_handle<Device>(device), object);
    report_binding(from_handle<Device>(device), ref(*object), object->data, object->size,
                   VK_DEVICE_ADDRESS_BINDING_TYPE_UNBIND_EXT);
  }
  destroy_handle<Buffer>(buffer);
}

/// Device addresses are host addresses.
VKAPI_ATTR VkDeviceAddress VKAPI_CALL GetBufferDeviceAddress(VkDevice, const VkBufferDeviceAddressInfo* info) {
  return reinterpret_cast<VkDeviceAddress>(from_handle<Buffer>(info->buffer).data);
}

/// A buffer's address is its memory's and where it lies in it: nothing else is to be given back.
VKAPI_ATTR std::uint64_t VKAPI_CALL GetBufferOpaqueCaptureAddress(VkDevice device,
                                                                  const VkBufferDeviceAddressInfo* info) {
  return GetBufferDeviceAddress(device, info);
}
VKAPI_ATTR std::uint64_t VKAPI_CALL
GetDeviceMemoryOpaqueCaptureAddress(VkDevice, const VkDeviceMemoryOpaqueCaptureAddressInfo* info) {
  return reinterpret_cast<std::uint64_t>(from_handle<DeviceMemory>(info->memory).data);
}

VKAPI_ATTR VkResult VKAPI_CALL CreateBufferView(VkDevice device, const VkBufferViewCreateInfo* info,
                                                const VkAllocationCallbacks* allocator, VkBufferView* view) {
  const Buffer& buffer = from_handle<Buffer>(info->buffer);
  const texel::FormatDesc& format = texel::view_format_desc(info->format);
  if (format.block_bytes == 0) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
  BufferView* object = create_object<BufferView>(from_handle<Device>(device).memory, allocator);
  object->view.data = buffer.data ? buffer.data + info->offset : nullptr;
  object->view.count = object->view.data ? buffer.resolve_range(info->offset, info->range) / format.block_bytes : 0;
  object->view.format = &format;
  enter_address(from_handle<Device>(device), {&object->view, sizeof object->view, object->view.data, ref(buffer)},
                *object);
  *view = to_handle(object);
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL DestroyBufferView(VkDevice device, VkBufferView view, const VkAllocationCallbacks*) {
  leave_address(from_handle<Device>(device), from_nullable<BufferView>(view));
  destroy_handle<BufferView>(view);
}

}  // namespace entry
}  // namespace vitrine::icd

// External memory (Vulkan 1.3.239, Capabilities; Memory Allocation: File Descriptor External Memory, Host External
// Memory): a file or the application's pages.
#include <fcntl.h>

#include "icd/entry_points.h"
#include "icd/object/device.h"
#include "icd/object/external.h"
#include "icd/object/memory.h"
#include "icd/object/shared_file.h"

namespace vitrine::icd {
namespace {

/// All the same to this device: whatever memory is a file can be given out as either.
constexpr VkExternalMemoryHandleTypeFlags kFileTypes =
    VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT | VK_EXTERNAL_MEMORY_HANDLE_TYPE_DMA_BUF_BIT_EXT;

}  // namespace

VkExternalMemoryProperties external_memory_properties(VkExternalMemoryHandleTypeFlagBits type) {
  VkExternalMemoryProperties out{};
  if (type & kFileTypes) {
    out.externalMemoryFeatures = VK_EXTERNAL_MEMORY_FEATURE_EXPORTABLE_BIT | VK_EXTERNAL_MEMORY_FEATURE_IMPORTABLE_BIT;
    out.exportFromImportedHandleTypes = out.compatibleHandleTypes = kFileTypes;
  } else if (type == VK_EXTERNAL_MEMORY_HANDLE_TYPE_HOST_ALLOCATION_BIT_EXT ||
             type == VK_EXTERNAL_MEMORY_HANDLE_TYPE_HOST_MAPPED_FOREIGN_MEMORY_BIT_EXT) {
    out.externalMemoryFeatures = VK_EXTERNAL_MEMORY_FEATURE_IMPORTABLE_BIT;
    out.compatibleHandleTypes = type;
  }
  return out;
}

namespace entry {

VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceExternalBufferProperties(VkPhysicalDevice,
                                                                     const VkPhysicalDeviceExternalBufferInfo* info,
                                                                     VkExternalBufferProperties* out) {
  out->externalMemoryProperties = external_memory_properties(info->handleType);
}

VKAPI_ATTR VkResult VKAPI_CALL GetMemoryFdKHR(VkDevice, const VkMemoryGetFdInfoKHR* info, int* descriptor) {
  const DeviceMemory& memory = from_handle<DeviceMemory>(info->memory);
  const bool dma_buf = info->handleType == VK_EXTERNAL_MEMORY_HANDLE_TYPE_DMA_BUF_BIT_EXT;
  *descriptor = -1;
  if (memory.file >= 0) *descriptor = dma_buf ? export_dma_buf(memory.file) : fcntl(memory.file, F_DUPFD_CLOEXEC, 0);
  return *descriptor >= 0 ? VK_SUCCESS : VK_ERROR_TOO_MANY_OBJECTS;
}

/// Opaque descriptors have no properties to ask for.
VKAPI_ATTR VkResult VKAPI_CALL GetMemoryFdPropertiesKHR(VkDevice, VkExternalMemoryHandleTypeFlagBits type,
                                                        int descriptor, VkMemoryFdPropertiesKHR* out) {
  const bool dma_buf = type == VK_EXTERNAL_MEMORY_HANDLE_TYPE_DMA_BUF_BIT_EXT;
  out->memoryTypeBits = dma_buf && lasting_bytes_of(descriptor) != 0;
  return out->memoryTypeBits ? VK_SUCCESS : VK_ERROR_INVALID_EXTERNAL_HANDLE;
}

VKAPI_ATTR VkResult VKAPI_CALL GetMemoryHostPointerPropertiesEXT(VkDevice, VkExternalMemoryHandleTypeFlagBits type,
                                                                 const void*, VkMemoryHostPointerPropertiesEXT* out) {
  const bool known = external_memory_properties(type).externalMemoryFeatures != 0;
  if (!known || (type & kFileTypes)) return VK_ERROR_INVALID_EXTERNAL_HANDLE;
  out->memoryTypeBits = 1;
  return VK_SUCCESS;
}

}  // namespace entry
}  // namespace vitrine::icd

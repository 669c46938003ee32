// Fences and semaphores that leave the device as file descriptors (Vulkan 1.3.239, Capabilities: External Semaphore
// Handle Types and Compatibility; Synchronization and Cache Control: Importing and Exporting Fence and Semaphore
// Payloads). An opaque descriptor is shared memory. A sync file is taken from whoever has one; this device has none to
// give, and waits until it may say -1: signalled already.
#include "icd/edge/util.h"
#include "icd/entry_points.h"
#include "icd/object/sync.h"

namespace vitrine::icd {
namespace {

/// The object's own payload, or one until the next wait or reset.
template <class T>
VkResult import_payload(Device& device, T& object, bool temporary, std::shared_ptr<ExternalPayload> payload) {
  if (!payload) return VK_ERROR_INVALID_EXTERNAL_HANDLE;
  const std::lock_guard lock(device.sync_mutex);
  if (!temporary) object.shared = payload;
  object.temporary = temporary ? std::move(payload) : nullptr;
  return VK_SUCCESS;
}

template <class T>
VkResult export_payload(Device& device, const T& object, int& descriptor) {
  const std::lock_guard lock(device.sync_mutex);
  const auto& payload = object.temporary ? object.temporary : object.shared;
  descriptor = payload ? payload->descriptor() : -1;
  return descriptor >= 0 ? VK_SUCCESS : VK_ERROR_TOO_MANY_OBJECTS;
}

}  // namespace

namespace entry {

VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceExternalFenceProperties(VkPhysicalDevice,
                                                                    const VkPhysicalDeviceExternalFenceInfo* info,
                                                                    VkExternalFenceProperties* out) {
  const bool known = info->handleType == VK_EXTERNAL_FENCE_HANDLE_TYPE_OPAQUE_FD_BIT ||
                     info->handleType == VK_EXTERNAL_FENCE_HANDLE_TYPE_SYNC_FD_BIT;
  out->exportFromImportedHandleTypes = out->compatibleHandleTypes = known ? info->handleType : 0;
  out->externalFenceFeatures =
      known ? VK_EXTERNAL_FENCE_FEATURE_EXPORTABLE_BIT | VK_EXTERNAL_FENCE_FEATURE_IMPORTABLE_BIT : 0;
}

VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceExternalSemaphoreProperties(
    VkPhysicalDevice, const VkPhysicalDeviceExternalSemaphoreInfo* info, VkExternalSemaphoreProperties* out) {
  const auto* type = find_in_chain<VkSemaphoreTypeCreateInfo>(info->pNext);
  const bool timeline = type && type->semaphoreType == VK_SEMAPHORE_TYPE_TIMELINE;
  const bool known = info->handleType == VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT ||
                     (info->handleType == VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_SYNC_FD_BIT && !timeline);
  out->exportFromImportedHandleTypes = out->compatibleHandleTypes = known ? info->handleType : 0;
  out->externalSemaphoreFeatures =
      known ? VK_EXTERNAL_SEMAPHORE_FEATURE_EXPORTABLE_BIT | VK_EXTERNAL_SEMAPHORE_FEATURE_IMPORTABLE_BIT : 0;
}

VKAPI_ATTR VkResult VKAPI_CALL ImportFenceFdKHR(VkDevice device, const VkImportFenceFdInfoKHR* info) {
  const bool sync_file = info->handleType == VK_EXTERNAL_FENCE_HANDLE_TYPE_SYNC_FD_BIT;
  const bool temporary = sync_file || (info->flags & VK_FENCE_IMPORT_TEMPORARY_BIT);
  return import_payload(from_handle<Device>(device), from_handle<Fence>(info->fence), temporary,
                        sync_file ? ExternalPayload::of_sync_file(info->fd)
                                  : ExternalPayload::open(info->fd, ExternalPayload::Kind::kFence));
}

VKAPI_ATTR VkResult VKAPI_CALL GetFenceFdKHR(VkDevice device_handle, const VkFenceGetFdInfoKHR* info, int* out) {
  Device& device = from_handle<Device>(device_handle);
  Fence& fence = from_handle<Fence>(info->fence);
  if (info->handleType == VK_EXTERNAL_FENCE_HANDLE_TYPE_OPAQUE_FD_BIT) return export_payload(device, fence, *out);
  *out = -1;
  if (!wait_fence(device, fence)) return VK_SUCCESS;
  const std::lock_guard lock(device.sync_mutex);
  reset_fence(fence);
  return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL ImportSemaphoreFdKHR(VkDevice device, const VkImportSemaphoreFdInfoKHR* info) {
  Semaphore& semaphore = from_handle<Semaphore>(info->semaphore);
  const bool sync_file = info->handleType == VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_SYNC_FD_BIT;
  const bool temporary = sync_file || (info->flags & VK_SEMAPHORE_IMPORT_TEMPORARY_BIT);
  return import_payload(
      from_handle<Device>(device), semaphore, temporary,
      sync_file ? ExternalPayload::of_sync_file(info->fd) : ExternalPayload::open(info->fd, semaphore_kind(semaphore)));
}

VKAPI_ATTR VkResult VKAPI_CALL GetSemaphoreFdKHR(VkDevice device_handle, const VkSemaphoreGetFdInfoKHR* info,
                                                 int* out) {
  Device& device = from_handle<Device>(device_handle);
  Semaphore& semaphore = from_handle<Semaphore>(info->semaphore);
  if (info->handleType == VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT)
    return export_payload(device, semaphore, *out);
  *out = -1;
  wait_semaphore(device, semaphore, 0, std::exchange(semaphore.temporary, nullptr));
  return VK_SUCCESS;
}

}  // namespace entry
}  // namespace vitrine::icd

// Swapchains (Vulkan 1.3.239, WSI Swapchain): creation, acquiring images, presenting.
#include <algorithm>
#include <chrono>

#include "base/shake.h"
#include "glass/sync/sync.h"
#include "glass/timeline.h"
#include "icd/edge/util.h"
#include "icd/entry_points.h"
#include "icd/object/queue.h"
#include "icd/object/sync.h"
#include "icd/wsi/swapchain.h"

namespace vitrine::icd {
namespace {

VkImageCreateInfo image_info(const VkSwapchainCreateInfoKHR& info) {
  auto image = make_struct<VkImageCreateInfo>();
  if (info.flags & VK_SWAPCHAIN_CREATE_MUTABLE_FORMAT_BIT_KHR) {
    image.flags = VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT | VK_IMAGE_CREATE_EXTENDED_USAGE_BIT;
  }
  image.imageType = VK_IMAGE_TYPE_2D;
  image.format = info.imageFormat;
  image.extent = {info.imageExtent.width, info.imageExtent.height, 1};
  image.mipLevels = 1;
  image.arrayLayers = info.imageArrayLayers;
  image.samples = VK_SAMPLE_COUNT_1_BIT;
  image.tiling = VK_IMAGE_TILING_OPTIMAL;
  image.usage = info.imageUsage;
  return image;
}

VkResult create_images(Swapchain& swapchain, const VkSwapchainCreateInfoKHR& info) {
  const VkImageCreateInfo image = image_info(info);
  swapchain.slots.resize(std::max(info.minImageCount, 2u));
  for (Swapchain::Slot& slot : swapchain.slots) {
    slot.image = create_object<Image>(swapchain.memory, nullptr);
    if (const VkResult result = init_image(*slot.image, image); result != VK_SUCCESS) return result;
    slot.backing = create_object<DeviceMemory>(swapchain.memory, nullptr, slot.image->layout.size, allocated_bytes());
    if (!slot.backing->data) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    slot.image->data = slot.backing->data;
    watch_image(*slot.image, true);
  }
  return VK_SUCCESS;
}

/// "Upon calling vkCreateSwapchainKHR with an oldSwapchain that is not VK_NULL_HANDLE, oldSwapchain is retired": images
/// that the application still owns may be presented yet, no other can be acquired.
void retire(Swapchain* old) {
  if (!old) return;
  {
    const std::lock_guard lock(old->mutex);
    old->retired = true;
  }
  old->image_released.notify_all();
}

/// OUT_OF_DATE when the window has another size than the images.
VkResult check_window(const Swapchain& swapchain) {
  VkExtent2D extent{};
  const VkResult result = swapchain.window->extent(extent);
  if (result != VK_SUCCESS || extent.width == 0xFFFFFFFF) return result;
  const bool same = extent.width == swapchain.extent.width && extent.height == swapchain.extent.height;
  return same ? VK_SUCCESS : VK_ERROR_OUT_OF_DATE_KHR;
}

/// The image that has been waiting longest, or null.
Swapchain::Slot* oldest_free(Swapchain& swapchain) {
  Swapchain::Slot* best = nullptr;
  for (Swapchain::Slot& slot : swapchain.slots) {
    if (slot.owner == Swapchain::Owner::kSwapchain && (!best || slot.released < best->released)) best = &slot;
  }
  return best;
}

/// Waits until images come back such that `ready`. False: the time is over.
template <class Ready>
bool wait_for_images(Swapchain& swapchain, std::unique_lock<std::mutex>& lock, std::uint64_t timeout, Ready ready) {
  // Longer than a year is for ever: the clock's arithmetic would overflow.
  constexpr std::uint64_t kForever = 366ull * 24 * 3600 * 1000000000;
  if (timeout < kForever) return swapchain.image_released.wait_for(lock, std::chrono::nanoseconds(timeout), ready);
  swapchain.image_released.wait(lock, ready);
  return true;
}

VkResult acquire(Swapchain& swapchain, std::uint64_t timeout, std::uint32_t& index) {
  if (const VkResult result = check_window(swapchain); result != VK_SUCCESS) return result;
  std::unique_lock lock(swapchain.mutex);
  Swapchain::Slot* slot = nullptr;
  const auto ready = [&] { return swapchain.retired || swapchain.status < 0 || (slot = oldest_free(swapchain)); };
  if (!wait_for_images(swapchain, lock, timeout, ready)) return timeout == 0 ? VK_NOT_READY : VK_TIMEOUT;
  if (swapchain.retired) return VK_ERROR_OUT_OF_DATE_KHR;
  if (base::fails_now()) swapchain.status = VK_ERROR_OUT_OF_DATE_KHR;
  if (swapchain.status < 0) return swapchain.status;
  slot->owner = Swapchain::Owner::kApplication;
  index = static_cast<std::uint32_t>(slot - swapchain.slots.data());
  return swapchain.status;
}

bool is_in_order(VkPresentModeKHR mode) {
  return mode == VK_PRESENT_MODE_FIFO_KHR || mode == VK_PRESENT_MODE_FIFO_RELAXED_KHR;
}

/// The image of the i-th swapchain of a present, with what the chain says of that present.
void give_to_queue(const VkPresentInfoKHR& info, std::uint32_t i) {
  const auto* ids = find_in_chain<VkPresentIdKHR>(info.pNext);
  const auto* fences = find_in_chain<VkSwapchainPresentFenceInfoEXT>(info.pNext);
  const auto* modes = find_in_chain<VkSwapchainPresentModeInfoEXT>(info.pNext);
  Swapchain& swapchain = from_handle<Swapchain>(info.pSwapchains[i]);
  const std::lock_guard lock(swapchain.mutex);
  if (modes && i < modes->swapchainCount) swapchain.mode = modes->pPresentModes[i];
  Swapchain::Slot& slot = swapchain.slots[info.pImageIndices[i]];
  slot.present_id = ids && ids->pPresentIds && i < ids->swapchainCount ? ids->pPresentIds[i] : 0;
  slot.fence = fences && i < fences->swapchainCount ? from_nullable<Fence>(fences->pFences[i]) : nullptr;
  slot.in_order = is_in_order(swapchain.mode);
  slot.owner = Swapchain::Owner::kQueue;
}

void give_back(Swapchain& swapchain, std::uint32_t index) {
  const std::lock_guard lock(swapchain.mutex);
  swapchain.slots[index].owner = Swapchain::Owner::kApplication;
}

/// What is known of the swapchain's presents so far; those still on the queue report through a later call.
VkResult status_of(Swapchain& swapchain) {
  const std::lock_guard lock(swapchain.mutex);
  return swapchain.status;
}

void show_on_queue(void* swapchain, std::uint32_t index) { show_image(*static_cast<Swapchain*>(swapchain), index); }

/// Errors win over SUBOPTIMAL, which wins over SUCCESS.
VkResult worse(VkResult a, VkResult b) { return a < 0 || b == VK_SUCCESS ? a : b; }

}  // namespace

namespace entry {

VKAPI_ATTR VkResult VKAPI_CALL CreateSwapchainKHR(VkDevice device_handle, const VkSwapchainCreateInfoKHR* info,
                                                  const VkAllocationCallbacks* allocator, VkSwapchainKHR* out) {
  Device& device = from_handle<Device>(device_handle);
  if (is_lost(device)) return VK_ERROR_DEVICE_LOST;
  retire(from_nullable<Swapchain>(info->oldSwapchain));
  Owned<Swapchain> swapchain_owner(create_object<Swapchain>(device.memory, allocator));
  Swapchain& swapchain = *swapchain_owner;
  swapchain.device = &device;
  swapchain.window = from_handle<Surface>(info->surface).window;
  swapchain.extent = info->imageExtent;
  swapchain.mode = info->presentMode;
  swapchain.red_first = info->imageFormat == VK_FORMAT_R8G8B8A8_UNORM || info->imageFormat == VK_FORMAT_R8G8B8A8_SRGB;
  if (const VkResult result = create_images(swapchain, *info); result != VK_SUCCESS) return result;
  *out = to_handle(swapchain_owner.release());
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL DestroySwapchainKHR(VkDevice, VkSwapchainKHR swapchain, const VkAllocationCallbacks*) {
  if (Swapchain* object = from_nullable<Swapchain>(swapchain)) {
    // Presents may still be on the queue: the specification lets a swapchain go once its images are not in use by it.
    std::unique_lock lock(object->mutex);
    object->image_released.wait(lock, [&] {
      return std::none_of(object->slots.begin(), object->slots.end(),
                          [](const Swapchain::Slot& slot) { return slot.owner == Swapchain::Owner::kQueue; });
    });
    lock.unlock();
    destroy_object(object);
  }
}

VKAPI_ATTR VkResult VKAPI_CALL GetSwapchainImagesKHR(VkDevice, VkSwapchainKHR swapchain, std::uint32_t* count,
                                                     VkImage* images) {
  OutArray<VkImage> array(count, images);
  for (const Swapchain::Slot& slot : from_handle<Swapchain>(swapchain).slots) array.push(to_handle(slot.image));
  return array.result();
}

VKAPI_ATTR VkResult VKAPI_CALL AcquireNextImage2KHR(VkDevice device_handle, const VkAcquireNextImageInfoKHR* info,
                                                    std::uint32_t* index) {
  Device& device = from_handle<Device>(device_handle);
  if (is_lost(device)) return VK_ERROR_DEVICE_LOST;
  const glass::Span span("wait", "vkAcquireNextImageKHR");
  const VkResult result = acquire(from_handle<Swapchain>(info->swapchain), info->timeout, *index);
  if (result != VK_SUCCESS && result != VK_SUBOPTIMAL_KHR) return result;
  if (glass::sync::Hazards* const hazards = glass::sync::hazards_of(&device))
    hazards->acquire({from_nullable<Swapchain>(info->swapchain), *index}, from_nullable<Semaphore>(info->semaphore),
                     from_nullable<Fence>(info->fence));
  // The image is free when it is handed out: showing it has ended.
  if (Semaphore* const semaphore = from_nullable<Semaphore>(info->semaphore))
    signal_semaphore(device, *semaphore, 0, semaphore->temporary);
  if (info->fence) signal_fence(device, from_handle<Fence>(info->fence));
  return result;
}

VKAPI_ATTR VkResult VKAPI_CALL AcquireNextImageKHR(VkDevice device, VkSwapchainKHR swapchain, std::uint64_t timeout,
                                                   VkSemaphore semaphore, VkFence fence, std::uint32_t* index) {
  auto info = make_struct<VkAcquireNextImageInfoKHR>();
  info.swapchain = swapchain;
  info.timeout = timeout;
  info.semaphore = semaphore;
  info.fence = fence;
  info.deviceMask = 1;
  return AcquireNextImage2KHR(device, &info, index);
}

VKAPI_ATTR VkResult VKAPI_CALL QueuePresentKHR(VkQueue queue_handle, const VkPresentInfoKHR* info) {
  Queue& queue = from_handle<Queue>(queue_handle);
  Vector<QueueCall> calls{HostAllocator<QueueCall>(queue.device.memory, VK_SYSTEM_ALLOCATION_SCOPE_COMMAND)};
  calls.reserve(info->swapchainCount);
  for (std::uint32_t i = 0; i < info->swapchainCount; ++i) {
    calls.push_back({show_on_queue, &from_handle<Swapchain>(info->pSwapchains[i]), info->pImageIndices[i]});
  }
  Vector<SemaphoreOp> waits{HostAllocator<SemaphoreOp>(queue.device.memory, VK_SYSTEM_ALLOCATION_SCOPE_COMMAND)};
  waits.reserve(info->waitSemaphoreCount);
  for (std::uint32_t i = 0; i < info->waitSemaphoreCount; ++i) waits.push_back({info->pWaitSemaphores[i], 0});
  for (std::uint32_t i = 0; i < info->swapchainCount; ++i) give_to_queue(*info, i);
  BatchInfo batch;
  batch.waits = waits;
  batch.calls = calls;
  VkResult result = VK_SUCCESS;
  try {
    result = submit(queue, {&batch, 1});
  } catch (...) {
    for (const QueueCall& call : calls) give_back(*static_cast<Swapchain*>(call.object), call.argument);
    throw;
  }
  for (std::uint32_t i = 0; i < info->swapchainCount; ++i) {
    const VkResult one = result < 0 ? result : status_of(from_handle<Swapchain>(info->pSwapchains[i]));
    if (info->pResults) info->pResults[i] = one;
    result = worse(result, one);
  }
  return result;
}

/// Acquired images come back without having been shown.
VKAPI_ATTR VkResult VKAPI_CALL ReleaseSwapchainImagesEXT(VkDevice, const VkReleaseSwapchainImagesInfoEXT* info) {
  Swapchain& swapchain = from_handle<Swapchain>(info->swapchain);
  {
    const std::lock_guard lock(swapchain.mutex);
    for (std::uint32_t i = 0; i < info->imageIndexCount; ++i) {
      Swapchain::Slot& slot = swapchain.slots[info->pImageIndices[i]];
      slot.owner = Swapchain::Owner::kSwapchain;
      slot.released = ++swapchain.release_count;
    }
  }
  swapchain.image_released.notify_all();
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL SetHdrMetadataEXT(VkDevice, std::uint32_t count, const VkSwapchainKHR* swapchains,
                                             const VkHdrMetadataEXT* metadata) {
  for (std::uint32_t i = 0; i < count; ++i) {
    Swapchain& swapchain = from_handle<Swapchain>(swapchains[i]);
    const std::lock_guard lock(swapchain.mutex);
    swapchain.hdr_metadata = metadata[i];
    swapchain.hdr_metadata->pNext = nullptr;
  }
}

VKAPI_ATTR VkResult VKAPI_CALL WaitForPresentKHR(VkDevice device, VkSwapchainKHR handle, std::uint64_t present_id,
                                                 std::uint64_t timeout) {
  if (is_lost(from_handle<Device>(device))) return VK_ERROR_DEVICE_LOST;
  Swapchain& swapchain = from_handle<Swapchain>(handle);
  std::unique_lock lock(swapchain.mutex);
  const auto ready = [&] { return swapchain.status < 0 || swapchain.shown_id >= present_id; };
  if (!wait_for_images(swapchain, lock, timeout, ready)) return VK_TIMEOUT;
  return swapchain.shown_id >= present_id ? VK_SUCCESS : swapchain.status;
}

VKAPI_ATTR VkResult VKAPI_CALL GetDeviceGroupPresentCapabilitiesKHR(VkDevice,
                                                                    VkDeviceGroupPresentCapabilitiesKHR* capabilities) {
  std::fill(std::begin(capabilities->presentMask), std::end(capabilities->presentMask), 0u);
  capabilities->presentMask[0] = 1;
  capabilities->modes = VK_DEVICE_GROUP_PRESENT_MODE_LOCAL_BIT_KHR;
  return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL GetDeviceGroupSurfacePresentModesKHR(VkDevice, VkSurfaceKHR,
                                                                    VkDeviceGroupPresentModeFlagsKHR* modes) {
  *modes = VK_DEVICE_GROUP_PRESENT_MODE_LOCAL_BIT_KHR;
  return VK_SUCCESS;
}

}  // namespace entry
}  // namespace vitrine::icd

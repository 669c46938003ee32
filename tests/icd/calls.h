// The driver's functions by name, and a device with one queue, for whatever links the driver.
#pragma once

#include <cstdint>
#include <span>

#include "icd/edge/util.h"
#include "icd/edge/vulkan_api.h"

extern "C" VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vk_icdGetInstanceProcAddr(VkInstance instance, const char* name);

namespace vitrine::icd::test {

template <class F>
F get(VkInstance instance, const char* name) {
  return reinterpret_cast<F>(vk_icdGetInstanceProcAddr(instance, name));
}
#define VK_GET(instance, name) ::vitrine::icd::test::get<PFN_vk##name>(instance, "vk" #name)

inline VkResult create_device(VkInstance instance, VkPhysicalDevice physical_device, VkDevice* device,
                              const VkAllocationCallbacks* allocator = nullptr, const void* next = nullptr,
                              std::span<const char* const> extensions = {}) {
  const float priority = 1;
  VkDeviceQueueCreateInfo queue = make_struct<VkDeviceQueueCreateInfo>();
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  VkDeviceCreateInfo info = make_struct<VkDeviceCreateInfo>(const_cast<void*>(next));
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  return VK_GET(instance, CreateDevice)(physical_device, &info, allocator, device);
}

}  // namespace vitrine::icd::test

// A Vulkan layer that writes every presented image to a file, so that two drivers' frames can be compared.
//
// CAPTURE_DIR names the folder; frame N becomes frame_NNNN.raw: one line of text "width height format", then the
// texels.
#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace {

struct Swapchain {
  VkFormat format;
  VkExtent2D extent;
  std::vector<VkImage> images;
};

struct Device {
  VkDevice device;
  VkPhysicalDevice physical;
  PFN_vkGetDeviceProcAddr next;
  PFN_vkSetDeviceLoaderData set_loader_data;
  std::map<VkSwapchainKHR, Swapchain> swapchains;
  uint32_t family = 0;

  template <typename T>
  T call(const char* name) const {
    return reinterpret_cast<T>(next(device, name));
  }
#define NEXT(device, function) (device).call<PFN_##function>(#function)
};

std::mutex g_mutex;
PFN_vkGetInstanceProcAddr g_instance_next;
VkInstance g_instance;
std::map<void*, Device> g_devices;  // by dispatch key
uint32_t g_frame;

void* key(void* handle) { return *static_cast<void**>(handle); }

template <typename Info>
Info* chain_link(const void* next, VkStructureType type, VkLayerFunction function) {
  for (auto* info = static_cast<const Info*>(next); info; info = static_cast<const Info*>(info->pNext))
    if (info->sType == type && info->function == function) return const_cast<Info*>(info);
  return nullptr;
}

VKAPI_ATTR VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator,
                                               VkInstance* instance) {
  auto* link = chain_link<VkLayerInstanceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO,
                                                     VK_LAYER_LINK_INFO);
  if (!link) return VK_ERROR_INITIALIZATION_FAILED;
  g_instance_next = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  const auto create = reinterpret_cast<PFN_vkCreateInstance>(g_instance_next(VK_NULL_HANDLE, "vkCreateInstance"));
  const VkResult result = create(info, allocator, instance);
  g_instance = *instance;
  return result;
}

VKAPI_ATTR VkResult VKAPI_CALL create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                             const VkAllocationCallbacks* allocator, VkDevice* device) {
  auto* link =
      chain_link<VkLayerDeviceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO, VK_LAYER_LINK_INFO);
  if (!link) return VK_ERROR_INITIALIZATION_FAILED;
  const auto* loader = chain_link<VkLayerDeviceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO,
                                                           VK_LOADER_DATA_CALLBACK);
  const PFN_vkGetDeviceProcAddr next = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  const auto create = reinterpret_cast<PFN_vkCreateDevice>(g_instance_next(g_instance, "vkCreateDevice"));
  const VkResult result = create(physical, info, allocator, device);
  if (result != VK_SUCCESS) return result;
  const std::lock_guard lock(g_mutex);
  Device& stored = g_devices[key(*device)];
  stored = {*device, physical, next, loader ? loader->u.pfnSetDeviceLoaderData : nullptr, {}};
  stored.family = info->pQueueCreateInfos[0].queueFamilyIndex;
  return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL create_swapchain(VkDevice device, const VkSwapchainCreateInfoKHR* info,
                                                const VkAllocationCallbacks* allocator, VkSwapchainKHR* swapchain) {
  const std::lock_guard lock(g_mutex);
  Device& d = g_devices[key(device)];
  VkSwapchainCreateInfoKHR readable = *info;
  readable.imageUsage |= VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  const VkResult result = NEXT(d, vkCreateSwapchainKHR)(device, &readable, allocator, swapchain);
  if (result != VK_SUCCESS) return result;
  Swapchain stored{info->imageFormat, info->imageExtent, {}};
  uint32_t count = 0;
  const auto get = NEXT(d, vkGetSwapchainImagesKHR);
  get(device, *swapchain, &count, nullptr);
  stored.images.resize(count);
  get(device, *swapchain, &count, stored.images.data());
  d.swapchains[*swapchain] = stored;
  return VK_SUCCESS;
}

void record_copy(const Device& d, VkCommandBuffer cmd, const Swapchain& swapchain, VkImage image, VkBuffer buffer) {
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  NEXT(d, vkBeginCommandBuffer)(cmd, &begin);
  VkImageMemoryBarrier barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
  barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
  barrier.oldLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
  barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image;
  barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  const auto pipeline_barrier = NEXT(d, vkCmdPipelineBarrier);
  pipeline_barrier(cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0, nullptr,
                   1, &barrier);
  VkBufferImageCopy region{};
  region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  region.imageExtent = {swapchain.extent.width, swapchain.extent.height, 1};
  NEXT(d, vkCmdCopyImageToBuffer)(cmd, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer, 1, &region);
  std::swap(barrier.oldLayout, barrier.newLayout);
  barrier.srcAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
  barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT;
  pipeline_barrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0, nullptr,
                   1, &barrier);
  NEXT(d, vkEndCommandBuffer)(cmd);
}

void write_frame(const Swapchain& swapchain, const void* texels, size_t size) {
  const char* folder = std::getenv("CAPTURE_DIR");
  char name[32];
  std::snprintf(name, sizeof name, "/frame_%04u.raw", g_frame++);
  std::FILE* file = std::fopen((std::string(folder ? folder : ".") + name).c_str(), "wb");
  if (!file) return;
  std::fprintf(file, "%u %u %d\n", swapchain.extent.width, swapchain.extent.height, swapchain.format);
  std::fwrite(texels, 1, size, file);
  std::fclose(file);
}

/// Copies one presented image to a file. The queue has finished everything before.
void capture(const Device& d, VkQueue queue, const Swapchain& swapchain, VkImage image) {
  const VkDeviceSize size = VkDeviceSize{4} * swapchain.extent.width * swapchain.extent.height;
  VkBufferCreateInfo buffer_info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  buffer_info.size = size;
  buffer_info.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  VkBuffer buffer;
  NEXT(d, vkCreateBuffer)(d.device, &buffer_info, nullptr, &buffer);
  VkMemoryRequirements needed;
  NEXT(d, vkGetBufferMemoryRequirements)(d.device, buffer, &needed);
  VkPhysicalDeviceMemoryProperties types;
  reinterpret_cast<PFN_vkGetPhysicalDeviceMemoryProperties>(
      g_instance_next(g_instance, "vkGetPhysicalDeviceMemoryProperties"))(d.physical, &types);
  VkMemoryAllocateInfo memory_info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  memory_info.allocationSize = needed.size;
  for (uint32_t i = types.memoryTypeCount; i-- > 0;)
    if ((needed.memoryTypeBits >> i & 1) && (types.memoryTypes[i].propertyFlags & VK_MEMORY_PROPERTY_HOST_COHERENT_BIT))
      memory_info.memoryTypeIndex = i;
  VkDeviceMemory memory;
  NEXT(d, vkAllocateMemory)(d.device, &memory_info, nullptr, &memory);
  NEXT(d, vkBindBufferMemory)(d.device, buffer, memory, 0);

  VkCommandPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  pool_info.queueFamilyIndex = d.family;
  VkCommandPool pool;
  NEXT(d, vkCreateCommandPool)(d.device, &pool_info, nullptr, &pool);
  VkCommandBufferAllocateInfo cmd_info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  cmd_info.commandPool = pool;
  cmd_info.commandBufferCount = 1;
  VkCommandBuffer cmd;
  NEXT(d, vkAllocateCommandBuffers)(d.device, &cmd_info, &cmd);
  if (d.set_loader_data) d.set_loader_data(d.device, cmd);
  record_copy(d, cmd, swapchain, image, buffer);
  VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &cmd;
  NEXT(d, vkQueueSubmit)(queue, 1, &submit, VK_NULL_HANDLE);
  NEXT(d, vkQueueWaitIdle)(queue);
  void* mapped = nullptr;
  if (NEXT(d, vkMapMemory)(d.device, memory, 0, VK_WHOLE_SIZE, 0, &mapped) == VK_SUCCESS)
    write_frame(swapchain, mapped, size);
  NEXT(d, vkDestroyCommandPool)(d.device, pool, nullptr);
  NEXT(d, vkDestroyBuffer)(d.device, buffer, nullptr);
  NEXT(d, vkFreeMemory)(d.device, memory, nullptr);
}

VKAPI_ATTR VkResult VKAPI_CALL queue_present(VkQueue queue, const VkPresentInfoKHR* info) {
  const std::lock_guard lock(g_mutex);
  Device& d = g_devices[key(queue)];
  NEXT(d, vkQueueWaitIdle)(queue);
  for (uint32_t i = 0; i < info->swapchainCount; ++i) {
    const Swapchain& swapchain = d.swapchains[info->pSwapchains[i]];
    capture(d, queue, swapchain, swapchain.images[info->pImageIndices[i]]);
  }
  return NEXT(d, vkQueuePresentKHR)(queue, info);
}

PFN_vkVoidFunction VKAPI_CALL get_instance_proc(VkInstance instance, const char* name);

PFN_vkVoidFunction VKAPI_CALL get_device_proc(VkDevice device, const char* name) {
#define INTERCEPT(api, function) \
  if (!std::strcmp(name, api)) return reinterpret_cast<PFN_vkVoidFunction>(function)
  INTERCEPT("vkGetDeviceProcAddr", get_device_proc);
  INTERCEPT("vkCreateSwapchainKHR", create_swapchain);
  INTERCEPT("vkQueuePresentKHR", queue_present);
  if (!device) return nullptr;
  return g_devices[key(device)].next(device, name);
}

PFN_vkVoidFunction VKAPI_CALL get_instance_proc(VkInstance instance, const char* name) {
  INTERCEPT("vkGetInstanceProcAddr", get_instance_proc);
  INTERCEPT("vkCreateInstance", create_instance);
  INTERCEPT("vkCreateDevice", create_device);
  INTERCEPT("vkGetDeviceProcAddr", get_device_proc);
  INTERCEPT("vkCreateSwapchainKHR", create_swapchain);
  INTERCEPT("vkQueuePresentKHR", queue_present);
  return instance ? g_instance_next(instance, name) : nullptr;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* wanted) {
  wanted->loaderLayerInterfaceVersion = 2;
  wanted->pfnGetInstanceProcAddr = get_instance_proc;
  wanted->pfnGetDeviceProcAddr = get_device_proc;
  wanted->pfnGetPhysicalDeviceProcAddr = nullptr;
  return VK_SUCCESS;
}

// See device.h.
#include "glass/replayer/device.h"

#include <algorithm>
#include <cstring>

#include "glass/replayer/features.h"

namespace vitrine::glass::replayer {
namespace {

VkInstance make_instance(bool& names) {
  std::uint32_t count = 0;
  vkEnumerateInstanceExtensionProperties(nullptr, &count, nullptr);
  std::vector<VkExtensionProperties> there(count);
  vkEnumerateInstanceExtensionProperties(nullptr, &count, there.data());
  names = std::any_of(there.begin(), there.end(), [](const VkExtensionProperties& p) {
    return std::strcmp(p.extensionName, VK_EXT_DEBUG_UTILS_EXTENSION_NAME) == 0;
  });
  const char* const extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.pApplicationName = "vitrine replay";
  application.apiVersion = VK_API_VERSION_1_3;
  VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  info.pApplicationInfo = &application;
  info.enabledExtensionCount = names ? 1 : 0;
  info.ppEnabledExtensionNames = &extension;
  VkInstance instance = VK_NULL_HANDLE;
  must(vkCreateInstance(&info, nullptr, &instance), "vkCreateInstance");
  return instance;
}

/// A family that draws, dispatches and copies; else Failure.
std::uint32_t find_family(VkPhysicalDevice device) {
  std::uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
  constexpr VkQueueFlags kAll = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
  for (std::uint32_t i = 0; i < count; ++i)
    if ((families[i].queueFlags & kAll) == kAll) return i;
  throw Failure("the device has no queue for graphics and compute");
}

void choose_physical(Device& d) {
  std::uint32_t count = 1;
  const VkResult result = vkEnumeratePhysicalDevices(d.instance, &count, &d.physical);
  if (result < 0 || count == 0) throw Failure("no Vulkan device is there");
  vkGetPhysicalDeviceProperties(d.physical, &d.properties);
  vkGetPhysicalDeviceMemoryProperties(d.physical, &d.memory);
  if (d.properties.apiVersion < VK_API_VERSION_1_3) throw Failure("the device has no Vulkan 1.3");
}

}  // namespace

void must(VkResult result, const char* what) {
  if (result == VK_ERROR_DEVICE_LOST) throw Lost(what);
  if (result < 0) throw Failure(std::string(what) + " failed: VkResult " + std::to_string(result));
}

bool Device::has(const char* extension) const {
  return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

Device make_device(const bug::Bug& bug) {
  Device d;
  d.instance = make_instance(d.names);
  choose_physical(d);
  Features features(d.physical, bug);
  if (const char* const missing = features.missing(bug))
    throw Failure(std::string("the command needs ") + missing + ", which this driver lacks");
  const float priority = 1;
  VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  queue.queueFamilyIndex = find_family(d.physical);
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
  info.pNext = features.chain();
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  info.enabledExtensionCount = static_cast<std::uint32_t>(features.extensions().size());
  info.ppEnabledExtensionNames = features.extensions().data();
  must(vkCreateDevice(d.physical, &info, nullptr, &d.device), "vkCreateDevice");
  d.addresses_again = features.addresses_again();
  d.extensions.assign(features.extensions().begin(), features.extensions().end());
  vkGetDeviceQueue(d.device, queue.queueFamilyIndex, 0, &d.queue);
  return d;
}

VkDeviceMemory allocate(const Device& d, const VkMemoryRequirements& needs, bool host, const void* next) {
  constexpr VkMemoryPropertyFlags kHost = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  const VkMemoryPropertyFlags wanted = host ? kHost : VkMemoryPropertyFlags{0};
  for (std::uint32_t i = 0; i < d.memory.memoryTypeCount; ++i) {
    if (!(needs.memoryTypeBits >> i & 1) || (d.memory.memoryTypes[i].propertyFlags & wanted) != wanted) continue;
    VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    info.pNext = next;
    info.allocationSize = needs.size;
    info.memoryTypeIndex = i;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    must(vkAllocateMemory(d.device, &info, nullptr, &memory), "vkAllocateMemory");
    return memory;
  }
  throw Failure("the device has no memory of a kind that is needed");
}

void set_name(const Device& d, VkObjectType type, std::uint64_t handle, const std::string& name) {
  if (!d.names || name.empty()) return;
  static const auto set = reinterpret_cast<PFN_vkSetDebugUtilsObjectNameEXT>(
      vkGetInstanceProcAddr(d.instance, "vkSetDebugUtilsObjectNameEXT"));
  VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
  info.objectType = type;
  info.objectHandle = handle;
  info.pObjectName = name.c_str();
  if (set) set(d.device, &info);
}

VkCommandBuffer begin_commands(const Device& d, VkCommandPool& pool) {
  VkCommandPoolCreateInfo info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  info.queueFamilyIndex = find_family(d.physical);
  must(vkCreateCommandPool(d.device, &info, nullptr, &pool), "vkCreateCommandPool");
  VkCommandBufferAllocateInfo allocation{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  allocation.commandPool = pool;
  allocation.commandBufferCount = 1;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  must(vkAllocateCommandBuffers(d.device, &allocation, &commands), "vkAllocateCommandBuffers");
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  must(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
  return commands;
}

void run_commands(const Device& d, VkCommandPool pool, VkCommandBuffer commands) {
  must(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
  VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands;
  must(vkQueueSubmit(d.queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
  must(vkQueueWaitIdle(d.queue), "vkQueueWaitIdle");
  vkDestroyCommandPool(d.device, pool, nullptr);
}

void barrier(VkCommandBuffer commands) {
  VkMemoryBarrier all{VK_STRUCTURE_TYPE_MEMORY_BARRIER};
  all.srcAccessMask = all.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1, &all, 0,
                       nullptr, 0, nullptr);
}

}  // namespace vitrine::glass::replayer

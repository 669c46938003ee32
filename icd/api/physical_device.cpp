// Physical devices: properties, features, limits, queue families and memory (Vulkan 1.3.239, Devices and Queues;
// Features; Limits; Memory Allocation: Device Memory Properties).
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "base/simd.h"
#include "base/workers.h"
#include "icd/edge/util.h"
#include "icd/entry_points.h"
#include "icd/object/instance.h"
#include "icd/object/memory.h"
#include "icd/properties.h"
#include "icd/version.h"

namespace vitrine::icd {
namespace {

/// VITRINE_DEVICE_TYPE=cpu|virtual|integrated|discrete: for applications that skip CPU devices.
VkPhysicalDeviceType device_type(VkPhysicalDeviceType claimed) {
  const char* wanted = std::getenv("VITRINE_DEVICE_TYPE");
  if (!wanted) return claimed;
  const std::string_view name(wanted);
  if (name == "virtual") return VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU;
  if (name == "integrated") return VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU;
  if (name == "discrete") return VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
  return claimed;
}

/// A UUID of readable bytes: a tag and the driver version. Equal builds of one version share caches and memory.
void write_uuid(std::uint8_t (&uuid)[VK_UUID_SIZE], const char (&tag)[9], std::uint32_t version) {
  std::memset(uuid, 0, sizeof uuid);
  std::memcpy(uuid, tag, 8);
  std::memcpy(uuid + 8, &version, sizeof version);
}

VkPhysicalDeviceProperties make_properties() {
  VkPhysicalDeviceProperties properties = kClaimedPhysicalDeviceProperties;
  base::select_simd_target();  // before anything is computed
  properties.deviceType = device_type(properties.deviceType);
  write_uuid(properties.pipelineCacheUUID, "vitrCACH", properties.driverVersion);
  return properties;
}

/// One heap of three quarters of the machine's memory, and one type that is everything at once.
VkPhysicalDeviceMemoryProperties make_memory_properties() {
  VkPhysicalDeviceMemoryProperties properties{};
  const long pages = sysconf(_SC_PHYS_PAGES);
  const long page_size = sysconf(_SC_PAGESIZE);
  const VkDeviceSize total = pages > 0 && page_size > 0 ? VkDeviceSize(pages) * VkDeviceSize(page_size) : 1ull << 30;
  properties.memoryHeapCount = 1;
  properties.memoryHeaps[0] = {total / 4 * 3, VK_MEMORY_HEAP_DEVICE_LOCAL_BIT};
  properties.memoryTypeCount = 1;
  properties.memoryTypes[0].propertyFlags = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                            VK_MEMORY_PROPERTY_HOST_COHERENT_BIT | VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
  return properties;
}

FeatureSet make_features() {
  FeatureSet features;
  for (const Feature feature : claimed_features()) features.set(feature);
  return features;
}

ExtensionSet make_device_extensions() {
  ExtensionSet extensions;
  for (const ExtensionInfo& info : extension_infos()) {
    if (info.claimed && !info.is_instance) {
      extensions.set(static_cast<Extension>(&info - extension_infos().data()));
    }
  }
  return extensions;
}

/// Which device this is, across processes and other APIs.
template <class T>
void write_identity(const PhysicalDevice& device, T& ids) {
  write_uuid(ids.deviceUUID, "vitrDEVC", device.properties.driverVersion);
  write_uuid(ids.driverUUID, "vitrDRVR", device.properties.driverVersion);
}

/// What runs here: results are the same for all of it, speed is not.
template <class T>
void write_driver_info(T& driver) {
  std::snprintf(driver.driverInfo, sizeof driver.driverInfo, "%s, %s, %zu threads", kDriverVersionText,
                base::simd_target_name(), base::worker_count());
}

/// What all instances of this process have allocated, and what they could have: that, and what the machine has free.
void write_budget(const PhysicalDevice& device, VkPhysicalDeviceMemoryBudgetPropertiesEXT& out) {
  std::fill(std::begin(out.heapBudget), std::end(out.heapBudget), 0);
  std::fill(std::begin(out.heapUsage), std::end(out.heapUsage), 0);
  const long pages = sysconf(_SC_AVPHYS_PAGES), page_size = sysconf(_SC_PAGESIZE);
  const VkDeviceSize heap = device.memory_properties.memoryHeaps[0].size;
  const VkDeviceSize free = pages > 0 && page_size > 0 ? VkDeviceSize(pages) * VkDeviceSize(page_size) : heap;
  out.heapUsage[0] = allocated_bytes().load();
  out.heapBudget[0] = std::min(heap, out.heapUsage[0] + free);
}

constexpr VkQueueFamilyProperties kUniversalFamily = {
    VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT | VK_QUEUE_TRANSFER_BIT, 1, 64, {1, 1, 1}};

/// Threads of an ordinary process: nothing above what the system gives everybody.
constexpr std::array kGlobalPriorities = {VK_QUEUE_GLOBAL_PRIORITY_LOW_KHR, VK_QUEUE_GLOBAL_PRIORITY_MEDIUM_KHR};

#ifdef VK_EXT_host_image_copy
/// Those that the host may copy into and out of: all that an image with contents can have.
constexpr std::array kHostCopyLayouts = {VK_IMAGE_LAYOUT_GENERAL,
                                         VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                         VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
                                         VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL,
                                         VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                         VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                                         VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                         VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL,
                                         VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_STENCIL_READ_ONLY_OPTIMAL,
                                         VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                                         VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL,
                                         VK_IMAGE_LAYOUT_STENCIL_ATTACHMENT_OPTIMAL,
                                         VK_IMAGE_LAYOUT_STENCIL_READ_ONLY_OPTIMAL,
                                         VK_IMAGE_LAYOUT_READ_ONLY_OPTIMAL,
                                         VK_IMAGE_LAYOUT_ATTACHMENT_OPTIMAL,
                                         VK_IMAGE_LAYOUT_PRESENT_SRC_KHR,
                                         VK_IMAGE_LAYOUT_ATTACHMENT_FEEDBACK_LOOP_OPTIMAL_EXT};

void write_list(std::uint32_t& count, VkImageLayout* out) {
  const auto all = static_cast<std::uint32_t>(kHostCopyLayouts.size());
  count = out ? std::min(count, all) : all;
  if (out) std::copy_n(kHostCopyLayouts.begin(), count, out);
}

/// Into the lists of a structure of properties.
template <class T>
void write_layouts(T* out) {
  if (!out) return;
  write_list(out->copySrcLayoutCount, out->pCopySrcLayouts);
  write_list(out->copyDstLayoutCount, out->pCopyDstLayouts);
}
#endif

}  // namespace

PhysicalDevice::PhysicalDevice(const HostMemory& m, Instance& owner)
    : DispatchableObject(m),
      instance(owner),
      properties(make_properties()),
      features(make_features()),
      extensions(make_device_extensions()),
      memory_properties(make_memory_properties()) {}

namespace entry {

VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceProperties(VkPhysicalDevice device, VkPhysicalDeviceProperties* out) {
  *out = from_handle<PhysicalDevice>(device).properties;
}

VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceProperties2(VkPhysicalDevice device, VkPhysicalDeviceProperties2* out) {
  const PhysicalDevice& physical_device = from_handle<PhysicalDevice>(device);
  out->properties = physical_device.properties;
  write_property_chain(out->pNext);
  if (auto* ids = find_in_out_chain<VkPhysicalDeviceIDProperties>(out->pNext)) write_identity(physical_device, *ids);
  if (auto* core = find_in_out_chain<VkPhysicalDeviceVulkan11Properties>(out->pNext);
      core && physical_device.properties.apiVersion >= VK_API_VERSION_1_2) {
    write_identity(physical_device, *core);
  }
  if (auto* driver = find_in_out_chain<VkPhysicalDeviceDriverProperties>(out->pNext)) write_driver_info(*driver);
  if (auto* core = find_in_out_chain<VkPhysicalDeviceVulkan12Properties>(out->pNext);
      core && physical_device.properties.apiVersion >= VK_API_VERSION_1_2) {
    write_driver_info(*core);
  }
#ifdef VK_EXT_host_image_copy
  write_layouts(find_in_out_chain<VkPhysicalDeviceHostImageCopyPropertiesEXT>(out->pNext));
#endif
#ifdef VK_API_VERSION_1_4
  write_layouts(find_in_out_chain<VkPhysicalDeviceVulkan14Properties>(out->pNext));
#endif
#ifdef VK_KHR_maintenance7
  // Nothing lies underneath.
  if (auto* layered = find_in_out_chain<VkPhysicalDeviceLayeredApiPropertiesListKHR>(out->pNext))
    layered->layeredApiCount = 0;
#endif
}

VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceFeatures(VkPhysicalDevice device, VkPhysicalDeviceFeatures* out) {
  write_features(out, from_handle<PhysicalDevice>(device).features);
}

VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceFeatures2(VkPhysicalDevice device, VkPhysicalDeviceFeatures2* out) {
  write_feature_chain(out, from_handle<PhysicalDevice>(device).features);
}

VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceQueueFamilyProperties(VkPhysicalDevice, std::uint32_t* count,
                                                                  VkQueueFamilyProperties* out) {
  OutArray<VkQueueFamilyProperties> array(count, out);
  array.push(kUniversalFamily);
  array.result();
}

VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceQueueFamilyProperties2(VkPhysicalDevice, std::uint32_t* count,
                                                                   VkQueueFamilyProperties2* out) {
  OutArray<VkQueueFamilyProperties2> array(count, out);
  if (VkQueueFamilyProperties2* family = array.next()) {
    family->queueFamilyProperties = kUniversalFamily;
    if (auto* priorities = find_in_out_chain<VkQueueFamilyGlobalPriorityPropertiesKHR>(family->pNext)) {
      priorities->priorityCount = static_cast<std::uint32_t>(kGlobalPriorities.size());
      std::ranges::copy(kGlobalPriorities, priorities->priorities);
    }
  }
  array.result();
}

/// The driver is no tool.
VKAPI_ATTR VkResult VKAPI_CALL GetPhysicalDeviceToolProperties(VkPhysicalDevice, std::uint32_t* count,
                                                               VkPhysicalDeviceToolProperties*) {
  *count = 0;
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceMemoryProperties(VkPhysicalDevice device,
                                                             VkPhysicalDeviceMemoryProperties* out) {
  *out = from_handle<PhysicalDevice>(device).memory_properties;
}

VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceMemoryProperties2(VkPhysicalDevice device,
                                                              VkPhysicalDeviceMemoryProperties2* out) {
  const PhysicalDevice& physical_device = from_handle<PhysicalDevice>(device);
  out->memoryProperties = physical_device.memory_properties;
  if (auto* budget = find_in_out_chain<VkPhysicalDeviceMemoryBudgetPropertiesEXT>(out->pNext)) {
    write_budget(physical_device, *budget);
  }
}

}  // namespace entry
}  // namespace vitrine::icd

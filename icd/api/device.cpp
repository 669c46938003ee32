// Devices and queues as objects (Vulkan 1.3.239, Devices and Queues: Device Creation, Queues).
#include "icd/object/device.h"

#include "glass/session.h"
#include "glass/sync/sync.h"
#include "icd/edge/util.h"
#include "icd/entry_points.h"
#include "icd/object/address_book.h"
#include "icd/object/descriptor_bytes.h"

namespace vitrine::icd {
namespace {

VkResult enable_device_extensions(const PhysicalDevice& parent, const VkDeviceCreateInfo& info, ExtensionSet& enabled) {
  for (std::uint32_t i = 0; i < info.enabledExtensionCount; ++i) {
    const Extension extension = find_extension(info.ppEnabledExtensionNames[i]);
    if (extension == Extension::kCount || !parent.extensions.test(extension)) return VK_ERROR_EXTENSION_NOT_PRESENT;
    enabled.set(extension);
  }
  return VK_SUCCESS;
}

VkResult enable_features(const PhysicalDevice& parent, const VkDeviceCreateInfo& info, FeatureSet& enabled) {
  if (info.pEnabledFeatures) read_features(info.pEnabledFeatures, enabled);
  read_feature_chain(info.pNext, enabled);
  for (std::size_t i = 0; i < static_cast<std::size_t>(Feature::kCount); ++i) {
    const Feature feature = static_cast<Feature>(i);
    if (enabled.test(feature) && !parent.features.test(feature)) return VK_ERROR_FEATURE_NOT_PRESENT;
  }
  return VK_SUCCESS;
}

/// A queue that is to be served before other processes' (VK_KHR_global_priority): not ours to grant.
bool wants_more_than_others(const VkDeviceCreateInfo& info) {
  for (std::uint32_t i = 0; i < info.queueCreateInfoCount; ++i) {
    const auto* wanted = find_in_chain<VkDeviceQueueGlobalPriorityCreateInfoKHR>(info.pQueueCreateInfos[i].pNext);
    if (wanted && wanted->globalPriority > VK_QUEUE_GLOBAL_PRIORITY_MEDIUM_KHR) return true;
  }
  return false;
}

void keep_memory_reports(const VkDeviceCreateInfo& info, Device& device) {
  using Report = VkDeviceDeviceMemoryReportCreateInfoEXT;
  for (const VkBaseInStructure& item : in_chain(info.pNext))
    if (item.sType == kStructureTypeOf<Report>) device.memory_reports.push_back(reinterpret_cast<const Report&>(item));
}

}  // namespace

namespace entry {

VKAPI_ATTR VkResult VKAPI_CALL CreateDevice(VkPhysicalDevice physical_device, const VkDeviceCreateInfo* info,
                                            const VkAllocationCallbacks* allocator, VkDevice* device) {
  PhysicalDevice& parent = from_handle<PhysicalDevice>(physical_device);
  ExtensionSet extensions;
  FeatureSet features;
  VkResult result = enable_device_extensions(parent, *info, extensions);
  if (result == VK_SUCCESS) result = enable_features(parent, *info, features);
  if (result != VK_SUCCESS) return result;
  if (wants_more_than_others(*info)) return VK_ERROR_NOT_PERMITTED_KHR;
  Owned<Device> object(create_object<Device>(parent.instance.memory, allocator, parent));
  object->extensions = extensions;
  object->features = features;
  keep_memory_reports(*info, *object);
  if (!glass::session().idle()) object->addresses = std::make_shared<AddressBook>();
  if (features.test(Feature::descriptorBuffer))
    object->described =
        std::allocate_shared<DescribedObjects>(HostAllocator<DescribedObjects>(object->memory), object->memory);
  if (info->queueCreateInfoCount) object->queue.flags = info->pQueueCreateInfos[0].flags;
  if (start_queue) start_queue(object->queue);
  *device = to_handle(object.release());
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL DestroyDevice(VkDevice device, const VkAllocationCallbacks*) {
  if (!device) return;
  if (stop_queue) stop_queue(from_handle<Device>(device).queue);
  glass::sync::forget_owner(&from_handle<Device>(device));
  destroy_handle<Device>(device);
  glass::session().write();
}

VKAPI_ATTR void VKAPI_CALL GetDeviceQueue(VkDevice device, std::uint32_t family, std::uint32_t index, VkQueue* queue) {
  VkDeviceQueueInfo2 info = make_struct<VkDeviceQueueInfo2>();
  info.queueFamilyIndex = family;
  info.queueIndex = index;
  GetDeviceQueue2(device, &info, queue);
}

VKAPI_ATTR void VKAPI_CALL GetDeviceQueue2(VkDevice device, const VkDeviceQueueInfo2* info, VkQueue* queue) {
  Device& d = from_handle<Device>(device);
  const bool exists = info->queueFamilyIndex == 0 && info->queueIndex == 0 && info->flags == d.queue.flags;
  *queue = exists ? to_handle(&d.queue) : VK_NULL_HANDLE;
}

}  // namespace entry
}  // namespace vitrine::icd

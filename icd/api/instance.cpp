// Instances and enumeration of physical devices (Vulkan 1.3.239, Initialization; Devices and Queues: Physical Devices,
// Device Groups).
#include "icd/object/instance.h"

#include <string_view>

#include "base/as_reference.h"
#include "base/shake.h"
#include "glass/output.h"
#include "icd/edge/util.h"
#include "icd/entry_points.h"
#include "icd/properties.h"
#include "icd/wsi/display.h"

namespace vitrine::icd {
namespace {

VkResult list_extensions(bool of_instance, std::uint32_t* count, VkExtensionProperties* out) {
  OutArray<VkExtensionProperties> array(count, out);
  for (const ExtensionInfo& info : extension_infos()) {
    if (!info.claimed || info.is_instance != of_instance) continue;
    VkExtensionProperties properties{};
    std::string_view(info.name).copy(properties.extensionName, VK_MAX_EXTENSION_NAME_SIZE - 1);
    properties.specVersion = info.spec_version;
    array.push(properties);
  }
  return array.result();
}

/// Messengers given in VkInstanceCreateInfo's chain report problems of vkCreateInstance itself; ours has none to report
/// beyond its result, so only the extensions matter here.
VkResult enable_instance_extensions(const VkInstanceCreateInfo& info, ExtensionSet& enabled) {
  for (std::uint32_t i = 0; i < info.enabledExtensionCount; ++i) {
    const Extension extension = find_extension(info.ppEnabledExtensionNames[i]);
    if (extension == Extension::kCount || !extension_info(extension).claimed ||
        !extension_info(extension).is_instance) {
      return VK_ERROR_EXTENSION_NOT_PRESENT;
    }
    enabled.set(extension);
  }
  return VK_SUCCESS;
}

/// Whoever asks for a row or a kind of shake that is none hears of it, once; the application goes on.
void complain_of_rows() {
  static const bool said = [] {
    for (const std::string& word : base::shake_settings().unknown)
      glass::complain("VITRINE_SHAKE: '" + word + "' means nothing; there are a seed and " + base::names_of_shakes());
    for (const std::string& name : base::asked_rows().unknown)
      glass::complain("VITRINE_AS_REFERENCE: '" + name + "' cannot be asked for; there are all, " +
                      base::names_of_rows());
    return true;
  }();
  static_cast<void>(said);
}

}  // namespace

namespace entry {

VKAPI_ATTR VkResult VKAPI_CALL EnumerateInstanceVersion(std::uint32_t* version) {
  *version = kClaimedPhysicalDeviceProperties.apiVersion;
  return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL EnumerateInstanceExtensionProperties(const char* layer, std::uint32_t* count,
                                                                    VkExtensionProperties* properties) {
  if (layer) return VK_ERROR_LAYER_NOT_PRESENT;
  return list_extensions(true, count, properties);
}

VKAPI_ATTR VkResult VKAPI_CALL EnumerateInstanceLayerProperties(std::uint32_t* count, VkLayerProperties*) {
  *count = 0;
  return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL CreateInstance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator,
                                              VkInstance* instance) {
  ExtensionSet extensions;
  const VkResult result = enable_instance_extensions(*info, extensions);
  if (result != VK_SUCCESS) return result;
  complain_of_rows();
  Instance* object = create_object<Instance>(HostMemory(), allocator);
  if (info->pApplicationInfo && info->pApplicationInfo->apiVersion) {
    object->api_version = info->pApplicationInfo->apiVersion;
  }
  object->extensions = extensions;
  Owned<Instance> owner(object);
  if (extensions.test(Extension::KHR_display)) make_display(*object);
  *instance = to_handle(owner.release());
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL DestroyInstance(VkInstance instance, const VkAllocationCallbacks*) {
  if (const Instance* object = from_nullable<Instance>(instance)) destroy_display(*object);
  destroy_handle<Instance>(instance);
}

VKAPI_ATTR VkResult VKAPI_CALL EnumeratePhysicalDevices(VkInstance instance, std::uint32_t* count,
                                                        VkPhysicalDevice* devices) {
  OutArray<VkPhysicalDevice> array(count, devices);
  array.push(to_handle(&from_handle<Instance>(instance).physical_device));
  return array.result();
}

VKAPI_ATTR VkResult VKAPI_CALL EnumeratePhysicalDeviceGroups(VkInstance instance, std::uint32_t* count,
                                                             VkPhysicalDeviceGroupProperties* groups) {
  OutArray<VkPhysicalDeviceGroupProperties> array(count, groups);
  if (VkPhysicalDeviceGroupProperties* group = array.next()) {
    group->physicalDeviceCount = 1;
    group->physicalDevices[0] = to_handle(&from_handle<Instance>(instance).physical_device);
    group->subsetAllocation = VK_FALSE;
  }
  return array.result();
}

VKAPI_ATTR VkResult VKAPI_CALL EnumerateDeviceExtensionProperties(VkPhysicalDevice, const char* layer,
                                                                  std::uint32_t* count,
                                                                  VkExtensionProperties* properties) {
  if (layer) return VK_ERROR_LAYER_NOT_PRESENT;
  return list_extensions(false, count, properties);
}

VKAPI_ATTR VkResult VKAPI_CALL EnumerateDeviceLayerProperties(VkPhysicalDevice, std::uint32_t* count,
                                                              VkLayerProperties*) {
  *count = 0;
  return VK_SUCCESS;
}

}  // namespace entry
}  // namespace vitrine::icd

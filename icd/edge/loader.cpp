// The loader interface: negotiation and name -> function (Vulkan loader-driver interface, version 7). The only exported
// symbols of the library.
#include <vulkan/vk_icd.h>

#include <algorithm>
#include <cstring>
#include <new>

#include "glass/session.h"
#include "icd/entry_points.h"
#include "icd/object/device.h"
#include "icd/registry/registry.h"

#define VITRINE_EXPORT extern "C" __attribute__((visibility("default")))

namespace vitrine::icd {
namespace {

// Interface 7: the loader may ask vk_icdGetInstanceProcAddr for the vk_icd functions too.
constexpr std::uint32_t kLoaderInterface = 7;

PFN_vkVoidFunction thunk_of(const EntryPoint& entry) {
  if (!entry.implementation) return nullptr;
  return glass::session().idle() ? entry.thunk : entry.observed;
}

bool is_always_global(const char* name) {
  static constexpr const char* kNames[] = {"vkEnumerateInstanceVersion", "vkEnumerateInstanceExtensionProperties",
                                           "vkEnumerateInstanceLayerProperties", "vkCreateInstance",
                                           "vkGetInstanceProcAddr"};
  return std::any_of(std::begin(kNames), std::end(kNames),
                     [name](const char* known) { return std::strcmp(name, known) == 0; });
}

/// Commands of an instance: enabled instance extensions count, and every device extension that the device has.
PFN_vkVoidFunction instance_command(const Instance& instance, const char* name) {
  const EntryPoint* entry = find_entry_point(name);
  if (!entry) return nullptr;
  ExtensionSet extensions = instance.extensions;
  extensions |= instance.physical_device.extensions;
  if (!is_open(*entry, instance.physical_device.properties.apiVersion, extensions)) return nullptr;
  return thunk_of(*entry);
}

/// Up to which version a device tells of commands: with maintenance5 "core commands beyond" the version that the
/// application asked for "will return NULL" (Vulkan 1.4.309, vkGetDeviceProcAddr).
std::uint32_t core_version(const Device& device) {
  const std::uint32_t version = device.physical_device.properties.apiVersion;
#ifdef VK_KHR_maintenance5
  if (device.features.test(Feature::maintenance5)) {
    return std::min(version, device.physical_device.instance.api_version);
  }
#endif
  return version;
}

}  // namespace

namespace entry {

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL GetDeviceProcAddr(VkDevice device, const char* name) {
  const EntryPoint* entry = find_entry_point(name);
  if (!entry || entry->scope != Scope::kDevice) return nullptr;
  const Device& d = from_handle<Device>(device);
  ExtensionSet extensions = d.extensions;
  extensions |= d.physical_device.instance.extensions;  // VK_EXT_debug_utils has device commands
  if (!is_open(*entry, core_version(d), extensions)) return nullptr;
  return thunk_of(*entry);
}

}  // namespace entry
}  // namespace vitrine::icd

using namespace vitrine::icd;

VITRINE_EXPORT VKAPI_ATTR VkResult VKAPI_CALL vk_icdNegotiateLoaderICDInterfaceVersion(std::uint32_t* version) {
  // Below 3 the loader would create surfaces of its own layout; every loader since 2016 speaks more.
  if (*version < 3) return VK_ERROR_INCOMPATIBLE_DRIVER;
  *version = std::min(*version, kLoaderInterface);
  return VK_SUCCESS;
}

namespace {

/// Without memory for the tools, which the first look-up makes, there is no command: the loader then finds no driver.
template <class F>
PFN_vkVoidFunction found_by(F&& look_up) noexcept {
  try {
    return look_up();
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

PFN_vkVoidFunction physical_device_command(VkInstance instance, const char* name) {
  const EntryPoint* entry = find_entry_point(name);
  if (!entry || entry->scope != Scope::kPhysicalDevice) return nullptr;
  return instance_command(from_handle<Instance>(instance), name);
}

}  // namespace

VITRINE_EXPORT VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vk_icdGetPhysicalDeviceProcAddr(VkInstance instance,
                                                                                        const char* name) {
  return found_by([=] { return physical_device_command(instance, name); });
}

VITRINE_EXPORT VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vk_icdGetInstanceProcAddr(VkInstance instance,
                                                                                  const char* name) {
  if (std::strcmp(name, "vk_icdNegotiateLoaderICDInterfaceVersion") == 0) {
    return reinterpret_cast<PFN_vkVoidFunction>(&vk_icdNegotiateLoaderICDInterfaceVersion);
  }
  if (std::strcmp(name, "vk_icdGetPhysicalDeviceProcAddr") == 0) {
    return reinterpret_cast<PFN_vkVoidFunction>(&vk_icdGetPhysicalDeviceProcAddr);
  }
  return found_by([=]() -> PFN_vkVoidFunction {
    if (is_always_global(name)) {
      const EntryPoint* entry = find_entry_point(name);
      return entry ? thunk_of(*entry) : nullptr;
    }
    return instance ? instance_command(from_handle<Instance>(instance), name) : nullptr;
  });
}

namespace vitrine::icd::entry {

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL GetInstanceProcAddr(VkInstance instance, const char* name) {
  return vk_icdGetInstanceProcAddr(instance, name);
}

}  // namespace vitrine::icd::entry

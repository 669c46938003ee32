// Messages to the application: VK_EXT_debug_utils messengers first, VITRINE_LOG on stderr beside them.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "icd/object/device.h"

namespace vitrine::icd {

struct ObjectRef {
  VkObjectType type = VK_OBJECT_TYPE_UNKNOWN;
  std::uint64_t handle = 0;
};
template <class T>
ObjectRef ref(const T& object) {
  return {T::kType, reinterpret_cast<std::uint64_t>(&object)};
}

/// The name that the application gave an object; empty: none.
std::string name_of(Instance& instance, ObjectRef object);

/// Those of several, "mesh + lit": null ones and ones without a name are left out.
std::string names_of(Instance& instance, std::span<const ObjectRef> objects);

/// Calls every messenger that listens for the severity and type. No lock is held during callbacks.
void send_message(Instance& instance, VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                  VkDebugUtilsMessageTypeFlagsEXT types, const VkDebugUtilsMessengerCallbackDataEXT& data);

/// Sends a message to every messenger of the instance that listens for `severity`. `id` names the kind of message
/// ("pipeline", "queue"...). Never throws.
void report(Instance& instance, VkDebugUtilsMessageSeverityFlagBitsEXT severity, ObjectRef object, const char* id,
            std::string_view message) noexcept;
inline void report(Device& device, VkDebugUtilsMessageSeverityFlagBitsEXT severity, ObjectRef object, const char* id,
                   std::string_view message) noexcept {
  report(device.physical_device.instance, severity, object, id, message);
}
/// Tells messengers that an object got or gives up addresses, where the device's feature asks for it.
void report_binding(Device& device, ObjectRef object, const void* address, VkDeviceSize bytes,
                    VkDeviceAddressBindingTypeEXT type);
/// An error that an API call is about to return.
template <class Owner>
void report_error(Owner& owner, ObjectRef object, const char* id, std::string_view message) noexcept {
  report(owner, VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT, object, id, message);
}

}  // namespace vitrine::icd

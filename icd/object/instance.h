// VkInstance and VkPhysicalDevice: one physical device, inside the instance.
#pragma once

#include <mutex>

#include "icd/object/object.h"
#include "icd/registry/registry.h"

namespace vitrine::icd {

struct Instance;

struct PhysicalDevice : DispatchableObject<VkPhysicalDevice, VK_OBJECT_TYPE_PHYSICAL_DEVICE> {
  PhysicalDevice(const HostMemory& m, Instance& owner);

  Instance& instance;
  VkPhysicalDeviceProperties properties;  ///< complete: run-time values filled in
  FeatureSet features;                    ///< claimed
  ExtensionSet extensions;                ///< claimed device extensions
  VkPhysicalDeviceMemoryProperties memory_properties;
};

/// A registered messenger of VK_EXT_debug_utils.
struct Messenger : Object<VkDebugUtilsMessengerEXT, VK_OBJECT_TYPE_DEBUG_UTILS_MESSENGER_EXT> {
  Messenger(const HostMemory& m, const VkDebugUtilsMessengerCreateInfoEXT& info) : Object(m), create_info(info) {}

  VkDebugUtilsMessengerCreateInfoEXT create_info;  ///< pNext is not followed
};

struct Instance : DispatchableObject<VkInstance, VK_OBJECT_TYPE_INSTANCE> {
  explicit Instance(const HostMemory& m) : DispatchableObject(m), physical_device(m, *this), messengers(m) {}

  std::uint32_t api_version = VK_API_VERSION_1_0;  ///< what the application asked for
  ExtensionSet extensions;                         ///< enabled
  PhysicalDevice physical_device;
  std::mutex notes_mutex;  ///< guards names and private data of all objects
  std::mutex messenger_mutex;
  Vector<Messenger*> messengers;
};

}  // namespace vitrine::icd

// VkDevice and VkQueue: what every other object is made from.
#pragma once

#include "icd/instance.h"

namespace vitrine::icd {

struct Device;

/// The one queue of the universal family. What runs on it is the queue chapter's business.
struct Queue : DispatchableObject<VkQueue, VK_OBJECT_TYPE_QUEUE> {
  Queue(const HostMemory& m, Device& owner) : DispatchableObject(m), device(owner) {}

  Device& device;
  VkDeviceQueueCreateFlags flags = 0;
};

struct Device : DispatchableObject<VkDevice, VK_OBJECT_TYPE_DEVICE> {
  Device(const HostMemory& m, PhysicalDevice& parent)
      : DispatchableObject(m), physical_device(parent), queue(m, *this) {}

  PhysicalDevice& physical_device;
  ExtensionSet extensions;  ///< enabled
  FeatureSet features;      ///< enabled
  Queue queue;
};

}  // namespace vitrine::icd

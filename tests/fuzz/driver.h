// What fuzzers that call the API need: the driver's functions, a device, and an end where they give what they may not
// give.
#pragma once

#include <span>
#include <string>

#include "tests/icd/calls.h"

namespace vitrine::fuzz {

/// Ends the process with a message where something that must work does not.
void demand(bool condition, const std::string& what);

/// A device with one queue.
struct Driver {
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical_device = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
};

/// Of Vulkan 1.3, with its physical device.
void make_instance(Driver& driver, std::span<const char* const> extensions);
/// `features`: what VkDeviceCreateInfo::pNext is.
void make_device(Driver& driver, std::span<const char* const> extensions, void* features);

}  // namespace vitrine::fuzz

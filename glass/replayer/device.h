// The Vulkan device that a bug file is replayed on: an application's view of it, through the loader.
#pragma once

#include <vulkan/vulkan.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "glass/bug/bug.h"

namespace vitrine::glass::replayer {

/// Why a file cannot be replayed here, in words.
struct Failure : std::runtime_error {
  using std::runtime_error::runtime_error;
};
/// The device is lost.
struct Lost : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws what a result means: nothing for success.
void must(VkResult result, const char* what);

/// Device and queue. Everything is destroyed with the process, but for what is destroyed earlier.
struct Device {
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  VkPhysicalDeviceProperties properties{};
  VkPhysicalDeviceMemoryProperties memory{};
  std::vector<std::string> extensions;  ///< enabled
  bool names = false;                   ///< VK_EXT_debug_utils is there
  bool addresses_again = false;         ///< bufferDeviceAddressCaptureReplay is enabled

  bool has(const char* extension) const;
  template <class F>
  F function(const char* name) const {
    const auto found = reinterpret_cast<F>(vkGetDeviceProcAddr(device, name));
    if (!found) throw Failure(std::string("this driver has no ") + name);
    return found;
  }
};

/// The first device of the loader that has a queue for all that the bug does, with all features that it has; robustness
/// as the bug had it.
Device make_device(const bug::Bug& bug);

/// Memory for these needs. `host`: that can be mapped; `next`: what else the allocation is to have.
VkDeviceMemory allocate(const Device& device, const VkMemoryRequirements& needs, bool host, const void* next = nullptr);

/// The name that the application gave, unless it is empty.
void set_name(const Device& device, VkObjectType type, std::uint64_t handle, const std::string& name);

/// Records with `record`, submits and waits.
template <class F>
void submit(const Device& device, const F& record);
/// Its parts.
VkCommandBuffer begin_commands(const Device& device, VkCommandPool& pool);
void run_commands(const Device& device, VkCommandPool pool, VkCommandBuffer commands);
/// Everything before is done before everything behind.
void barrier(VkCommandBuffer commands);

template <class F>
void submit(const Device& device, const F& record) {
  VkCommandPool pool = VK_NULL_HANDLE;
  const VkCommandBuffer commands = begin_commands(device, pool);
  record(commands);
  run_commands(device, pool, commands);
}

}  // namespace vitrine::glass::replayer

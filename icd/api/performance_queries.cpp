// Counters that performance queries read (Vulkan 1.3.239, Queries: Performance Queries).
#include <algorithm>
#include <cstring>
#include <string_view>

#include "glass/profile.h"
#include "icd/edge/util.h"
#include "icd/entry_points.h"

namespace vitrine::icd {
namespace {

using glass::ProfileCounter;

/// As much of the text as fits, ended by a zero.
void copy_text(std::string_view text, char (&to)[VK_MAX_DESCRIPTION_SIZE]) {
  const std::size_t size = std::min(text.size(), sizeof to - 1);
  std::memcpy(to, text.data(), size);
  to[size] = 0;
}

/// The same for a name in every version of the driver: its FNV-1a hashes.
void make_uuid(const std::string& name, std::uint8_t (&uuid)[VK_UUID_SIZE]) {
  for (std::uint64_t part = 0; part < 2; ++part) {
    std::uint64_t hash = 0xcbf29ce484222325u + part;
    for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    std::memcpy(uuid + 8 * part, &hash, 8);
  }
}

void describe(const ProfileCounter& from, VkPerformanceCounterKHR& to) {
  to.unit = from.is_bytes ? VK_PERFORMANCE_COUNTER_UNIT_BYTES_KHR : VK_PERFORMANCE_COUNTER_UNIT_GENERIC_KHR;
  to.scope = VK_PERFORMANCE_COUNTER_SCOPE_COMMAND_KHR;
  to.storage = VK_PERFORMANCE_COUNTER_STORAGE_UINT64_KHR;
  make_uuid(from.category + "/" + from.name, to.uuid);
}

void describe(const ProfileCounter& from, VkPerformanceCounterDescriptionKHR& to) {
  // What is counted runs in slower functions.
  to.flags = VK_PERFORMANCE_COUNTER_DESCRIPTION_PERFORMANCE_IMPACTING_BIT_KHR;
  copy_text(from.name, to.name);
  copy_text(from.category, to.category);
  copy_text(from.description, to.description);
}

}  // namespace

namespace entry {

VKAPI_ATTR VkResult VKAPI_CALL EnumeratePhysicalDeviceQueueFamilyPerformanceQueryCountersKHR(
    VkPhysicalDevice, std::uint32_t family, std::uint32_t* count, VkPerformanceCounterKHR* counters,
    VkPerformanceCounterDescriptionKHR* descriptions) {
  const auto& all = glass::profile_counters();
  const auto there = static_cast<std::uint32_t>(family == 0 ? all.size() : 0);
  if (!counters && !descriptions) {
    *count = there;
    return VK_SUCCESS;
  }
  *count = std::min(*count, there);
  for (std::uint32_t i = 0; i < *count; ++i) {
    if (counters) describe(all[i], counters[i]);
    if (descriptions) describe(all[i], descriptions[i]);
  }
  return *count < there ? VK_INCOMPLETE : VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL GetPhysicalDeviceQueueFamilyPerformanceQueryPassesKHR(
    VkPhysicalDevice, const VkQueryPoolPerformanceCreateInfoKHR*, std::uint32_t* passes) {
  *passes = 1;
}

/// "Implementations may allow multiple actors to hold the profiling lock concurrently": there is nothing to share.
VKAPI_ATTR VkResult VKAPI_CALL AcquireProfilingLockKHR(VkDevice, const VkAcquireProfilingLockInfoKHR*) {
  return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL ReleaseProfilingLockKHR(VkDevice) {}

}  // namespace entry
}  // namespace vitrine::icd

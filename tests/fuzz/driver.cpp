// See driver.h.
#include "tests/fuzz/driver.h"

#include <cstdio>
#include <cstdlib>

#include "icd/edge/util.h"

namespace vitrine::fuzz {

using icd::make_struct;

void demand(bool condition, const std::string& what) {
  if (condition) return;
  std::fprintf(stderr, "failed: %s\n", what.c_str());
  std::abort();
}

void make_instance(Driver& driver, std::span<const char* const> extensions) {
  auto application = make_struct<VkApplicationInfo>();
  application.apiVersion = VK_API_VERSION_1_3;
  auto info = make_struct<VkInstanceCreateInfo>();
  info.pApplicationInfo = &application;
  info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  demand(FUZZ_CALL(nullptr, CreateInstance)(&info, nullptr, &driver.instance) == VK_SUCCESS, "an instance");
  std::uint32_t count = 1;
  FUZZ_CALL(driver.instance, EnumeratePhysicalDevices)(driver.instance, &count, &driver.physical_device);
}

void make_device(Driver& driver, std::span<const char* const> extensions, void* features) {
  const float priority = 1;
  auto queue = make_struct<VkDeviceQueueCreateInfo>();
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  auto info = make_struct<VkDeviceCreateInfo>(features);
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  demand(FUZZ_CALL(driver.instance, CreateDevice)(driver.physical_device, &info, nullptr, &driver.device) == VK_SUCCESS,
         "a device");
  FUZZ_CALL(driver.instance, GetDeviceQueue)(driver.device, 0, 0, &driver.queue);
}

}  // namespace vitrine::fuzz

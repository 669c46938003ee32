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
  demand(VK_GET(nullptr, CreateInstance)(&info, nullptr, &driver.instance) == VK_SUCCESS, "an instance");
  std::uint32_t count = 1;
  VK_GET(driver.instance, EnumeratePhysicalDevices)(driver.instance, &count, &driver.physical_device);
}

void make_device(Driver& driver, std::span<const char* const> extensions, void* features) {
  demand(icd::test::create_device(driver.instance, driver.physical_device, &driver.device, nullptr, features,
                                  extensions) == VK_SUCCESS,
         "a device");
  VK_GET(driver.instance, GetDeviceQueue)(driver.device, 0, 0, &driver.queue);
}

}  // namespace vitrine::fuzz

// The driver handed to the loader by the application itself, which opened it: VK_LUNARG_direct_driver_loading. Then no
// manifest is needed, and those that there are can be left alone. usage: direct_loading_test LIBVITRINE_ICD_SO
// MANIFEST; 77 where the loader does not offer it, as Debian 12's (1.3.239); LD_LIBRARY_PATH brings another.
#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "tests/icd/small_program.h"

namespace {

PFN_vkGetInstanceProcAddr of_loader, of_driver;
VkDirectDriverLoadingModeLUNARG mode;
std::string manifest;

/// Of an application that has the driver in its hand.
VKAPI_ATTR VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator,
                                               VkInstance* instance) {
  VkDirectDriverLoadingInfoLUNARG driver{VK_STRUCTURE_TYPE_DIRECT_DRIVER_LOADING_INFO_LUNARG, nullptr, 0, of_driver};
  VkDirectDriverLoadingListLUNARG list{VK_STRUCTURE_TYPE_DIRECT_DRIVER_LOADING_LIST_LUNARG,
                                       const_cast<void*>(info->pNext), mode, 1, &driver};
  std::vector<const char*> names(info->ppEnabledExtensionNames,
                                 info->ppEnabledExtensionNames + info->enabledExtensionCount);
  names.push_back(VK_LUNARG_DIRECT_DRIVER_LOADING_EXTENSION_NAME);
  VkInstanceCreateInfo direct = *info;
  direct.pNext = &list;
  direct.enabledExtensionCount = static_cast<std::uint32_t>(names.size());
  direct.ppEnabledExtensionNames = names.data();
  const auto create = reinterpret_cast<PFN_vkCreateInstance>(of_loader(nullptr, "vkCreateInstance"));
  return create(&direct, allocator, instance);
}

}  // namespace

/// What the program calls: the loader's functions.
extern "C" VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vk_icdGetInstanceProcAddr(VkInstance instance, const char* name) {
  if (std::string_view(name) == "vkCreateInstance") return reinterpret_cast<PFN_vkVoidFunction>(&create_instance);
  return of_loader(instance, name);
}

namespace vitrine::icd::test {
namespace {

bool loader_knows() {
  std::uint32_t count = 0;
  const auto enumerate = VK_GET(nullptr, EnumerateInstanceExtensionProperties);
  if (enumerate(nullptr, &count, nullptr) != VK_SUCCESS) return false;
  std::vector<VkExtensionProperties> offered(count);
  enumerate(nullptr, &count, offered.data());
  return std::any_of(offered.begin(), offered.end(), [](const VkExtensionProperties& e) {
    return std::string_view(e.extensionName) == VK_LUNARG_DIRECT_DRIVER_LOADING_EXTENSION_NAME;
  });
}

std::vector<std::string> device_names() {
  VkInstance instance;
  EXPECT_EQ(create_instance(&instance), VK_SUCCESS);
  const auto enumerate = VK_GET(instance, EnumeratePhysicalDevices);
  std::uint32_t count = 0;
  EXPECT_EQ(enumerate(instance, &count, nullptr), VK_SUCCESS);
  std::vector<VkPhysicalDevice> devices(count);
  EXPECT_EQ(enumerate(instance, &count, devices.data()), VK_SUCCESS);
  std::vector<std::string> names;
  for (const VkPhysicalDevice device : devices) {
    VkPhysicalDeviceProperties properties;
    VK_GET(instance, GetPhysicalDeviceProperties)(device, &properties);
    names.push_back(properties.deviceName);
  }
  VK_GET(instance, DestroyInstance)(instance, nullptr);
  return names;
}

void find_manifests(const std::string& files, VkDirectDriverLoadingModeLUNARG wanted) {
  setenv("VK_DRIVER_FILES", files.c_str(), 1);
  mode = wanted;
}

void expect_program_to_run() {
  Program p;
  EXPECT_EQ(run(p), VK_SUCCESS);
  check_results(p);
  destroy(p);
}

using Names = std::vector<std::string>;

TEST(DirectLoading, NeedsNoManifest) {
  find_manifests("/nowhere/none.json", VK_DIRECT_DRIVER_LOADING_MODE_EXCLUSIVE_LUNARG);
  EXPECT_EQ(device_names(), Names{"Vitrine"});
  expect_program_to_run();
}

TEST(DirectLoading, LeavesManifestsAloneWhereItIsExclusive) {
  find_manifests(manifest, VK_DIRECT_DRIVER_LOADING_MODE_EXCLUSIVE_LUNARG);
  EXPECT_EQ(device_names(), Names{"Vitrine"});
  expect_program_to_run();
}

/// Then the driver is there twice, once by its manifest.
TEST(DirectLoading, ComesBesideManifestsWhereItIsInclusive) {
  find_manifests(manifest, VK_DIRECT_DRIVER_LOADING_MODE_INCLUSIVE_LUNARG);
  EXPECT_EQ(device_names(), (Names{"Vitrine", "Vitrine"}));
}

}  // namespace
}  // namespace vitrine::icd::test

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  if (argc != 3) return 2;
  manifest = argv[2];
  void* const loader = dlopen("libvulkan.so.1", RTLD_NOW | RTLD_LOCAL);
  void* const driver = dlopen(argv[1], RTLD_NOW | RTLD_LOCAL);
  if (!driver) return 2;
  if (!loader) return 77;
  of_loader = reinterpret_cast<PFN_vkGetInstanceProcAddr>(dlsym(loader, "vkGetInstanceProcAddr"));
  of_driver = reinterpret_cast<PFN_vkGetInstanceProcAddr>(dlsym(driver, "vk_icdGetInstanceProcAddr"));
  setenv("VK_DRIVER_FILES", argv[2], 1);
  if (!vitrine::icd::test::loader_knows()) return 77;
  return RUN_ALL_TESTS();
}

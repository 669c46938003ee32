// Loader interface, instances, device groups, allocation failure.
#include <vulkan/vk_icd.h>

#include <vector>

#include "icd/registry/registry.h"
#include "tests/icd/fixture.h"

extern "C" VKAPI_ATTR VkResult VKAPI_CALL vk_icdNegotiateLoaderICDInterfaceVersion(std::uint32_t* version);
extern "C" VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vk_icdGetPhysicalDeviceProcAddr(VkInstance, const char* name);

namespace vitrine::icd::test {
namespace {

TEST(Loader, NegotiatesTheSmallerVersion) {
  std::uint32_t version = 5;
  EXPECT_EQ(vk_icdNegotiateLoaderICDInterfaceVersion(&version), VK_SUCCESS);
  EXPECT_EQ(version, 5u);
  version = 1000;
  EXPECT_EQ(vk_icdNegotiateLoaderICDInterfaceVersion(&version), VK_SUCCESS);
  EXPECT_EQ(version, 7u);
  version = 2;
  EXPECT_EQ(vk_icdNegotiateLoaderICDInterfaceVersion(&version), VK_ERROR_INCOMPATIBLE_DRIVER);
}

/// An application that hands the driver to the loader has this one function of it (VK_LUNARG_direct_driver_loading).
TEST(Loader, OneFunctionLeadsToTheOthers) {
  const auto negotiate = vk_icdGetInstanceProcAddr(nullptr, "vk_icdNegotiateLoaderICDInterfaceVersion");
  EXPECT_EQ(negotiate, reinterpret_cast<PFN_vkVoidFunction>(&vk_icdNegotiateLoaderICDInterfaceVersion));
  const auto of_physical_device = vk_icdGetInstanceProcAddr(nullptr, "vk_icdGetPhysicalDeviceProcAddr");
  EXPECT_EQ(of_physical_device, reinterpret_cast<PFN_vkVoidFunction>(&vk_icdGetPhysicalDeviceProcAddr));
  EXPECT_NE(vk_icdGetInstanceProcAddr(nullptr, "vkEnumerateInstanceExtensionProperties"), nullptr);
}

TEST(Loader, OnlyGlobalCommandsWithoutInstance) {
  EXPECT_NE(vk_icdGetInstanceProcAddr(nullptr, "vkCreateInstance"), nullptr);
  EXPECT_NE(vk_icdGetInstanceProcAddr(nullptr, "vkEnumerateInstanceVersion"), nullptr);
  EXPECT_EQ(vk_icdGetInstanceProcAddr(nullptr, "vkCreateDevice"), nullptr);
  EXPECT_EQ(vk_icdGetInstanceProcAddr(nullptr, "vkCreateBuffer"), nullptr);
}

TEST(Loader, CommandsFollowEnabledExtensions) {
  VkInstance plain, with;
  ASSERT_EQ(create_instance(&plain), VK_SUCCESS);
  ASSERT_EQ(create_instance(&with, nullptr, {VK_KHR_GET_PHYSICAL_DEVICE_PROPERTIES_2_EXTENSION_NAME}), VK_SUCCESS);
  EXPECT_EQ(vk_icdGetInstanceProcAddr(plain, "vkGetPhysicalDeviceFeatures2KHR"), nullptr);
  EXPECT_NE(vk_icdGetInstanceProcAddr(with, "vkGetPhysicalDeviceFeatures2KHR"), nullptr);
  EXPECT_NE(vk_icdGetInstanceProcAddr(plain, "vkCreateBuffer"), nullptr);
  EXPECT_NE(vk_icdGetPhysicalDeviceProcAddr(plain, "vkGetPhysicalDeviceProperties2"), nullptr);
  EXPECT_EQ(vk_icdGetPhysicalDeviceProcAddr(plain, "vkCreateBuffer"), nullptr);
  VK_GET(plain, DestroyInstance)(plain, nullptr);
  VK_GET(with, DestroyInstance)(with, nullptr);
}

TEST(Instance, DispatchableHandlesCarryTheLoaderMagic) {
  VkInstance instance;
  ASSERT_EQ(create_instance(&instance), VK_SUCCESS);
  EXPECT_EQ(reinterpret_cast<VK_LOADER_DATA*>(instance)->loaderMagic, ICD_LOADER_MAGIC);
  std::uint32_t count = 1;
  VkPhysicalDevice device;
  ASSERT_EQ(VK_GET(instance, EnumeratePhysicalDevices)(instance, &count, &device), VK_SUCCESS);
  EXPECT_EQ(reinterpret_cast<VK_LOADER_DATA*>(device)->loaderMagic, ICD_LOADER_MAGIC);
  VK_GET(instance, DestroyInstance)(instance, nullptr);
}

TEST(Instance, UnknownExtensionIsRefused) {
  VkInstance instance;
  EXPECT_EQ(create_instance(&instance, nullptr, {"VK_EXT_no_such"}), VK_ERROR_EXTENSION_NOT_PRESENT);
  EXPECT_EQ(create_instance(&instance, nullptr, {"VK_KHR_maintenance1"}), VK_ERROR_EXTENSION_NOT_PRESENT);
}

TEST(Instance, ExtensionsAreCountedThenFilled) {
  const auto enumerate = VK_GET(nullptr, EnumerateInstanceExtensionProperties);
  std::uint32_t count = 0;
  ASSERT_EQ(enumerate(nullptr, &count, nullptr), VK_SUCCESS);
  ASSERT_GT(count, 3u);
  std::vector<VkExtensionProperties> properties(count);
  std::uint32_t less = count - 1;
  EXPECT_EQ(enumerate(nullptr, &less, properties.data()), VK_INCOMPLETE);
  EXPECT_EQ(less, count - 1);
  EXPECT_EQ(enumerate(nullptr, &count, properties.data()), VK_SUCCESS);
  for (const VkExtensionProperties& p : properties) EXPECT_GT(p.specVersion, 0u) << p.extensionName;
}

TEST(Instance, OneDeviceGroupOfOneDevice) {
  VkInstance instance;
  ASSERT_EQ(create_instance(&instance), VK_SUCCESS);
  std::uint32_t count = 1;
  auto group = make_struct<VkPhysicalDeviceGroupProperties>();
  EXPECT_EQ(VK_GET(instance, EnumeratePhysicalDeviceGroups)(instance, &count, &group), VK_SUCCESS);
  EXPECT_EQ(group.physicalDeviceCount, 1u);
  EXPECT_NE(group.physicalDevices[0], VkPhysicalDevice{});
  VK_GET(instance, DestroyInstance)(instance, nullptr);
}

TEST(Instance, EveryFailingAllocationIsAnErrorAndLeaksNothing) {
  CountingAllocator allocator;
  for (std::size_t n = 0;; ++n) {
    ASSERT_LT(n, 100u);
    allocator.fail_after(n);
    allocator.clear_failed();
    VkInstance instance = VK_NULL_HANDLE;
    const VkResult result = create_instance(&instance, allocator.callbacks());
    if (result == VK_SUCCESS) {
      EXPECT_FALSE(allocator.failed());
      VK_GET(instance, DestroyInstance)(instance, allocator.callbacks());
      EXPECT_EQ(allocator.live(), 0u);
      EXPECT_GT(n, 0u);
      break;
    }
    EXPECT_EQ(result, VK_ERROR_OUT_OF_HOST_MEMORY);
    EXPECT_EQ(allocator.live(), 0u);
  }
}

}  // namespace
}  // namespace vitrine::icd::test

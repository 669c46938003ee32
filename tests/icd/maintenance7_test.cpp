// VK_KHR_maintenance7, which neither older headers nor the reference know: properties, and results of queries. Draws
// beside secondary command buffers are local_read_test.cpp's.
#include "icd/object/query_pool.h"
#include "tests/icd/fixture.h"

#ifdef VK_KHR_maintenance7
namespace vitrine::icd::test {
namespace {

#define VK_CALL(name) VK_GET(instance, name)

using Maintenance7 = DeviceTest;

TEST_F(Maintenance7, IsOffered) {
  auto features = make_struct<VkPhysicalDeviceMaintenance7FeaturesKHR>();
  auto all = make_struct<VkPhysicalDeviceFeatures2>(&features);
  VK_CALL(GetPhysicalDeviceFeatures2)(physical_device, &all);
  EXPECT_TRUE(features.maintenance7);
  auto properties = make_struct<VkPhysicalDeviceMaintenance7PropertiesKHR>();
  auto whole = make_struct<VkPhysicalDeviceProperties2>(&properties);
  VK_CALL(GetPhysicalDeviceProperties2)(physical_device, &whole);
  const VkPhysicalDeviceLimits& limits = whole.properties.limits;
  EXPECT_TRUE(properties.separateDepthStencilAttachmentAccess);
  EXPECT_EQ(properties.maxDescriptorSetTotalUniformBuffersDynamic, limits.maxDescriptorSetUniformBuffersDynamic);
  EXPECT_EQ(properties.maxDescriptorSetTotalStorageBuffersDynamic, limits.maxDescriptorSetStorageBuffersDynamic);
  EXPECT_EQ(properties.maxDescriptorSetTotalBuffersDynamic,
            limits.maxDescriptorSetUniformBuffersDynamic + limits.maxDescriptorSetStorageBuffersDynamic);
  EXPECT_EQ(properties.maxDescriptorSetUpdateAfterBindTotalBuffersDynamic,
            properties.maxDescriptorSetTotalBuffersDynamic);
}

/// Vulkan 1.4.309, VkPhysicalDeviceLayeredApiPropertiesListKHR: no device lies underneath, and the array stays the
/// application's.
TEST_F(Maintenance7, NoLayersAreUnderneath) {
  VkPhysicalDeviceLayeredApiPropertiesKHR room[2];
  auto list = make_struct<VkPhysicalDeviceLayeredApiPropertiesListKHR>();
  auto whole = make_struct<VkPhysicalDeviceProperties2>(&list);
  for (const bool asks : {false, true}) {
    list.layeredApiCount = 2;
    list.pLayeredApis = asks ? room : nullptr;
    VK_CALL(GetPhysicalDeviceProperties2)(physical_device, &whole);
    EXPECT_EQ(list.layeredApiCount, 0u);
    EXPECT_EQ(list.pLayeredApis, asks ? room : nullptr);
  }
}

/// With the feature 32 bits of a result are the low ones; without it they saturate, as the reference's do.
TEST_F(Maintenance7, NarrowResultsAreTheLowBitsOfWideOnes) {
  for (const bool enabled : {false, true}) {
    auto features = make_struct<VkPhysicalDeviceMaintenance7FeaturesKHR>();
    features.maintenance7 = enabled;
    const char* const name = VK_KHR_MAINTENANCE_7_EXTENSION_NAME;
    VkDevice other = VK_NULL_HANDLE;
    ASSERT_EQ(create_device(instance, physical_device, &other, nullptr, &features, {&name, 1}), VK_SUCCESS);
    auto pool_info = make_struct<VkQueryPoolCreateInfo>();
    pool_info.queryType = VK_QUERY_TYPE_OCCLUSION;
    pool_info.queryCount = 1;
    VkQueryPool pool = VK_NULL_HANDLE;
    ASSERT_EQ(VK_CALL(CreateQueryPool)(other, &pool_info, nullptr, &pool), VK_SUCCESS);
    from_handle<QueryPool>(pool).counters_of(0)->store(0x100000007u);
    from_handle<QueryPool>(pool).available[0].store(1);
    std::uint32_t narrow = 0;
    std::uint64_t wide = 0;
    const auto results = VK_CALL(GetQueryPoolResults);
    EXPECT_EQ(results(other, pool, 0, 1, sizeof narrow, &narrow, 0, 0), VK_SUCCESS);
    EXPECT_EQ(results(other, pool, 0, 1, sizeof wide, &wide, 0, VK_QUERY_RESULT_64_BIT), VK_SUCCESS);
    EXPECT_EQ(wide, 0x100000007u);
    EXPECT_EQ(narrow, enabled ? 7u : UINT32_MAX);
    VK_CALL(DestroyQueryPool)(other, pool, nullptr);
    VK_CALL(DestroyDevice)(other, nullptr);
  }
}

}  // namespace
}  // namespace vitrine::icd::test
#endif

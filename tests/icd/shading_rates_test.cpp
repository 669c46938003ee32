// What the device tells of fragment shading rates (Vulkan 1.3.239, Fragment Shading Rates; Limits).
#include <algorithm>
#include <vector>

#include "tests/icd/fixture.h"

namespace vitrine::icd::test {
namespace {

class ShadingRates : public DeviceTest {
 protected:
  std::vector<VkPhysicalDeviceFragmentShadingRateKHR> rates() {
    const auto list = VK_GET(instance, GetPhysicalDeviceFragmentShadingRatesKHR);
    std::uint32_t count = 0;
    EXPECT_EQ(list(physical_device, &count, nullptr), VK_SUCCESS);
    std::vector<VkPhysicalDeviceFragmentShadingRateKHR> out(count,
                                                            make_struct<VkPhysicalDeviceFragmentShadingRateKHR>());
    EXPECT_EQ(list(physical_device, &count, out.data()), VK_SUCCESS);
    EXPECT_EQ(count, out.size());
    return out;
  }
};

TEST_F(ShadingRates, AreOrderedAndHaveWhatIsRequired) {
  auto limits = make_struct<VkPhysicalDeviceFragmentShadingRatePropertiesKHR>();
  auto properties = make_struct<VkPhysicalDeviceProperties2>(&limits);
  VK_GET(instance, GetPhysicalDeviceProperties2)(physical_device, &properties);
  const auto all = rates();
  const auto samples_of = [&](std::uint32_t width, std::uint32_t height) {
    for (const auto& rate : all)
      if (rate.fragmentSize.width == width && rate.fragmentSize.height == height) return rate.sampleCounts;
    return VkSampleCountFlags{0};
  };
  const VkSampleCountFlags required = VK_SAMPLE_COUNT_1_BIT | VK_SAMPLE_COUNT_2_BIT | VK_SAMPLE_COUNT_4_BIT;
  EXPECT_EQ(samples_of(2, 2) & required, required);
  EXPECT_EQ(samples_of(2, 1) & required, required);
  EXPECT_EQ(samples_of(1, 1), ~VkSampleCountFlags{0});
  for (std::size_t i = 0; i < all.size(); ++i) {
    const VkExtent2D size = all[i].fragmentSize;
    EXPECT_LE(size.width, limits.maxFragmentSize.width);
    EXPECT_LE(size.height, limits.maxFragmentSize.height);
    if (size.width * size.height > 1)
      for (std::uint32_t bit = 1; bit != 0; bit <<= 1)
        if ((all[i].sampleCounts & bit) != 0) {
          EXPECT_LE(size.width * size.height * bit, limits.maxFragmentShadingRateCoverageSamples);
          EXPECT_LE(bit, static_cast<std::uint32_t>(limits.maxFragmentShadingRateRasterizationSamples));
        }
    if (i == 0) continue;
    const VkExtent2D before = all[i - 1].fragmentSize;
    EXPECT_TRUE(before.width > size.width || (before.width == size.width && before.height > size.height)) << i;
  }
}

TEST_F(ShadingRates, AreCutToTheApplicationsArray) {
  std::uint32_t count = 2;
  auto one = make_struct<VkPhysicalDeviceFragmentShadingRateKHR>();
  VkPhysicalDeviceFragmentShadingRateKHR some[3] = {one, one, one};
  EXPECT_EQ(VK_GET(instance, GetPhysicalDeviceFragmentShadingRatesKHR)(physical_device, &count, some), VK_INCOMPLETE);
  EXPECT_EQ(count, 2u);
  EXPECT_EQ(some[1].fragmentSize.width, 4u);
  EXPECT_EQ(some[2].fragmentSize.width, 0u);
}

TEST_F(ShadingRates, AttachmentsAreBytes) {
  VkFormatProperties properties;
  VK_GET(instance, GetPhysicalDeviceFormatProperties)(physical_device, VK_FORMAT_R8_UINT, &properties);
  EXPECT_TRUE(properties.optimalTilingFeatures & VK_FORMAT_FEATURE_FRAGMENT_SHADING_RATE_ATTACHMENT_BIT_KHR);
  const auto image = VK_GET(instance, GetPhysicalDeviceImageFormatProperties);
  VkImageFormatProperties limits;
  const auto ask = [&](VkFormat format) {
    return image(physical_device, format, VK_IMAGE_TYPE_2D, VK_IMAGE_TILING_OPTIMAL,
                 VK_IMAGE_USAGE_FRAGMENT_SHADING_RATE_ATTACHMENT_BIT_KHR, 0, &limits);
  };
  EXPECT_EQ(ask(VK_FORMAT_R8_UINT), VK_SUCCESS);
  EXPECT_EQ(limits.sampleCounts, VkSampleCountFlags{VK_SAMPLE_COUNT_1_BIT});
  EXPECT_EQ(ask(VK_FORMAT_R8_UNORM), VK_ERROR_FORMAT_NOT_SUPPORTED);
}

}  // namespace
}  // namespace vitrine::icd::test

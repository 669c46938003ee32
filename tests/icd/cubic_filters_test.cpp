// What the API tells of cubic filters (VK_EXT_filter_cubic), and blits with them. The formulas are tested in texel.
#include <cmath>
#include <vector>

#include "icd/registry/registry.h"
#include "tests/icd/fixture.h"
#include "texel/format.h"

namespace vitrine::icd::test {
namespace {

class CubicFilters : public DeviceTest {
 protected:
  void ask(VkFormat format, VkImageViewType view, VkFilterCubicImageViewImageFormatPropertiesEXT& out) {
    auto view_info = make_struct<VkPhysicalDeviceImageViewImageFormatInfoEXT>();
    view_info.imageViewType = view;
    auto info = make_struct<VkPhysicalDeviceImageFormatInfo2>(&view_info);
    info.format = format;
    info.type = VK_IMAGE_TYPE_2D;
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
    out = make_struct<VkFilterCubicImageViewImageFormatPropertiesEXT>();
    auto properties = make_struct<VkImageFormatProperties2>(&out);
    EXPECT_EQ(VK_GET(instance, GetPhysicalDeviceImageFormatProperties2)(physical_device, &info, &properties),
              VK_SUCCESS);
  }
};

TEST_F(CubicFilters, GoWithLinearOnes) {
  constexpr VkFormatFeatureFlags kLinear = VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
  constexpr VkFormatFeatureFlags kCubic = VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_CUBIC_BIT_EXT;
  for (const FormatClaim& claim : format_claims()) {
    const bool planes = texel::format_desc(claim.format).requires_conversion();
    const VkFormatFeatureFlags features = claim.properties.optimalTilingFeatures;
    EXPECT_EQ((features & kCubic) != 0, (features & kLinear) != 0 && !planes) << claim.format;
    EXPECT_EQ(claim.properties.bufferFeatures & kCubic, 0u);
  }
}

TEST_F(CubicFilters, AreOfFlatViews) {
  VkFilterCubicImageViewImageFormatPropertiesEXT out;
  for (const auto view : {VK_IMAGE_VIEW_TYPE_2D, VK_IMAGE_VIEW_TYPE_2D_ARRAY}) {
    ask(VK_FORMAT_R8G8B8A8_UNORM, view, out);
    EXPECT_EQ(out.filterCubic, VK_TRUE);
    EXPECT_EQ(out.filterCubicMinmax, VK_FALSE) << "the format is not filtered so at all";
    ask(VK_FORMAT_R32_SFLOAT, view, out);
    EXPECT_EQ(out.filterCubic, VK_TRUE);
    EXPECT_EQ(out.filterCubicMinmax, VK_TRUE);
    ask(VK_FORMAT_R8G8B8A8_UINT, view, out);
    EXPECT_EQ(out.filterCubic, VK_FALSE);
  }
  for (const auto view : {VK_IMAGE_VIEW_TYPE_1D, VK_IMAGE_VIEW_TYPE_3D, VK_IMAGE_VIEW_TYPE_CUBE}) {
    ask(VK_FORMAT_R8G8B8A8_UNORM, view, out);
    EXPECT_EQ(out.filterCubic, VK_FALSE) << view;
  }
}

/// A step of four texels becomes one of sixteen, which rises and falls beyond its ends as the curve does.
TEST_F(CubicFilters, BlitsFollowTheCurve) {
  const auto make = [&](std::uint32_t width, VkImage& image, VkDeviceMemory& memory) {
    auto info = make_struct<VkImageCreateInfo>();
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = VK_FORMAT_R32_SFLOAT;
    info.extent = {width, 1, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.tiling = VK_IMAGE_TILING_LINEAR;
    info.usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    EXPECT_EQ(VK_GET(instance, CreateImage)(device, &info, nullptr, &image), VK_SUCCESS);
    auto allocate = make_struct<VkMemoryAllocateInfo>();
    allocate.allocationSize = 4096;
    EXPECT_EQ(VK_GET(instance, AllocateMemory)(device, &allocate, nullptr, &memory), VK_SUCCESS);
    EXPECT_EQ(VK_GET(instance, BindImageMemory)(device, image, memory, 0), VK_SUCCESS);
    void* data = nullptr;
    EXPECT_EQ(VK_GET(instance, MapMemory)(device, memory, 0, VK_WHOLE_SIZE, 0, &data), VK_SUCCESS);
    return static_cast<float*>(data);
  };
  VkImage from, to;
  VkDeviceMemory memory[2];
  float* const source = make(4, from, memory[0]);
  const float* const target = make(16, to, memory[1]);
  for (int i = 0; i < 4; ++i) source[i] = i < 2 ? 0.0f : 1.0f;
  VkImageBlit region{};
  region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  region.srcOffsets[1] = {4, 1, 1};
  region.dstOffsets[1] = {16, 1, 1};
  run([&](VkCommandBuffer commands) {
    const auto blit = VK_GET(instance, CmdBlitImage);
    blit(commands, from, VK_IMAGE_LAYOUT_GENERAL, to, VK_IMAGE_LAYOUT_GENERAL, 1, &region, VK_FILTER_CUBIC_EXT);
  });
  for (int x = 0; x < 16; ++x) {
    const float u = (static_cast<float>(x) + 0.5f) / 4 - 0.5f, a = u - std::floor(u);
    const int first = static_cast<int>(std::floor(u)) - 1;
    const float weight[4] = {(-a + 2 * a * a - a * a * a) / 2, (2 - 5 * a * a + 3 * a * a * a) / 2,
                             (a + 4 * a * a - 3 * a * a * a) / 2, (-a * a + a * a * a) / 2};
    float expected = 0;
    for (int k = 0; k < 4; ++k) expected += weight[k] * (first + k < 2 ? 0.0f : 1.0f);
    EXPECT_NEAR(target[x], expected, 1e-5f) << x;
  }
  EXPECT_LT(target[5], 0.0f);
  EXPECT_GT(target[10], 1.0f);
  for (const VkImage image : {from, to}) VK_GET(instance, DestroyImage)(device, image, nullptr);
  for (const VkDeviceMemory m : memory) VK_GET(instance, FreeMemory)(device, m, nullptr);
}

}  // namespace
}  // namespace vitrine::icd::test

// Format descriptions: positions of channels, kinds, aspects, and unknown values.
#include "texel/format.h"

#include <gtest/gtest.h>

namespace vitrine::texel {
namespace {

struct Position {
  char name;
  int bits;
  int offset;
};

void expect_channels(VkFormat format, std::initializer_list<Position> expected) {
  const FormatDesc& desc = format_desc(format);
  ASSERT_EQ(desc.format, format);
  ASSERT_EQ(desc.channel_count, expected.size()) << desc.name;
  std::size_t i = 0;
  for (const Position& p : expected) {
    EXPECT_EQ(desc.channel[i].name, p.name) << desc.name << " channel " << i;
    EXPECT_EQ(desc.channel[i].bits, p.bits) << desc.name << " channel " << i;
    EXPECT_EQ(desc.channel[i].offset, p.offset) << desc.name << " channel " << i;
    ++i;
  }
}

TEST(Format, ChannelsInMemoryOrder) {
  expect_channels(VK_FORMAT_R8G8B8A8_UNORM, {{'R', 8, 0}, {'G', 8, 8}, {'B', 8, 16}, {'A', 8, 24}});
  expect_channels(VK_FORMAT_B8G8R8A8_SRGB, {{'B', 8, 0}, {'G', 8, 8}, {'R', 8, 16}, {'A', 8, 24}});
  expect_channels(VK_FORMAT_A2B10G10R10_UNORM_PACK32, {{'R', 10, 0}, {'G', 10, 10}, {'B', 10, 20}, {'A', 2, 30}});
  expect_channels(VK_FORMAT_R5G6B5_UNORM_PACK16, {{'B', 5, 0}, {'G', 6, 5}, {'R', 5, 11}});
  expect_channels(VK_FORMAT_B5G5R5A1_UNORM_PACK16, {{'A', 1, 0}, {'R', 5, 1}, {'G', 5, 6}, {'B', 5, 11}});
  expect_channels(VK_FORMAT_B10G11R11_UFLOAT_PACK32, {{'R', 11, 0}, {'G', 11, 11}, {'B', 10, 22}});
  expect_channels(VK_FORMAT_E5B9G9R9_UFLOAT_PACK32, {{'R', 9, 0}, {'G', 9, 9}, {'B', 9, 18}});
  expect_channels(VK_FORMAT_X8_D24_UNORM_PACK32, {{'D', 24, 0}});
  expect_channels(VK_FORMAT_D32_SFLOAT_S8_UINT, {{'D', 32, 0}, {'S', 8, 32}});
  expect_channels(VK_FORMAT_R32G32B32A32_SFLOAT, {{'R', 32, 0}, {'G', 32, 32}, {'B', 32, 64}, {'A', 32, 96}});
  expect_channels(VK_FORMAT_R10X6G10X6_UNORM_2PACK16, {{'R', 10, 6}, {'G', 10, 22}});
}

TEST(Format, KindsAndAspects) {
  EXPECT_EQ(format_desc(VK_FORMAT_R16G16_UINT).kind, Kind::kUint);
  EXPECT_EQ(format_desc(VK_FORMAT_R16G16_SINT).kind, Kind::kSint);
  EXPECT_EQ(format_desc(VK_FORMAT_R16G16_SNORM).kind, Kind::kFloat);
  EXPECT_TRUE(format_desc(VK_FORMAT_D24_UNORM_S8_UINT).has_stencil());
  EXPECT_FALSE(format_desc(VK_FORMAT_D16_UNORM).has_stencil());
  EXPECT_EQ(format_desc(VK_FORMAT_X8_D24_UNORM_PACK32).aspects, VkImageAspectFlags{VK_IMAGE_ASPECT_DEPTH_BIT});
  EXPECT_EQ(format_desc(VK_FORMAT_S8_UINT).aspects, VkImageAspectFlags{VK_IMAGE_ASPECT_STENCIL_BIT});
  EXPECT_TRUE(format_desc(VK_FORMAT_BC7_SRGB_BLOCK).is_srgb());
  EXPECT_EQ(format_desc(VK_FORMAT_BC7_SRGB_BLOCK).block_bytes, 16);
  EXPECT_EQ(format_desc(VK_FORMAT_BC4_SNORM_BLOCK).channel[0].numeric, Numeric::kSnorm);
  EXPECT_EQ(format_desc(VK_FORMAT_ASTC_12x10_UNORM_BLOCK).block_width, 12);
  EXPECT_EQ(format_desc(VK_FORMAT_A4R4G4B4_UNORM_PACK16).block_bytes, 2);
  EXPECT_EQ(format_desc(VK_FORMAT_G8_B8_R8_3PLANE_420_UNORM).plane_count, 3);
}

TEST(Format, UnknownValuesHaveNoBytes) {
  for (const auto value : {0, 12345, 1000000000, 0x7FFFFFFF, -1}) {
    EXPECT_EQ(format_desc(static_cast<VkFormat>(value)).block_bytes, 0) << value;
  }
}

}  // namespace
}  // namespace vitrine::texel

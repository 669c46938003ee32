// Transfers: copies keep every block, clears fill what they name and nothing else, resolves average.
#include "texel/transfer.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <vector>

namespace vitrine::texel {
namespace {

struct TestImage {
  ImageLayout layout;
  std::vector<std::byte> memory;
  ImageMemory get() { return {&layout, memory.data()}; }

  explicit TestImage(VkFormat format, Extent extent, std::uint32_t levels = 1, std::uint32_t layers = 1,
                     std::uint32_t samples = 1, VkImageType type = VK_IMAGE_TYPE_2D) {
    ImageDesc desc;
    desc.type = type;
    desc.format = format;
    desc.extent = extent;
    desc.levels = levels;
    desc.layers = layers;
    desc.samples = samples;
    EXPECT_TRUE(make_image_layout(desc, layout));
    memory.resize(layout.size);
  }
};

std::vector<std::byte> random_bytes(std::size_t count) {
  std::mt19937 generator(7);
  std::vector<std::byte> bytes(count);
  for (std::byte& b : bytes) b = static_cast<std::byte>(generator());
  return bytes;
}

VkBufferImageCopy region_of(VkImageAspectFlags aspect, VkExtent3D extent, std::uint32_t layers = 1) {
  VkBufferImageCopy region{};
  region.imageSubresource = {aspect, 0, 0, layers};
  region.imageExtent = extent;
  return region;
}

void expect_round_trip(VkFormat format, VkImageAspectFlags aspect, std::size_t texel_bytes, std::uint32_t block,
                       std::uint32_t word_mask = UINT32_MAX) {
  TestImage image(format, {37, 21, 1}, 2, 3);
  const std::size_t blocks = std::size_t{(37 + block - 1) / block} * ((21 + block - 1) / block) * 3;
  std::vector<std::byte> source = random_bytes(blocks * texel_bytes);
  std::vector<std::byte> result(source.size());
  const VkBufferImageCopy region = region_of(aspect, {37, 21, 1}, 3);
  copy_buffer_to_image(source, image.get(), region);
  copy_image_to_buffer(image.get(), result, region);
  if (word_mask != UINT32_MAX) {
    for (std::size_t i = 3; i < source.size(); i += 4) source[i] = std::byte{0};
  }
  EXPECT_EQ(source, result) << format_desc(format).name << " aspect " << aspect;
}

TEST(Copy, BufferRoundTrips) {
  expect_round_trip(VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_ASPECT_COLOR_BIT, 4, 1);
  expect_round_trip(VK_FORMAT_R32G32B32A32_SFLOAT, VK_IMAGE_ASPECT_COLOR_BIT, 16, 1);
  expect_round_trip(VK_FORMAT_R8G8B8_UNORM, VK_IMAGE_ASPECT_COLOR_BIT, 3, 1);
  expect_round_trip(VK_FORMAT_BC1_RGB_UNORM_BLOCK, VK_IMAGE_ASPECT_COLOR_BIT, 8, 4);
  expect_round_trip(VK_FORMAT_D24_UNORM_S8_UINT, VK_IMAGE_ASPECT_STENCIL_BIT, 1, 1);
  expect_round_trip(VK_FORMAT_D24_UNORM_S8_UINT, VK_IMAGE_ASPECT_DEPTH_BIT, 4, 1, 0xFFFFFF);
  expect_round_trip(VK_FORMAT_D32_SFLOAT_S8_UINT, VK_IMAGE_ASPECT_DEPTH_BIT, 4, 1);
}

TEST(Copy, LargeImagesInParallel) {
  TestImage image(VK_FORMAT_R8G8B8A8_UNORM, {1024, 600, 1});
  const std::vector<std::byte> source = random_bytes(1024 * 600 * 4);
  std::vector<std::byte> result(source.size());
  copy_buffer_to_image(source, image.get(), region_of(VK_IMAGE_ASPECT_COLOR_BIT, {1024, 600, 1}));
  copy_image_to_buffer(image.get(), result, region_of(VK_IMAGE_ASPECT_COLOR_BIT, {1024, 600, 1}));
  EXPECT_EQ(source, result);
}

TEST(Copy, RowLengthOffsetAndShortBuffers) {
  TestImage image(VK_FORMAT_R8_UNORM, {8, 8, 1});
  std::vector<std::byte> source = random_bytes(100);
  VkBufferImageCopy region = region_of(VK_IMAGE_ASPECT_COLOR_BIT, {3, 2, 1});
  region.bufferOffset = 5;
  region.bufferRowLength = 10;
  region.imageOffset = {4, 6, 0};
  copy_buffer_to_image(source, image.get(), region);
  const std::byte* row = image.memory.data() + 7 * image.layout.plane[0].level[0].row_pitch;
  EXPECT_EQ(row[4], source[15]);
  EXPECT_EQ(row[6], source[17]);
  EXPECT_EQ(row[7], std::byte{0});
  region.bufferOffset = 95;
  const std::vector<std::byte> before = image.memory;
  copy_buffer_to_image(source, image.get(), region);  // needs 13 bytes, has 5
  EXPECT_EQ(before, image.memory);
}

TEST(Copy, SlicesBecomeLayers) {
  TestImage volume(VK_FORMAT_R8_UNORM, {4, 4, 6}, 1, 1, 1, VK_IMAGE_TYPE_3D);
  TestImage array(VK_FORMAT_R8_UNORM, {4, 4, 1}, 1, 6);
  const std::vector<std::byte> source = random_bytes(4 * 4 * 6);
  copy_buffer_to_image(source, volume.get(), region_of(VK_IMAGE_ASPECT_COLOR_BIT, {4, 4, 6}));
  VkImageCopy region{};
  region.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  region.srcOffset = {0, 0, 2};
  region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 3};
  region.extent = {4, 4, 3};
  copy_image(volume.get(), array.get(), region);
  std::vector<std::byte> result(4 * 4 * 6);
  copy_image_to_buffer(array.get(), result, region_of(VK_IMAGE_ASPECT_COLOR_BIT, {4, 4, 1}, 6));
  EXPECT_EQ(std::memcmp(result.data() + 16, source.data() + 32, 48), 0);
  EXPECT_EQ(result[0], std::byte{0});
  EXPECT_EQ(result[64], std::byte{0});
}

TEST(Clear, RangesAndRects) {
  TestImage image(VK_FORMAT_R32G32B32_SFLOAT, {70, 5, 1}, 2, 2);
  VkClearColorValue color{};
  color.float32[0] = 1;
  color.float32[1] = 2;
  color.float32[2] = 3;
  clear_color_image(image.get(), color,
                    {VK_IMAGE_ASPECT_COLOR_BIT, 1, VK_REMAINING_MIP_LEVELS, 1, VK_REMAINING_ARRAY_LAYERS});
  ImageViewDesc vd;
  vd.type = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
  vd.format = VK_FORMAT_R32G32B32_SFLOAT;
  vd.level_count = 2;
  vd.layer_count = 2;
  const ImageView view = make_image_view(image.layout, image.memory.data(), vd);
  const auto at = [&](std::uint32_t level, std::uint32_t layer, std::uint32_t x, std::uint32_t y) {
    float rgb[3];
    std::memcpy(rgb, view.block(level, layer, 0, x, y, 0), sizeof(rgb));
    return rgb[0] * 100 + rgb[1] * 10 + rgb[2];
  };
  EXPECT_EQ(at(1, 1, 34, 1), 123.0f);
  EXPECT_EQ(at(1, 0, 0, 0), 0.0f);
  EXPECT_EQ(at(0, 1, 0, 0), 0.0f);
  fill_view(view, 0, {{60, 1}, {100, 2}}, 0, 1, encode_clear_color(*view.format, color));
  EXPECT_EQ(at(0, 0, 69, 2), 123.0f);
  EXPECT_EQ(at(0, 0, 59, 2), 0.0f);
  EXPECT_EQ(at(0, 0, 69, 3), 0.0f);
  EXPECT_EQ(at(0, 1, 69, 2), 0.0f);
}

TEST(Resolve, AveragesInSampleOrder) {
  TestImage image(VK_FORMAT_R8G8B8A8_UNORM, {3, 1, 1}, 1, 1, 4);
  TestImage result(VK_FORMAT_R8G8B8A8_UNORM, {3, 1, 1});
  for (std::size_t s = 0; s < 4; ++s) {
    image.memory[s * image.layout.plane[0].level[0].sample_stride + 4] = static_cast<std::byte>(10 * (s + 1));
  }
  VkImageResolve region{};
  region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  region.extent = {3, 1, 1};
  resolve_image(image.get(), result.get(), region);
  EXPECT_EQ(result.memory[4], std::byte{25});
  EXPECT_EQ(result.memory[0], std::byte{0});
}

}  // namespace
}  // namespace vitrine::texel

// Transfers: copies keep every block, clears fill what they name and nothing else, resolves average.
#include "texel/transfer.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <vector>

#include "tests/simd_targets.h"
#include "texel/capabilities.h"
#include "texel/transfer/blit.h"

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

/// Rows of any length end where they should: whatever is beside them stays.
TEST(Clear, RowsOfAllLengths) {
  constexpr std::size_t kRows = 2;
  const std::vector<std::byte> random = random_bytes(16);
  StoredTexel value;
  std::memcpy(value.bytes.data(), random.data(), random.size());
  base::for_each_simd_target([&] {
    for (const std::size_t block : {1, 2, 3, 4, 6, 8, 12, 16}) {
      for (std::size_t length = block; length <= 600; length += block) {
        const std::size_t pitch = length + 5;
        std::vector<std::byte> filled(kRows * pitch + 1, std::byte{0xee});
        std::vector<std::byte> expected = filled;
        for (std::size_t row = 0; row < kRows; ++row)
          for (std::size_t i = 0; i < length; ++i) expected[1 + row * pitch + i] = value.bytes[i % block];
        fill_rows(filled.data() + 1, pitch, length, kRows, value, block);
        ASSERT_EQ(filled, expected) << "texels of " << block << " bytes, rows of " << length;
      }
    }
  });
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

TEST(Resolve, ReducesDepthOf24BitsExactly) {
  TestImage image(VK_FORMAT_X8_D24_UNORM_PACK32, {3, 1, 1}, 1, 1, 4);
  TestImage result(VK_FORMAT_X8_D24_UNORM_PACK32, {3, 1, 1});
  const auto view_of = [](TestImage& of) {
    ImageViewDesc desc;
    desc.format = VK_FORMAT_X8_D24_UNORM_PACK32;
    desc.aspect = VK_IMAGE_ASPECT_DEPTH_BIT;
    return make_image_view(of.layout, of.memory.data(), desc);
  };
  const ImageView from = view_of(image), to = view_of(result);
  constexpr std::uint32_t kSamples[4] = {0xfffffe, 0xffffff, 0xfffffb, 0xffffff};
  for (std::uint32_t s = 0; s < 4; ++s) std::memcpy(from.block(0, 0, s, 1, 0, 0), &kSamples[s], 4);
  const auto resolved = [&](VkResolveModeFlagBits mode) {
    resolve_view(from, to, mode, {{1, 0}, {1, 1}}, 0, 1);
    std::uint32_t word;
    std::memcpy(&word, to.block(0, 0, 0, 1, 0, 0), 4);
    return word;
  };
  EXPECT_EQ(resolved(VK_RESOLVE_MODE_SAMPLE_ZERO_BIT), 0xfffffeu);
  EXPECT_EQ(resolved(VK_RESOLVE_MODE_MIN_BIT), 0xfffffbu);
  EXPECT_EQ(resolved(VK_RESOLVE_MODE_MAX_BIT), 0xffffffu);
  EXPECT_EQ(resolved(VK_RESOLVE_MODE_AVERAGE_BIT), 0xfffffeu);  // 7/4 below the largest
}

constexpr VkFormat kBlitFormats[] = {
    VK_FORMAT_R8G8B8A8_UNORM,
    VK_FORMAT_B8G8R8A8_UNORM,
    VK_FORMAT_R8_UNORM,
    VK_FORMAT_R5G6B5_UNORM_PACK16,
    VK_FORMAT_R8G8B8A8_SRGB,
    VK_FORMAT_R8G8B8A8_SNORM,
    VK_FORMAT_R16G16B16A16_SFLOAT,
    VK_FORMAT_R32G32B32A32_SFLOAT,
    VK_FORMAT_R16_UNORM,
    VK_FORMAT_BC1_RGBA_UNORM_BLOCK,
    VK_FORMAT_A2B10G10R10_UNORM_PACK32,
    VK_FORMAT_B10G11R11_UFLOAT_PACK32,
    VK_FORMAT_R8G8B8A8_UINT,
    VK_FORMAT_R32_UINT,
    VK_FORMAT_R16G16_SINT,
    VK_FORMAT_D32_SFLOAT,
    VK_FORMAT_D16_UNORM,
    VK_FORMAT_R16G16_SFLOAT,
    VK_FORMAT_R8G8_UNORM,
    VK_FORMAT_BC3_SRGB_BLOCK,
    VK_FORMAT_BC7_UNORM_BLOCK,
    VK_FORMAT_B5G6R5_UNORM_PACK16,
    VK_FORMAT_R4G4B4A4_UNORM_PACK16,
    VK_FORMAT_A2R10G10B10_UNORM_PACK32,
    VK_FORMAT_R8G8_SRGB,
#ifdef VK_VERSION_1_4
    VK_FORMAT_A8_UNORM,
    VK_FORMAT_A1B5G5R5_UNORM_PACK16,
#endif
};

/// Formats that are halved by way of bytes or values.
constexpr VkFormat kDecodedFormats[] = {
    VK_FORMAT_R8G8_UNORM,          VK_FORMAT_R16G16_SFLOAT, VK_FORMAT_R16_UNORM,  VK_FORMAT_R32G32_SFLOAT,
    VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R8_SNORM,      VK_FORMAT_R16_SFLOAT, VK_FORMAT_R5G6B5_UNORM_PACK16,
    VK_FORMAT_R16G16B16A16_SNORM,  VK_FORMAT_R8_SRGB,       VK_FORMAT_R32_SFLOAT, VK_FORMAT_B4G4R4A4_UNORM_PACK16};

/// Levels of mips, and other regions at half the size: rows against texels one by one, on every SIMD target.
void compare_halved(unsigned seed) {
  std::mt19937 random(seed);
  constexpr VkFormat kFormats[] = {VK_FORMAT_R8G8B8A8_UNORM,         VK_FORMAT_B8G8R8A8_UNORM,
                                   VK_FORMAT_R8G8B8A8_SRGB,          VK_FORMAT_B8G8R8A8_SRGB,
                                   VK_FORMAT_R16G16B16A16_SFLOAT,    VK_FORMAT_R8_UNORM,
                                   VK_FORMAT_B10G11R11_UFLOAT_PACK32};
  const FormatDesc& format = random() % 3 != 0 ? format_desc(kFormats[random() % std::size(kFormats)])
                                               : format_desc(kDecodedFormats[random() % std::size(kDecodedFormats)]);
  const auto size = [&] {
    return random() % 2 ? std::uint32_t{1} << random() % 8 : 1 + static_cast<std::uint32_t>(random() % 90);
  };
  const std::uint32_t width = size(), height = size();
  TestImage source(format.format, {2 * width, 2 * height, 1}, 1, 1), expected(format.format, {width, height, 1}, 1, 1);
  for (std::byte& b : source.memory) b = static_cast<std::byte>(random());
  const bool floats = format.channel[0].numeric == Numeric::kSfloat || format.channel[0].numeric == Numeric::kUfloat;
  for (std::size_t i = 1; floats && i < source.memory.size(); i += 2) source.memory[i] &= std::byte{0x3b};
  TestImage result = expected;
  VkImageBlit region{};
  region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  const auto extent = [](std::uint32_t w, std::uint32_t h) {
    return VkOffset3D{static_cast<std::int32_t>(w), static_cast<std::int32_t>(h), 1};
  };
  const std::uint32_t left = static_cast<std::uint32_t>(random()) % width;
  region.srcOffsets[0] = {static_cast<std::int32_t>(2 * left), 0, 0};
  region.srcOffsets[1] = extent(2 * width, 2 * height);
  region.dstOffsets[0] = {static_cast<std::int32_t>(left), 0, 0};
  region.dstOffsets[1] = extent(width, height);
  blit_image_by_texels(source.get(), expected.get(), region, VK_FILTER_LINEAR);
  blit_image(source.get(), result.get(), region, VK_FILTER_LINEAR);
  EXPECT_EQ(expected.memory, result.memory) << "seed " << seed << " " << format.name << " " << width << "x" << height;
}

/// One random blit: rows against texels one by one.
void compare_blits(unsigned seed) {
  std::mt19937 random(seed);
  const auto below = [&](std::uint32_t n) { return static_cast<std::int32_t>(random() % n); };
  const VkFormat from_format = kBlitFormats[random() % std::size(kBlitFormats)];
  VkFormat to_format = random() % 2 ? from_format : kBlitFormats[random() % std::size(kBlitFormats)];
  const FormatDesc &from = format_desc(from_format), &to = format_desc(to_format);
  if (!can_encode(to) || from.kind != to.kind || from.has_depth() != to.has_depth()) {
    to_format = from.has_depth() ? from_format : from.is_integer() ? VK_FORMAT_R32_UINT : VK_FORMAT_R8G8B8A8_UNORM;
    if (from.kind == Kind::kSint) to_format = VK_FORMAT_R16G16_SINT;
    if (from.kind == Kind::kUint) to_format = VK_FORMAT_R32_UINT;
  }
  TestImage source(from_format, {40, 30, 1}, 1, 2), expected(to_format, {90, 70, 1}, 1, 2);
  for (std::byte& b : source.memory) b = static_cast<std::byte>(random());
  const bool floats = from.channel[0].numeric == Numeric::kSfloat || from.channel[0].numeric == Numeric::kUfloat;
  for (std::size_t i = 1; floats && i < source.memory.size(); i += 2) source.memory[i] &= std::byte{0x3b};
  TestImage result = expected;
  VkImageBlit region{};
  const VkImageAspectFlags aspect = from.has_depth() ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
  region.srcSubresource = region.dstSubresource = {aspect, 0, 0, 2};
  const std::int32_t x = below(30), y = below(20), width = 1 + below(10), height = 1 + below(10);
  const bool whole = random() % 2;
  region.srcOffsets[0] = whole ? VkOffset3D{0, 0, 0} : VkOffset3D{x, y, 0};
  region.srcOffsets[1] = whole ? VkOffset3D{40, 30, 1} : VkOffset3D{x + width, y + height, 1};
  const std::int32_t to_x = below(20), to_y = below(20);
  region.dstOffsets[0] = {to_x, to_y, 0};
  region.dstOffsets[1] = {to_x + 1 + below(70), to_y + 1 + below(50), 1};
  if (random() % 6 == 0) {
    const VkOffset3D *a = region.srcOffsets, *b = region.dstOffsets;
    region.dstOffsets[1] = {b[0].x + a[1].x - a[0].x, b[0].y + a[1].y - a[0].y, 1};
  }
  if (random() % 4 == 0) std::swap(region.srcOffsets[0].x, region.srcOffsets[1].x);
  if (random() % 4 == 0) std::swap(region.dstOffsets[0].y, region.dstOffsets[1].y);
  const VkFilter filter = random() % 2 ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
  blit_image_by_texels(source.get(), expected.get(), region, filter);
  blit_image(source.get(), result.get(), region, filter);
  EXPECT_EQ(expected.memory, result.memory)
      << "seed " << seed << " " << from.name << " to " << format_desc(to_format).name << " filter " << filter;
}

TEST(Blit, RowsEqualTexelsOneByOne) {
  for (unsigned seed = 0; seed < 400 && !testing::Test::HasFailure(); ++seed) compare_blits(seed);
}

/// Fields of a word in another order: `from` of [first bit, bits] each become `to`, least significant first.
std::uint32_t reorder(std::uint32_t word, std::initializer_list<std::pair<std::uint32_t, std::uint32_t>> fields) {
  std::uint32_t result = 0, at = 0;
  for (const auto& [first, bits] : fields) {
    result |= (word >> first & ((1u << bits) - 1)) << at;
    at += bits;
  }
  return result;
}

std::vector<std::byte> blitted(TestImage& source, VkFormat to, VkFilter filter) {
  TestImage result(to, {33, 9, 1}, 1, 1);
  VkImageBlit region{};
  region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  region.srcOffsets[1] = {20, 14, 1};
  region.dstOffsets[1] = {33, 9, 1};
  blit_image(source.get(), result.get(), region, filter);
  return result.memory;
}

/// Formats that the reference does not blit to, as the ones with the same fields that it does.
TEST(Blit, FormatsOfTheSameFieldsGetTheSameCodes) {
  TestImage source(VK_FORMAT_R32G32B32A32_SFLOAT, {20, 14, 1}, 1, 1);
  std::mt19937 random(5);
  for (std::size_t i = 0; i < source.memory.size(); i += 4) {
    const float value = static_cast<float>(random() % 4096) / 3000.0f - 0.2f;
    std::memcpy(&source.memory[i], &value, sizeof(value));
  }
  struct Row {
    VkFormat format, peer;
    std::uint32_t (*reordered)(std::uint32_t);
  };
  constexpr Row kRows[] = {
      {VK_FORMAT_B5G6R5_UNORM_PACK16, VK_FORMAT_R5G6B5_UNORM_PACK16,
       [](std::uint32_t w) {
         return reorder(w, {{11, 5}, {5, 6}, {0, 5}});
       }},
      {VK_FORMAT_R4G4B4A4_UNORM_PACK16, VK_FORMAT_B4G4R4A4_UNORM_PACK16,
       [](std::uint32_t w) {
         return reorder(w, {{0, 4}, {12, 4}, {8, 4}, {4, 4}});
       }},
      {VK_FORMAT_A2R10G10B10_UNORM_PACK32, VK_FORMAT_A2B10G10R10_UNORM_PACK32,
       [](std::uint32_t w) {
         return reorder(w, {{20, 10}, {10, 10}, {0, 10}, {30, 2}});
       }},
#ifdef VK_VERSION_1_4
      {VK_FORMAT_A1B5G5R5_UNORM_PACK16, VK_FORMAT_A1R5G5B5_UNORM_PACK16,
       [](std::uint32_t w) {
         return reorder(w, {{10, 5}, {5, 5}, {0, 5}, {15, 1}});
       }},
#endif
  };
  for (const Row& row : kRows) {
    for (const VkFilter filter : {VK_FILTER_NEAREST, VK_FILTER_LINEAR}) {
      const std::vector<std::byte> result = blitted(source, row.format, filter),
                                   peer = blitted(source, row.peer, filter);
      const std::size_t bytes = format_desc(row.format).block_bytes;
      ASSERT_EQ(result.size(), peer.size());
      for (std::size_t i = 0; i < result.size(); i += bytes) {
        std::uint32_t a = 0, b = 0;
        std::memcpy(&a, &result[i], bytes);
        std::memcpy(&b, &peer[i], bytes);
        ASSERT_EQ(row.reordered(a), b) << format_desc(row.format).name << " filter " << filter;
      }
    }
  }
}

TEST(Blit, HalvedRowsEqualTexelsOneByOne) {
  base::for_each_simd_target([] {
    for (unsigned seed = 0; seed < 300 && !testing::Test::HasFailure(); ++seed) compare_halved(seed);
  });
}

}  // namespace
}  // namespace vitrine::texel

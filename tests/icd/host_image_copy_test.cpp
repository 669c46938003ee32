// VK_EXT_host_image_copy, which neither older headers nor the reference know: copies that the host makes give the bytes
// that commands give. What the tool sync makes of them is sync_images_test.cpp's.
#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "glass/pixel/pixels.h"
#include "icd/object/image.h"
#include "tests/icd/maintenance5_fixture.h"

#ifdef VK_KHR_maintenance6
namespace vitrine::icd::test {
namespace {

#define VK_CALL(name) VK_GET(instance, name)

/// A part of an image, and how the host's memory is laid out around it, in texels.
struct Part {
  const char* name;
  VkImageType type;
  VkFormat format;
  VkExtent3D extent;  ///< of the image
  std::uint32_t levels, layers;
  VkImageSubresourceLayers where;
  VkOffset3D offset;
  VkExtent3D copied;
  std::uint32_t row_length, height;
  std::uint32_t block_bytes, block;  ///< texels of a block in each direction
};

constexpr std::uint32_t kAll = VK_REMAINING_ARRAY_LAYERS;
constexpr Part kParts[] = {
    {"colour",
     VK_IMAGE_TYPE_2D,
     VK_FORMAT_R8G8B8A8_UNORM,
     {37, 19, 1},
     1,
     1,
     {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
     {3, 5, 0},
     {20, 9, 1},
     0,
     0,
     4,
     1},
    {"rows",
     VK_IMAGE_TYPE_2D,
     VK_FORMAT_R16G16_SFLOAT,
     {37, 19, 1},
     1,
     1,
     {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
     {0, 0, 0},
     {37, 19, 1},
     41,
     23,
     4,
     1},
    {"layers_of_a_level",
     VK_IMAGE_TYPE_2D,
     VK_FORMAT_R8_UNORM,
     {32, 32, 1},
     3,
     5,
     {VK_IMAGE_ASPECT_COLOR_BIT, 1, 2, kAll},
     {1, 2, 0},
     {13, 11, 1},
     15,
     12,
     1,
     1},
    {"slices",
     VK_IMAGE_TYPE_3D,
     VK_FORMAT_R32G32B32A32_SFLOAT,
     {9, 7, 6},
     2,
     1,
     {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
     {1, 1, 2},
     {7, 5, 3},
     8,
     7,
     16,
     1},
    {"line",
     VK_IMAGE_TYPE_1D,
     VK_FORMAT_R8G8_UINT,
     {100, 1, 1},
     1,
     3,
     {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 2},
     {10, 0, 0},
     {70, 1, 1},
     0,
     0,
     2,
     1},
    {"blocks",
     VK_IMAGE_TYPE_2D,
     VK_FORMAT_BC1_RGBA_UNORM_BLOCK,
     {30, 18, 1},
     2,
     1,
     {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
     {8, 4, 0},
     {22, 14, 1},
     32,
     0,
     8,
     4},
    {"depth",
     VK_IMAGE_TYPE_2D,
     VK_FORMAT_D32_SFLOAT_S8_UINT,
     {17, 13, 1},
     1,
     1,
     {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 0, 1},
     {2, 1, 0},
     {12, 9, 1},
     0,
     0,
     4,
     1},
    {"stencil",
     VK_IMAGE_TYPE_2D,
     VK_FORMAT_D32_SFLOAT_S8_UINT,
     {17, 13, 1},
     1,
     1,
     {VK_IMAGE_ASPECT_STENCIL_BIT, 0, 0, 1},
     {2, 1, 0},
     {12, 9, 1},
     14,
     10,
     1,
     1},
    {"plane",
     VK_IMAGE_TYPE_2D,
     VK_FORMAT_G8_B8R8_2PLANE_420_UNORM,
     {24, 16, 1},
     1,
     1,
     {VK_IMAGE_ASPECT_PLANE_1_BIT, 0, 0, 1},
     {2, 2, 0},
     {10, 6, 1},
     0,
     0,
     2,
     1},
};

class HostCopyDevice : public Maintenance5Device {
 protected:
  void TearDown() override {
    for (const VkImage image : images) VK_CALL(DestroyImage)(device, image, nullptr);
    for (const VkDeviceMemory m : memories) VK_CALL(FreeMemory)(device, m, nullptr);
    Maintenance5Device::TearDown();
  }

  /// In GENERAL by the host's own transition.
  VkImage make_image(const Part& part) {
    auto info = image_info(part.type, part.format, part.extent, part.layers);
    info.mipLevels = part.levels;
    info.usage |= VK_IMAGE_USAGE_HOST_TRANSFER_BIT_EXT;
    VkImage image = VK_NULL_HANDLE;
    EXPECT_EQ(VK_CALL(CreateImage)(device, &info, nullptr, &image), VK_SUCCESS);
    VkMemoryRequirements needed;
    VK_CALL(GetImageMemoryRequirements)(device, image, &needed);
    std::byte* data = nullptr;
    const VkDeviceMemory memory = map(needed.size, data);
    std::memset(data, 0x11, needed.size);
    EXPECT_EQ(VK_CALL(BindImageMemory)(device, image, memory, 0), VK_SUCCESS);
    auto transition = make_struct<VkHostImageLayoutTransitionInfoEXT>();
    transition.image = image;
    transition.newLayout = VK_IMAGE_LAYOUT_GENERAL;
    transition.subresourceRange = {part.where.aspectMask, 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS};
    EXPECT_EQ(VK_CALL(TransitionImageLayoutEXT)(device, 1, &transition), VK_SUCCESS);
    images.push_back(image);
    memories.push_back(memory);
    return image;
  }

  static std::size_t bytes_of(const Part& part) {
    const auto blocks = [&](std::uint32_t texels) { return std::size_t{(texels + part.block - 1) / part.block}; };
    const std::uint32_t layers =
        part.where.layerCount == kAll ? part.layers - part.where.baseArrayLayer : part.where.layerCount;
    return blocks(std::max(part.row_length, part.copied.width)) * blocks(std::max(part.height, part.copied.height)) *
           std::max(part.copied.depth, layers) * part.block_bytes;
  }

  static std::vector<std::byte> noise(std::size_t size, std::uint32_t seed) {
    std::vector<std::byte> out(size);
    for (std::size_t i = 0; i < size; ++i) out[i] = static_cast<std::byte>((i + seed) * 2654435761u >> 13);
    return out;
  }

  template <class Region>
  static Region region_of(const Part& part) {
    auto region = make_struct<Region>();
    region.imageSubresource = part.where;
    region.imageOffset = part.offset;
    region.imageExtent = part.copied;
    if constexpr (requires { region.memoryRowLength; }) {
      region.memoryRowLength = part.row_length;
      region.memoryImageHeight = part.height;
    } else {
      region.bufferRowLength = part.row_length;
      region.bufferImageHeight = part.height;
    }
    return region;
  }

  void put(VkImage image, const Part& part, const std::vector<std::byte>& bytes, VkHostImageCopyFlagsEXT flags = 0) {
    auto region = region_of<VkMemoryToImageCopyEXT>(part);
    region.pHostPointer = bytes.data();
    auto info = make_struct<VkCopyMemoryToImageInfoEXT>();
    info.flags = flags;
    info.dstImage = image;
    info.dstImageLayout = VK_IMAGE_LAYOUT_GENERAL;
    info.regionCount = 1;
    info.pRegions = &region;
    EXPECT_EQ(VK_CALL(CopyMemoryToImageEXT)(device, &info), VK_SUCCESS);
  }

  std::vector<std::byte> get(VkImage image, const Part& part, std::size_t size, VkHostImageCopyFlagsEXT flags = 0) {
    std::vector<std::byte> bytes(size, std::byte{0x77});
    auto region = region_of<VkImageToMemoryCopyEXT>(part);
    region.pHostPointer = bytes.data();
    auto info = make_struct<VkCopyImageToMemoryInfoEXT>();
    info.flags = flags;
    info.srcImage = image;
    info.srcImageLayout = VK_IMAGE_LAYOUT_GENERAL;
    info.regionCount = 1;
    info.pRegions = &region;
    EXPECT_EQ(VK_CALL(CopyImageToMemoryEXT)(device, &info), VK_SUCCESS);
    return bytes;
  }

  VkImageCopy2 copy_images(VkImage from, VkImage to, const Part& part) {
    auto region = make_struct<VkImageCopy2>();
    region.srcSubresource = region.dstSubresource = part.where;
    region.srcOffset = region.dstOffset = part.offset;
    region.extent = part.copied;
    auto info = make_struct<VkCopyImageToImageInfoEXT>();
    info.srcImage = from;
    info.dstImage = to;
    info.srcImageLayout = info.dstImageLayout = VK_IMAGE_LAYOUT_GENERAL;
    info.regionCount = 1;
    info.pRegions = &region;
    EXPECT_EQ(VK_CALL(CopyImageToImageEXT)(device, &info), VK_SUCCESS);
    return region;
  }

  std::vector<std::byte> get_by_command(VkImage image, const Part& part) {
    const Bytes buffer = make_bytes(bytes_of(part));
    std::memset(buffer.data, 0x77, buffer.size);
    run([&](VkCommandBuffer commands) {
      auto region = region_of<VkBufferImageCopy2>(part);
      auto info = make_struct<VkCopyImageToBufferInfo2>();
      info.srcImage = image;
      info.srcImageLayout = VK_IMAGE_LAYOUT_GENERAL;
      info.dstBuffer = buffer.buffer;
      info.regionCount = 1;
      info.pRegions = &region;
      VK_CALL(CmdCopyImageToBuffer2)(commands, &info);
    });
    return {buffer.data, buffer.data + buffer.size};
  }

  void put_by_command(VkImage image, const Part& part, const std::vector<std::byte>& bytes) {
    const Bytes buffer = make_bytes(bytes.size());
    std::copy(bytes.begin(), bytes.end(), buffer.data);
    run([&](VkCommandBuffer commands) {
      auto region = region_of<VkBufferImageCopy2>(part);
      auto info = make_struct<VkCopyBufferToImageInfo2>();
      info.srcBuffer = buffer.buffer;
      info.dstImage = image;
      info.dstImageLayout = VK_IMAGE_LAYOUT_GENERAL;
      info.regionCount = 1;
      info.pRegions = &region;
      VK_CALL(CmdCopyBufferToImage2)(commands, &info);
    });
  }

  /// The whole level of a layer, packed.
  static Part whole(const Part& part) {
    Part all = part;
    const std::uint32_t level = part.where.mipLevel;
    const std::uint32_t shrink = part.where.aspectMask == VK_IMAGE_ASPECT_PLANE_1_BIT ? 2 : 1;
    all.where.layerCount = 1;
    all.offset = {};
    all.copied = {std::max(1u, part.extent.width >> level) / shrink, std::max(1u, part.extent.height >> level) / shrink,
                  std::max(1u, part.extent.depth >> level)};
    if (part.type == VK_IMAGE_TYPE_1D) all.copied.height = 1;
    all.row_length = all.height = 0;
    return all;
  }

  std::vector<VkImage> images;
  std::vector<VkDeviceMemory> memories;
};

class HostImageCopy : public HostCopyDevice, public ::testing::WithParamInterface<Part> {};

TEST_P(HostImageCopy, GivesWhatCommandsGive) {
  const Part& part = GetParam();
  const auto texels = noise(bytes_of(part), 1);
  const VkImage by_host = make_image(part), by_command = make_image(part);
  put(by_host, part, texels);
  put_by_command(by_command, part, texels);
  const auto read = get_by_command(by_host, part);
  EXPECT_EQ(read, get_by_command(by_command, part));
  EXPECT_EQ(get(by_host, part, bytes_of(part)), read) << "also what lies between rows is left alone";
  EXPECT_NE(read, std::vector<std::byte>(read.size(), std::byte{0x77}));
  // Nothing else has changed.
  const Part all = whole(part);
  EXPECT_EQ(get_by_command(by_host, all), get_by_command(by_command, all));
}

TEST_P(HostImageCopy, CopiesBetweenImages) {
  const Part& part = GetParam();
  const VkImage from = make_image(part), to = make_image(part), by_command = make_image(part);
  put(from, part, noise(bytes_of(part), 2));
  const VkImageCopy2 region = copy_images(from, to, part);
  run([&](VkCommandBuffer commands) {
    auto command = make_struct<VkCopyImageInfo2>();
    command.srcImage = from;
    command.dstImage = by_command;
    command.srcImageLayout = command.dstImageLayout = VK_IMAGE_LAYOUT_GENERAL;
    command.regionCount = 1;
    command.pRegions = &region;
    VK_CALL(CmdCopyImage2)(commands, &command);
  });
  const Part all = whole(part);
  const auto read = get_by_command(to, all);
  EXPECT_EQ(read, get_by_command(by_command, all));
  EXPECT_EQ(get_by_command(to, part), get_by_command(from, part));
  EXPECT_NE(get_by_command(to, part), get_by_command(make_image(part), part));
}

/// As it is on the device: as long as vkGetImageSubresourceLayout2 says, and good for another image of the same
/// parameters.
TEST_P(HostImageCopy, KeepsTheDevicesArrangement) {
  const Part all = whole(GetParam());
  const VkImage from = make_image(all), to = make_image(all);
  put(from, all, noise(bytes_of(all), 3));
  auto size = make_struct<VkSubresourceHostMemcpySizeEXT>();
  auto layout = make_struct<VkSubresourceLayout2KHR>(&size);
  auto subresource = make_struct<VkImageSubresource2KHR>();
  subresource.imageSubresource = {all.where.aspectMask, all.where.mipLevel, all.where.baseArrayLayer};
  VK_CALL(GetImageSubresourceLayout2KHR)(device, from, &subresource, &layout);
  EXPECT_EQ(size.size, bytes_of(all));
  const auto kept = get(from, all, static_cast<std::size_t>(size.size), VK_HOST_IMAGE_COPY_MEMCPY_EXT);
  put(to, all, kept, VK_HOST_IMAGE_COPY_MEMCPY_EXT);
  EXPECT_EQ(get_by_command(to, all), get_by_command(from, all));
}

INSTANTIATE_TEST_SUITE_P(Parts, HostImageCopy, ::testing::ValuesIn(kParts),
                         [](const auto& info) { return std::string(info.param.name); });

using HostImageCopyClaims = Maintenance5Device;

TEST_F(HostImageCopyClaims, LayoutsAreListed) {
  auto features = make_struct<VkPhysicalDeviceHostImageCopyFeaturesEXT>();
  auto all = make_struct<VkPhysicalDeviceFeatures2>(&features);
  VK_CALL(GetPhysicalDeviceFeatures2)(physical_device, &all);
  EXPECT_TRUE(features.hostImageCopy);
  auto properties = make_struct<VkPhysicalDeviceHostImageCopyPropertiesEXT>();
  auto whole = make_struct<VkPhysicalDeviceProperties2>(&properties);
  VK_CALL(GetPhysicalDeviceProperties2)(physical_device, &whole);
  EXPECT_TRUE(properties.identicalMemoryTypeRequirements);
  const std::uint32_t sources = properties.copySrcLayoutCount, targets = properties.copyDstLayoutCount;
  ASSERT_GT(sources, 1u);
  ASSERT_GT(targets, 1u);
  std::vector<VkImageLayout> from(sources, VK_IMAGE_LAYOUT_MAX_ENUM), to(targets, VK_IMAGE_LAYOUT_MAX_ENUM);
  properties.pCopySrcLayouts = from.data();
  properties.pCopyDstLayouts = to.data();
  properties.copyDstLayoutCount = 1;
  VK_CALL(GetPhysicalDeviceProperties2)(physical_device, &whole);
  EXPECT_EQ(properties.copySrcLayoutCount, sources);
  EXPECT_EQ(properties.copyDstLayoutCount, 1u);
  EXPECT_EQ(properties.pCopySrcLayouts, from.data());
  EXPECT_EQ(std::count(from.begin(), from.end(), VK_IMAGE_LAYOUT_GENERAL), 1);
  EXPECT_EQ(std::count(from.begin(), from.end(), VK_IMAGE_LAYOUT_MAX_ENUM), 0);
  EXPECT_NE(to[0], VK_IMAGE_LAYOUT_MAX_ENUM);
  EXPECT_EQ(to[1], VK_IMAGE_LAYOUT_MAX_ENUM) << "more than was asked for";
}

/// Vulkan 1.4.309, Required Format Support: where colours can be sampled the host can copy; and Image Format
/// Properties: with that usage the answers are those without it.
TEST_F(HostImageCopyClaims, WhatCanBeSampledTheHostCanCopy) {
  std::uint32_t seen = 0;
  for (int value = 1; value < 200; ++value) {
    const auto format = static_cast<VkFormat>(value);
    auto wide = make_struct<VkFormatProperties3>();
    auto properties = make_struct<VkFormatProperties2>(&wide);
    VK_CALL(GetPhysicalDeviceFormatProperties2)(physical_device, format, &properties);
    for (const VkFormatFeatureFlags2 features : {wide.linearTilingFeatures, wide.optimalTilingFeatures}) {
      EXPECT_EQ((features & VK_FORMAT_FEATURE_2_SAMPLED_IMAGE_BIT) != 0,
                (features & VK_FORMAT_FEATURE_2_HOST_IMAGE_TRANSFER_BIT_EXT) != 0)
          << value;
    }
    EXPECT_FALSE(wide.bufferFeatures & VK_FORMAT_FEATURE_2_HOST_IMAGE_TRANSFER_BIT_EXT);
    if (!(wide.optimalTilingFeatures & VK_FORMAT_FEATURE_2_SAMPLED_IMAGE_BIT)) continue;
    ++seen;
    auto info = make_struct<VkPhysicalDeviceImageFormatInfo2>();
    info.format = format;
    info.type = VK_IMAGE_TYPE_2D;
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
    auto without = make_struct<VkImageFormatProperties2>();
    EXPECT_EQ(VK_CALL(GetPhysicalDeviceImageFormatProperties2)(physical_device, &info, &without), VK_SUCCESS);
    info.usage |= VK_IMAGE_USAGE_HOST_TRANSFER_BIT_EXT;
    auto query = make_struct<VkHostImageCopyDevicePerformanceQueryEXT>();
    auto with = make_struct<VkImageFormatProperties2>(&query);
    EXPECT_EQ(VK_CALL(GetPhysicalDeviceImageFormatProperties2)(physical_device, &info, &with), VK_SUCCESS);
    EXPECT_EQ(std::memcmp(&without.imageFormatProperties, &with.imageFormatProperties, sizeof(VkImageFormatProperties)),
              0);
    EXPECT_TRUE(query.optimalDeviceAccess);
    EXPECT_TRUE(query.identicalMemoryLayout);
  }
  EXPECT_GT(seen, 100u);
}

/// The tool pixel watches texel (10, 6) of all images: inside of what is copied.
TEST_F(HostCopyDevice, HistoriesOfTexelsTellOfIt) {
  glass::pixel::Pixels* const pixels = glass::pixel::pixels();
  if (!pixels) GTEST_SKIP() << "needs VITRINE_TOOLS=pixel";
  Part part = kParts[0];
  const VkImage from = make_image(part), to = make_image(part);
  put(from, part, noise(bytes_of(part), 3));
  copy_images(from, to, part);
  part.offset.x = 11;  // beside the texel
  part.copied.width = 4;
  put(to, part, noise(bytes_of(part), 4));
  const auto watched = [&](VkImage image) {
    const auto texels = pixels->texels_of(&from_handle<Image>(image));
    EXPECT_EQ(texels.size(), 1u);
    return texels.front();
  };
  const glass::pixel::Texel &source = *watched(from), &target = *watched(to);
  ASSERT_EQ(source.events.size(), 1u);
  EXPECT_EQ(source.events[0].kind, glass::pixel::EventKind::kUpload);
  EXPECT_EQ(source.events[0].address.command_name, "vkCopyMemoryToImage");
  EXPECT_EQ(source.events[0].after, source.read());
  EXPECT_NE(source.events[0].after, source.events[0].before);
  ASSERT_EQ(target.events.size(), 1u);
  EXPECT_EQ(target.events[0].kind, glass::pixel::EventKind::kCopy);
  EXPECT_EQ(target.events[0].address.command_name, "vkCopyImageToImage");
  EXPECT_EQ(target.events[0].after, source.read());
  ASSERT_EQ(target.events[0].sources.size(), 1u);
  EXPECT_EQ(target.events[0].sources[0].texel, source.id);
}

}  // namespace
}  // namespace vitrine::icd::test
#endif

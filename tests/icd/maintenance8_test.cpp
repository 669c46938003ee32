// VK_KHR_maintenance8, which neither older headers nor the reference know: copies between colours and depth or stencil,
// blits between slices and layers, caches that are merged while they are used, and what barriers may say. Offsets of
// lookups are newer_words_test.cpp's.
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "glass/pixel/pixels.h"
#include "tests/icd/maintenance5_fixture.h"

#ifdef VK_KHR_maintenance8
namespace vitrine::icd::test {
namespace {

#define VK_CALL(name) VK_GET(instance, name)

constexpr VkExtent3D kExtent{21, 13, 1};
constexpr VkImageAspectFlags kColor = VK_IMAGE_ASPECT_COLOR_BIT, kDepth = VK_IMAGE_ASPECT_DEPTH_BIT,
                             kStencil = VK_IMAGE_ASPECT_STENCIL_BIT;

class Maintenance8 : public Maintenance5Device {
 protected:
  Picture flat(VkFormat format, VkImageAspectFlags aspect) {
    return make_picture(VK_IMAGE_TYPE_2D, format, kExtent, 1, VK_SAMPLE_COUNT_1_BIT, aspect);
  }

  /// The same region of both, by one copy.
  void copy(const Picture& from, VkImageAspectFlags source, const Picture& to, VkImageAspectFlags target) {
    auto region = make_struct<VkImageCopy2>();
    region.srcSubresource = {source, 0, 0, 1};
    region.dstSubresource = {target, 0, 0, 1};
    region.srcOffset = {3, 2, 0};
    region.dstOffset = {1, 4, 0};
    region.extent = {17, 9, 1};
    auto info = make_struct<VkCopyImageInfo2>();
    info.srcImage = from.image;
    info.dstImage = to.image;
    info.srcImageLayout = info.dstImageLayout = VK_IMAGE_LAYOUT_GENERAL;
    info.regionCount = 1;
    info.pRegions = &region;
    run([&](VkCommandBuffer commands) { VK_CALL(CmdCopyImage2)(commands, &info); });
  }

  /// The same through a buffer, as it is done without the extension.
  void copy_through_buffer(const Picture& from, VkImageAspectFlags source, const Picture& to,
                           VkImageAspectFlags target) {
    const Bytes between = make_bytes(17 * 9 * 4);
    VkBufferImageCopy out{}, in{};
    out.imageSubresource = {source, 0, 0, 1};
    out.imageOffset = {3, 2, 0};
    in.imageSubresource = {target, 0, 0, 1};
    in.imageOffset = {1, 4, 0};
    out.imageExtent = in.imageExtent = {17, 9, 1};
    run([&](VkCommandBuffer commands) {
      VK_CALL(CmdCopyImageToBuffer)(commands, from.image, VK_IMAGE_LAYOUT_GENERAL, between.buffer, 1, &out);
      VK_CALL(CmdCopyBufferToImage)(commands, between.buffer, to.image, VK_IMAGE_LAYOUT_GENERAL, 1, &in);
    });
  }

  static std::vector<std::byte> bytes_of(const Picture& picture) { return {picture.data, picture.data + picture.size}; }
};

TEST_F(Maintenance8, IsOffered) {
  auto features = make_struct<VkPhysicalDeviceMaintenance8FeaturesKHR>();
  auto all = make_struct<VkPhysicalDeviceFeatures2>(&features);
  VK_CALL(GetPhysicalDeviceFeatures2)(physical_device, &all);
  EXPECT_TRUE(features.maintenance8);
}

/// Vulkan 1.4.309, Compatible Formats for Depth-Stencil to/from Color Copies: the whole list.
TEST_F(Maintenance8, ColoursAreCopiedToDepthAndStencilAndBack) {
  struct Pairs {
    VkImageAspectFlags aspect;
    std::vector<VkFormat> planes, colors;
  };
  const Pairs pairs[] = {
      {kDepth,
       {VK_FORMAT_D32_SFLOAT, VK_FORMAT_D32_SFLOAT_S8_UINT, VK_FORMAT_X8_D24_UNORM_PACK32, VK_FORMAT_D24_UNORM_S8_UINT},
       {VK_FORMAT_R32_SFLOAT, VK_FORMAT_R32_SINT, VK_FORMAT_R32_UINT}},
      {kDepth,
       {VK_FORMAT_D16_UNORM, VK_FORMAT_D16_UNORM_S8_UINT},
       {VK_FORMAT_R16_SFLOAT, VK_FORMAT_R16_UNORM, VK_FORMAT_R16_SNORM, VK_FORMAT_R16_UINT, VK_FORMAT_R16_SINT}},
      {kStencil,
       {VK_FORMAT_S8_UINT, VK_FORMAT_D16_UNORM_S8_UINT, VK_FORMAT_D24_UNORM_S8_UINT, VK_FORMAT_D32_SFLOAT_S8_UINT},
       {VK_FORMAT_R8_UINT, VK_FORMAT_R8_SINT, VK_FORMAT_R8_UNORM, VK_FORMAT_R8_SNORM}}};
  std::uint32_t seen = 0;
  for (const Pairs& pair : pairs)
    for (const VkFormat plane : pair.planes) {
      VkFormatProperties offered;
      VK_CALL(GetPhysicalDeviceFormatProperties)(physical_device, plane, &offered);
      if ((offered.optimalTilingFeatures & VK_FORMAT_FEATURE_TRANSFER_DST_BIT) == 0) continue;
      for (const VkFormat color : pair.colors) {
        const Picture source = flat(color, kColor);
        const Picture direct = flat(plane, pair.aspect), detour = flat(plane, pair.aspect);
        const auto before = bytes_of(direct);
        fill(source, static_cast<std::uint32_t>(color));
        copy(source, kColor, direct, pair.aspect);
        copy_through_buffer(source, kColor, detour, pair.aspect);
        EXPECT_EQ(bytes_of(direct), bytes_of(detour)) << color << " to " << plane;
        EXPECT_NE(bytes_of(direct), before);
        const Picture back = flat(color, kColor), other = flat(color, kColor);
        copy(direct, pair.aspect, back, kColor);
        copy_through_buffer(direct, pair.aspect, other, kColor);
        EXPECT_EQ(bytes_of(back), bytes_of(other)) << plane << " to " << color;
        EXPECT_NE(bytes_of(back), std::vector<std::byte>(back.size)) << plane;
        ++seen;
      }
    }
  EXPECT_GE(seen, 20u);
}

/// A slice of a volume to a layer of an array that is not the first, and back, scaled or not: as from and to images
/// that have nothing but them.
TEST_F(Maintenance8, SlicesAreBlittedToLayersAndBack) {
  constexpr VkFormat kFormat = VK_FORMAT_R8G8B8A8_UNORM;
  constexpr std::uint32_t kSlice = 3, kLayer = 2;
  const auto blit = [&](const Picture& from, const Picture& to, VkImageBlit region, VkExtent2D size, VkFilter filter) {
    region.srcSubresource.aspectMask = region.dstSubresource.aspectMask = kColor;
    region.srcSubresource.layerCount = region.dstSubresource.layerCount = 1;
    region.srcOffsets[0].x = 1;
    region.srcOffsets[1].x = 16;
    region.srcOffsets[1].y = 13;
    region.dstOffsets[1].x = static_cast<std::int32_t>(size.width);
    region.dstOffsets[1].y = static_cast<std::int32_t>(size.height);
    run([&](VkCommandBuffer commands) {
      VK_CALL(CmdBlitImage)
      (commands, from.image, VK_IMAGE_LAYOUT_GENERAL, to.image, VK_IMAGE_LAYOUT_GENERAL, 1, &region, filter);
    });
  };
  const auto rows = [](const Picture& picture, std::uint32_t slice) {
    std::vector<std::byte> out;
    for (std::uint32_t y = 0; y < kExtent.height; ++y)
      out.insert(out.end(), picture.row(slice, y), picture.row(slice, y) + kExtent.width * 4);
    return out;
  };
  const VkExtent3D volume_extent{kExtent.width, kExtent.height, 5};
  for (const VkFormat other : {kFormat, VK_FORMAT_B8G8R8A8_UNORM})
    for (const VkExtent2D size : {VkExtent2D{15, 13}, VkExtent2D{20, 7}})
      for (const VkFilter filter : {VK_FILTER_NEAREST, VK_FILTER_LINEAR}) {
        if (filter == VK_FILTER_LINEAR && size.width != 15) continue;  // nothing lies between the texels
        const Picture volume = make_picture(VK_IMAGE_TYPE_3D, kFormat, volume_extent, 1);
        const Picture array = make_picture(VK_IMAGE_TYPE_2D, other, kExtent, 4);
        const Picture alone = flat(kFormat, kColor), flat_target = flat(other, kColor);
        fill(volume, 5);
        for (std::uint32_t y = 0; y < kExtent.height; ++y)
          std::memcpy(alone.row(0, y), volume.row(kSlice, y), kExtent.width * 4);
        const auto untouched = rows(array, 0);
        VkImageBlit region{}, plain{};
        plain.srcOffsets[1].z = plain.dstOffsets[1].z = 1;
        region.srcOffsets[0].z = kSlice;
        region.srcOffsets[1].z = kSlice + 1;
        region.dstOffsets[1].z = 1;
        region.dstSubresource.baseArrayLayer = kLayer;
        blit(volume, array, region, size, filter);
        blit(alone, flat_target, plain, size, filter);
        EXPECT_EQ(rows(array, kLayer), rows(flat_target, 0)) << other << ", " << size.width;
        EXPECT_NE(rows(array, kLayer), untouched);
        for (const std::uint32_t layer : {0u, 1u, 3u}) EXPECT_EQ(rows(array, layer), untouched);

        const Picture other_volume = make_picture(VK_IMAGE_TYPE_3D, kFormat, volume_extent, 1);
        const Picture result = flat(kFormat, kColor);
        VkImageBlit back{};
        back.srcSubresource.baseArrayLayer = kLayer;
        back.srcOffsets[1].z = 1;
        back.dstOffsets[0].z = kSlice;
        back.dstOffsets[1].z = kSlice + 1;
        blit(array, other_volume, back, size, filter);
        blit(flat_target, result, plain, size, filter);
        EXPECT_EQ(rows(other_volume, kSlice), rows(result, 0)) << other << ", " << size.width;
        EXPECT_NE(rows(other_volume, kSlice), untouched);
        for (const std::uint32_t slice : {0u, 1u, 2u, 4u}) EXPECT_EQ(rows(other_volume, slice), untouched);
      }
}

/// Where VITRINE_TOOLS=pixel is on, with VITRINE_PIXEL for layer 2 and slice 3 (tests/CMakeLists.txt).
class VolumeBlitTexels : public Maintenance8 {
 protected:
  void SetUp() override {
    if (!std::getenv("VITRINE_PIXEL")) GTEST_SKIP() << "needs VITRINE_TOOLS=pixel";
    Maintenance8::SetUp();
  }
  void TearDown() override {
    if (device) Maintenance8::TearDown();
  }
};

TEST_F(VolumeBlitTexels, ComeFromTheSliceAndTheLayer) {
  const Picture volume = make_picture(VK_IMAGE_TYPE_3D, VK_FORMAT_R8G8B8A8_UNORM, {8, 8, 5}, 1);
  const Picture array = make_picture(VK_IMAGE_TYPE_2D, VK_FORMAT_R8G8B8A8_UNORM, {8, 8, 1}, 4);
  VkImageBlit in{}, out{};
  in.srcSubresource = out.srcSubresource = in.dstSubresource = out.dstSubresource = {kColor, 0, 0, 1};
  in.srcOffsets[1] = in.dstOffsets[1] = out.srcOffsets[1] = out.dstOffsets[1] = {8, 8, 1};
  in.dstSubresource.baseArrayLayer = out.srcSubresource.baseArrayLayer = 2;
  in.srcOffsets[0].z = out.dstOffsets[0].z = 3;
  in.srcOffsets[1].z = out.dstOffsets[1].z = 4;
  const auto blit = [&](const Picture& from, const Picture& to, const VkImageBlit& region) {
    run([&](VkCommandBuffer commands) {
      VK_CALL(CmdBlitImage)
      (commands, from.image, VK_IMAGE_LAYOUT_GENERAL, to.image, VK_IMAGE_LAYOUT_GENERAL, 1, &region, VK_FILTER_NEAREST);
    });
  };
  // Whether a texel comes from one of this layer and slice, and nothing from where nobody knows.
  const auto told = [](const std::string& source) {
    std::string text = glass::pixel::pixels()->to_json();
    std::erase_if(text, [](char c) { return c == ' ' || c == '\n'; });
    bool found = false;
    constexpr std::string_view kSources = "\"sources\":[";
    for (std::size_t at = 0; (at = text.find(kSources, at)) != std::string::npos; at += kSources.size())
      found |= text.substr(at, text.find('}', at) - at).find(source) != std::string::npos;
    return found && text.find("\"unknown\"") == std::string::npos;
  };
  blit(volume, array, in);
  EXPECT_TRUE(told("\"layer\":0,\"slice\":3")) << glass::pixel::pixels()->to_json();
  blit(array, volume, out);
  EXPECT_TRUE(told("\"layer\":2,\"slice\":0")) << glass::pixel::pixels()->to_json();
}

TEST_F(Maintenance8, CachesAreMergedByTwoThreads) {
  auto info = make_struct<VkPipelineCacheCreateInfo>();
  VkPipelineCache source = VK_NULL_HANDLE, target = VK_NULL_HANDLE;
  ASSERT_EQ(VK_CALL(CreatePipelineCache)(device, &info, nullptr, &source), VK_SUCCESS);
  info.flags = VK_PIPELINE_CACHE_CREATE_INTERNALLY_SYNCHRONIZED_MERGE_BIT_KHR;
  ASSERT_EQ(VK_CALL(CreatePipelineCache)(device, &info, nullptr, &target), VK_SUCCESS);
  const auto words = compile(VK_SHADER_STAGE_COMPUTE_BIT, "layout(local_size_x = 1) in; void main() {}");
  const auto layout_info = make_struct<VkPipelineLayoutCreateInfo>();
  VkPipelineLayout layout = VK_NULL_HANDLE;
  ASSERT_EQ(VK_CALL(CreatePipelineLayout)(device, &layout_info, nullptr, &layout), VK_SUCCESS);
  std::thread merging([&] {
    for (int i = 0; i < 100; ++i) EXPECT_EQ(VK_CALL(MergePipelineCaches)(device, target, 1, &source), VK_SUCCESS);
  });
  for (int i = 0; i < 20; ++i) {
    auto module = module_info(words);
    auto pipeline_info = make_struct<VkComputePipelineCreateInfo>();
    pipeline_info.stage = make_struct<VkPipelineShaderStageCreateInfo>(&module);
    pipeline_info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    pipeline_info.stage.pName = "main";
    pipeline_info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    EXPECT_EQ(VK_CALL(CreateComputePipelines)(device, target, 1, &pipeline_info, nullptr, &pipeline), VK_SUCCESS);
    VK_CALL(DestroyPipeline)(device, pipeline, nullptr);
  }
  merging.join();
  VK_CALL(DestroyPipelineLayout)(device, layout, nullptr);
  VK_CALL(DestroyPipelineCache)(device, source, nullptr);
  VK_CALL(DestroyPipelineCache)(device, target, nullptr);
}

/// There is one family of queues: what is transferred stays where it is, and stages order what they name as ever.
TEST_F(Maintenance8, BarriersHaveMoreAccessesAndStagesOfTransfers) {
  const Bytes from = make_bytes(64), between = make_bytes(64), to = make_bytes(64);
  for (std::size_t i = 0; i < 64; ++i) from.data[i] = static_cast<std::byte>(i + 1);
  run([&](VkCommandBuffer commands) {
    const VkBufferCopy whole{0, 0, 64};
    VK_CALL(CmdCopyBuffer)(commands, from.buffer, between.buffer, 1, &whole);
    auto more = make_struct<VkMemoryBarrierAccessFlags3KHR>();
    more.srcAccessMask3 = more.dstAccessMask3 = VK_ACCESS_3_NONE_KHR;
    auto barrier = make_struct<VkBufferMemoryBarrier2>(&more);
    barrier.srcStageMask = barrier.dstStageMask = VK_PIPELINE_STAGE_2_COPY_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_TRANSFER_READ_BIT;
    barrier.srcQueueFamilyIndex = 0;
    barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_EXTERNAL;
    barrier.buffer = between.buffer;
    barrier.size = VK_WHOLE_SIZE;
    auto info = make_struct<VkDependencyInfo>();
    info.dependencyFlags = VK_DEPENDENCY_QUEUE_FAMILY_OWNERSHIP_TRANSFER_USE_ALL_STAGES_BIT_KHR;
    info.bufferMemoryBarrierCount = 1;
    info.pBufferMemoryBarriers = &barrier;
    VK_CALL(CmdPipelineBarrier2KHR)(commands, &info);
    std::swap(barrier.srcQueueFamilyIndex, barrier.dstQueueFamilyIndex);
    VK_CALL(CmdPipelineBarrier2KHR)(commands, &info);
    VK_CALL(CmdCopyBuffer)(commands, between.buffer, to.buffer, 1, &whole);
  });
  EXPECT_EQ(std::memcmp(from.data, to.data, 64), 0);
}

}  // namespace
}  // namespace vitrine::icd::test
#endif

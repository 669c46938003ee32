// VK_KHR_maintenance5, which neither older headers nor the reference know: what can be asked, created and copied. Its
// draws are maintenance5_draws_test.cpp's.
#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "icd/object/memory.h"
#include "tests/icd/maintenance5_fixture.h"
#include "tests/icd/shaders.h"

#ifdef VK_KHR_maintenance6
namespace vitrine::icd::test {
namespace {

#define VK_CALL(name) VK_GET(instance, name)

using Maintenance5 = Maintenance5Device;

TEST_F(Maintenance5, IsOffered) {
  auto features = make_struct<VkPhysicalDeviceMaintenance5FeaturesKHR>();
  auto all = make_struct<VkPhysicalDeviceFeatures2>(&features);
  VK_CALL(GetPhysicalDeviceFeatures2)(physical_device, &all);
  EXPECT_TRUE(features.maintenance5);
  auto properties = make_struct<VkPhysicalDeviceMaintenance5PropertiesKHR>();
  auto whole = make_struct<VkPhysicalDeviceProperties2>(&properties);
  VK_CALL(GetPhysicalDeviceProperties2)(physical_device, &whole);
  EXPECT_TRUE(properties.earlyFragmentMultisampleCoverageAfterSampleCounting);
  EXPECT_TRUE(properties.earlyFragmentSampleMaskTestBeforeSampleCounting);
  EXPECT_TRUE(properties.depthStencilSwizzleOneSupport);
  EXPECT_TRUE(properties.polygonModePointSize);
  EXPECT_TRUE(whole.properties.limits.strictLines) << "what lines that are not strict do is never seen";
}

/// Vulkan 1.4.309, vkGetDeviceProcAddr: "core commands beyond that version [...] will return NULL", where the feature
/// is enabled. The instance asks for 1.1.
TEST_F(Maintenance5, CommandsBeyondTheApplicationsVersionAreAbsent) {
  const auto of = [&](VkDevice d, const char* name) { return VK_CALL(GetDeviceProcAddr)(d, name); };
  EXPECT_TRUE(of(device, "vkTrimCommandPool"));
  EXPECT_TRUE(of(device, "vkCmdBindIndexBuffer2KHR"));
  EXPECT_TRUE(of(device, "vkCmdBeginRenderingKHR")) << "of an extension that is enabled";
  EXPECT_FALSE(of(device, "vkCmdDrawIndirectCount"));
  EXPECT_FALSE(of(device, "vkCmdBeginRendering"));
  EXPECT_FALSE(of(device, "vkCmdBindIndexBuffer2"));
  VkDevice without = VK_NULL_HANDLE;
  ASSERT_EQ(create_device(instance, physical_device, &without), VK_SUCCESS);
  EXPECT_TRUE(of(without, "vkCmdBeginRendering"));
  EXPECT_FALSE(of(without, "vkCmdBindIndexBuffer2KHR"));
  VK_CALL(DestroyDevice)(without, nullptr);
}

/// Vulkan 1.4.309, Fundamentals: "any integer value representable in the range valid for the defined type is valid" in
/// queries of physical devices, which say that it is not supported.
TEST_F(Maintenance5, UnknownFormatsHaveNoFeatures) {
  for (const std::uint32_t value : {500u, 1000470077u, 0x7ffffffeu}) {
    VkFormat format;
    std::memcpy(&format, &value, sizeof format);
    auto properties = make_struct<VkFormatProperties2>();
    VK_CALL(GetPhysicalDeviceFormatProperties2)(physical_device, format, &properties);
    EXPECT_EQ(properties.formatProperties.optimalTilingFeatures, 0u);
    EXPECT_EQ(properties.formatProperties.linearTilingFeatures, 0u);
    EXPECT_EQ(properties.formatProperties.bufferFeatures, 0u);
    VkImageFormatProperties image;
    EXPECT_EQ(
        VK_CALL(GetPhysicalDeviceImageFormatProperties)(physical_device, format, VK_IMAGE_TYPE_2D,
                                                        VK_IMAGE_TILING_OPTIMAL, VK_IMAGE_USAGE_SAMPLED_BIT, 0, &image),
        VK_ERROR_FORMAT_NOT_SUPPORTED);
  }
  VkImageFormatProperties image;
  EXPECT_EQ(VK_CALL(GetPhysicalDeviceImageFormatProperties)(physical_device, VK_FORMAT_R8_UNORM, VK_IMAGE_TYPE_2D,
                                                            VK_IMAGE_TILING_OPTIMAL, 1u << 30, 0, &image),
            VK_ERROR_FORMAT_NOT_SUPPORTED);
}

TEST_F(Maintenance5, AnAreaMayStartAndEndAnywhere) {
  const VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
  auto info = make_struct<VkRenderingAreaInfoKHR>();
  info.colorAttachmentCount = 1;
  info.pColorAttachmentFormats = &format;
  VkExtent2D granularity{};
  VK_CALL(GetRenderingAreaGranularityKHR)(device, &info, &granularity);
  EXPECT_EQ(granularity.width, 1u);
  EXPECT_EQ(granularity.height, 1u);
}

TEST_F(Maintenance5, LayoutsNeedNoImage) {
  for (const VkFormat format : {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_BC1_RGB_UNORM_BLOCK, VK_FORMAT_D24_UNORM_S8_UINT}) {
    for (const VkImageTiling tiling : {VK_IMAGE_TILING_LINEAR, VK_IMAGE_TILING_OPTIMAL}) {
      auto info = image_info(VK_IMAGE_TYPE_2D, format, {44, 20, 1}, 3);
      info.mipLevels = 3;
      info.tiling = tiling;
      VkImage image;
      ASSERT_EQ(VK_CALL(CreateImage)(device, &info, nullptr, &image), VK_SUCCESS);
      const bool depth = format == VK_FORMAT_D24_UNORM_S8_UINT;
      const VkImageAspectFlags aspect = depth ? VK_IMAGE_ASPECT_STENCIL_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
      auto subresource = make_struct<VkImageSubresource2KHR>();
      subresource.imageSubresource = {aspect, 2, 1};
      VkSubresourceLayout expected{};
      VK_CALL(GetImageSubresourceLayout)(device, image, &subresource.imageSubresource, &expected);
      auto of_image = make_struct<VkSubresourceLayout2KHR>(), of_info = make_struct<VkSubresourceLayout2KHR>();
      VK_CALL(GetImageSubresourceLayout2KHR)(device, image, &subresource, &of_image);
      auto query = make_struct<VkDeviceImageSubresourceInfoKHR>();
      query.pCreateInfo = &info;
      query.pSubresource = &subresource;
      VK_CALL(GetDeviceImageSubresourceLayoutKHR)(device, &query, &of_info);
      EXPECT_GT(expected.offset, 0u);
      for (const VkSubresourceLayout& got : {of_image.subresourceLayout, of_info.subresourceLayout}) {
        EXPECT_EQ(got.offset, expected.offset);
        EXPECT_EQ(got.size, expected.size);
        EXPECT_EQ(got.rowPitch, expected.rowPitch);
        EXPECT_EQ(got.arrayPitch, expected.arrayPitch);
        EXPECT_EQ(got.depthPitch, expected.depthPitch);
      }
      VK_CALL(DestroyImage)(device, image, nullptr);
    }
  }
}

/// Vulkan 1.4.309, VkBufferUsageFlags2CreateInfo: "used instead of the corresponding usage value".
TEST_F(Maintenance5, UsagesOfBuffersComeFromTheChain) {
  auto usage = make_struct<VkBufferUsageFlags2CreateInfoKHR>();
  usage.usage = VK_BUFFER_USAGE_2_INDEX_BUFFER_BIT_KHR | VK_BUFFER_USAGE_2_UNIFORM_TEXEL_BUFFER_BIT_KHR;
  auto info = make_struct<VkBufferCreateInfo>(&usage);
  info.size = 64;
  info.usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
  VkBuffer buffer;
  ASSERT_EQ(VK_CALL(CreateBuffer)(device, &info, nullptr, &buffer), VK_SUCCESS);
  EXPECT_EQ(from_handle<Buffer>(buffer).usage,
            VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
  VK_CALL(DestroyBuffer)(device, buffer, nullptr);
}

/// Vulkan 1.4.309, VkPipelineCreateFlags2CreateInfo: as with buffers.
TEST_F(Maintenance5, FlagsOfPipelinesComeFromTheChain) {
  const auto layout_info = make_struct<VkPipelineLayoutCreateInfo>();
  VkPipelineLayout layout;
  ASSERT_EQ(VK_CALL(CreatePipelineLayout)(device, &layout_info, nullptr, &layout), VK_SUCCESS);
  std::string log;
  const auto words = compile(VK_SHADER_STAGE_COMPUTE_BIT, "void main() {}");
  auto module = module_info(words);
  auto wide = make_struct<VkPipelineCreateFlags2CreateInfoKHR>();
  auto info = make_struct<VkComputePipelineCreateInfo>(&wide);
  info.stage = make_struct<VkPipelineShaderStageCreateInfo>(&module);
  info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.stage.pName = "main";
  info.layout = layout;
  const VkComputePipelineCreateInfo both[] = {info, info};
  VkPipeline pipelines[2];
  const auto create = [&](std::uint32_t count, const VkComputePipelineCreateInfo* infos) {
    return VK_CALL(CreateComputePipelines)(device, VK_NULL_HANDLE, count, infos, nullptr, pipelines);
  };
  wide.flags = VK_PIPELINE_CREATE_2_FAIL_ON_PIPELINE_COMPILE_REQUIRED_BIT_KHR |
               VK_PIPELINE_CREATE_2_EARLY_RETURN_ON_FAILURE_BIT_KHR;
  EXPECT_EQ(create(2, both), VK_PIPELINE_COMPILE_REQUIRED);
  wide.flags = 0;
  info.flags = VK_PIPELINE_CREATE_FAIL_ON_PIPELINE_COMPILE_REQUIRED_BIT;
  EXPECT_EQ(create(1, &info), VK_SUCCESS) << "the chain's flags are taken in place of the others";
  VK_CALL(DestroyPipeline)(device, pipelines[0], nullptr);
  // The first fails: without an early return the second is made.
  auto missing = info;
  auto failing = wide;
  failing.flags = VK_PIPELINE_CREATE_2_FAIL_ON_PIPELINE_COMPILE_REQUIRED_BIT_KHR;
  const auto other_words = compile(VK_SHADER_STAGE_COMPUTE_BIT, "shared int a; void main() { a = 1; }");
  auto other = module_info(other_words);
  missing.pNext = &failing;
  missing.stage.pNext = &other;
  const VkComputePipelineCreateInfo mixed[] = {missing, info};
  EXPECT_EQ(create(2, mixed), VK_PIPELINE_COMPILE_REQUIRED);
  EXPECT_EQ(pipelines[0], VkPipeline{VK_NULL_HANDLE});
  EXPECT_NE(pipelines[1], VkPipeline{VK_NULL_HANDLE});
  VK_CALL(DestroyPipeline)(device, pipelines[1], nullptr);
  failing.flags |= VK_PIPELINE_CREATE_2_EARLY_RETURN_ON_FAILURE_BIT_KHR;
  EXPECT_EQ(create(2, mixed), VK_PIPELINE_COMPILE_REQUIRED);
  EXPECT_EQ(pipelines[1], VkPipeline{VK_NULL_HANDLE});
  VK_CALL(DestroyPipelineLayout)(device, layout, nullptr);
}

/// Every command whose regions have layers: with VK_REMAINING_ARRAY_LAYERS as with their number.
TEST_F(Maintenance5, RemainingLayersAreThoseToTheEnd) {
  constexpr std::uint32_t kLayers = 5, kFirst = 2;
  constexpr VkExtent3D kExtent{8, 6, 1};
  const auto layers = [](std::uint32_t first, std::uint32_t count) {
    return VkImageSubresourceLayers{VK_IMAGE_ASPECT_COLOR_BIT, 0, first, count};
  };
  for (int command = 0; command < 5; ++command) {
    std::vector<std::byte> results[3];
    for (int form = 0; form < 3; ++form) {
      const bool resolves = command == 4;
      Picture source = make_picture(VK_IMAGE_TYPE_2D, VK_FORMAT_R8G8B8A8_UNORM, kExtent, kLayers,
                                    resolves ? VK_SAMPLE_COUNT_4_BIT : VK_SAMPLE_COUNT_1_BIT);
      Picture target = make_picture(VK_IMAGE_TYPE_2D, VK_FORMAT_R8G8B8A8_UNORM, kExtent, kLayers - 1);
      fill(source, 1);
      fill(target, 99);
      Bytes bytes = make_bytes(4096);
      for (std::size_t i = 0; i < bytes.size; ++i) bytes.data[i] = static_cast<std::byte>(i * 7);
      // The source is from layer 2 of 5 on, the target from layer 1 of 4: three layers.
      const VkImageSubresourceLayers from = layers(kFirst, form == 0 ? 3 : VK_REMAINING_ARRAY_LAYERS),
                                     to = layers(1, form == 2   ? 3
                                                    : form == 0 ? 3
                                                                : VK_REMAINING_ARRAY_LAYERS);
      run([&](VkCommandBuffer commands) {
        const VkImageCopy copy{from, {}, to, {}, kExtent};
        const VkImageBlit blit{from, {{0, 0, 0}, {8, 6, 1}}, to, {{8, 6, 0}, {0, 0, 1}}};
        const VkImageResolve resolve{from, {}, to, {}, kExtent};
        const VkBufferImageCopy upload{0, 0, 0, to, {}, kExtent}, download{0, 0, 0, from, {}, kExtent};
        constexpr VkImageLayout kLayout = VK_IMAGE_LAYOUT_GENERAL;
        if (command == 0) VK_CALL(CmdCopyImage)(commands, source.image, kLayout, target.image, kLayout, 1, &copy);
        if (command == 1) VK_CALL(CmdBlitImage)
        (commands, source.image, kLayout, target.image, kLayout, 1, &blit, VK_FILTER_NEAREST);
        if (command == 2) VK_CALL(CmdCopyBufferToImage)(commands, bytes.buffer, target.image, kLayout, 1, &upload);
        if (command == 3) VK_CALL(CmdCopyImageToBuffer)(commands, source.image, kLayout, bytes.buffer, 1, &download);
        if (resolves) VK_CALL(CmdResolveImage)(commands, source.image, kLayout, target.image, kLayout, 1, &resolve);
      });
      results[form].assign(target.data, target.data + target.size);
      results[form].insert(results[form].end(), bytes.data, bytes.data + bytes.size);
    }
    EXPECT_EQ(results[0], results[1]) << command;
    EXPECT_EQ(results[0], results[2]) << command;
  }
}

/// Vulkan 1.4.309, Copying Data Between Images: "all other combinations are allowed and function as if 1D images are 2D
/// images with a height of 1".
TEST_F(Maintenance5, ImagesAreCopiedWhateverTheirTypes) {
  constexpr VkExtent3D kRow{16, 1, 1};
  constexpr VkImageType kTypes[] = {VK_IMAGE_TYPE_1D, VK_IMAGE_TYPE_2D, VK_IMAGE_TYPE_3D};
  for (const VkImageType from : kTypes) {
    for (const VkImageType to : kTypes) {
      // Three rows: as layers, or as slices of the 3D image.
      const auto rows = [&](VkImageType type) {
        const bool slices = type == VK_IMAGE_TYPE_3D;
        return make_picture(type, VK_FORMAT_R8G8B8A8_UNORM, {16, 1, slices ? 3u : 1u}, slices ? 1 : 3);
      };
      Picture source = rows(from), target = rows(to);
      fill(source, 5);
      fill(target, 200);
      const auto part = [](VkImageType type) {
        return VkImageSubresourceLayers{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, type == VK_IMAGE_TYPE_3D ? 1u : 3u};
      };
      const bool slices = from == VK_IMAGE_TYPE_3D || to == VK_IMAGE_TYPE_3D;
      const VkImageCopy copy{part(from), {}, part(to), {}, {kRow.width, kRow.height, slices ? 3u : 1u}};
      run([&](VkCommandBuffer commands) {
        VK_CALL(CmdCopyImage)
        (commands, source.image, VK_IMAGE_LAYOUT_GENERAL, target.image, VK_IMAGE_LAYOUT_GENERAL, 1, &copy);
      });
      for (std::uint32_t row = 0; row < 3; ++row) {
        EXPECT_EQ(std::memcmp(source.row(row), target.row(row), kRow.width * 4), 0)
            << from << " to " << to << " " << row;
      }
    }
  }
}

}  // namespace
}  // namespace vitrine::icd::test
#endif

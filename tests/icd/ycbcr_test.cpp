// Multi-planar images and conversions through the API, which the reference does not offer: against known values. The
// formulas themselves are tested in texel.
#include <array>
#include <cmath>

#include "tests/icd/fixture.h"
#include "tests/icd/shaders.h"

namespace vitrine::icd::test {
namespace {

constexpr VkFormat kNv12 = VK_FORMAT_G8_B8R8_2PLANE_420_UNORM;
constexpr VkDeviceSize kPlaneMemory = 4096;  ///< bytes that each plane of an image is bound to
constexpr VkDeviceSize kResults = 8 * kPlaneMemory;
constexpr std::array<VkImageAspectFlagBits, 2> kPlanes{VK_IMAGE_ASPECT_PLANE_0_BIT, VK_IMAGE_ASPECT_PLANE_1_BIT};

class Ycbcr : public DeviceTest {
 protected:
  void SetUp() override {
    DeviceTest::SetUp();
    auto info = make_struct<VkMemoryAllocateInfo>();
    info.allocationSize = kResults + 4096;
    ASSERT_EQ(VK_GET(instance, AllocateMemory)(device, &info, nullptr, &memory), VK_SUCCESS);
    void* data;
    ASSERT_EQ(VK_GET(instance, MapMemory)(device, memory, 0, VK_WHOLE_SIZE, 0, &data), VK_SUCCESS);
    bytes = static_cast<std::uint8_t*>(data);
    auto buffer_info = make_struct<VkBufferCreateInfo>();
    buffer_info.size = 4096;
    buffer_info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    ASSERT_EQ(VK_GET(instance, CreateBuffer)(device, &buffer_info, nullptr, &buffer), VK_SUCCESS);
    ASSERT_EQ(VK_GET(instance, BindBufferMemory)(device, buffer, memory, kResults), VK_SUCCESS);
  }

  void TearDown() override {
    VK_GET(instance, DestroyBuffer)(device, buffer, nullptr);
    VK_GET(instance, FreeMemory)(device, memory, nullptr);
    DeviceTest::TearDown();
  }

  VkImageCreateInfo image_info(VkImageCreateFlags flags, VkImageUsageFlags usage) {
    auto info = make_struct<VkImageCreateInfo>();
    info.flags = flags;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = kNv12;
    info.extent = {8, 8, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.tiling = VK_IMAGE_TILING_LINEAR;
    info.usage = usage;
    return info;
  }

  /// An image whose planes lie in memory of their own, the second one first; or a whole one.
  VkImage make_image(VkImageCreateFlags flags, VkImageUsageFlags usage, VkDeviceSize offset) {
    const VkImageCreateInfo info = image_info(flags, usage);
    VkImage image = VK_NULL_HANDLE;
    EXPECT_EQ(VK_GET(instance, CreateImage)(device, &info, nullptr, &image), VK_SUCCESS);
    if (!(flags & VK_IMAGE_CREATE_DISJOINT_BIT)) {
      EXPECT_EQ(VK_GET(instance, BindImageMemory)(device, image, memory, offset), VK_SUCCESS);
      return image;
    }
    std::array<VkBindImagePlaneMemoryInfo, 2> planes;
    std::array<VkBindImageMemoryInfo, 2> binds;
    for (std::uint32_t p = 0; p < 2; ++p) {
      planes[p] = make_struct<VkBindImagePlaneMemoryInfo>();
      planes[p].planeAspect = kPlanes[p];
      binds[p] = make_struct<VkBindImageMemoryInfo>(&planes[p]);
      binds[p].image = image;
      binds[p].memory = memory;
      binds[p].memoryOffset = offset + (1 - p) * kPlaneMemory;
    }
    EXPECT_EQ(VK_GET(instance, BindImageMemory2)(device, 2, binds.data()), VK_SUCCESS);
    return image;
  }

  VkSubresourceLayout layout_of(VkImage image, VkImageAspectFlagBits aspect) {
    const VkImageSubresource subresource{static_cast<VkImageAspectFlags>(aspect), 0, 0};
    VkSubresourceLayout layout{};
    VK_GET(instance, GetImageSubresourceLayout)(device, image, &subresource, &layout);
    return layout;
  }

  VkImageView make_view(VkImage image, VkFormat format, VkImageAspectFlagBits aspect, const void* next) {
    auto info = make_struct<VkImageViewCreateInfo>(const_cast<void*>(next));
    info.image = image;
    info.viewType = VK_IMAGE_VIEW_TYPE_2D;
    info.format = format;
    info.subresourceRange = {static_cast<VkImageAspectFlags>(aspect), 0, 1, 0, 1};
    VkImageView view = VK_NULL_HANDLE;
    EXPECT_EQ(VK_GET(instance, CreateImageView)(device, &info, nullptr, &view), VK_SUCCESS);
    return view;
  }

  VkSamplerYcbcrConversion make_conversion(VkSamplerYcbcrModelConversion model, VkSamplerYcbcrRange range) {
    auto info = make_struct<VkSamplerYcbcrConversionCreateInfo>();
    info.format = kNv12;
    info.ycbcrModel = model;
    info.ycbcrRange = range;
    info.xChromaOffset = info.yChromaOffset = VK_CHROMA_LOCATION_MIDPOINT;
    VkSamplerYcbcrConversion conversion = VK_NULL_HANDLE;
    EXPECT_EQ(VK_GET(instance, CreateSamplerYcbcrConversion)(device, &info, nullptr, &conversion), VK_SUCCESS);
    return conversion;
  }

  VkDeviceMemory memory = VK_NULL_HANDLE;
  std::uint8_t* bytes = nullptr;
  VkBuffer buffer = VK_NULL_HANDLE;
};

TEST_F(Ycbcr, ImagesOfFormatsWithConversionAreTwoDimensionalAndPlain) {
  const auto ask = [&](VkFormat format, VkImageType type, VkImageCreateFlags flags, VkImageFormatProperties& out) {
    return VK_GET(instance, GetPhysicalDeviceImageFormatProperties)(
        physical_device, format, type, VK_IMAGE_TILING_OPTIMAL, VK_IMAGE_USAGE_SAMPLED_BIT, flags, &out);
  };
  VkImageFormatProperties out{};
  EXPECT_EQ(ask(kNv12, VK_IMAGE_TYPE_2D, VK_IMAGE_CREATE_DISJOINT_BIT, out), VK_SUCCESS);
  EXPECT_EQ(out.maxMipLevels, 1u);
  EXPECT_EQ(out.sampleCounts, VkSampleCountFlags{VK_SAMPLE_COUNT_1_BIT});
  EXPECT_GT(out.maxArrayLayers, 1u);
  EXPECT_EQ(ask(kNv12, VK_IMAGE_TYPE_3D, 0, out), VK_ERROR_FORMAT_NOT_SUPPORTED);
  EXPECT_EQ(ask(kNv12, VK_IMAGE_TYPE_2D, VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT, out), VK_ERROR_FORMAT_NOT_SUPPORTED);
  const auto disjoint = VK_IMAGE_CREATE_DISJOINT_BIT;
  EXPECT_EQ(ask(VK_FORMAT_G8B8G8R8_422_UNORM, VK_IMAGE_TYPE_2D, disjoint, out), VK_ERROR_FORMAT_NOT_SUPPORTED);
  EXPECT_EQ(ask(VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_TYPE_2D, disjoint, out), VK_ERROR_FORMAT_NOT_SUPPORTED);
}

TEST_F(Ycbcr, PlanesOfDisjointImagesHaveRequirementsOfTheirOwn) {
  const VkImage whole = make_image(0, VK_IMAGE_USAGE_SAMPLED_BIT, 0);
  const VkImage image = make_image(VK_IMAGE_CREATE_DISJOINT_BIT, VK_IMAGE_USAGE_SAMPLED_BIT, 0);
  VkDeviceSize sum = 0;
  for (const VkImageAspectFlagBits aspect : kPlanes) {
    auto plane = make_struct<VkImagePlaneMemoryRequirementsInfo>();
    plane.planeAspect = aspect;
    auto info = make_struct<VkImageMemoryRequirementsInfo2>(&plane);
    info.image = image;
    auto out = make_struct<VkMemoryRequirements2>(), early = out;
    VK_GET(instance, GetImageMemoryRequirements2)(device, &info, &out);
    const VkImageCreateInfo create = image_info(VK_IMAGE_CREATE_DISJOINT_BIT, VK_IMAGE_USAGE_SAMPLED_BIT);
    auto before = make_struct<VkDeviceImageMemoryRequirements>();
    before.pCreateInfo = &create;
    before.planeAspect = aspect;
    VK_GET(instance, GetDeviceImageMemoryRequirements)(device, &before, &early);
    EXPECT_EQ(out.memoryRequirements.size, early.memoryRequirements.size);
    const VkSubresourceLayout layout = layout_of(image, aspect);
    EXPECT_EQ(layout.offset, 0u);
    EXPECT_GE(out.memoryRequirements.size, layout.size);
    EXPECT_EQ(layout_of(whole, aspect).offset, sum);
    sum += out.memoryRequirements.size;
  }
  VkMemoryRequirements all{};
  VK_GET(instance, GetImageMemoryRequirements)(device, whole, &all);
  EXPECT_EQ(all.size, sum);
  VK_GET(instance, DestroyImage)(device, image, nullptr);
  VK_GET(instance, DestroyImage)(device, whole, nullptr);
}

TEST_F(Ycbcr, ConvertsThroughImmutableSamplersAndStoresToPlanes) {
  const VkImage source = make_image(VK_IMAGE_CREATE_DISJOINT_BIT, VK_IMAGE_USAGE_SAMPLED_BIT, 0);
  constexpr VkImageCreateFlags kPlaneViews = VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT | VK_IMAGE_CREATE_EXTENDED_USAGE_BIT;
  const VkImage target = make_image(kPlaneViews, VK_IMAGE_USAGE_STORAGE_BIT, 4 * kPlaneMemory);
  std::uint8_t* luma = bytes + kPlaneMemory;
  std::uint8_t* chroma = bytes;
  const VkDeviceSize luma_pitch = layout_of(source, kPlanes[0]).rowPitch;
  const VkDeviceSize chroma_pitch = layout_of(source, kPlanes[1]).rowPitch;
  for (std::uint32_t y = 0; y < 8; ++y) {
    for (std::uint32_t x = 0; x < 8; ++x) luma[y * luma_pitch + x] = static_cast<std::uint8_t>(16 + 27 * (x ^ y));
  }
  for (std::uint32_t y = 0; y < 4; ++y) {
    for (std::uint32_t x = 0; x < 8; ++x) chroma[y * chroma_pitch + x] = static_cast<std::uint8_t>(16 + 28 * x + 3 * y);
  }

  const std::array<VkSamplerYcbcrConversion, 2> conversions{
      make_conversion(VK_SAMPLER_YCBCR_MODEL_CONVERSION_YCBCR_601, VK_SAMPLER_YCBCR_RANGE_ITU_NARROW),
      make_conversion(VK_SAMPLER_YCBCR_MODEL_CONVERSION_RGB_IDENTITY, VK_SAMPLER_YCBCR_RANGE_ITU_FULL)};
  std::array<VkSampler, 2> samplers{};
  std::array<VkImageView, 3> views{};
  for (std::uint32_t i = 0; i < 2; ++i) {
    auto conversion = make_struct<VkSamplerYcbcrConversionInfo>();
    conversion.conversion = conversions[i];
    auto info = make_struct<VkSamplerCreateInfo>(&conversion);
    info.addressModeU = info.addressModeV = info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    ASSERT_EQ(VK_GET(instance, CreateSampler)(device, &info, nullptr, &samplers[i]), VK_SUCCESS);
    views[i] = make_view(source, kNv12, VK_IMAGE_ASPECT_COLOR_BIT, &conversion);
  }
  views[2] = make_view(target, VK_FORMAT_R8G8_UNORM, kPlanes[1], nullptr);

  const std::array<VkDescriptorSetLayoutBinding, 3> bindings{{
      {0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 2, VK_SHADER_STAGE_COMPUTE_BIT, samplers.data()},
      {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr},
      {2, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr},
  }};
  auto layout_info = make_struct<VkDescriptorSetLayoutCreateInfo>();
  layout_info.bindingCount = 3;
  layout_info.pBindings = bindings.data();
  VkDescriptorSetLayout set_layout;
  ASSERT_EQ(VK_GET(instance, CreateDescriptorSetLayout)(device, &layout_info, nullptr, &set_layout), VK_SUCCESS);
  const std::array<VkDescriptorPoolSize, 3> sizes{{{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 2},
                                                   {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1},
                                                   {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1}}};
  auto pool_info = make_struct<VkDescriptorPoolCreateInfo>();
  pool_info.maxSets = 1;
  pool_info.poolSizeCount = 3;
  pool_info.pPoolSizes = sizes.data();
  VkDescriptorPool pool;
  ASSERT_EQ(VK_GET(instance, CreateDescriptorPool)(device, &pool_info, nullptr, &pool), VK_SUCCESS);
  auto allocate = make_struct<VkDescriptorSetAllocateInfo>();
  allocate.descriptorPool = pool;
  allocate.descriptorSetCount = 1;
  allocate.pSetLayouts = &set_layout;
  VkDescriptorSet set;
  ASSERT_EQ(VK_GET(instance, AllocateDescriptorSets)(device, &allocate, &set), VK_SUCCESS);
  std::array<VkDescriptorImageInfo, 3> infos{};
  for (std::uint32_t i = 0; i < 3; ++i) infos[i] = {VK_NULL_HANDLE, views[i], VK_IMAGE_LAYOUT_GENERAL};
  const VkDescriptorBufferInfo buffer_info{buffer, 0, VK_WHOLE_SIZE};
  std::array<VkWriteDescriptorSet, 3> writes;
  for (std::uint32_t i = 0; i < 3; ++i) {
    writes[i] = make_struct<VkWriteDescriptorSet>();
    writes[i].dstSet = set;
    writes[i].dstBinding = i;
    writes[i].descriptorType = bindings[i].descriptorType;
    writes[i].descriptorCount = bindings[i].descriptorCount;
    writes[i].pBufferInfo = &buffer_info;
    writes[i].pImageInfo = i == 0 ? infos.data() : &infos[2];
  }
  VK_GET(instance, UpdateDescriptorSets)(device, 3, writes.data(), 0, nullptr);

  auto pipeline_layout_info = make_struct<VkPipelineLayoutCreateInfo>();
  pipeline_layout_info.setLayoutCount = 1;
  pipeline_layout_info.pSetLayouts = &set_layout;
  VkPipelineLayout layout;
  ASSERT_EQ(VK_GET(instance, CreatePipelineLayout)(device, &pipeline_layout_info, nullptr, &layout), VK_SUCCESS);
  auto module_info = make_struct<VkShaderModuleCreateInfo>();
  module_info.codeSize = sizeof kYcbcrWords;
  module_info.pCode = kYcbcrWords;
  VkShaderModule module;
  ASSERT_EQ(VK_GET(instance, CreateShaderModule)(device, &module_info, nullptr, &module), VK_SUCCESS);
  auto pipeline_info = make_struct<VkComputePipelineCreateInfo>();
  pipeline_info.stage = make_struct<VkPipelineShaderStageCreateInfo>();
  pipeline_info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  pipeline_info.stage.module = module;
  pipeline_info.stage.pName = "main";
  pipeline_info.layout = layout;
  VkPipeline pipeline;
  ASSERT_EQ(VK_GET(instance, CreateComputePipelines)(device, {}, 1, &pipeline_info, nullptr, &pipeline), VK_SUCCESS);
  // Conversions and samplers may go before what was made of them.
  for (const VkSampler sampler : samplers) VK_GET(instance, DestroySampler)(device, sampler, nullptr);
  for (const auto c : conversions) VK_GET(instance, DestroySamplerYcbcrConversion)(device, c, nullptr);

  dispatch(pipeline, layout, set);

  const auto* result = reinterpret_cast<const float*>(bytes + kResults);
  for (std::uint32_t i = 0; i < 64; ++i) {
    const std::uint32_t x = i & 7, y = i >> 3;
    const double g = luma[y * luma_pitch + x];
    const double b = chroma[y / 2 * chroma_pitch + x / 2 * 2], r = chroma[y / 2 * chroma_pitch + x / 2 * 2 + 1];
    const double luminance = (g - 16) / 219, cb = (b - 128) / 224, cr = (r - 128) / 224;
    EXPECT_NEAR(result[i * 4], luminance + 1.402 * cr, 1e-5);
    EXPECT_NEAR(result[i * 4 + 1], luminance - (0.202008 * cb + 0.419198 * cr) / 0.587, 1e-5);
    EXPECT_NEAR(result[i * 4 + 2], luminance + 1.772 * cb, 1e-5);
    EXPECT_EQ(result[i * 4 + 3], 1.0f);
    EXPECT_NEAR(result[(64 + i) * 4], r / 255, 1e-6);
    EXPECT_NEAR(result[(64 + i) * 4 + 1], g / 255, 1e-6);
    EXPECT_NEAR(result[(64 + i) * 4 + 2], b / 255, 1e-6);
  }
  const VkSubresourceLayout written = layout_of(target, kPlanes[1]);
  const std::uint8_t* plane = bytes + 4 * kPlaneMemory + written.offset;
  for (std::uint32_t i = 0; i < 16; ++i) {
    const std::uint8_t* texel = plane + (i >> 2) * written.rowPitch + (i & 3) * 2;
    EXPECT_EQ(texel[0], i);
    EXPECT_EQ(texel[1], i + 100);
  }

  VK_GET(instance, DestroyPipeline)(device, pipeline, nullptr);
  VK_GET(instance, DestroyShaderModule)(device, module, nullptr);
  VK_GET(instance, DestroyPipelineLayout)(device, layout, nullptr);
  VK_GET(instance, DestroyDescriptorPool)(device, pool, nullptr);
  VK_GET(instance, DestroyDescriptorSetLayout)(device, set_layout, nullptr);
  for (const VkImageView view : views) VK_GET(instance, DestroyImageView)(device, view, nullptr);
  for (const VkImage image : {source, target}) VK_GET(instance, DestroyImage)(device, image, nullptr);
}

}  // namespace
}  // namespace vitrine::icd::test

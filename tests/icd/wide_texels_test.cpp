// Images of 64-bit integers (VK_EXT_shader_image_atomic_int64): what can be asked of their formats, clears and copies,
// and fetches, lookups and atomics that no GLSL compiler writes, against values known beforehand.
#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <spirv-tools/libspirv.hpp>
#include <string>
#include <vector>

#include "tests/icd/fixture.h"

namespace vitrine::icd::test {
namespace {

using Texel = std::array<std::uint64_t, 4>;

constexpr std::uint32_t kSize = 4;  ///< texels along both sides
constexpr VkDeviceSize kWordsOffset = 1 << 16;
constexpr VkDeviceSize kResultBytes = 1 << 14;
constexpr VkFormat kFormats[] = {VK_FORMAT_R64_UINT, VK_FORMAT_R64_SINT};

/// Descriptors: 0 the image as a sampled one, 1 a sampler, 2 results, 3 the image as a storage one, 4 and 5 its texels
/// as uniform and storage texel buffers.
constexpr std::array<VkDescriptorType, 6> kTypes{
    VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,        VK_DESCRIPTOR_TYPE_SAMPLER,
    VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,       VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
    VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER};

/// Lane i of 64 looks at texel (%x, %y) = (i % 8 - 2, i / 8 - 2), and may store %r0, %r1 and %r2 (v4ulong).
std::string module_text(const std::string& body, VkFormat format) {
  const std::string is_signed = format == VK_FORMAT_R64_SINT ? "1" : "0";
  std::string text = R"(
OpCapability Shader
OpCapability Int64
OpCapability Int64Atomics
OpCapability Int64ImageEXT
OpCapability SampledBuffer
OpCapability ImageBuffer
OpExtension "SPV_EXT_shader_image_int64"
OpMemoryModel Logical GLSL450
OpEntryPoint GLCompute %main "main" %id
OpExecutionMode %main LocalSize 64 1 1
OpDecorate %id BuiltIn LocalInvocationIndex
OpDecorate %array ArrayStride 32
OpMemberDecorate %block 0 Offset 0
OpDecorate %block BufferBlock
)";
  const char* const names[] = {"sampled", "sampler", "results", "stored", "texels", "stored_texels"};
  for (std::size_t i = 0; i < std::size(names); ++i)
    text += std::string("OpDecorate %") + names[i] + " DescriptorSet 0\nOpDecorate %" + names[i] + " Binding " +
            std::to_string(i) + "\n";
  text += R"(
%void = OpTypeVoid
%function = OpTypeFunction %void
%uint = OpTypeInt 32 0
%int = OpTypeInt 32 1
%float = OpTypeFloat 32
%ulong = OpTypeInt 64 )" +
          is_signed + R"(
%v2int = OpTypeVector %int 2
%v2float = OpTypeVector %float 2
%v4ulong = OpTypeVector %ulong 4
%u0 = OpConstant %uint 0
%u1 = OpConstant %uint 1
%u2 = OpConstant %uint 2
%u3 = OpConstant %uint 3
%u8 = OpConstant %uint 8
%u192 = OpConstant %uint 192
%i0 = OpConstant %int 0
%i2 = OpConstant %int 2
%i4 = OpConstant %int 4
%f0 = OpConstant %float 0
%quarter = OpConstant %float 0.25
%half = OpConstant %float 0.5
%one = OpConstant %float 1
%l5 = OpConstant %ulong 5
%big = OpConstant %ulong 4294967297
%zero = OpConstantNull %v4ulong
%image = OpTypeImage %ulong 2D 0 0 0 1 Unknown
%sampler_type = OpTypeSampler
%sampled_image = OpTypeSampledImage %image
%storage = OpTypeImage %ulong 2D 0 0 0 2 )" +
          (format == VK_FORMAT_R64_SINT ? "R64i" : "R64ui") + R"(
%buffer = OpTypeImage %ulong Buffer 0 0 0 1 Unknown
%storage_buffer = OpTypeImage %ulong Buffer 0 0 0 2 )" +
          (format == VK_FORMAT_R64_SINT ? "R64i" : "R64ui") + R"(
%array = OpTypeRuntimeArray %v4ulong
%block = OpTypeStruct %array
%ptr_image = OpTypePointer UniformConstant %image
%ptr_sampler = OpTypePointer UniformConstant %sampler_type
%ptr_storage = OpTypePointer UniformConstant %storage
%ptr_buffer = OpTypePointer UniformConstant %buffer
%ptr_storage_buffer = OpTypePointer UniformConstant %storage_buffer
%ptr_block = OpTypePointer Uniform %block
%ptr_texel = OpTypePointer Uniform %v4ulong
%ptr_input = OpTypePointer Input %uint
%ptr_atomic = OpTypePointer Image %ulong
%sampled = OpVariable %ptr_image UniformConstant
%sampler = OpVariable %ptr_sampler UniformConstant
%results = OpVariable %ptr_block Uniform
%stored = OpVariable %ptr_storage UniformConstant
%texels = OpVariable %ptr_buffer UniformConstant
%stored_texels = OpVariable %ptr_storage_buffer UniformConstant
%id = OpVariable %ptr_input Input
%main = OpFunction %void None %function
%entry = OpLabel
%i = OpLoad %uint %id
%column = OpUMod %uint %i %u8
%row = OpUDiv %uint %i %u8
%column_int = OpBitcast %int %column
%row_int = OpBitcast %int %row
%x = OpISub %int %column_int %i2
%y = OpISub %int %row_int %i2
%at = OpCompositeConstruct %v2int %x %y
%row_start = OpIMul %int %y %i4
%linear = OpIAdd %int %row_start %x
)" + body +
          "\n";
  for (int r = 0; r < 3; ++r) {
    const std::string n = std::to_string(r);
    if (body.find("%r" + n + " =") == std::string::npos) continue;
    text += "%at" + n + " = OpIMul %uint %i %u3\n%index" + n + " = OpIAdd %uint %at" + n + " %u" + n + "\n%place" + n +
            " = OpAccessChain %ptr_texel %results %u0 %index" + n + "\nOpStore %place" + n + " %r" + n + "\n";
  }
  return text + "OpReturn\nOpFunctionEnd\n";
}

class WideTexels : public DeviceTest {
 protected:
  void make_device() override {
    auto wide = make_struct<VkPhysicalDeviceShaderImageAtomicInt64FeaturesEXT>();
    wide.shaderImageInt64Atomics = VK_TRUE;
    auto borders = make_struct<VkPhysicalDeviceCustomBorderColorFeaturesEXT>(&wide);
    borders.customBorderColors = borders.customBorderColorWithoutFormat = VK_TRUE;
    auto features = make_struct<VkPhysicalDeviceFeatures2>(&borders);
    features.features.shaderInt64 = VK_TRUE;
    const char* const names[] = {VK_EXT_SHADER_IMAGE_ATOMIC_INT64_EXTENSION_NAME,
                                 VK_EXT_CUSTOM_BORDER_COLOR_EXTENSION_NAME};
    ASSERT_EQ(create_device(instance, physical_device, &device, nullptr, &features, names), VK_SUCCESS);
  }

  void SetUp() override {
    DeviceTest::SetUp();
    auto info = make_struct<VkMemoryAllocateInfo>();
    info.allocationSize = kWordsOffset + kResultBytes + 4096;
    ASSERT_EQ(VK_GET(instance, AllocateMemory)(device, &info, nullptr, &memory), VK_SUCCESS);
    void* mapped = nullptr;
    ASSERT_EQ(VK_GET(instance, MapMemory)(device, memory, 0, VK_WHOLE_SIZE, 0, &mapped), VK_SUCCESS);
    bytes = static_cast<std::byte*>(mapped);
    results = make_buffer(kResultBytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, kWordsOffset);
    linear = make_buffer(8 * kSize * kSize,
                         VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT |
                             VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                         kWordsOffset + kResultBytes);
  }

  void TearDown() override {
    while (!deferred.empty()) {
      deferred.back()();
      deferred.pop_back();
    }
    VK_GET(instance, FreeMemory)(device, memory, nullptr);
    DeviceTest::TearDown();
  }

  VkBuffer make_buffer(VkDeviceSize size, VkBufferUsageFlags usage, VkDeviceSize offset) {
    auto info = make_struct<VkBufferCreateInfo>();
    info.size = size;
    info.usage = usage;
    VkBuffer buffer = VK_NULL_HANDLE;
    EXPECT_EQ(VK_GET(instance, CreateBuffer)(device, &info, nullptr, &buffer), VK_SUCCESS);
    EXPECT_EQ(VK_GET(instance, BindBufferMemory)(device, buffer, memory, offset), VK_SUCCESS);
    deferred.push_back([=, this] { VK_GET(instance, DestroyBuffer)(device, buffer, nullptr); });
    return buffer;
  }

  /// An image of 4x4 texels at the start of the memory.
  VkImage make_image(VkFormat format) {
    auto info = make_struct<VkImageCreateInfo>();
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {kSize, kSize, 1};
    info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                 VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    VkImage image = VK_NULL_HANDLE;
    EXPECT_EQ(VK_GET(instance, CreateImage)(device, &info, nullptr, &image), VK_SUCCESS);
    VkMemoryRequirements needed;
    VK_GET(instance, GetImageMemoryRequirements)(device, image, &needed);
    EXPECT_LE(needed.size, kWordsOffset);
    EXPECT_EQ(VK_GET(instance, BindImageMemory)(device, image, memory, 0), VK_SUCCESS);
    deferred.push_back([=, this] { VK_GET(instance, DestroyImage)(device, image, nullptr); });
    return image;
  }

  VkImageView make_view(VkImage image, VkFormat format, VkComponentMapping components = {}) {
    auto info = make_struct<VkImageViewCreateInfo>();
    info.image = image;
    info.viewType = VK_IMAGE_VIEW_TYPE_2D;
    info.format = format;
    info.components = components;
    info.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    VkImageView view = VK_NULL_HANDLE;
    EXPECT_EQ(VK_GET(instance, CreateImageView)(device, &info, nullptr, &view), VK_SUCCESS);
    deferred.push_back([=, this] { VK_GET(instance, DestroyImageView)(device, view, nullptr); });
    return view;
  }

  VkSampler make_sampler(VkBorderColor border, const void* next = nullptr) {
    auto info = make_struct<VkSamplerCreateInfo>(const_cast<void*>(next));
    info.addressModeU = info.addressModeV = info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
    info.borderColor = border;
    VkSampler sampler = VK_NULL_HANDLE;
    EXPECT_EQ(VK_GET(instance, CreateSampler)(device, &info, nullptr, &sampler), VK_SUCCESS);
    deferred.push_back([=, this] { VK_GET(instance, DestroySampler)(device, sampler, nullptr); });
    return sampler;
  }

  void copy(VkImage image, bool to_image) {
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {kSize, kSize, 1};
    run([&](VkCommandBuffer commands) {
      if (to_image)
        VK_GET(instance, CmdCopyBufferToImage)(commands, linear, image, VK_IMAGE_LAYOUT_GENERAL, 1, &region);
      else
        VK_GET(instance, CmdCopyImageToBuffer)(commands, image, VK_IMAGE_LAYOUT_GENERAL, linear, 1, &region);
    });
  }

  /// Runs a module over the image; what is not given is left out of the descriptors' updates.
  void run_module(const std::string& body, VkFormat format, VkImageView sampled, VkSampler sampler,
                  VkImageView stored) {
    std::array<VkDescriptorSetLayoutBinding, kTypes.size()> bindings{};
    std::array<VkDescriptorPoolSize, kTypes.size()> sizes{};
    for (std::uint32_t i = 0; i < kTypes.size(); ++i) {
      bindings[i] = {i, kTypes[i], 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
      sizes[i] = {kTypes[i], 1};
    }
    auto layout_info = make_struct<VkDescriptorSetLayoutCreateInfo>();
    layout_info.bindingCount = static_cast<std::uint32_t>(bindings.size());
    layout_info.pBindings = bindings.data();
    VkDescriptorSetLayout set_layout;
    ASSERT_EQ(VK_GET(instance, CreateDescriptorSetLayout)(device, &layout_info, nullptr, &set_layout), VK_SUCCESS);
    auto pool_info = make_struct<VkDescriptorPoolCreateInfo>();
    pool_info.maxSets = 1;
    pool_info.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
    pool_info.pPoolSizes = sizes.data();
    VkDescriptorPool pool;
    ASSERT_EQ(VK_GET(instance, CreateDescriptorPool)(device, &pool_info, nullptr, &pool), VK_SUCCESS);
    auto allocate = make_struct<VkDescriptorSetAllocateInfo>();
    allocate.descriptorPool = pool;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &set_layout;
    VkDescriptorSet set;
    ASSERT_EQ(VK_GET(instance, AllocateDescriptorSets)(device, &allocate, &set), VK_SUCCESS);
    write_set(set, format, sampled, sampler, stored);
    auto pipeline_layout_info = make_struct<VkPipelineLayoutCreateInfo>();
    pipeline_layout_info.setLayoutCount = 1;
    pipeline_layout_info.pSetLayouts = &set_layout;
    VkPipelineLayout layout;
    ASSERT_EQ(VK_GET(instance, CreatePipelineLayout)(device, &pipeline_layout_info, nullptr, &layout), VK_SUCCESS);
    const VkPipeline pipeline = make_pipeline(module_text(body, format), layout);
    if (pipeline) dispatch(pipeline, layout, set);
    VK_GET(instance, DestroyPipeline)(device, pipeline, nullptr);
    VK_GET(instance, DestroyPipelineLayout)(device, layout, nullptr);
    VK_GET(instance, DestroyDescriptorPool)(device, pool, nullptr);
    VK_GET(instance, DestroyDescriptorSetLayout)(device, set_layout, nullptr);
  }

  void write_set(VkDescriptorSet set, VkFormat format, VkImageView sampled, VkSampler sampler, VkImageView stored) {
    auto info = make_struct<VkBufferViewCreateInfo>();
    info.buffer = linear;
    info.format = format;
    info.range = VK_WHOLE_SIZE;
    VkBufferView texels = VK_NULL_HANDLE;
    ASSERT_EQ(VK_GET(instance, CreateBufferView)(device, &info, nullptr, &texels), VK_SUCCESS);
    deferred.push_back([=, this] { VK_GET(instance, DestroyBufferView)(device, texels, nullptr); });
    const VkDescriptorBufferInfo buffer_info{results, 0, VK_WHOLE_SIZE};
    for (std::uint32_t i = 0; i < kTypes.size(); ++i) {
      const VkDescriptorImageInfo image_info{sampler, i == 0 ? sampled : stored, VK_IMAGE_LAYOUT_GENERAL};
      auto write = make_struct<VkWriteDescriptorSet>();
      write.dstSet = set;
      write.dstBinding = i;
      write.descriptorType = kTypes[i];
      write.descriptorCount = 1;
      write.pImageInfo = &image_info;
      write.pBufferInfo = &buffer_info;
      write.pTexelBufferView = &texels;
      VK_GET(instance, UpdateDescriptorSets)(device, 1, &write, 0, nullptr);
    }
  }

  VkPipeline make_pipeline(const std::string& text, VkPipelineLayout layout) {
    spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_1);
    tools.SetMessageConsumer([](spv_message_level_t, const char*, const spv_position_t& at, const char* message) {
      ADD_FAILURE() << "line " << at.line + 1 << ": " << message;
    });
    std::vector<std::uint32_t> words;
    if (!tools.Assemble(text, &words)) return VK_NULL_HANDLE;
    EXPECT_TRUE(tools.Validate(words)) << text;
    auto module_info = make_struct<VkShaderModuleCreateInfo>();
    module_info.codeSize = words.size() * sizeof(std::uint32_t);
    module_info.pCode = words.data();
    VkShaderModule module;
    EXPECT_EQ(VK_GET(instance, CreateShaderModule)(device, &module_info, nullptr, &module), VK_SUCCESS);
    auto info = make_struct<VkComputePipelineCreateInfo>();
    info.stage = make_struct<VkPipelineShaderStageCreateInfo>();
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.module = module;
    info.stage.pName = "main";
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    EXPECT_EQ(VK_GET(instance, CreateComputePipelines)(device, {}, 1, &info, nullptr, &pipeline), VK_SUCCESS);
    VK_GET(instance, DestroyShaderModule)(device, module, nullptr);
    return pipeline;
  }

  std::uint64_t& word(std::uint32_t i) {
    return reinterpret_cast<std::uint64_t*>(bytes + kWordsOffset + kResultBytes)[i];
  }
  Texel result(std::uint32_t lane, std::uint32_t r) const {
    Texel texel;
    std::memcpy(texel.data(), bytes + kWordsOffset + (lane * 3 + r) * sizeof(Texel), sizeof(Texel));
    return texel;
  }

  VkDeviceMemory memory = VK_NULL_HANDLE;
  std::byte* bytes = nullptr;
  VkBuffer results = VK_NULL_HANDLE, linear = VK_NULL_HANDLE;
  std::vector<std::function<void()>> deferred;
};

std::uint64_t number_of(std::uint32_t i) { return 0x8123456700000000u * (i % 2) + 0x9abcdef101u * (i + 3) - i * i; }

bool is_inside(std::int32_t x, std::int32_t y) {
  return x >= 0 && y >= 0 && x < std::int32_t{kSize} && y < std::int32_t{kSize};
}

Texel swizzled(const Texel& texel, const VkComponentMapping& mapping) {
  const VkComponentSwizzle all[] = {mapping.r, mapping.g, mapping.b, mapping.a};
  Texel out;
  for (std::size_t c = 0; c < 4; ++c)
    out[c] = all[c] == VK_COMPONENT_SWIZZLE_IDENTITY ? texel[c]
             : all[c] == VK_COMPONENT_SWIZZLE_ZERO   ? 0
             : all[c] == VK_COMPONENT_SWIZZLE_ONE    ? 1
                                                     : texel[all[c] - VK_COMPONENT_SWIZZLE_R];
  return out;
}

TEST_F(WideTexels, FormatsAreForShadersAndTransfers) {
  for (const VkFormat format : kFormats) {
    VkFormatProperties properties;
    VK_GET(instance, GetPhysicalDeviceFormatProperties)(physical_device, format, &properties);
    constexpr VkFormatFeatureFlags kImage =
        VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT | VK_FORMAT_FEATURE_STORAGE_IMAGE_ATOMIC_BIT |
        VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT | VK_FORMAT_FEATURE_TRANSFER_SRC_BIT | VK_FORMAT_FEATURE_TRANSFER_DST_BIT;
    constexpr VkFormatFeatureFlags kBuffer =
        VK_FORMAT_FEATURE_UNIFORM_TEXEL_BUFFER_BIT | VK_FORMAT_FEATURE_STORAGE_TEXEL_BUFFER_BIT |
        VK_FORMAT_FEATURE_STORAGE_TEXEL_BUFFER_ATOMIC_BIT | VK_FORMAT_FEATURE_VERTEX_BUFFER_BIT;
    EXPECT_EQ(properties.optimalTilingFeatures, kImage);
    EXPECT_EQ(properties.linearTilingFeatures, kImage);
    EXPECT_EQ(properties.bufferFeatures, kBuffer);
    const auto query = VK_GET(instance, GetPhysicalDeviceImageFormatProperties);
    VkImageFormatProperties out;
    for (const VkImageType type : {VK_IMAGE_TYPE_1D, VK_IMAGE_TYPE_2D, VK_IMAGE_TYPE_3D}) {
      ASSERT_EQ(query(physical_device, format, type, VK_IMAGE_TILING_OPTIMAL, VK_IMAGE_USAGE_STORAGE_BIT, 0, &out),
                VK_SUCCESS);
      EXPECT_EQ(out.sampleCounts, VkSampleCountFlags{VK_SAMPLE_COUNT_1_BIT});
    }
    EXPECT_EQ(query(physical_device, format, VK_IMAGE_TYPE_2D, VK_IMAGE_TILING_OPTIMAL,
                    VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, 0, &out),
              VK_ERROR_FORMAT_NOT_SUPPORTED);
  }
}

TEST_F(WideTexels, SparseOnesAreNotClaimed) {
  auto wide = make_struct<VkPhysicalDeviceShaderImageAtomicInt64FeaturesEXT>();
  auto features = make_struct<VkPhysicalDeviceFeatures2>(&wide);
  VK_GET(instance, GetPhysicalDeviceFeatures2)(physical_device, &features);
  EXPECT_EQ(wide.shaderImageInt64Atomics, VK_TRUE);
  EXPECT_EQ(wide.sparseImageInt64Atomics, VK_FALSE);
}

TEST_F(WideTexels, ClearsTakeTwoElements) {
  for (const VkFormat format : kFormats) {
    const VkImage image = make_image(format);
    VkClearColorValue color{};
    color.uint32[0] = 0x89abcdef;
    color.uint32[1] = 0x01234567;
    color.uint32[2] = color.uint32[3] = 77;
    const VkImageSubresourceRange range{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    run([&](VkCommandBuffer commands) {
      VK_GET(instance, CmdClearColorImage)(commands, image, VK_IMAGE_LAYOUT_GENERAL, &color, 1, &range);
    });
    copy(image, false);
    for (std::uint32_t i = 0; i < kSize * kSize; ++i) EXPECT_EQ(word(i), 0x0123456789abcdefu);
  }
}

/// A fetch, a lookup of the nearest texel and a gather of four, inside and outside of the image.
constexpr const char* kLookups = R"(
%img = OpLoad %image %sampled
%smp = OpLoad %sampler_type %sampler
%both = OpSampledImage %sampled_image %img %smp
%fx = OpConvertSToF %float %x
%fy = OpConvertSToF %float %y
%cx = OpFAdd %float %fx %half
%cy = OpFAdd %float %fy %half
%sx = OpFMul %float %cx %quarter
%sy = OpFMul %float %cy %quarter
%uv = OpCompositeConstruct %v2float %sx %sy
%ex = OpFAdd %float %fx %one
%ey = OpFAdd %float %fy %one
%gx = OpFMul %float %ex %quarter
%gy = OpFMul %float %ey %quarter
%corner = OpCompositeConstruct %v2float %gx %gy
%r0 = OpImageFetch %v4ulong %img %at Lod %i0
%r1 = OpImageSampleExplicitLod %v4ulong %both %uv Lod %f0
%r2 = OpImageGather %v4ulong %both %corner %u0
)";

TEST_F(WideTexels, FetchesAndLookups) {
  struct Border {
    VkBorderColor color;
    Texel texel;
  };
  constexpr VkComponentSwizzle kR = VK_COMPONENT_SWIZZLE_R, kG = VK_COMPONENT_SWIZZLE_G, kA = VK_COMPONENT_SWIZZLE_A;
  constexpr VkComponentMapping kMappings[] = {{},
                                              {VK_COMPONENT_SWIZZLE_ONE, kR, VK_COMPONENT_SWIZZLE_ZERO, kR},
                                              {kG, kA, kR, VK_COMPONENT_SWIZZLE_ONE},
                                              {kA, kR, kG, kG}};
  constexpr Border kBorders[] = {{VK_BORDER_COLOR_INT_TRANSPARENT_BLACK, {0, 0, 0, 1}},
                                 {VK_BORDER_COLOR_INT_OPAQUE_WHITE, {1, 0, 0, 1}},
                                 {VK_BORDER_COLOR_INT_CUSTOM_EXT, {0x9abcdef012345678, 0, 0, 1}}};
  // Of a 64-bit component the first two elements, as of clears.
  auto custom = make_struct<VkSamplerCustomBorderColorCreateInfoEXT>();
  custom.customBorderColor.uint32[0] = 0x12345678;
  custom.customBorderColor.uint32[1] = 0x9abcdef0;
  custom.customBorderColor.uint32[2] = custom.customBorderColor.uint32[3] = 5;
  for (const VkFormat format : kFormats)
    for (const VkComponentMapping& mapping : kMappings)
      for (const Border& border : kBorders) {
        const VkImage image = make_image(format);
        for (std::uint32_t i = 0; i < kSize * kSize; ++i) word(i) = number_of(i);
        copy(image, true);
        run_module(kLookups, format, make_view(image, format, mapping), make_sampler(border.color, &custom),
                   make_view(image, format));
        const auto texel = [&](std::int32_t x, std::int32_t y, const Texel& outside) {
          const bool inside = is_inside(x, y);
          const Texel found{
              inside ? number_of(static_cast<std::uint32_t>(y) * kSize + static_cast<std::uint32_t>(x)) : 0, 0, 0, 1};
          return swizzled(inside ? found : outside, mapping);
        };
        for (std::uint32_t lane = 0; lane < 64; ++lane) {
          const auto x = static_cast<std::int32_t>(lane % 8) - 2, y = static_cast<std::int32_t>(lane / 8) - 2;
          EXPECT_EQ(result(lane, 0), texel(x, y, {0, 0, 0, 1})) << lane;
          EXPECT_EQ(result(lane, 1), texel(x, y, border.texel)) << lane;
          const Texel gathered{texel(x, y + 1, border.texel)[0], texel(x + 1, y + 1, border.texel)[0],
                               texel(x + 1, y, border.texel)[0], texel(x, y, border.texel)[0]};
          EXPECT_EQ(result(lane, 2), gathered) << lane;
        }
      }
}

TEST_F(WideTexels, TexelBuffersAreFetched) {
  for (const VkFormat format : kFormats) {
    const VkImage image = make_image(format);
    for (std::uint32_t i = 0; i < kSize * kSize; ++i) word(i) = number_of(i);
    const VkImageView view = make_view(image, format);
    run_module(
        "%buf = OpLoad %buffer %texels\n%r0 = OpImageFetch %v4ulong %buf %linear\n"
        "%sbuf = OpLoad %storage_buffer %stored_texels\n%r1 = OpImageRead %v4ulong %sbuf %linear\n",
        format, view, make_sampler(VK_BORDER_COLOR_INT_OPAQUE_BLACK), view);
    for (std::uint32_t lane = 0; lane < 64; ++lane) {
      const std::int32_t at = (static_cast<std::int32_t>(lane / 8) - 2) * 4 + static_cast<std::int32_t>(lane % 8) - 2;
      const bool inside = at >= 0 && at < static_cast<std::int32_t>(kSize * kSize);
      const Texel want{inside ? number_of(static_cast<std::uint32_t>(at)) : 0, 0, 0, 1};
      EXPECT_EQ(result(lane, 0), want) << lane;
      EXPECT_EQ(result(lane, 1), want) << lane;
    }
  }
}

/// Atomics that GLSL does not name; lanes outside of the image do nothing and get 0.
TEST_F(WideTexels, AtomicsOfOneTexelALane) {
  struct Row {
    const char* code;  ///< on %p; %old is what it gives
    std::uint64_t (*after)(std::uint64_t);
    bool gives_new;
  };
  constexpr Row kRows[] = {
      {"%old = OpAtomicLoad %ulong %p %u1 %u0", [](std::uint64_t v) { return v; }, false},
      {"OpAtomicStore %p %u1 %u0 %big\n%old = OpAtomicLoad %ulong %p %u1 %u0",
       [](std::uint64_t) { return std::uint64_t{4294967297}; }, true},
      {"%old = OpAtomicIIncrement %ulong %p %u1 %u0", [](std::uint64_t v) { return v + 1; }, false},
      {"%old = OpAtomicIDecrement %ulong %p %u1 %u0", [](std::uint64_t v) { return v - 1; }, false},
      {"%old = OpAtomicISub %ulong %p %u1 %u0 %big", [](std::uint64_t v) { return v - 4294967297; }, false},
      {"%old = OpAtomicSMax %ulong %p %u1 %u0 %l5",
       [](std::uint64_t v) { return static_cast<std::int64_t>(v) < 5 ? 5 : v; }, false},
      {"%old = OpAtomicUMin %ulong %p %u1 %u0 %big",
       [](std::uint64_t v) { return std::min(v, std::uint64_t{4294967297}); }, false}};
  for (const VkFormat format : kFormats)
    for (const bool buffer : {false, true})
      for (const Row& row : kRows) {
        const VkImage image = make_image(format);
        for (std::uint32_t i = 0; i < kSize * kSize; ++i) word(i) = number_of(i);
        if (!buffer) copy(image, true);
        const VkImageView view = make_view(image, format);
        const std::string pointer = buffer ? "%p = OpImageTexelPointer %ptr_atomic %stored_texels %i_signed %u0\n"
                                           : "%p = OpImageTexelPointer %ptr_atomic %stored %at %u0\n";
        const std::string body = "%i_signed = OpBitcast %int %i\n" + pointer + row.code +
                                 "\n%r0 = OpCompositeInsert %v4ulong %old %zero 0\n";
        run_module(body, format, view, make_sampler(VK_BORDER_COLOR_INT_OPAQUE_BLACK), view);
        if (!buffer) copy(image, false);
        for (std::uint32_t i = 0; i < kSize * kSize; ++i) EXPECT_EQ(word(i), row.after(number_of(i))) << row.code << i;
        for (std::uint32_t lane = 0; lane < 64; ++lane) {
          const auto x = static_cast<std::int32_t>(lane % 8) - 2, y = static_cast<std::int32_t>(lane / 8) - 2;
          const bool inside = buffer ? lane < kSize * kSize : is_inside(x, y);
          const std::uint32_t i = buffer ? lane : static_cast<std::uint32_t>(y) * kSize + static_cast<std::uint32_t>(x);
          const std::uint64_t want = !inside ? 0 : row.gives_new ? row.after(number_of(i)) : number_of(i);
          EXPECT_EQ(result(lane, 0)[0], want) << row.code << lane;
        }
      }
}

}  // namespace
}  // namespace vitrine::icd::test

// Sampler Y'CbCr conversions. The reference has none, so the specification's formulas stand in for it: on its side a
// case computes them, and a value of the device that is as near to them as rounding explains counts as theirs.
#include <cmath>
#include <cstring>

#include "harness/case.h"
#include "harness/run.h"
#include "tests/texel/ycbcr_model.h"

namespace vitrine::cts {
namespace {

constexpr uint32_t kWidth = 16, kHeight = 12, kLookups = 256;
constexpr double kTolerance = 2e-5;

struct YcbcrFormat {
  VkFormat format;
  const char* name;
};
#define FORMAT(name) \
  { VK_FORMAT_##name, #name }
constexpr YcbcrFormat kFormats[] = {
    FORMAT(G8B8G8R8_422_UNORM),
    FORMAT(B8G8R8G8_422_UNORM),
    FORMAT(G8_B8_R8_3PLANE_420_UNORM),
    FORMAT(G8_B8R8_2PLANE_420_UNORM),
    FORMAT(G8_B8_R8_3PLANE_422_UNORM),
    FORMAT(G8_B8R8_2PLANE_422_UNORM),
    FORMAT(G8_B8_R8_3PLANE_444_UNORM),
    FORMAT(R10X6G10X6B10X6A10X6_UNORM_4PACK16),
    FORMAT(G10X6B10X6G10X6R10X6_422_UNORM_4PACK16),
    FORMAT(B10X6G10X6R10X6G10X6_422_UNORM_4PACK16),
    FORMAT(G10X6_B10X6_R10X6_3PLANE_420_UNORM_3PACK16),
    FORMAT(G10X6_B10X6R10X6_2PLANE_420_UNORM_3PACK16),
    FORMAT(G10X6_B10X6_R10X6_3PLANE_422_UNORM_3PACK16),
    FORMAT(G10X6_B10X6R10X6_2PLANE_422_UNORM_3PACK16),
    FORMAT(G10X6_B10X6_R10X6_3PLANE_444_UNORM_3PACK16),
    FORMAT(R12X4G12X4B12X4A12X4_UNORM_4PACK16),
    FORMAT(G12X4B12X4G12X4R12X4_422_UNORM_4PACK16),
    FORMAT(B12X4G12X4R12X4G12X4_422_UNORM_4PACK16),
    FORMAT(G12X4_B12X4_R12X4_3PLANE_420_UNORM_3PACK16),
    FORMAT(G12X4_B12X4R12X4_2PLANE_420_UNORM_3PACK16),
    FORMAT(G12X4_B12X4_R12X4_3PLANE_422_UNORM_3PACK16),
    FORMAT(G12X4_B12X4R12X4_2PLANE_422_UNORM_3PACK16),
    FORMAT(G12X4_B12X4_R12X4_3PLANE_444_UNORM_3PACK16),
    FORMAT(G16B16G16R16_422_UNORM),
    FORMAT(B16G16R16G16_422_UNORM),
    FORMAT(G16_B16_R16_3PLANE_420_UNORM),
    FORMAT(G16_B16R16_2PLANE_420_UNORM),
    FORMAT(G16_B16_R16_3PLANE_422_UNORM),
    FORMAT(G16_B16R16_2PLANE_422_UNORM),
    FORMAT(G16_B16_R16_3PLANE_444_UNORM),
    FORMAT(G8_B8R8_2PLANE_444_UNORM),
    FORMAT(G10X6_B10X6R10X6_2PLANE_444_UNORM_3PACK16),
    FORMAT(G12X4_B12X4R12X4_2PLANE_444_UNORM_3PACK16),
    FORMAT(G16_B16R16_2PLANE_444_UNORM),
};
#undef FORMAT

/// The planes of an image as copies see them, tightly packed.
struct Planes {
  struct Plane {
    uint32_t row = 0;  ///< elements
    VkExtent3D extent{};
    std::vector<unsigned char> bytes;
  };
  test::YcbcrName named;
  std::vector<Plane> planes;

  Planes(Random& random, const char* name) : named(name) {
    for (int p = 0; p < named.planes; ++p) {
      Plane plane;
      plane.extent = {p > 0 && named.halved_x ? kWidth / 2 : kWidth, p > 0 && named.halved_y ? kHeight / 2 : kHeight,
                      1};
      const uint32_t per_texel = named.has_alpha ? 4 : named.planes == 1 ? 2 : named.planes == 2 && p == 1 ? 2 : 1;
      plane.row = plane.extent.width * per_texel;
      plane.bytes.resize(size_t{plane.row} * plane.extent.height * static_cast<uint32_t>(named.bytes));
      for (unsigned char& byte : plane.bytes) byte = static_cast<unsigned char>(random.bits() >> 24);
      planes.push_back(std::move(plane));
    }
  }

  double element(int plane, uint32_t y, uint32_t index) const {
    const Plane& p = planes[static_cast<size_t>(plane)];
    uint32_t word = 0;
    std::memcpy(&word, &p.bytes[(size_t{y} * p.row + index) * static_cast<size_t>(named.bytes)],
                static_cast<size_t>(named.bytes));
    return (word >> (8 * named.bytes - named.bits)) / (std::ldexp(1.0, named.bits) - 1);
  }
};

test::YcbcrModel random_model(Random& random, const Planes& planes) {
  test::YcbcrModel model{planes.named, kWidth, kHeight};
  model.element = [&planes](int plane, uint32_t, uint32_t y, uint32_t index) {
    return planes.element(plane, y, index);
  };
  model.model = static_cast<VkSamplerYcbcrModelConversion>(random.below(5));
  model.range = static_cast<VkSamplerYcbcrRange>(random.below(2));
  if (random.chance(0.3f)) std::swap(model.swizzle[0], model.swizzle[2]);
  if (random.chance(0.3f)) model.swizzle[3] = static_cast<uint8_t>(4 + random.below(2));
  model.linear = random.chance(0.5f);
  model.chroma_linear = random.chance(0.5f);
  model.x_cosited = random.chance(0.5f);
  model.y_cosited = random.chance(0.5f);
  return model;
}

VkImage make_image(Run& run, const YcbcrFormat& format, const Planes& planes) {
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format.format;
  info.extent = {kWidth, kHeight, 1};
  info.mipLevels = info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  VkImage image;
  CTS_VK(vkCreateImage(run.device, &info, nullptr, &image));
  VkMemoryRequirements requirements;
  vkGetImageMemoryRequirements(run.device, image, &requirements);
  VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  allocate.allocationSize = requirements.size;
  allocate.memoryTypeIndex = run.gpu.memory_type(requirements.memoryTypeBits, 0);
  VkDeviceMemory memory;
  CTS_VK(vkAllocateMemory(run.device, &allocate, nullptr, &memory));
  run.own(memory, vkFreeMemory);
  run.own(image, vkDestroyImage);
  CTS_VK(vkBindImageMemory(run.device, image, memory, 0));
  run.once([&](VkCommandBuffer cmd) {
    VkImageMemoryBarrier first{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
    first.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    first.newLayout = VK_IMAGE_LAYOUT_GENERAL;
    first.srcQueueFamilyIndex = first.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    first.image = image;
    first.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0,
                         nullptr, 1, &first);
    for (size_t p = 0; p < planes.planes.size(); ++p) {
      const Buffer staging = run.buffer_of(planes.planes[p].bytes);
      VkBufferImageCopy copy{};
      copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
      if (planes.planes.size() > 1) copy.imageSubresource.aspectMask = VK_IMAGE_ASPECT_PLANE_0_BIT << p;
      copy.imageExtent = planes.planes[p].extent;
      vkCmdCopyBufferToImage(cmd, staging.handle, image, VK_IMAGE_LAYOUT_GENERAL, 1, &copy);
    }
  });
  return image;
}

VkSamplerYcbcrConversion make_conversion(Run& run, VkFormat format, const test::YcbcrModel& model) {
  VkSamplerYcbcrConversionCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_YCBCR_CONVERSION_CREATE_INFO};
  info.format = format;
  info.ycbcrModel = model.model;
  info.ycbcrRange = model.range;
  if (model.swizzle[0] == 2) info.components = {VK_COMPONENT_SWIZZLE_B, {}, VK_COMPONENT_SWIZZLE_R, {}};
  if (model.swizzle[3] > 3)
    info.components.a = model.swizzle[3] == 4 ? VK_COMPONENT_SWIZZLE_ZERO : VK_COMPONENT_SWIZZLE_ONE;
  info.xChromaOffset = model.x_cosited ? VK_CHROMA_LOCATION_COSITED_EVEN : VK_CHROMA_LOCATION_MIDPOINT;
  info.yChromaOffset = model.y_cosited ? VK_CHROMA_LOCATION_COSITED_EVEN : VK_CHROMA_LOCATION_MIDPOINT;
  info.chromaFilter = model.chroma_linear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
  VkSamplerYcbcrConversion conversion;
  CTS_VK(vkCreateSamplerYcbcrConversion(run.device, &info, nullptr, &conversion));
  return run.own(conversion, vkDestroySamplerYcbcrConversion);
}

/// What the device samples at the coordinates.
Buffer look_up(Run& run, const YcbcrFormat& format, VkImage image, const test::YcbcrModel& model,
               const std::vector<float>& coordinates) {
  VkSamplerYcbcrConversionInfo conversion{VK_STRUCTURE_TYPE_SAMPLER_YCBCR_CONVERSION_INFO};
  conversion.conversion = make_conversion(run, format.format, model);
  VkSamplerCreateInfo sampler{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO, &conversion};
  sampler.magFilter = sampler.minFilter = model.linear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
  sampler.addressModeU = sampler.addressModeV = sampler.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO, &conversion};
  view.image = image;
  view.viewType = VK_IMAGE_VIEW_TYPE_2D;
  view.format = format.format;
  view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  VkImageView handle;
  CTS_VK(vkCreateImageView(run.device, &view, nullptr, &handle));
  run.own(handle, vkDestroyImageView);
  const Buffer in = run.buffer_of(coordinates), out = run.buffer(kLookups * 16);
  Binding binding{
      0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, {}, {{run.sampler(sampler), handle, VK_IMAGE_LAYOUT_GENERAL}}, {}};
  binding.immutable_samplers = true;
  const Resources res = run.resources({binding, storage_buffer(1, in), storage_buffer(2, out)});
  run.dispatch(res, run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, R"(
layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler2D t;
layout(std430, binding = 1) buffer A { vec2 at[]; };
layout(std430, binding = 2) buffer R { vec4 r[]; };
void main() { r[gl_GlobalInvocationID.x] = textureLod(t, at[gl_GlobalInvocationID.x], 0.0); })")),
               kLookups / 64);
  return out;
}

void convert(Run& run, const YcbcrFormat& format) {
  const bool by_formulas = &run.gpu == &gpus().reference;
  run.require(by_formulas || run.gpu.extension_features.samplerYcbcrConversion, "samplerYcbcrConversion");
  const Planes planes(run.random, format.name);
  const VkImage image = by_formulas ? VK_NULL_HANDLE : make_image(run, format, planes);
  for (int n = 0; n < 4; ++n) {
    const test::YcbcrModel model = random_model(run.random, planes);
    std::vector<float> coordinates(kLookups * 2);
    // A quarter of a texel away from where a nearest texel changes, also outside of the image.
    for (size_t i = 0; i < coordinates.size(); ++i) {
      const uint32_t size = i % 2 ? kHeight : kWidth;
      coordinates[i] =
          (static_cast<float>(run.random.between(-2, static_cast<int32_t>(size) + 1)) + run.random.real(0.25f, 0.75f)) /
          static_cast<float>(size);
    }
    Output output{"lookup" + std::to_string(n), format_info(VK_FORMAT_R32G32B32A32_SFLOAT), 16, kLookups / 16, 1, {}};
    output.bytes.resize(kLookups * 16);
    std::vector<float> values(kLookups * 4);
    if (!by_formulas)
      std::memcpy(values.data(), look_up(run, format, image, model, coordinates).data, output.bytes.size());
    for (size_t i = 0; i < kLookups; ++i) {
      double want[4];
      model.sample(coordinates[2 * i], coordinates[2 * i + 1], 0, want);
      for (size_t c = 0; c < 4; ++c) {
        float& value = values[4 * i + c];
        if (by_formulas || std::abs(value - want[c]) <= kTolerance) value = static_cast<float>(want[c]);
      }
    }
    std::memcpy(output.bytes.data(), values.data(), output.bytes.size());
    run.out(std::move(output));
  }
}

const bool kCases = [] {
  for (const YcbcrFormat& format : kFormats)
    AddCase("texture", std::string("ycbcr.") + format.name, [&format](Run& run) { convert(run, format); });
  return true;
}();

}  // namespace
}  // namespace vitrine::cts

// Images of a run: creation, upload, download, and what multisampled ones hold per sample.
#include "harness/run.h"

#include <algorithm>

namespace vitrine::cts {
namespace {

VkImageType image_type(VkImageViewType view) {
  switch (view) {
    case VK_IMAGE_VIEW_TYPE_1D:
    case VK_IMAGE_VIEW_TYPE_1D_ARRAY:
      return VK_IMAGE_TYPE_1D;
    case VK_IMAGE_VIEW_TYPE_3D:
      return VK_IMAGE_TYPE_3D;
    default:
      return VK_IMAGE_TYPE_2D;
  }
}

VkFormatFeatureFlags needed_features(VkImageUsageFlags usage) {
  VkFormatFeatureFlags needed = 0;
  if (usage & VK_IMAGE_USAGE_SAMPLED_BIT) needed |= VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT;
  if (usage & VK_IMAGE_USAGE_STORAGE_BIT) needed |= VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT;
  if (usage & VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT) needed |= VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT;
  if (usage & VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT) needed |= VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT;
  return needed;
}

VkExtent3D block_extent(const FormatInfo& info, VkExtent3D texels) {
  return {(texels.width + info.block - 1) / info.block, (texels.height + info.block_height - 1) / info.block_height,
          texels.depth};
}

}  // namespace

VkExtent3D Image::level_extent(uint32_t level) const {
  return {std::max(spec.extent.width >> level, 1u), std::max(spec.extent.height >> level, 1u),
          std::max(spec.extent.depth >> level, 1u)};
}

VkFormat aspect_format(VkFormat format, VkImageAspectFlags aspect) {
  if (aspect == VK_IMAGE_ASPECT_STENCIL_BIT) return VK_FORMAT_S8_UINT;
  if (format == VK_FORMAT_D24_UNORM_S8_UINT) return VK_FORMAT_X8_D24_UNORM_PACK32;
  if (format == VK_FORMAT_D32_SFLOAT_S8_UINT) return VK_FORMAT_D32_SFLOAT;
  return format;
}

VkDeviceSize level_bytes(const Image& image, uint32_t level, VkImageAspectFlags aspect) {
  const FormatInfo& info = format_info(aspect_format(image.spec.format, aspect ? aspect : image.aspects()));
  const VkExtent3D blocks = block_extent(info, image.level_extent(level));
  return VkDeviceSize{info.bytes} * blocks.width * blocks.height * blocks.depth * image.spec.layers;
}

Image Run::image(const ImageSpec& spec) {
  const FormatInfo& format = format_info(spec.format);
  require((gpu.features_of(spec.format, spec.tiling) & needed_features(spec.usage)) == needed_features(spec.usage),
          format.name);
  inputs.image(spec);
  Image result;
  result.spec = spec;
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO, spec.next};
  info.flags = spec.flags;
  if (spec.view == VK_IMAGE_VIEW_TYPE_CUBE || spec.view == VK_IMAGE_VIEW_TYPE_CUBE_ARRAY)
    info.flags |= VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT;
  info.imageType = image_type(spec.view);
  info.format = spec.format;
  info.extent = spec.extent;
  info.mipLevels = spec.levels;
  info.arrayLayers = spec.layers;
  info.samples = spec.samples;
  info.tiling = spec.tiling;
  info.usage = spec.usage | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  VkImageFormatProperties limits;
  const VkResult possible = vkGetPhysicalDeviceImageFormatProperties(gpu.physical, info.format, info.imageType,
                                                                     info.tiling, info.usage, info.flags, &limits);
  require(possible == VK_SUCCESS && (limits.sampleCounts & spec.samples) && spec.levels <= limits.maxMipLevels &&
              spec.layers <= limits.maxArrayLayers,
          format.name);
  CTS_VK(vkCreateImage(device, &info, nullptr, &result.handle));
  VkMemoryRequirements requirements;
  vkGetImageMemoryRequirements(device, result.handle, &requirements);
  result.memory =
      allocate(requirements, spec.tiling == VK_IMAGE_TILING_LINEAR ? VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT : 0);
  own(result.handle, vkDestroyImage);
  CTS_VK(vkBindImageMemory(device, result.handle, result.memory, 0));
  constexpr VkImageUsageFlags kViewable = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT |
                                          VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT |
                                          VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
                                          VK_IMAGE_USAGE_FRAGMENT_SHADING_RATE_ATTACHMENT_BIT_KHR;
  if (spec.usage & kViewable) {
    VkImageSubresourceRange range = result.range();
    const bool attachment = spec.usage & VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    if (!attachment && range.aspectMask == (VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT))
      range.aspectMask = VK_IMAGE_ASPECT_DEPTH_BIT;
    result.view = image_view(result, spec.view, spec.format, range, spec.components);
  }
  VkImageMemoryBarrier first{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
  first.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  first.oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
  first.newLayout = VK_IMAGE_LAYOUT_GENERAL;
  first.srcQueueFamilyIndex = first.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  first.image = result.handle;
  first.subresourceRange = result.range();
  pending_.push_back(first);
  return result;
}

VkImageView Run::image_view(const Image& image, VkImageViewType type, VkFormat format, VkImageSubresourceRange range,
                            VkComponentMapping components) {
  VkImageViewCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  info.image = image.handle;
  info.viewType = type;
  info.format = format;
  info.components = components;
  info.subresourceRange = range;
  VkImageView result;
  CTS_VK(vkCreateImageView(device, &info, nullptr, &result));
  return own(result, vkDestroyImageView);
}

void Run::upload(const Image& image, uint32_t level, std::span<const unsigned char> bytes, VkImageAspectFlags aspect) {
  const Buffer staging = buffer(bytes.size());
  std::memcpy(staging.data, bytes.data(), bytes.size());
  once([&](VkCommandBuffer cmd) {
    VkBufferImageCopy region{};
    region.imageSubresource = image.layers(level);
    if (aspect) region.imageSubresource.aspectMask = aspect;
    region.imageExtent = image.level_extent(level);
    vkCmdCopyBufferToImage(cmd, staging.handle, image.handle, VK_IMAGE_LAYOUT_GENERAL, 1, &region);
  });
}

std::vector<unsigned char> Run::download(const Image& image, uint32_t level, VkImageAspectFlags aspect) {
  if (!aspect) aspect = image.aspects();
  const Buffer staging = buffer(level_bytes(image, level, aspect));
  once([&](VkCommandBuffer cmd) {
    VkBufferImageCopy region{};
    region.imageSubresource = image.layers(level);
    region.imageSubresource.aspectMask = aspect;
    region.imageExtent = image.level_extent(level);
    vkCmdCopyImageToBuffer(cmd, image.handle, VK_IMAGE_LAYOUT_GENERAL, staging.handle, 1, &region);
  });
  std::vector<unsigned char> bytes(staging.data, staging.data + staging.size);
  // The copy leaves the upper byte of a 24-bit depth value undefined.
  if (aspect_format(image.spec.format, aspect) == VK_FORMAT_X8_D24_UNORM_PACK32)
    for (size_t i = 3; i < bytes.size(); i += 4) bytes[i] = 0;
  return bytes;
}

Output& Run::out(Output output) {
  outputs.push_back(std::move(output));
  return outputs.back();
}

Output& Run::out(const std::string& name, const Buffer& buffer, VkFormat format) {
  const FormatInfo& info = format_info(format);
  return out(Output{name, info, static_cast<uint32_t>(buffer.size / info.bytes), 1, 1,
                    std::vector<unsigned char>(buffer.data, buffer.data + buffer.size / info.bytes * info.bytes)});
}

void Run::out(const std::string& name, const Image& image) {
  if (image.spec.samples != VK_SAMPLE_COUNT_1_BIT) return out_samples(name, image);
  for (const VkImageAspectFlagBits aspect :
       {VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_ASPECT_STENCIL_BIT}) {
    if (!(image.aspects() & aspect)) continue;
    for (uint32_t level = 0; level < image.spec.levels; ++level) {
      const FormatInfo& info = format_info(aspect_format(image.spec.format, aspect));
      const VkExtent3D extent = block_extent(info, image.level_extent(level));
      std::string full = name;
      if (aspect == VK_IMAGE_ASPECT_STENCIL_BIT) full += ".stencil";
      if (image.spec.levels > 1) full += ".level" + std::to_string(level);
      // A level of a few texels is often one colour without anything being wrong.
      const bool tiny = level > 0 || extent.width * extent.height <= 4;
      out(Output{full,
                 info,
                 extent.width,
                 extent.height,
                 extent.depth * image.spec.layers,
                 download(image, level, aspect),
                 false,
                 {},
                 tiny});
    }
  }
}

namespace {

void out_samples_of(Run& run, const std::string& name, const Image& image, VkImageAspectFlagBits aspect) {
  const bool stencil = aspect == VK_IMAGE_ASPECT_STENCIL_BIT;
  const Numeric numeric = format_info(image.spec.format).numeric;
  const std::string prefix = numeric == Numeric::kUint || stencil ? "u" : numeric == Numeric::kSint ? "i" : "";
  const auto samples = static_cast<uint32_t>(image.spec.samples);
  const uint32_t width = image.spec.extent.width, height = image.spec.extent.height;
  const uint32_t planes = samples * image.spec.layers;
  const Buffer texels = run.buffer(VkDeviceSize{16} * width * height * planes);
  Image readable = image;
  const VkImageSubresourceRange range{static_cast<VkImageAspectFlags>(aspect), 0, 1, 0, image.spec.layers};
  readable.view = run.image_view(image, VK_IMAGE_VIEW_TYPE_2D_ARRAY, image.spec.format, range);
  const Resources res =
      run.resources({sampled(0, readable, run.sampler(VK_FILTER_NEAREST)), storage_buffer(1, texels)});
  const std::string code =
      "layout(local_size_x = 8, local_size_y = 8) in;\n"
      "layout(binding = 0) uniform " +
      prefix +
      "sampler2DMSArray source;\n"
      "layout(binding = 1) buffer Texels { " +
      prefix +
      "vec4 texels[]; };\n"
      "void main() {\n"
      "  ivec2 size = textureSize(source).xy, p = ivec2(gl_GlobalInvocationID.xy);\n"
      "  if (p.x >= size.x || p.y >= size.y) return;\n"
      "  int plane = int(gl_GlobalInvocationID.z), samples = " +
      std::to_string(samples) +
      ";\n"
      "  texels[(plane * size.y + p.y) * size.x + p.x] =\n"
      "      texelFetch(source, ivec3(p, plane / samples), plane % samples);\n"
      "}\n";
  const VkPipeline pipeline = run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, code));
  run.once([&](VkCommandBuffer cmd) {
    vkCmdBindPipeline(cmd, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
    res.bind(cmd, VK_PIPELINE_BIND_POINT_COMPUTE);
    vkCmdDispatch(cmd, (width + 7) / 8, (height + 7) / 8, planes);
  });
  const VkFormat shown = prefix == "u"   ? VK_FORMAT_R32G32B32A32_UINT
                         : prefix == "i" ? VK_FORMAT_R32G32B32A32_SINT
                                         : VK_FORMAT_R32G32B32A32_SFLOAT;
  run.out(Output{stencil ? name + ".stencil" : name, format_info(shown), width, height, planes,
                 std::vector<unsigned char>(texels.data, texels.data + texels.size)});
}

}  // namespace

void Run::out_samples(const std::string& name, const Image& image) {
  for (const VkImageAspectFlagBits aspect :
       {VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_ASPECT_STENCIL_BIT})
    if (image.aspects() & aspect) out_samples_of(*this, name, image, aspect);
}

std::vector<unsigned char> random_texels(Random& random, VkFormat format, size_t bytes) {
  const FormatInfo& info = format_info(format);
  std::vector<unsigned char> result(bytes);
  const auto put = [&](size_t at, uint32_t word, size_t size) { std::memcpy(result.data() + at, &word, size); };
  if (info.bits[0] == 32 && (info.numeric == Numeric::kFloat || info.numeric == Numeric::kDepth)) {
    for (size_t i = 0; i + 4 <= bytes; i += 4) {
      const float value = info.numeric == Numeric::kDepth ? random.unit() : random.real(-2.0f, 3.0f);
      std::memcpy(result.data() + i, &value, 4);
    }
  } else if (info.numeric == Numeric::kFloat) {
    for (size_t i = 0; i + 2 <= bytes; i += 2) put(i, (random.bits() & 0x83ff) | (8 + random.below(9)) << 10, 2);
  } else if (info.numeric == Numeric::kPackedFloat && info.bits[0] == 11) {
    const auto exponent = [&] { return 8 + random.below(9); };
    for (size_t i = 0; i + 4 <= bytes; i += 4)
      put(i, exponent() << 6 | exponent() << 17 | exponent() << 27 | (random.bits() & 0x07c1f83fu), 4);
  } else {
    for (unsigned char& byte : result) byte = static_cast<unsigned char>(random.bits() >> 24);
    if (info.bytes == 4 && info.bits[0] == 24)
      for (size_t i = 3; i < bytes; i += 4) result[i] = 0;
  }
  return result;
}

void Run::fill_random(const Image& image) {
  for (const VkImageAspectFlagBits aspect :
       {VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_ASPECT_DEPTH_BIT, VK_IMAGE_ASPECT_STENCIL_BIT})
    if (image.aspects() & aspect)
      for (uint32_t level = 0; level < image.spec.levels; ++level)
        upload(image, level,
               random_texels(random, aspect_format(image.spec.format, aspect), level_bytes(image, level, aspect)),
               aspect);
}

}  // namespace vitrine::cts

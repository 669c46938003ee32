// Images of several planes in transfers, and views of single planes: sampled, stored to, drawn to. The reference lacks
// the formats; on its side each plane is an image of its own.
#include <algorithm>

#include "cases/api/random_transfer.h"
#include "cases/common/storage_format.h"
#include "harness/case.h"
#include "harness/graphics.h"
#include "texel/format.h"

namespace vitrine::cts {
namespace {

constexpr VkImageLayout kGeneral = VK_IMAGE_LAYOUT_GENERAL;

/// One plane, or an image of one plane, as copies and views name it.
struct Plane {
  Image image;  ///< handle, and the plane's own extent, layers and format
  VkImageAspectFlags aspect;

  VkImageSubresourceLayers layers(uint32_t first, uint32_t count) const { return {aspect, 0, first, count}; }
};

std::vector<VkFormat> planar_formats() {
  std::vector<VkFormat> result;
  const auto add = [&](int first, int last) {
    for (int format = first; format <= last; ++format)
      if (texel::format_desc(static_cast<VkFormat>(format)).plane_count > 1)
        result.push_back(static_cast<VkFormat>(format));
  };
  add(VK_FORMAT_G8B8G8R8_422_UNORM, VK_FORMAT_G16_B16_R16_3PLANE_444_UNORM);
  add(VK_FORMAT_G8_B8R8_2PLANE_444_UNORM, VK_FORMAT_G16_B16R16_2PLANE_444_UNORM);
  return result;
}

/// A format of the suite for the texels of a plane: 10 and 12 bits lie in the upper bits of 16.
VkFormat stored_format(VkFormat plane) {
  switch (texel::format_desc(plane).block_bytes) {
    case 1:
      return VK_FORMAT_R8_UNORM;
    case 2:
      return plane == VK_FORMAT_R8G8_UNORM ? plane : VK_FORMAT_R16_UNORM;
    default:
      return VK_FORMAT_R16G16_UNORM;
  }
}

VkDeviceMemory allocate(Run& run, const VkMemoryRequirements& requirements) {
  VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  info.allocationSize = requirements.size;
  info.memoryTypeIndex = run.gpu.memory_type(requirements.memoryTypeBits, 0);
  VkDeviceMemory memory;
  CTS_VK(vkAllocateMemory(run.device, &info, nullptr, &memory));
  return run.own(memory, vkFreeMemory);
}

/// Memory for the whole, or for every plane of a disjoint image.
void bind_memory(Run& run, VkImage image, uint32_t disjoint_planes) {
  std::vector<VkBindImagePlaneMemoryInfo> planes(disjoint_planes);
  std::vector<VkBindImageMemoryInfo> binds;
  for (uint32_t p = 0; p < std::max(disjoint_planes, 1u); ++p) {
    VkImagePlaneMemoryRequirementsInfo plane{VK_STRUCTURE_TYPE_IMAGE_PLANE_MEMORY_REQUIREMENTS_INFO};
    plane.planeAspect = static_cast<VkImageAspectFlagBits>(VK_IMAGE_ASPECT_PLANE_0_BIT << p);
    const VkImageMemoryRequirementsInfo2 info{VK_STRUCTURE_TYPE_IMAGE_MEMORY_REQUIREMENTS_INFO_2,
                                              disjoint_planes ? &plane : nullptr, image};
    VkMemoryRequirements2 requirements{VK_STRUCTURE_TYPE_MEMORY_REQUIREMENTS_2};
    vkGetImageMemoryRequirements2(run.device, &info, &requirements);
    VkBindImageMemoryInfo bind{VK_STRUCTURE_TYPE_BIND_IMAGE_MEMORY_INFO};
    bind.image = image;
    bind.memory = allocate(run, requirements.memoryRequirements);
    if (disjoint_planes) {
      planes[p] = {VK_STRUCTURE_TYPE_BIND_IMAGE_PLANE_MEMORY_INFO, nullptr, plane.planeAspect};
      bind.pNext = &planes[p];
    }
    binds.push_back(bind);
  }
  CTS_VK(vkBindImageMemory2(run.device, static_cast<uint32_t>(binds.size()), binds.data()));
}

VkImage make_image(Run& run, VkFormat format, VkExtent3D extent, uint32_t layers, VkImageUsageFlags usage,
                   bool disjoint) {
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.flags = VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT | VK_IMAGE_CREATE_EXTENDED_USAGE_BIT;
  if (disjoint) info.flags |= VK_IMAGE_CREATE_DISJOINT_BIT;
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format;
  info.extent = extent;
  info.mipLevels = 1;
  info.arrayLayers = layers;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = usage | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  VkImage image;
  CTS_VK(vkCreateImage(run.device, &info, nullptr, &image));
  bind_memory(run, image, disjoint ? texel::format_desc(format).plane_count : 0);
  run.own(image, vkDestroyImage);
  run.once([&](VkCommandBuffer cmd) {
    VkImageMemoryBarrier first{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
    first.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    first.newLayout = kGeneral;
    first.srcQueueFamilyIndex = first.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    first.image = image;
    first.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, layers};
    if (disjoint) first.subresourceRange.aspectMask = texel::format_desc(format).aspects;
    vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0,
                         nullptr, 1, &first);
  });
  return image;
}

void upload(Run& run, const Plane& plane) {
  const uint32_t layers = plane.image.spec.layers;
  const VkExtent3D extent = plane.image.spec.extent;
  const size_t bytes = size_t{extent.width} * extent.height * layers * format_info(plane.image.spec.format).bytes;
  const Buffer staging = run.buffer_of(random_texels(run.random, plane.image.spec.format, bytes));
  run.once([&](VkCommandBuffer cmd) {
    const VkBufferImageCopy copy{0, 0, 0, plane.layers(0, layers), {}, extent};
    vkCmdCopyBufferToImage(cmd, staging.handle, plane.image.handle, kGeneral, 1, &copy);
  });
}

void out(Run& run, const std::string& name, const Plane& plane) {
  const uint32_t layers = plane.image.spec.layers;
  const VkExtent3D extent = plane.image.spec.extent;
  const FormatInfo& info = format_info(plane.image.spec.format);
  const Buffer staging = run.buffer(VkDeviceSize{extent.width} * extent.height * layers * info.bytes);
  run.once([&](VkCommandBuffer cmd) {
    const VkBufferImageCopy copy{0, 0, 0, plane.layers(0, layers), {}, extent};
    vkCmdCopyImageToBuffer(cmd, plane.image.handle, kGeneral, staging.handle, 1, &copy);
  });
  run.out(Output{name, info, extent.width, extent.height, layers,
                 std::vector<unsigned char>(staging.data, staging.data + staging.size)});
}

/// The planes of an image with random texels.
std::vector<Plane> make_planes(Run& run, VkFormat format, VkExtent3D extent, uint32_t layers, VkImageUsageFlags usage) {
  const texel::FormatDesc& desc = texel::format_desc(format);
  const bool disjoint = run.random.chance(0.4f);
  const bool by_planes = &run.gpu == &gpus().reference;
  run.note("format", std::string(desc.name) + (disjoint ? " disjoint" : ""));
  run.require(by_planes || run.gpu.extension_features.samplerYcbcrConversion, "samplerYcbcrConversion");
  const VkImage whole = by_planes ? VK_NULL_HANDLE : make_image(run, format, extent, layers, usage, disjoint);
  std::vector<Plane> planes;
  for (uint32_t p = 0; p < desc.plane_count; ++p) {
    ImageSpec spec;
    spec.format = stored_format(desc.plane[p].format);
    spec.extent = {extent.width / desc.plane[p].width_divisor, extent.height / desc.plane[p].height_divisor, 1};
    spec.layers = layers;
    spec.view = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
    spec.usage = usage;
    spec.flags = VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT;
    Image image;
    image.handle = whole;
    image.spec = spec;
    planes.push_back({by_planes ? run.image(spec) : image, VK_IMAGE_ASPECT_COLOR_BIT});
    if (!by_planes) planes.back().aspect = VK_IMAGE_ASPECT_PLANE_0_BIT << p;
    upload(run, planes.back());
  }
  return planes;
}

VkExtent3D random_extent(Random& random) { return {2 * (4 + random.below(30)), 2 * (4 + random.below(30)), 1}; }

std::vector<Plane> random_planes(Run& run, VkImageUsageFlags usage) {
  const uint32_t layers = 1 + run.random.below(3);
  const VkExtent3D extent = random_extent(run.random);
  return make_planes(run, run.random.pick(planar_formats()), extent, layers, usage);
}

/// Between buffers, planes of two images, and images of one plane.
CTS_RANDOM("api", "random_planar_copies", 60) {
  Random& random = run.random;
  const std::vector<VkFormat> formats = planar_formats();
  const uint32_t layers = 1 + random.below(3);
  const auto make = [&] {
    const VkExtent3D extent = random_extent(random);
    return make_planes(run, random.pick(formats), extent, layers, 0);
  };
  std::vector<Plane> planes = make();
  const std::vector<Plane> others = make();
  planes.insert(planes.end(), others.begin(), others.end());
  for (const VkFormat format :
       {VK_FORMAT_R8_UINT, VK_FORMAT_R8G8_UNORM, VK_FORMAT_R16_SFLOAT, VK_FORMAT_R8G8B8A8_SNORM}) {
    ImageSpec spec;
    spec.format = format;
    spec.extent = {16 + random.below(40), 16 + random.below(40), 1};
    spec.layers = layers;
    spec.view = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
    planes.push_back({run.image(spec), VK_IMAGE_ASPECT_COLOR_BIT});
    upload(run, planes.back());
  }
  const Buffer buffer = run.buffer(1 << 16);
  for (VkDeviceSize i = 0; i < buffer.size; ++i) buffer.data[i] = static_cast<unsigned char>(random.bits() >> 24);
  run.once([&](VkCommandBuffer cmd) {
    for (int n = 0; n < 8; ++n) {
      const size_t index = random.below(static_cast<uint32_t>(planes.size()));
      const Plane& from = planes[index];
      const uint32_t bytes = format_info(from.image.spec.format).bytes;
      const Region region = random_region(random, from.image, 0);
      const uint32_t first = random.below(layers), count = 1 + random.below(layers - first);
      const uint32_t what = random.below(4);
      if (what < 2) {
        VkBufferImageCopy copy{
            VkDeviceSize{random.below(256)} * 4, 0, 0, from.layers(first, count), region.offset, region.extent};
        if (random.chance(0.5f)) copy.bufferRowLength = region.extent.width + random.below(5);
        if (random.chance(0.5f)) copy.bufferImageHeight = region.extent.height + random.below(3);
        if (what == 0)
          vkCmdCopyBufferToImage(cmd, buffer.handle, from.image.handle, kGeneral, 1, &copy);
        else
          vkCmdCopyImageToBuffer(cmd, from.image.handle, kGeneral, buffer.handle, 1, &copy);
      } else {
        std::vector<size_t> targets;
        for (size_t t = 0; t < planes.size(); ++t)
          if (t != index && format_info(planes[t].image.spec.format).bytes == bytes) targets.push_back(t);
        if (targets.empty()) continue;
        const Plane& to = planes[random.pick(targets)];
        const Region place = random_region(random, to.image, 0);
        const VkImageCopy copy{from.layers(first, count),
                               region.offset,
                               to.layers(random.below(layers - count + 1), count),
                               place.offset,
                               {std::min(region.extent.width, place.extent.width),
                                std::min(region.extent.height, place.extent.height), 1}};
        vkCmdCopyImage(cmd, from.image.handle, kGeneral, to.image.handle, kGeneral, 1, &copy);
      }
      run.barrier(cmd);
    }
  });
  for (size_t p = 0; p < planes.size(); ++p) out(run, "plane" + std::to_string(p), planes[p]);
  run.out("buffer", buffer);
}

/// A view of one plane and one layer of it, in a format of the same size that the reference has these features of.
/// Random texels hold NaNs, which attachments may quiet, so nothing is drawn to floats (nor to signed 10 bits:
/// deviations.md, snorm10-attachments).
Image plane_view(Run& run, const Plane& plane, VkFormatFeatureFlags features) {
  std::vector<VkFormat> formats;
  const bool stored = features & VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT;
  const bool drawn = features & (VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT | VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT);
  const auto fits = [&](const FormatInfo& info) {
    const bool floats = info.numeric == Numeric::kFloat || info.numeric == Numeric::kPackedFloat;
    const bool signed_tens = info.numeric == Numeric::kSnorm && info.bits[0] == 10;
    return info.bytes == format_info(plane.image.spec.format).bytes && info.numeric != Numeric::kSrgb &&
           !(drawn && (floats || signed_tens));
  };
  for (const VkFormat format : stored ? storage_formats(features) : formats_with(features))
    if (fits(format_info(format))) formats.push_back(format);
  Image image = plane.image;
  image.spec.format = run.random.pick(formats);
  image.spec.view = VK_IMAGE_VIEW_TYPE_2D;
  const uint32_t layer = run.random.below(plane.image.spec.layers);
  image.view = run.image_view(image, VK_IMAGE_VIEW_TYPE_2D, image.spec.format, {plane.aspect, 0, 1, layer, 1});
  run.note("view", format_info(image.spec.format).name);
  return image;
}

/// A triangle over the first pixels of a target, with what the resources hold.
void draw(Run& run, const Target& target, const Resources& resources, const std::string& fragment, bool blends) {
  GraphicsSpec spec;
  spec.layout = resources.layout;
  spec.vertex = kFullScreenVertex;
  spec.fragment = fragment;
  if (blends) {
    VkPipelineColorBlendAttachmentState blend{};
    blend.blendEnable = VK_TRUE;
    blend.srcColorBlendFactor = blend.srcAlphaBlendFactor = VK_BLEND_FACTOR_CONSTANT_COLOR;
    blend.dstColorBlendFactor = blend.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_CONSTANT_COLOR;
    blend.colorWriteMask = 0xf;
    spec.blends = {blend};
    for (float& c : spec.blend.blendConstants) c = 0.375f;
  }
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  draw_once(run, target, pipeline, &resources);
}

CTS_RANDOM("texture", "random_plane_sampled", 30) {
  Random& random = run.random;
  const std::vector<Plane> planes = random_planes(run, VK_IMAGE_USAGE_SAMPLED_BIT);
  const Image image = plane_view(run, random.pick(planes), VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT);
  const std::string prefix = glsl_prefix(format_info(image.spec.format));
  const bool linear = prefix.empty() && random.chance(0.6f);
  const Resources resources =
      run.resources({sampled(0, image, run.sampler(linear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST))});
  TargetSpec spec;
  spec.colors = {prefix == "u"   ? VK_FORMAT_R32G32B32A32_UINT
                 : prefix == "i" ? VK_FORMAT_R32G32B32A32_SINT
                                 : VK_FORMAT_R32G32B32A32_SFLOAT};
  const Target target = make_target(run, spec);
  draw(run, target, resources,
       "layout(binding = 0) uniform " + prefix + "sampler2D t;\nlayout(location = 0) out " + prefix +
           "vec4 v;\nvoid main() { v = texture(t, gl_FragCoord.xy * (1.3 / 64.0) - 0.1); }\n",
       false);
  out_target(run, target);
  run.outputs.back().nan_bits_free = true;
}

CTS_RANDOM("texture", "random_plane_stored", 30) {
  Random& random = run.random;
  const std::vector<Plane> planes = random_planes(run, VK_IMAGE_USAGE_STORAGE_BIT);
  const Image image = plane_view(run, random.pick(planes), VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT);
  const std::string prefix = glsl_prefix(format_info(image.spec.format));
  const std::string value =
      prefix.empty() ? "vec4(0.1, 0.4, 0.7, 1.0) * float(p.x + p.y) * 0.02" : prefix + "vec4(p.x, p.y, p.x + p.y, 7)";
  const Resources resources = run.resources({storage_image(0, image)});
  const VkPipeline pipeline = run.compute(
      resources.layout,
      run.shader(VK_SHADER_STAGE_COMPUTE_BIT, "layout(local_size_x = 8, local_size_y = 8) in;\nlayout(binding = 0, " +
                                                  image_layout(image.spec.format) + ") uniform " + prefix +
                                                  "image2D t;\nvoid main() {\n"
                                                  "  ivec2 p = ivec2(gl_GlobalInvocationID.xy);\n"
                                                  "  if ((p.x + p.y) % 3 == 0) imageStore(t, p, " +
                                                  value + ");\n  else imageStore(t, p, imageLoad(t, p).yxzw);\n}\n"));
  run.dispatch(resources, pipeline, 8, 8);
  for (size_t p = 0; p < planes.size(); ++p) out(run, "plane" + std::to_string(p), planes[p]);
}

CTS_RANDOM("texture", "random_plane_drawn", 30) {
  Random& random = run.random;
  const std::vector<Plane> planes = random_planes(run, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
  const bool blends = random.chance(0.5f);
  const Image image =
      plane_view(run, random.pick(planes),
                 blends ? VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT : VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT);
  const Target target = make_target_of(run, image);
  const std::string prefix = glsl_prefix(format_info(image.spec.format));
  draw(run, target, {},
       "layout(location = 0) out " + prefix +
           "vec4 v;\nvoid main() {\n  if (gl_FragCoord.x > gl_FragCoord.y + 9.0) "
           "discard;\n  v = " +
           prefix + "vec4(vec4(gl_FragCoord.xyx, 40.0) * " + (prefix.empty() ? "0.02" : "1.0") + ");\n}\n",
       blends);
  for (size_t p = 0; p < planes.size(); ++p) out(run, "plane" + std::to_string(p), planes[p]);
}

}  // namespace
}  // namespace vitrine::cts

// Images seen in other ways than they were made: slices of volumes as attachments, other formats of a list, separate
// usage of stencil, linear layouts through mapped memory, formats that stand in for attachments.
#include <cstring>

#include "cases/api/random_transfer.h"
#include "cases/common/storage_format.h"
#include "harness/case.h"
#include "harness/execute.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

/// Triangles in random colours, blended where `blends`.
void draw_triangles(Run& run, const Target& target, bool blends, const std::string& geometry = "") {
  Random& random = run.random;
  const std::string prefix = glsl_prefix(format_info(target.spec.colors[0]));
  std::vector<float> vertices;
  for (int v = 0; v < 18; ++v) {
    for (int c = 0; c < 2; ++c) vertices.push_back(random.real(-1.2f, 1.2f));
    vertices.insert(vertices.end(), {0.5f, 1.0f});
    for (int c = 0; c < 4; ++c) vertices.push_back(prefix.empty() ? random.unit() : random.real(0, 120));
  }
  GraphicsSpec spec;
  spec.floats({4, 4});
  spec.vertex = kColorVertex;
  spec.geometry = geometry;
  spec.fragment = "layout(location = 0) in vec4 passed;\nlayout(location = 0) out " + prefix +
                  "vec4 v;\nvoid main() { v = " + prefix + "vec4(passed); }\n";
  if (blends) {
    VkPipelineColorBlendAttachmentState blend{};
    blend.blendEnable = VK_TRUE;
    blend.srcColorBlendFactor = blend.srcAlphaBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
    blend.dstColorBlendFactor = blend.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    blend.colorWriteMask = random.chance(0.7f) ? 0xf : 1 + random.below(15);
    spec.blends = {blend};
  }
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  const Buffer buffer = run.buffer_of(vertices);
  run.once([&](VkCommandBuffer cmd) {
    target.begin(cmd);
    bind_pipeline(cmd, pipeline);
    bind_vertices(cmd, buffer);
    vkCmdDraw(cmd, 18, 1, 0, 0);
    vkCmdEndRenderPass(cmd);
  });
}

/// Slices of a volume as a flat attachment, or as the layers of one.
CTS_RANDOM("image", "random_volume_attachment", 24) {
  Random& random = run.random;
  run.require(run.gpu.features.geometryShader, "geometry shaders");
  ImageSpec spec;
  spec.format = random.pick(
      {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R8G8_UINT, VK_FORMAT_R5G6B5_UNORM_PACK16});
  spec.view = VK_IMAGE_VIEW_TYPE_3D;
  spec.extent = {8 + random.below(40), 8 + random.below(40), 2 + random.below(7)};
  spec.levels = 1 + random.below(2);
  spec.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  spec.flags = VK_IMAGE_CREATE_2D_ARRAY_COMPATIBLE_BIT;
  const Image volume = run.image(spec);
  run.fill_random(volume);
  const uint32_t level = random.below(spec.levels), slices = volume.level_extent(level).depth;
  const bool layered = random.chance(0.5f);
  const uint32_t first = random.below(slices), count = layered ? 1 + random.below(slices - first) : 1;
  Image slice = volume;
  slice.spec.extent = volume.level_extent(level);
  slice.view = run.image_view(volume, layered ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D, spec.format,
                              {VK_IMAGE_ASPECT_COLOR_BIT, level, 1, first, count});
  const std::string geometry =
      "layout(triangles) in;\nlayout(triangle_strip, max_vertices = 3) out;\n"
      "layout(location = 0) in vec4 passed[];\nlayout(location = 0) out vec4 result;\nvoid main() {\n"
      "  for (int i = 0; i < 3; ++i) {\n    gl_Position = gl_in[i].gl_Position;\n    gl_Layer = gl_PrimitiveIDIn % " +
      std::to_string(count) + ";\n    result = passed[i];\n    EmitVertex();\n  }\n}\n";
  draw_triangles(run, make_target_of(run, slice, count), false, layered ? geometry : "");
  run.out("volume", volume);
}

/// An image with a list of formats, looked up, stored to and drawn to in one of the others.
CTS_RANDOM("image", "random_format_list", 40) {
  Random& random = run.random;
  run.require(run.gpu.has("VK_KHR_image_format_list"), "VK_KHR_image_format_list");
  const uint32_t use = random.below(3);
  const VkFormatFeatureFlags features = use == 0   ? VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT
                                        : use == 1 ? VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT
                                                   : VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT;
  const auto fits = [&](const FormatInfo& info) {
    const bool floats = info.numeric == Numeric::kFloat || info.numeric == Numeric::kPackedFloat;
    const bool signed_tens = info.numeric == Numeric::kSnorm && info.bits[0] == 10;
    return info.numeric != Numeric::kSrgb && !(use == 2 && (floats || signed_tens));
  };
  std::vector<VkFormat> formats, others;
  for (const VkFormat format : use == 1 ? storage_formats(features) : formats_with(features))
    if (fits(format_info(format))) formats.push_back(format);
  ImageSpec spec;
  spec.format = random.pick(formats);
  for (const VkFormat format : formats)
    if (format_info(format).bytes == format_info(spec.format).bytes) others.push_back(format);
  const VkFormat view_format = random.pick(others);
  const VkFormat list[] = {view_format, spec.format};
  VkImageFormatListCreateInfo list_info{VK_STRUCTURE_TYPE_IMAGE_FORMAT_LIST_CREATE_INFO};
  list_info.viewFormatCount = view_format == spec.format ? 1 : 2;
  list_info.pViewFormats = list;
  spec.next = &list_info;
  spec.flags = VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT;
  spec.extent = {8 + random.below(40), 8 + random.below(40), 1};
  spec.levels = 1 + random.below(3);
  spec.layers = 1 + random.below(3);
  spec.view = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
  spec.usage = use == 0   ? VkImageUsageFlags{VK_IMAGE_USAGE_SAMPLED_BIT}
               : use == 1 ? VkImageUsageFlags{VK_IMAGE_USAGE_STORAGE_BIT}
                          : VkImageUsageFlags{VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT};
  const Image image = run.image(spec);
  run.fill_random(image);
  run.note("formats", std::string(format_info(spec.format).name) + " as " + format_info(view_format).name);
  const uint32_t level = random.below(spec.levels), layer = random.below(spec.layers);
  Image seen = image;
  seen.spec.format = view_format;
  seen.spec.extent = image.level_extent(level);
  seen.view =
      run.image_view(image, VK_IMAGE_VIEW_TYPE_2D, view_format, {VK_IMAGE_ASPECT_COLOR_BIT, level, 1, layer, 1});
  const std::string prefix = glsl_prefix(format_info(view_format));
  if (use == 2) {
    draw_triangles(run, make_target_of(run, seen, 1), false);
  } else {
    const Buffer result = run.buffer(VkDeviceSize{16} * 4096);
    std::memset(result.data, 0, result.size);
    const std::string head = "layout(local_size_x = 8, local_size_y = 8) in;\nlayout(std430, binding = 1) buffer R { " +
                             prefix + "vec4 r[]; };\n";
    const std::string body =
        use == 0 ? "layout(binding = 0) uniform " + prefix +
                       "sampler2D t;\nvoid main() {\n  ivec2 p = ivec2(gl_GlobalInvocationID.xy);\n"
                       "  r[p.y * 64 + p.x] = texelFetch(t, p % textureSize(t, 0), 0);\n}\n"
                 : "layout(binding = 0, " + image_layout(view_format) + ") uniform " + prefix +
                       "image2D t;\nvoid main() {\n  ivec2 p = ivec2(gl_GlobalInvocationID.xy);\n"
                       "  r[p.y * 64 + p.x] = imageLoad(t, p);\n  imageStore(t, p, imageLoad(t, p).yxzw);\n}\n";
    const Resources res =
        run.resources({use == 0 ? sampled(0, seen, run.sampler(VK_FILTER_NEAREST)) : storage_image(0, seen),
                       storage_buffer(1, result)});
    run.dispatch(res, run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, head + body)), 8, 8);
    run.out("seen", result, prefix.empty() ? VK_FORMAT_R32G32B32A32_SFLOAT : VK_FORMAT_R32G32B32A32_UINT)
        .nan_bits_free = true;
  }
  run.out("image", image);
  for (Output& output : run.outputs) output.nan_bits_free = output.may_be_blank = true;
}

/// Depth and stencil with usages of their own: one is sampled, the other drawn to or sampled as well.
CTS_RANDOM("image", "random_stencil_usage", 16) {
  Random& random = run.random;
  run.require(run.gpu.has("VK_EXT_separate_stencil_usage"), "VK_EXT_separate_stencil_usage");
  VkImageStencilUsageCreateInfo stencil{VK_STRUCTURE_TYPE_IMAGE_STENCIL_USAGE_CREATE_INFO};
  stencil.stencilUsage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
  ImageSpec spec;
  spec.format = random.pick({VK_FORMAT_D24_UNORM_S8_UINT, VK_FORMAT_D32_SFLOAT_S8_UINT});
  spec.extent = {64, 64, 1};
  spec.next = &stencil;
  spec.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  const Image image = run.image(spec);
  run.fill_random(image);
  Image stencil_image = image;
  stencil_image.view =
      run.image_view(image, VK_IMAGE_VIEW_TYPE_2D, spec.format, {VK_IMAGE_ASPECT_STENCIL_BIT, 0, 1, 0, 1});
  const Buffer result = run.buffer(VkDeviceSize{8} * 4096);
  const Resources res =
      run.resources({sampled(0, image, run.sampler(VK_FILTER_NEAREST)),
                     sampled(1, stencil_image, run.sampler(VK_FILTER_NEAREST)), storage_buffer(2, result)});
  const VkPipeline pipeline = run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, R"(
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D d;
layout(binding = 1) uniform usampler2D s;
layout(std430, binding = 2) buffer R { uvec2 r[]; };
void main() {
  ivec2 p = ivec2(gl_GlobalInvocationID.xy);
  r[p.y * 64 + p.x] = uvec2(floatBitsToUint(texelFetch(d, p, 0).x), texelFetch(s, p, 0).x);
})"));
  run.dispatch(res, pipeline, 8, 8);
  run.out("sampled", result);
  run.out("image", image);
}

/// Written and read through mapped memory, where the layout says that its texels are.
CTS_RANDOM("image", "random_linear_layout", 40) {
  Random& random = run.random;
  std::vector<VkFormat> formats;
  for (const VkFormat format : formats_with(VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT, true))
    if (gpus().reference.features_of(format, VK_IMAGE_TILING_LINEAR) & VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT)
      formats.push_back(format);
  ImageSpec spec = random_spec(random, random.pick(formats));
  spec.tiling = VK_IMAGE_TILING_LINEAR;
  const Image image = run.image(spec);
  run.fill_random(image);
  unsigned char* mapped = nullptr;
  CTS_VK(vkMapMemory(run.device, image.memory, 0, VK_WHOLE_SIZE, 0, reinterpret_cast<void**>(&mapped)));
  const FormatInfo& info = format_info(spec.format);
  std::vector<unsigned char> seen;
  for (uint32_t level = 0; level < spec.levels; ++level)
    for (uint32_t layer = 0; layer < spec.layers; ++layer) {
      const VkImageSubresource part{VK_IMAGE_ASPECT_COLOR_BIT, level, layer};
      VkSubresourceLayout layout;
      vkGetImageSubresourceLayout(run.device, image.handle, &part, &layout);
      const VkExtent3D extent = image.level_extent(level);
      const uint32_t columns = (extent.width + info.block - 1) / info.block,
                     rows = (extent.height + info.block_height - 1) / info.block_height;
      for (uint32_t z = 0; z < extent.depth; ++z)
        for (uint32_t y = 0; y < rows; ++y) {
          unsigned char* row = mapped + layout.offset + z * layout.depthPitch + y * layout.rowPitch;
          seen.insert(seen.end(), row, row + size_t{columns} * info.bytes);
          if (y % 3 == 1) std::memset(row, 0x2b, size_t{columns / 2} * info.bytes);
        }
    }
  vkUnmapMemory(run.device, image.memory);
  const Buffer copy = run.buffer_of(seen);
  run.out("seen", copy, VK_FORMAT_R8_UINT);
  run.out("image", image);
}

/// What a format without a peer in the reference holds after draws, with the order of its fields made the peer's.
CTS_RANDOM("image", "random_r4g4b4a4_attachment", 16) {
  const bool stands_in = &run.gpu == &gpus().reference;
  ImageSpec spec;
  spec.format = stands_in ? VK_FORMAT_B4G4R4A4_UNORM_PACK16 : VK_FORMAT_R4G4B4A4_UNORM_PACK16;
  spec.extent = {40, 30, 1};
  spec.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  const Image image = run.image(spec);
  const auto swapped = [&](std::vector<unsigned char> bytes) {
    for (size_t i = 0; stands_in && i < bytes.size(); i += 2) {
      const auto red = static_cast<unsigned char>(bytes[i + 1] >> 4), blue = static_cast<unsigned char>(bytes[i] >> 4);
      bytes[i + 1] = static_cast<unsigned char>((bytes[i + 1] & 15) | blue << 4);
      bytes[i] = static_cast<unsigned char>((bytes[i] & 15) | red << 4);
    }
    return bytes;
  };
  run.upload(image, 0, swapped(random_texels(run.random, spec.format, 40 * 30 * 2)));
  draw_triangles(run, make_target_of(run, image, 1), run.random.chance(0.8f));
  run.out(Output{"color", format_info(VK_FORMAT_R4G4B4A4_UNORM_PACK16), 40, 30, 1, swapped(run.download(image, 0))});
}

/// Stores to an sRGB image are encoded as an attachment's colours are; the reference, which has no such storage images,
/// draws them. Loads are fetches.
CTS_RANDOM("image", "random_srgb_storage", 12) {
  Random& random = run.random;
  const bool draws = &run.gpu == &gpus().reference;
  run.require(reference_cpu().srgb_comparable, "a comparable sRGB encoding");
  run.require(draws || run.gpu.features.shaderStorageImageWriteWithoutFormat, "stores without a format");
  const VkFormat format =
      random.pick({VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_B8G8R8A8_SRGB, VK_FORMAT_A8B8G8R8_SRGB_PACK32});
  std::vector<float> values(64 * 64 * 4);
  for (float& value : values) value = random.chance(0.8f) ? random.unit() : random.real(-1.0f, 2.0f);
  ImageSpec table_spec;
  table_spec.format = VK_FORMAT_R32G32B32A32_SFLOAT;
  table_spec.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  const Image table = run.image(table_spec);
  run.upload(table, 0, {reinterpret_cast<const unsigned char*>(values.data()), values.size() * 4});
  ImageSpec spec;
  spec.format = format;
  spec.usage = draws ? VkImageUsageFlags{VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT}
                     : VkImageUsageFlags{VK_IMAGE_USAGE_STORAGE_BIT};
  const Image image = run.image(spec);
  const VkSampler nearest = run.sampler(VK_FILTER_NEAREST);
  const Buffer loaded = run.buffer(VkDeviceSize{16} * 4096);
  if (draws) {
    const Target target = make_target_of(run, image, 1);
    const Resources res = run.resources({sampled(0, table, nearest)});
    GraphicsSpec draw;
    draw.layout = res.layout;
    draw.vertex = kFullScreenVertex;
    draw.fragment =
        "layout(binding = 0) uniform sampler2D t;\nlayout(location = 0) out vec4 v;\n"
        "void main() { v = texelFetch(t, ivec2(gl_FragCoord.xy), 0); }\n";
    const VkPipeline pipeline = make_pipeline(run, draw, target);
    draw_once(run, target, pipeline, &res);
  }
  const std::string head =
      "#extension GL_EXT_shader_image_load_formatted : require\nlayout(local_size_x = 8, local_size_y = 8) in;\n"
      "layout(binding = 0) uniform sampler2D t;\nlayout(std430, binding = 2) buffer R { vec4 r[]; };\n"
      "layout(binding = 1) uniform " +
      std::string(draws ? "sampler2D" : "image2D") +
      " a;\nvoid main() {\n  ivec2 p = ivec2(gl_GlobalInvocationID.xy);\n  ";
  const std::string load =
      head + "r[p.y * 64 + p.x] = " + (draws ? "texelFetch(a, p, 0)" : "imageLoad(a, p)") + ";\n}\n";
  const Resources res =
      run.resources({sampled(0, table, nearest), draws ? sampled(1, image, nearest) : storage_image(1, image),
                     storage_buffer(2, loaded)});
  if (!draws)
    run.dispatch(res,
                 run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT,
                                                    head + "imageStore(a, p, texelFetch(t, p, 0));\n}\n")),
                 8, 8);
  run.dispatch(res, run.compute(res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT, load)), 8, 8);
  run.out("stored", image);
  run.out("loaded", loaded, VK_FORMAT_R32G32B32A32_SFLOAT);
}

}  // namespace
}  // namespace vitrine::cts

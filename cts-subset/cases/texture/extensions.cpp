// What extensions and optional features add: custom border colours, 2D views of volumes, minima and maxima, cubes with
// seams, volumes of depth, multisampled storage images.
#include <cstring>

#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

/// One lookup per pixel of a 64x64 target; `code` sets vec4 v from vec2 p (0..1 over the target).
void look_up(Run& run, VkImageView view, VkSampler sampler, const std::string& code, const char* type,
             const char* extension = "") {
  Binding binding{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, {}, {{sampler, view, VK_IMAGE_LAYOUT_GENERAL}}, {}};
  const Resources res = run.resources({binding});
  TargetSpec target_spec;
  target_spec.colors = {VK_FORMAT_R32G32B32A32_SFLOAT};
  const Target target = make_target(run, target_spec);
  GraphicsSpec spec;
  spec.layout = res.layout;
  spec.vertex = kFullScreenVertex;
  spec.fragment =
      std::string(extension) + "layout(binding = 0) uniform sampler" + type +
      " t;\nlayout(location = 0) out vec4 v;\nvoid main() {\n  vec2 p = gl_FragCoord.xy * 0.015625;\n  v = " + code +
      ";\n}\n";
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  draw_once(run, target, pipeline, &res);
  run.out("color", target.colors[0]);
  run.outputs.back().nan_bits_free = true;
}

Image random_image(Run& run, VkFormat format, VkExtent3D extent, VkImageViewType view = VK_IMAGE_VIEW_TYPE_2D,
                   uint32_t layers = 1, VkImageCreateFlags flags = 0) {
  ImageSpec spec;
  spec.format = format;
  spec.extent = extent;
  spec.view = view;
  spec.layers = layers;
  spec.flags = flags;
  spec.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  const Image image = run.image(spec);
  run.fill_random(image);
  return image;
}

CTS_RANDOM("texture", "custom_border", 12) {
  run.require(run.gpu.extension_features.customBorderColors, "customBorderColors");
  Random& random = run.random;
  const VkFormat format =
      random.pick({VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R8G8B8A8_SNORM, VK_FORMAT_R16G16B16A16_SFLOAT,
                   VK_FORMAT_R8_UNORM, VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_B10G11R11_UFLOAT_PACK32});
  VkSamplerCustomBorderColorCreateInfoEXT custom{VK_STRUCTURE_TYPE_SAMPLER_CUSTOM_BORDER_COLOR_CREATE_INFO_EXT};
  for (float& c : custom.customBorderColor.float32) c = random.real(-1.5f, 1.5f);
  if (random.chance(0.5f)) custom.format = format;
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO, &custom};
  info.magFilter = info.minFilter = random.chance(0.5f) ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
  info.addressModeU = info.addressModeV = info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
  info.borderColor = VK_BORDER_COLOR_FLOAT_CUSTOM_EXT;
  const Image image = random_image(run, format, {13, 16, 1});
  VkComponentMapping mapping{};
  if (random.chance(0.5f)) {
    mapping = {VK_COMPONENT_SWIZZLE_B, VK_COMPONENT_SWIZZLE_ONE, VK_COMPONENT_SWIZZLE_R, VK_COMPONENT_SWIZZLE_A};
  }
  const VkImageView view = run.image_view(image, VK_IMAGE_VIEW_TYPE_2D, format, image.range(), mapping);
  look_up(run, view, run.sampler(info), "texture(t, p * 3.0 - 1.0)", "2D");
}

/// The operand MinLod, which the reference does not have: it samples the level that the lookup finds, or that one.
CTS_RANDOM("texture", "shader_min_lod", 16) {
  Random& random = run.random;
  ImageSpec spec;
  spec.format = random.pick({VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32_SFLOAT});
  spec.extent = {64, 32, 1};
  spec.levels = 7;
  spec.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  const Image image = run.image(spec);
  run.fill_random(image);
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = info.minFilter = random.chance(0.5f) ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
  info.mipmapMode = random.chance(0.5f) ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
  info.minLod = random.chance(0.3f) ? random.real(0, 2) : 0;
  info.maxLod = random.chance(0.5f) ? 5 : VK_LOD_CLAMP_NONE;
  const std::string at = "p * p * " + std::to_string(random.real(0.5f, 12.0f));
  const std::string level = std::to_string(random.real(0, 5)) + " * p.x";
  const bool has = run.gpu.features.shaderResourceMinLod;
  look_up(run, image.view, run.sampler(info),
          has ? "textureClampARB(t, " + at + ", " + level + ")"
              : "textureLod(t, " + at + ", max(textureQueryLod(t, " + at + ").y, " + level + "))",
          "2D", has ? "#extension GL_ARB_sparse_texture_clamp : require\n" : "");
}

CTS_RANDOM("texture", "view_of_3d", 8) {
  run.require(run.gpu.extension_features.sampler2DViewOf3D, "sampler2DViewOf3D");
  Random& random = run.random;
  const VkFormat format = random.pick({VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R32G32B32A32_SFLOAT});
  const Image image =
      random_image(run, format, {20, 31, 9}, VK_IMAGE_VIEW_TYPE_3D, 1, VK_IMAGE_CREATE_2D_VIEW_COMPATIBLE_BIT_EXT);
  VkImageSubresourceRange range{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, random.below(9), 1};
  const VkImageView view = run.image_view(image, VK_IMAGE_VIEW_TYPE_2D, format, range);
  look_up(run, view, run.sampler(random.chance(0.5f) ? VK_FILTER_LINEAR : VK_FILTER_NEAREST),
          "texture(t, p * 2.0 - 0.5)", "2D");
}

/// Blocks of a compressed image as texels of another format.
CTS_RANDOM("texture", "block_texel_view", 24) {
  Random& random = run.random;
  const bool wide = random.chance(0.5f);
  ImageSpec spec;
  spec.format = wide ? random.pick({VK_FORMAT_BC3_UNORM_BLOCK, VK_FORMAT_BC5_UNORM_BLOCK, VK_FORMAT_BC7_UNORM_BLOCK})
                     : random.pick({VK_FORMAT_BC1_RGBA_UNORM_BLOCK, VK_FORMAT_BC4_UNORM_BLOCK});
  spec.extent = {4 * (5 + random.below(12)), 4 * (5 + random.below(12)), 1};
  spec.levels = 3;
  spec.layers = 2;
  spec.view = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
  spec.flags = VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT | VK_IMAGE_CREATE_BLOCK_TEXEL_VIEW_COMPATIBLE_BIT;
  spec.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  const Image image = run.image(spec);
  run.fill_random(image);
  const VkFormat format =
      wide ? VK_FORMAT_R32G32B32A32_SFLOAT : random.pick({VK_FORMAT_R16G16B16A16_UNORM, VK_FORMAT_R16G16B16A16_SNORM});
  const VkImageSubresourceRange range{VK_IMAGE_ASPECT_COLOR_BIT, random.below(3), 1, random.below(2), 1};
  const VkImageView view = run.image_view(image, VK_IMAGE_VIEW_TYPE_2D, format, range);
  const bool fetched = wide || random.chance(0.5f);
  look_up(run, view, run.sampler(random.chance(0.5f) ? VK_FILTER_LINEAR : VK_FILTER_NEAREST),
          fetched ? "texelFetch(t, ivec2(gl_FragCoord.xy) % textureSize(t, 0), 0)" : "texture(t, p * 2.0 - 0.5)", "2D");
}

/// A slice of a volume as a storage image: read and written, with the other slices left alone.
CTS_RANDOM("texture", "storage_view_of_3d", 8) {
  run.require(run.gpu.extension_features.image2DViewOf3D, "image2DViewOf3D");
  Random& random = run.random;
  ImageSpec spec;
  spec.format = random.pick({VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R32G32B32A32_SFLOAT});
  spec.extent = {20, 31, 9};
  spec.levels = 2;
  spec.view = VK_IMAGE_VIEW_TYPE_3D;
  spec.flags = VK_IMAGE_CREATE_2D_VIEW_COMPATIBLE_BIT_EXT;
  spec.usage = VK_IMAGE_USAGE_STORAGE_BIT;
  const Image image = run.image(spec);
  run.fill_random(image);
  const uint32_t level = random.below(2);
  const VkImageSubresourceRange range{VK_IMAGE_ASPECT_COLOR_BIT, level, 1, random.below(9u >> level), 1};
  const VkImageView view = run.image_view(image, VK_IMAGE_VIEW_TYPE_2D, spec.format, range);
  const Resources res =
      run.resources({{0, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, {}, {{VK_NULL_HANDLE, view, VK_IMAGE_LAYOUT_GENERAL}}, {}}});
  const std::string layout = spec.format == VK_FORMAT_R8G8B8A8_UNORM ? "rgba8" : "rgba32f";
  const VkPipeline pipeline = run.compute(
      res.layout, run.shader(VK_SHADER_STAGE_COMPUTE_BIT,
                             "layout(local_size_x = 5, local_size_y = 5) in;\nlayout(binding = 0, " + layout +
                                 ") uniform image2D slice;\nvoid main() {\n"
                                 "  ivec2 p = ivec2(gl_GlobalInvocationID.xy);\n"
                                 "  imageStore(slice, p, imageLoad(slice, p).bgra);\n}\n"));
  run.dispatch(res, pipeline, 2, 3);
  run.out("volume", image);
}

CTS_RANDOM("texture", "minmax", 16) {
  run.require(run.gpu.has("VK_EXT_sampler_filter_minmax"), "VK_EXT_sampler_filter_minmax");
  Random& random = run.random;
  const VkFormat format = random.pick(
      {VK_FORMAT_R8_UNORM, VK_FORMAT_R8_SNORM, VK_FORMAT_R16_UNORM, VK_FORMAT_R16_SFLOAT, VK_FORMAT_R32_SFLOAT});
  const Image image = random_image(run, format, {13, 16, 1});
  VkSamplerReductionModeCreateInfo reduction{VK_STRUCTURE_TYPE_SAMPLER_REDUCTION_MODE_CREATE_INFO};
  reduction.reductionMode = random.chance(0.5f) ? VK_SAMPLER_REDUCTION_MODE_MIN : VK_SAMPLER_REDUCTION_MODE_MAX;
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO, &reduction};
  info.magFilter = info.minFilter = VK_FILTER_LINEAR;
  info.addressModeU = info.addressModeV = info.addressModeW = random.pick(
      {VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT});
  look_up(run, image.view, run.sampler(info), "texture(t, p * 3.0 - 1.0)", "2D");
}

/// Each face is an image of its own. The reference clamps to the edge whatever the address mode, so that is the mode.
CTS_RANDOM("texture", "non_seamless_cube", 24) {
  run.require(run.gpu.extension_features.nonSeamlessCubeMap, "nonSeamlessCubeMap");
  Random& random = run.random;
  const VkFormat format = random.pick({VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_R16G16B16A16_SFLOAT,
                                       VK_FORMAT_R5G6B5_UNORM_PACK16});
  const uint32_t side = 4 + random.below(21);
  const Image image = random_image(run, format, {side, side, 1}, VK_IMAGE_VIEW_TYPE_CUBE, 6);
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.flags = VK_SAMPLER_CREATE_NON_SEAMLESS_CUBE_MAP_BIT_EXT;
  info.magFilter = info.minFilter = random.chance(0.8f) ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
  info.addressModeU = info.addressModeV = info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  const std::string direction = "vec3(p * 4.0 - 2.0, sin(p.x * 7.0 + p.y * 11.0))";
  const bool gathers = random.chance(0.25f);
  look_up(run, image.view, run.sampler(info),
          gathers ? "textureGather(t, " + direction + ", 1)" : "texture(t, " + direction + ")", "Cube");
}

/// Volumes of depth and of stencil: uploaded, sampled, cleared, copied.
CTS_RANDOM("texture", "depth_volume", 12) {
  Random& random = run.random;
  const VkFormat format = random.pick({VK_FORMAT_D16_UNORM, VK_FORMAT_X8_D24_UNORM_PACK32, VK_FORMAT_D32_SFLOAT});
  const Image image = random_image(run, format, {20, 13, 7}, VK_IMAGE_VIEW_TYPE_3D);
  look_up(run, image.view, run.sampler(VK_FILTER_NEAREST), "texture(t, vec3(p * 2.0 - 0.5, p.x + p.y))", "3D");
  ImageSpec spec;
  spec.format = random.pick({format, VK_FORMAT_D24_UNORM_S8_UINT, VK_FORMAT_S8_UINT});
  spec.extent = {20, 13, 7};
  spec.levels = 2;
  spec.view = VK_IMAGE_VIEW_TYPE_3D;
  spec.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  const Image cleared = run.image(spec);
  run.fill_random(cleared);
  run.once([&](VkCommandBuffer cmd) {
    const VkClearDepthStencilValue value{random.unit(), random.below(256)};
    const VkImageSubresourceRange range{cleared.aspects(), 1, 1, 0, 1};
    vkCmdClearDepthStencilImage(cmd, cleared.handle, VK_IMAGE_LAYOUT_GENERAL, &value, 1, &range);
  });
  run.out("cleared", cleared);
}

/// Every sample written, changed and read by number.
CTS_RANDOM("texture", "storage_multisample", 12) {
  run.require(run.gpu.features.shaderStorageImageMultisample, "shaderStorageImageMultisample");
  Random& random = run.random;
  const bool integers = random.chance(0.5f), array = random.chance(0.5f);
  ImageSpec spec;
  spec.format = integers ? VK_FORMAT_R32_UINT : random.pick({VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R32G32B32A32_SFLOAT});
  spec.extent = {19, 11, 1};
  spec.samples = VK_SAMPLE_COUNT_4_BIT;
  spec.layers = array ? 3 : 1;
  spec.view = array ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
  spec.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  const Image image = run.image(spec);
  const uint32_t words = 19 * 11 * 3 * 4 * 4;
  const Buffer result = run.buffer(words * 4);
  std::memset(result.data, 0, words * 4);
  const Resources res = run.resources({storage_image(0, image), storage_buffer(1, result)});
  const std::string kind = std::string(integers ? "u" : "") + "image2DMS" + (array ? "Array" : "");
  const std::string layout = integers ? "r32ui" : spec.format == VK_FORMAT_R8G8B8A8_UNORM ? "rgba8" : "rgba32f";
  const std::string place = array ? "ivec3(g)" : "ivec2(g.xy)";
  const std::string value = integers ? "uvec4(g.x * 7u + g.y * 31u + g.z + uint(s) * 1000u)"
                                     : "vec4(float(g.x) * 0.05, float(g.y) * 0.1, float(g.z) * 0.3, float(s) * 0.25)";
  const std::string change =
      integers ? "imageAtomicAdd(image, " + place + ", s, uint(s) + g.x);"
               : "imageStore(image, " + place + ", s, imageLoad(image, " + place + ", s).wzyx * 0.5);";
  const std::string bits =
      integers ? "imageLoad(image, " + place + ", s)" : "floatBitsToUint(imageLoad(image, " + place + ", s))";
  const VkPipeline pipeline = run.compute(
      res.layout,
      run.shader(VK_SHADER_STAGE_COMPUTE_BIT,
                 "layout(local_size_x = 4, local_size_y = 4) in;\nlayout(binding = 0, " + layout + ") uniform " + kind +
                     " image;\nlayout(binding = 1) buffer Result { uvec4 result[]; };\nvoid main() {\n"
                     "  uvec3 g = gl_GlobalInvocationID;\n"
                     "  for (int s = 0; s < 4; ++s) imageStore(image, " +
                     place + ", s, " + value +
                     ");\n"
                     "  for (int s = 3; s >= 1; --s) { " +
                     change +
                     " }\n"
                     "  if (g.x >= 19u || g.y >= 11u) return;\n"
                     "  for (int s = 0; s < 4; ++s) result[((g.z * 11u + g.y) * 19u + g.x) * 4u + uint(s)] = " +
                     bits + ";\n}\n"));
  run.dispatch(res, pipeline, 5, 3, array ? 3 : 1);
  run.out("samples", result);
}

}  // namespace
}  // namespace vitrine::cts

// Texture-bound full-screen fragments: filters, formats, dimensions.
#include <string>

#include "bench.h"

namespace vitrine::bench {
namespace {

constexpr char kOnce[] = "uniform sampler2D t; void main() { o = texture(t, uv * vec2(3.1, 2.3)); }";
constexpr char kBlur[] =
    "uniform sampler2D t; void main() { vec4 s = vec4(0); for (int i = -4; i < 4; ++i)"
    " s += texture(t, uv + vec2(float(i) * 0.004, 0.0)); o = s * 0.125; }";
constexpr char kBlur25[] =
    "uniform sampler2D t; void main() { vec4 s = vec4(0); float w = 0.0; for (int y = -2; y <= 2; ++y)"
    " for (int x = -2; x <= 2; ++x) { float g = exp2(-0.3 * float(x * x + y * y)); w += g;"
    " s += g * texture(t, uv + vec2(x, y) * 0.0021); } o = s / w; }";
constexpr char kFetch25[] =
    "uniform sampler2D t; void main() { ivec2 p = ivec2(uv * 507.0) + 2; vec4 s = vec4(0); for (int y = -2; y <= 2; "
    "++y)"
    " for (int x = -2; x <= 2; ++x) s += texelFetch(t, p + ivec2(x, y), 0) * (1.0 / float(1 + x * x + y * y)); o = s; "
    "}";
constexpr char kRadial[] =
    "uniform sampler2D t; void main() { vec2 d = (vec2(0.5, 0.4) - uv) / 24.0; vec2 p = uv; vec4 s = vec4(0);"
    " float a = 1.0; for (int i = 0; i < 24; ++i) { s += texture(t, p) * a; p += d; a *= 0.93; } o = s * 0.085; }";
constexpr char kStretched[] = "uniform sampler2D t; void main() { o = texture(t, uv * vec2(6.0, 1.1)); }";
constexpr char kStretchedCube[] =
    "uniform samplerCube t; void main() { o = texture(t, vec3((uv * 2.0 - 1.0) * vec2(1.0, 0.2), 1.1)); }";
constexpr char kShadow[] =
    "uniform sampler2DShadow t; void main() { o = vec4(texture(t, vec3(uv * vec2(3.1, 2.3), 0.5))); }";
constexpr char kCube[] = "uniform samplerCube t; void main() { o = texture(t, vec3(uv * 2.0 - 1.0, 0.7)); }";
constexpr char kVolume[] =
    "uniform sampler3D t; void main() { o = texture(t, vec3(uv * vec2(3.1, 2.3), uv.x + uv.y)); }";

constexpr char kGather[] = "uniform sampler2D t; void main() { o = textureGather(t, uv * vec2(3.1, 2.3), 1); }";
constexpr char kGatherOffsets[] =
    "uniform sampler2D t; void main() { o = textureGatherOffsets(t, uv * vec2(3.1, 2.3),"
    " ivec2[4](ivec2(-2, 0), ivec2(1, 3), ivec2(0, -1), ivec2(2, 2))); }";
constexpr char kShadowGather[] =
    "uniform sampler2DShadow t; void main() { o = textureGather(t, uv * vec2(3.1, 2.3), 0.5); }";
constexpr char kFetch[] = "uniform sampler2D t; void main() { o = texelFetch(t, ivec2(uv * 511.0), 0); }";
constexpr char kIntegers[] =
    "uniform usampler2D t; void main() { o = vec4(texture(t, uv * vec2(3.1, 2.3))) * (1.0 / 255.0); }";
constexpr char kLine[] = "uniform sampler1D t; void main() { o = texture(t, uv.x * 3.1); }";
constexpr char kLines[] =
    "uniform sampler1DArray t; void main() { o = texture(t, vec2(uv.x * 3.1, floor(uv.y * 7.9))); }";
constexpr char kLayers[] =
    "uniform sampler2DArray t; void main() { o = texture(t, vec3(uv * vec2(3.1, 2.3), floor(uv.y * 7.9))); }";

constexpr char kPercentageCloser[] =
    "uniform sampler2DShadow t; void main() { float s = 0.0; for (int y = -1; y < 2; ++y) for (int x = -1; x < 2; ++x)"
    " s += texture(t, vec3(uv * vec2(3.1, 2.3) + vec2(x, y) / 512.0, 0.5)); o = vec4(s / 9.0); }";

struct TextureSpec {
  const char* body = kOnce;
  VkFilter filter = VK_FILTER_LINEAR;
  VkSamplerMipmapMode mip = VK_SAMPLER_MIPMAP_MODE_NEAREST;
  std::uint32_t levels = 1;
  VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
  VkImageViewType view = VK_IMAGE_VIEW_TYPE_2D;
  float anisotropy = 1;
  bool compare = false;
  VkSamplerAddressMode address = VK_SAMPLER_ADDRESS_MODE_REPEAT;
};

double measure(Run& run, const TextureSpec& spec) {
  cts::ImageSpec image_spec;
  image_spec.format = spec.format;
  image_spec.extent = {512, 512, 1};
  if (spec.view == VK_IMAGE_VIEW_TYPE_3D) image_spec.extent = {64, 64, 64};
  if (spec.view == VK_IMAGE_VIEW_TYPE_CUBE) {
    image_spec.layers = 6;
    image_spec.flags = VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT;
  }
  const bool line = spec.view == VK_IMAGE_VIEW_TYPE_1D || spec.view == VK_IMAGE_VIEW_TYPE_1D_ARRAY;
  if (line) image_spec.extent.height = 1;
  if (spec.view == VK_IMAGE_VIEW_TYPE_1D_ARRAY || spec.view == VK_IMAGE_VIEW_TYPE_2D_ARRAY) image_spec.layers = 8;
  image_spec.view = spec.view;
  image_spec.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  image_spec.levels = spec.levels;
  const cts::Image image = run.image(image_spec);
  run.fill_random(image);
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = info.minFilter = spec.filter;
  info.mipmapMode = spec.mip;
  info.addressModeU = info.addressModeV = info.addressModeW = spec.address;
  info.maxLod = spec.levels > 1 ? 1000.0f : 0.0f;
  info.anisotropyEnable = spec.anisotropy > 1;
  info.maxAnisotropy = spec.anisotropy;
  info.compareEnable = spec.compare;
  info.compareOp = VK_COMPARE_OP_LESS;
  const cts::Resources resources = run.resources({cts::sampled(0, image, run.sampler(info))});
  const std::string head = "layout(location=0) in vec2 uv; layout(location=0) out vec4 o; layout(binding=0) ";
  return measure_fragments(run, head + spec.body, &resources);
}

}  // namespace

std::vector<Workload> texture_workloads() {
  std::vector<Workload> rows;
  const auto add = [&](const char* name, TextureSpec spec) {
    rows.push_back({name, "Mpix/s", false, [spec](Run& run) { return measure(run, spec); }});
  };
  add("tex_nearest", {.filter = VK_FILTER_NEAREST});
  add("tex_bilinear", {});
  add("tex_trilinear", {.mip = VK_SAMPLER_MIPMAP_MODE_LINEAR, .levels = 10});
  add("tex_blur8", {.body = kBlur});
  add("tex_radial", {.body = kRadial});
  add("tex_blur25_32f", {.body = kBlur25, .format = VK_FORMAT_R32G32B32A32_SFLOAT});
  add("tex_near25_32f", {.body = kBlur25, .filter = VK_FILTER_NEAREST, .format = VK_FORMAT_R32G32B32A32_SFLOAT});
  add("tex_fetch25_32f", {.body = kFetch25, .format = VK_FORMAT_R32G32B32A32_SFLOAT});
  add("tex_rgba16f", {.format = VK_FORMAT_R16G16B16A16_SFLOAT});
  add("tex_srgb", {.format = VK_FORMAT_R8G8B8A8_SRGB});
  add("tex_aniso8", {.body = kStretched, .levels = 10, .anisotropy = 8});
  add("tex_aniso8_16f", {.body = kStretched, .levels = 10, .format = VK_FORMAT_R16G16B16A16_SFLOAT, .anisotropy = 8});
  add("tex_aniso8_11f",
      {.body = kStretched, .levels = 10, .format = VK_FORMAT_B10G11R11_UFLOAT_PACK32, .anisotropy = 8});
  add("tex_aniso8_bc1", {.body = kStretched, .levels = 10, .format = VK_FORMAT_BC1_RGBA_UNORM_BLOCK, .anisotropy = 8});
  add("tex_aniso8_cube", {.body = kStretchedCube, .levels = 10, .view = VK_IMAGE_VIEW_TYPE_CUBE, .anisotropy = 8});
  add("tex_shadow", {.body = kShadow, .format = VK_FORMAT_D32_SFLOAT, .compare = true});
  add("tex_bc1", {.format = VK_FORMAT_BC1_RGBA_UNORM_BLOCK});
  add("tex_bc7", {.format = VK_FORMAT_BC7_UNORM_BLOCK});
  add("tex_cube", {.body = kCube, .view = VK_IMAGE_VIEW_TYPE_CUBE});
  add("tex_3d", {.body = kVolume, .view = VK_IMAGE_VIEW_TYPE_3D});
  add("tex_gather", {.body = kGather});
  add("tex_gather_offs", {.body = kGatherOffsets});
  add("tex_gather_shad", {.body = kShadowGather, .format = VK_FORMAT_D32_SFLOAT, .compare = true});
  add("tex_fetch", {.body = kFetch});
  add("tex_uint", {.body = kIntegers, .filter = VK_FILTER_NEAREST, .format = VK_FORMAT_R8G8B8A8_UINT});
  add("tex_rgba32f", {.format = VK_FORMAT_R32G32B32A32_SFLOAT});
  add("tex_1d", {.body = kLine, .view = VK_IMAGE_VIEW_TYPE_1D});
  add("tex_1d_array", {.body = kLines, .view = VK_IMAGE_VIEW_TYPE_1D_ARRAY});
  add("tex_array", {.body = kLayers, .view = VK_IMAGE_VIEW_TYPE_2D_ARRAY});
  add("tex_nearest_array", {.body = kLayers, .filter = VK_FILTER_NEAREST, .view = VK_IMAGE_VIEW_TYPE_2D_ARRAY});
  add("tex_r8", {.format = VK_FORMAT_R8_UNORM});
  add("tex_rg8", {.format = VK_FORMAT_R8G8_UNORM});
  add("tex_r16", {.format = VK_FORMAT_R16_UNORM});
  add("tex_rgb10a2", {.format = VK_FORMAT_A2B10G10R10_UNORM_PACK32});
  add("tex_565", {.format = VK_FORMAT_R5G6B5_UNORM_PACK16});
  add("tex_3d_r8", {.body = kVolume, .format = VK_FORMAT_R8_UNORM, .view = VK_IMAGE_VIEW_TYPE_3D});
  add("tex_mirror", {.address = VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT});
  add("tex_border", {.address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER});
  add("tex_clamp_near", {.filter = VK_FILTER_NEAREST, .address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE});
  add("tex_pcf9", {.body = kPercentageCloser, .format = VK_FORMAT_D32_SFLOAT, .compare = true});
  add("tex_pcf9_d16", {.body = kPercentageCloser, .format = VK_FORMAT_D16_UNORM, .compare = true});
  return rows;
}

}  // namespace vitrine::bench

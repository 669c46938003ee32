// The least level of detail of image views (VK_EXT_image_view_min_lod), for lookups, fetches, gathers and queries. The
// reference does not have it: there the shader takes the level that follows.
#include <cmath>

#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

/// A view of an image of seven levels, from `base` on.
struct LimitedView {
  VkImageView view = VK_NULL_HANDLE;
  VkFormat format = VK_FORMAT_UNDEFINED;
  uint32_t base = 0;
  float min_lod = 0;  ///< from the base on
};

LimitedView make_view(Run& run, bool has) {
  Random& random = run.random;
  ImageSpec spec;
  spec.format = random.pick({VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT});
  spec.extent = {64, 64, 1};
  spec.levels = 7;
  spec.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  const Image image = run.image(spec);
  run.fill_random(image);
  LimitedView out;
  out.format = spec.format;
  out.base = random.below(3);
  const float limit = random.chance(0.2f) ? 0.0f : static_cast<float>(random.below(6 * 64)) / 64;
  out.min_lod = std::max(limit - static_cast<float>(out.base), 0.0f);
  VkImageViewMinLodCreateInfoEXT min_lod{VK_STRUCTURE_TYPE_IMAGE_VIEW_MIN_LOD_CREATE_INFO_EXT};
  min_lod.minLod = limit;
  VkImageViewCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO, has ? &min_lod : nullptr};
  info.image = image.handle;
  info.viewType = VK_IMAGE_VIEW_TYPE_2D;
  info.format = spec.format;
  info.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, out.base, 7 - out.base, 0, 1};
  CTS_VK(vkCreateImageView(run.device, &info, nullptr, &out.view));
  run.own(out.view, vkDestroyImageView);
  return out;
}

/// One lookup per pixel; `code` gives vec4 of vec2 p (0..1 over the target).
void look_up(Run& run, const LimitedView& view, VkSampler sampler, const std::string& code) {
  const Binding binding{
      0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, {}, {{sampler, view.view, VK_IMAGE_LAYOUT_GENERAL}}, {}};
  const Resources resources = run.resources({binding});
  TargetSpec target_spec;
  target_spec.colors = {VK_FORMAT_R32G32B32A32_SFLOAT};
  const Target target = make_target(run, target_spec);
  GraphicsSpec spec;
  spec.layout = resources.layout;
  spec.vertex = kFullScreenVertex;
  spec.fragment =
      "layout(binding = 0) uniform sampler2D t;\nlayout(location = 0) out vec4 v;\nvoid main() {\n"
      "  vec2 p = gl_FragCoord.xy * 0.015625;\n  v = " +
      code + ";\n}\n";
  draw_once(run, target, make_pipeline(run, spec, target), &resources);
  run.out("color", target.colors[0]);
  run.outputs.back().nan_bits_free = true;
  run.may_be_blank();
}

bool begin(Run& run) {
  run.require(gpus().device.extension_features.minLod, "minLod");
  return run.gpu.extension_features.minLod;
}

VkSamplerCreateInfo random_sampler(Random& random) {
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = info.minFilter = random.chance(0.5f) ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
  info.mipmapMode = random.chance(0.5f) ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
  info.minLod = random.chance(0.3f) ? random.real(0, 2) : 0;
  info.maxLod = VK_LOD_CLAMP_NONE;
  return info;
}

CTS_RANDOM("texture", "view_min_lod", 24) {
  const bool has = begin(run);
  Random& random = run.random;
  const LimitedView view = make_view(run, has);
  const VkSampler sampler = run.sampler(random_sampler(random));
  const std::string at = "p * p * " + std::to_string(random.real(0.5f, 12.0f));
  const std::string least = std::to_string(view.min_lod);
  if (random.chance(0.3f))
    return look_up(run, view, sampler,
                   has ? "textureLod(t, p, p.x * 6.0)" : "textureLod(t, p, max(p.x * 6.0, " + least + "))");
  look_up(run, view, sampler,
          has ? "texture(t, " + at + ")"
              : "textureLod(t, " + at + ", max(textureQueryLod(t, " + at + ").y, " + least + "))");
}

CTS_RANDOM("texture", "view_min_lod_fetch", 12) {
  const bool has = begin(run);
  const LimitedView view = make_view(run, has);
  const std::string fetch = "texelFetch(t, ivec2(p * 40.0) >> 3, int(p.y * 6.0))";
  const std::string least = std::to_string(static_cast<int>(view.min_lod));
  look_up(run, view, run.sampler(VK_FILTER_NEAREST),
          has ? fetch : "int(p.y * 6.0) < " + least + " ? vec4(0.0) : " + fetch);
}

CTS_RANDOM("texture", "view_min_lod_gather", 8) {
  const bool has = begin(run);
  const LimitedView view = make_view(run, has);
  const bool hidden = view.min_lod >= 1;
  look_up(run, view, run.sampler(VK_FILTER_LINEAR),
          has || !hidden ? "textureGather(t, p * 2.0 - 0.5, 1)" : "vec4(0.0)");
}

CTS_RANDOM("texture", "view_min_lod_query", 12) {
  const bool has = begin(run);
  const LimitedView view = make_view(run, has);
  VkSamplerCreateInfo info = random_sampler(run.random);
  const std::string query = "textureQueryLod(t, p * p * 6.0)";
  const float least = info.mipmapMode == VK_SAMPLER_MIPMAP_MODE_LINEAR ? view.min_lod : std::nearbyint(view.min_lod);
  look_up(run, view, run.sampler(info),
          has ? "vec4(" + query + ", textureQueryLevels(t), textureSize(t, 1).x)"
              : "vec4(max(" + query + ".x, " + std::to_string(least) + "), " + query +
                    ".y, textureQueryLevels(t), textureSize(t, 1).x)");
}

}  // namespace
}  // namespace vitrine::cts

// Plain texture cases, one thing each, so that a difference names it: every format, filter and address mode.
#include "cases/common/stand_in.h"
#include "harness/case.h"
#include "harness/graphics.h"

namespace vitrine::cts {
namespace {

/// One lookup per pixel of a square target; `code` sets vec4 v from vec2 p (0..1 over 64 pixels).
void look_up(Run& run, const Image& image, VkSampler sampler, const std::string& code, const char* type,
             uint32_t side = 64) {
  const FormatInfo& info = format_info(image.spec.format);
  const std::string prefix = info.numeric == Numeric::kUint ? "u" : info.numeric == Numeric::kSint ? "i" : "";
  const Resources res = run.resources({sampled(0, image, sampler)});
  TargetSpec target_spec;
  target_spec.colors = {prefix == "u"   ? VK_FORMAT_R32G32B32A32_UINT
                        : prefix == "i" ? VK_FORMAT_R32G32B32A32_SINT
                                        : VK_FORMAT_R32G32B32A32_SFLOAT};
  target_spec.width = target_spec.height = side;
  const Target target = make_target(run, target_spec);
  GraphicsSpec spec;
  spec.layout = res.layout;
  spec.vertex = kFullScreenVertex;
  spec.fragment = "layout(binding = 0) uniform " + prefix + "sampler" + type + " t;\nlayout(location = 0) out " +
                  prefix + "vec4 v;\nvoid main() {\n  vec2 p = gl_FragCoord.xy * 0.015625;\n  v = " + code + ";\n}\n";
  const VkPipeline pipeline = make_pipeline(run, spec, target);
  draw_once(run, target, pipeline, &res);
  run.out("color", target.colors[0]);
  run.outputs.back().nan_bits_free = true;
}

Image random_image(Run& run, VkFormat format, VkExtent3D extent, uint32_t levels = 1,
                   VkImageViewType view = VK_IMAGE_VIEW_TYPE_2D, uint32_t layers = 1) {
  ImageSpec spec;
  spec.format = format;
  spec.extent = extent;
  spec.levels = levels;
  spec.view = view;
  spec.layers = layers;
  spec.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  const Image image = run.image(spec);
  run.fill_random(image);
  return image;
}

/// All 256 or 65536 texels of a format.
void decode_every_texel(Run& run, const FormatInfo& info) {
  ImageSpec spec;
  spec.format = info.format;
  spec.extent = {256, info.bytes == 1 ? 1u : 256u, 1};
  spec.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  std::vector<unsigned char> texels(256 * info.bytes * spec.extent.height);
  for (size_t i = 0; i < texels.size() / info.bytes; ++i) {
    for (uint32_t byte = 0; byte < info.bytes; ++byte) {
      texels[i * info.bytes + byte] = static_cast<unsigned char>(i >> (8 * byte));
    }
  }
  const Image image = image_or_stand_in(run, spec, VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT, texels);
  look_up(run, image, run.sampler(VK_FILTER_NEAREST),
          "texelFetch(t, ivec2(gl_FragCoord.x, min(int(gl_FragCoord.y), textureSize(t, 0).y - 1)), 0)", "2D", 256);
}

void look_up_format(Run& run, VkFormat format, VkExtent3D extent, VkFilter filter, const std::string& code) {
  const VkFormatFeatureFlags features = filter == VK_FILTER_LINEAR ? VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT
                                                                   : VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT;
  run.require(has_or_stands_in(format, features), "linear filtering");
  ImageSpec spec;
  spec.format = format;
  spec.extent = extent;
  spec.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  const VkSampler sampler = run.sampler(filter);
  look_up(run, random_or_stand_in(run, spec, features), sampler, code, "2D");
}

const bool kFormats = [] {
  for (const FormatInfo& info : all_formats()) {
    if (info.format == VK_FORMAT_S8_UINT || info.format == VK_FORMAT_R32G32B32_SFLOAT) continue;
    const std::string name = info.name;
    const VkFormat format = info.format;
    if (info.bytes <= 2) {
      AddCase("texture", "format.every_texel." + name, [&info](Run& run) { decode_every_texel(run, info); });
    }
    AddCase("texture", "format.fetch." + name, [=](Run& run) {
      look_up_format(run, format, {64, 64, 1}, VK_FILTER_NEAREST, "texelFetch(t, ivec2(gl_FragCoord.xy), 0)");
    });
    AddCase("texture", "format.nearest." + name, [=](Run& run) {
      look_up_format(run, format, {29, 44, 1}, VK_FILTER_NEAREST, "texture(t, p)");
    });
    if (is_integer(info)) continue;
    AddCase("texture", "format.linear." + name, [=](Run& run) {
      look_up_format(run, format, {29, 44, 1}, VK_FILTER_LINEAR, "texture(t, p)");
    });
  }
  return true;
}();

struct AddressMode {
  const char* name;
  VkSamplerAddressMode value;
};
constexpr AddressMode kModes[] = {{"repeat", VK_SAMPLER_ADDRESS_MODE_REPEAT},
                                  {"mirrored_repeat", VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT},
                                  {"clamp_to_edge", VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE},
                                  {"clamp_to_border", VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER}};

const bool kAddressing = [] {
  for (const AddressMode& mode : kModes)
    for (const bool linear : {false, true})
      for (const bool floats : {false, true})
        for (const bool power_of_two : {false, true}) {
          const std::string name = std::string("address.") + mode.name + (linear ? ".linear" : ".nearest") +
                                   (floats ? ".rgba32f" : ".rgba8") + (power_of_two ? ".16x32" : ".13x37");
          AddCase("texture", name, [=](Run& run) {
            const VkExtent3D extent = power_of_two ? VkExtent3D{16, 32, 1} : VkExtent3D{13, 37, 1};
            const Image image =
                random_image(run, floats ? VK_FORMAT_R32G32B32A32_SFLOAT : VK_FORMAT_R8G8B8A8_UNORM, extent);
            look_up(run, image, run.sampler(linear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST, mode.value),
                    "texture(t, p * 5.3 - 2.1)", "2D");
          });
        }
  return true;
}();

const bool kMipmaps = [] {
  for (const bool linear : {false, true})
    for (const bool mip_linear : {false, true})
      for (const bool floats : {false, true}) {
        const std::string name = std::string("mipmap.") + (linear ? "linear" : "nearest") +
                                 (mip_linear ? ".linear" : ".nearest") + (floats ? ".rgba32f" : ".rgba8");
        const auto make = [=](Run& run, float bias) {
          VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
          info.magFilter = info.minFilter = linear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
          info.mipmapMode = mip_linear ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
          info.mipLodBias = bias;
          info.maxLod = VK_LOD_CLAMP_NONE;
          return run.sampler(info);
        };
        const VkFormat format = floats ? VK_FORMAT_R32G32B32A32_SFLOAT : VK_FORMAT_R8G8B8A8_UNORM;
        AddCase("texture", name + ".implicit", [=](Run& run) {
          const VkSampler sampler = make(run, 0);
          look_up(run, random_image(run, format, {50, 37, 1}, 6), sampler, "texture(t, p * p * 9.0)", "2D");
        });
        AddCase("texture", name + ".bias", [=](Run& run) {
          const VkSampler sampler = make(run, 0.6f);
          look_up(run, random_image(run, format, {64, 64, 1}, 7), sampler, "texture(t, p * p * 9.0, p.x * 3.0 - 1.0)",
                  "2D");
        });
        AddCase("texture", name + ".explicit", [=](Run& run) {
          const VkSampler sampler = make(run, 0);
          look_up(run, random_image(run, format, {64, 64, 1}, 7), sampler, "textureLod(t, p * 2.0, p.x * 8.0 - 1.0)",
                  "2D");
        });
        AddCase("texture", name + ".gradients", [=](Run& run) {
          const VkSampler sampler = make(run, 0);
          look_up(run, random_image(run, format, {50, 37, 1}, 6), sampler,
                  "textureGrad(t, p * 2.0, p * 0.3, p.yx * 0.2)", "2D");
        });
      }
  return true;
}();

/// Bounds from which on the reference leaves maxLod away, and so takes its short cut: slopes of rho * rho = 2 then lead
/// to level 1, where a level of detail of 0.5 is rounded to 0 (lavapipe-texture-blend.md A4).
const bool kLargeBounds = [] {
  for (const auto& [name, bound] : {std::pair("13_5", 13.5f), {"14", 14.0f}, {"14_5", 14.5f}, {"15", 15.0f}}) {
    AddCase("texture", std::string("mipmap.max_lod_") + name, [most = bound](Run& run) {
      VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
      info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_NEAREST;
      info.maxLod = most;
      const VkSampler sampler = run.sampler(info);
      look_up(run, random_image(run, VK_FORMAT_R32G32B32A32_SFLOAT, {64, 64, 1}, 7), sampler,
              "textureGrad(t, p, vec2(0.015625), vec2(0.0))", "2D");
    });
  }
  return true;
}();

const bool kShapes = [] {
  struct Shape {
    const char *type, *code;
    VkImageViewType view;
    VkExtent3D extent;
    uint32_t layers;
  };
  static constexpr Shape kList[] = {
      {"1D", "texture(t, p.x * 2.0 + p.y)", VK_IMAGE_VIEW_TYPE_1D, {37, 1, 1}, 1},
      {"1DArray", "texture(t, vec2(p.x * 2.0, p.y * 5.0))", VK_IMAGE_VIEW_TYPE_1D_ARRAY, {37, 1, 1}, 5},
      {"2DArray", "texture(t, vec3(p * 2.0, p.y * 5.0))", VK_IMAGE_VIEW_TYPE_2D_ARRAY, {20, 31, 1}, 5},
      {"3D", "texture(t, vec3(p * 2.0, p.x + p.y))", VK_IMAGE_VIEW_TYPE_3D, {20, 31, 9}, 1},
      {"Cube", "texture(t, vec3(p * 1.6 - 0.8, 1.0))", VK_IMAGE_VIEW_TYPE_CUBE, {32, 32, 1}, 6}};
  for (const Shape& shape : kList)
    for (const bool linear : {false, true})
      for (const VkFormat format : {VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R32G32B32A32_SFLOAT})
        AddCase("texture",
                std::string("shape.") + shape.type + (linear ? ".linear." : ".nearest.") + format_info(format).name,
                [=](Run& run) {
                  const Image image = random_image(run, format, shape.extent, 1, shape.view, shape.layers);
                  look_up(run, image,
                          run.sampler(linear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST, VK_SAMPLER_ADDRESS_MODE_REPEAT),
                          shape.code, shape.type);
                });
  return true;
}();

/// As wide as flat images may be.
CTS_CASE("texture", "shape.wide_volume") {
  const Image image = random_image(run, VK_FORMAT_R8G8B8A8_UNORM, {16384, 3, 2}, 15, VK_IMAGE_VIEW_TYPE_3D);
  look_up(run, image, run.sampler(VK_FILTER_LINEAR),
          "textureLod(t, vec3(p.x * 0.01 + p.y, p), p.x * 3.0) + texelFetch(t, ivec3(gl_FragCoord * 256.0) % "
          "textureSize(t, 0), 0)",
          "3D");
}

/// Levels follow from the coordinates of a whole quad, which a lookup gives also where some of its pixels do not look
/// up: post-processing does so (searches along edges).
CTS_CASE("texture", "divergent.lookups_in_turn") {
  const Image image = random_image(run, VK_FORMAT_R8G8B8A8_UNORM, {64, 64, 1}, 7, VK_IMAGE_VIEW_TYPE_2D);
  look_up(run, image, run.sampler(VK_FILTER_LINEAR),
          "(texture(t, p * 2.0).x < 0.6 ? texture(t, textureLod(t, p + 0.125, 0.0).xy + texelFetch(t, ivec2(p * 60.0), "
          "0).yx) : vec4(p, 0.0, 1.0))",
          "2D");
}

}  // namespace
}  // namespace vitrine::cts

// What random lookups look up.
//
// Left out here, because the reference's value then depends on neighbouring invocations (deviations.md): different min
// and mag filters on its float path, and linear filtering at the corners of a cube.
#include "cases/texture/lookup.h"

#include <algorithm>
#include <cstdio>
#include <limits>

#include "cases/api/random_transfer.h"
#include "cases/common/stand_in.h"

namespace vitrine::cts {
namespace {

/// Whether the reference filters it in fixed point: neither floats nor signed nor sRGB blocks.
bool fits_8_bit(const FormatInfo& info) {
  const bool unorm = std::string_view(info.name).find("_UNORM") != std::string_view::npos;
  return (info.numeric == Numeric::kUnorm && info.bits[0] <= 8) || (info.numeric == Numeric::kBlock && unorm);
}

VkFormat random_format(Random& random, const Family& family) {
  if (family.lacking) {
    std::vector<VkFormat> formats;
    for (const FormatInfo& info : all_formats())
      if (!reference_has(info.format, kFiltered) && has_or_stands_in(info.format, kFiltered))
        formats.push_back(info.format);
    return random.pick(formats);
  }
  const auto usable = [&](const FormatInfo& info) {
    if ((info.numeric == Numeric::kBlock) != family.compressed) return false;
    if ((info.numeric == Numeric::kDepth) != (family.kind == Kind::kShadow)) return false;
    if (family.kind == Kind::kShadow && info.format == VK_FORMAT_S8_UINT) return false;
    if (family.integer) return is_integer(info) && reference_has(info.format, kSampled);
    VkFormatFeatureFlags needed = VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT;
    if (family.anisotropic) needed |= VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
    if (family.reduced) needed |= VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_MINMAX_BIT;
    return (gpus().reference.features_of(info.format) & needed) == needed;
  };
  std::vector<VkFormat> formats;
  for (const FormatInfo& info : all_formats())
    if (usable(info)) formats.push_back(info.format);
  if (!family.compressed && family.kind != Kind::kShadow && !family.reduced && !family.integer && random.chance(0.4f))
    return random.pick({VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R8G8B8A8_SRGB});
  return random.pick(formats);
}

ImageSpec random_image(Random& random, const Shape& shape, VkFormat format, const Family& family) {
  const Kind kind = family.kind;
  ImageSpec spec;
  spec.format = format;
  spec.view = shape.view;
  spec.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  const bool cube = shape.view == VK_IMAGE_VIEW_TYPE_CUBE || shape.view == VK_IMAGE_VIEW_TYPE_CUBE_ARRAY;
  const auto side = [&] { return random.chance(0.5f) ? 1u << random.below(7) : 1 + random.below(60); };
  spec.extent = {side(), 1, 1};
  if (shape.dimensions > 1) spec.extent.height = cube ? spec.extent.width : side();
  if (cube) spec.extent.width = spec.extent.height = std::max(spec.extent.width, 12u);
  if (shape.view == VK_IMAGE_VIEW_TYPE_3D) spec.extent.depth = 1 + random.below(20);
  if (shape.coordinates > shape.dimensions) spec.layers = 1 + random.below(4);
  // A fetch beyond the only layer, and a constant swizzle of a depth comparison, are undefined.
  if (spec.layers == 1 && shape.coordinates > shape.dimensions && kind == Kind::kFetch) spec.layers = 2;
  if (cube) spec.layers *= 6;
  const uint32_t largest = std::max({spec.extent.width, spec.extent.height, spec.extent.depth});
  uint32_t possible = 1;
  while (largest >> possible) ++possible;
  if (largest == 1) spec.extent.width = 2;
  if (!family.unnormalized && random.chance(0.6f)) spec.levels = 1 + random.below(possible);
  // Random coordinates see the last level alone.
  if (spec.levels > 1 && spec.levels == possible && random.chance(0.7f)) --spec.levels;
  if (random.chance(family.bordered ? 0.6f : 0.2f) && kind != Kind::kShadow) {
    const auto swizzle = [&] { return static_cast<VkComponentSwizzle>(random.below(7)); };
    spec.components = {swizzle(), swizzle(), swizzle(), swizzle()};
    (random.chance(0.5f) ? spec.components.r : spec.components.b) = VK_COMPONENT_SWIZZLE_R;  // no constant colour
  }
  return spec;
}

VkSamplerCreateInfo random_sampler(Run& run, const Family& family, const Shape& shape, const ImageSpec& image) {
  Random& random = run.random;
  const FormatInfo& format = format_info(family.lacking ? reference_format(image.format, kFiltered) : image.format);
  const bool cube = shape.view == VK_IMAGE_VIEW_TYPE_CUBE || shape.view == VK_IMAGE_VIEW_TYPE_CUBE_ARRAY;
  const bool filterable = reference_has(format.format, kFiltered);
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = info.minFilter = filterable && random.chance(0.6f) ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
  info.mipmapMode = filterable && random.chance(0.5f) ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
  const auto address = [&] { return static_cast<VkSamplerAddressMode>(random.below(4)); };
  info.addressModeU = address();
  info.addressModeV = random.chance(0.7f) ? info.addressModeU : address();
  info.addressModeW = random.chance(0.7f) ? info.addressModeU : address();
  info.borderColor = is_integer(format)
                         ? random.pick({VK_BORDER_COLOR_INT_TRANSPARENT_BLACK, VK_BORDER_COLOR_INT_OPAQUE_BLACK,
                                        VK_BORDER_COLOR_INT_OPAQUE_WHITE})
                         : random.pick({VK_BORDER_COLOR_FLOAT_TRANSPARENT_BLACK, VK_BORDER_COLOR_FLOAT_OPAQUE_BLACK,
                                        VK_BORDER_COLOR_FLOAT_OPAQUE_WHITE});
  info.maxLod = random.chance(0.7f) ? VK_LOD_CLAMP_NONE : random.real(0.0f, 4.0f);
  if (random.chance(0.3f)) info.minLod = std::min(random.real(0.0f, 3.0f), info.maxLod);
  if (random.chance(0.3f)) info.mipLodBias = random.real(-2.0f, 2.0f);
  if (family.bordered) {
    (random.chance(0.5f) ? info.addressModeU : info.addressModeV) = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
    if (random.chance(0.5f)) info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER;
  }
  if (family.mixed)
    for (VkSamplerAddressMode* mode : {&info.addressModeU, &info.addressModeV, &info.addressModeW})
      *mode = random.pick({VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE});
  const auto plain = [](VkSamplerAddressMode m) {
    return m == VK_SAMPLER_ADDRESS_MODE_REPEAT || m == VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  };
  const bool fixed_point_path = fits_8_bit(format) && family.kind == Kind::kImplicit && !cube &&
                                plain(info.addressModeU) && plain(info.addressModeV) && plain(info.addressModeW);
  // Elsewhere nearest lookups change beside linear ones (deviations.md, mixed-filters).
  if (fixed_point_path && (family.mixed || random.chance(0.3f)))
    info.minFilter = info.magFilter == VK_FILTER_LINEAR ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
  // Special directions are at corners, and the reference reads beyond the face where one is no number.
  if (cube && family.special) info.magFilter = info.minFilter = VK_FILTER_NEAREST;
  if (cube && !family.anisotropic && info.magFilter == VK_FILTER_LINEAR) info.maxLod = info.minLod = 0.0f;
  if (family.anisotropic) {
    run.require(run.gpu.features.samplerAnisotropy, "samplerAnisotropy");
    // Lines and whole numbers, which no ellipse averages, end the reference's compiler (deviations.md).
    const bool averaged = shape.dimensions > 1 && !is_integer(format), reference = &run.gpu == &gpus().reference;
    info.anisotropyEnable = averaged || !reference;
    info.maxAnisotropy = random.pick({2.0f, 3.9f, 4.0f, 16.0f});
    if (random.chance(0.2f)) info.maxLod = info.minLod;
  }
  if (family.unnormalized) {
    const auto clamp = [&] {
      return random.pick({VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_BORDER});
    };
    info.unnormalizedCoordinates = VK_TRUE;
    info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_NEAREST;
    info.minLod = info.maxLod = info.mipLodBias = 0.0f;
    info.addressModeU = clamp();
    info.addressModeV = clamp();
  }
  if (family.special && random.chance(0.3f)) {
    info.minLod = random.pick({-1000.0f, -0.25f, 0.5f, 14.5f, 1e30f});
    info.maxLod = std::max(info.minLod, random.pick({-0.25f, 1.5f, 13.75f, 15.25f, 1e30f}));
  }
  if (family.kind == Kind::kShadow) {
    info.compareEnable = VK_TRUE;
    // The others hardly ever change from texel to texel.
    info.compareOp = random.chance(0.9f) ? random.pick({VK_COMPARE_OP_LESS, VK_COMPARE_OP_LESS_OR_EQUAL,
                                                        VK_COMPARE_OP_GREATER, VK_COMPARE_OP_GREATER_OR_EQUAL})
                                         : static_cast<VkCompareOp>(random.below(8));
  }
  return info;
}

std::string coordinate(const std::string& source, uint32_t components) {
  return components == 1 ? source + ".x" : source + "." + std::string("xyzw").substr(0, components);
}

float special_number(Random& random) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const float magnitude =
      random.pick({std::numeric_limits<float>::quiet_NaN(), kInfinity, 3.4e38f, 1e30f, 4e9f, 2147483648.0f,
                   2147483520.0f, 16777217.0f, 65536.5f, 1024.0f, 127.0f, 1e-30f, 1e-40f, 0.0f});
  return random.chance(0.5f) ? magnitude : -magnitude;
}

/// Puts special numbers into a table of coordinates and extras. `by_quad`: the same coordinates for a quad with one,
/// for other differences make footprints that the reference walks through for minutes.
void make_special(Random& random, bool by_quad, std::vector<float>& values) {
  for (uint32_t y = 0; y < 2 * kSize; ++y) {
    for (uint32_t x = 0; x < kSize; ++x) {
      const auto at = [&](uint32_t px, uint32_t py) { return values.begin() + (py * kSize + px) * 4; };
      if (random.chance(0.2f)) at(x, y)[random.below(4)] = special_number(random);
      if (by_quad && y < kSize) std::copy_n(at(x & ~1u, y & ~1u), 4, at(x, y));
    }
  }
}

/// Coordinates inside and outside the texture. Cubes: directions away from corners, so that one texel suffices.
std::vector<float> random_coordinates(Random& random, const Family& family, const Shape& shape) {
  const bool cube = shape.dimensions == 3 && shape.view != VK_IMAGE_VIEW_TYPE_3D;
  std::vector<float> values, extras;
  for (uint32_t i = 0; i < kSize * kSize; ++i) {
    float c[4];
    for (float& v : c) v = random.chance(0.6f) ? random.unit() : random.real(-3.0f, 4.0f);
    if (cube) {
      const uint32_t major = random.below(3);
      for (uint32_t k = 0; k < 3; ++k) c[k] = random.real(-0.8f, 0.8f);
      c[(major + 1) % 3] = random.real(-0.999f, 0.999f);
      c[major] = random.chance(0.5f) ? 1.0f : -1.0f;
      const float scale = random.real(0.1f, 3.0f);
      for (uint32_t k = 0; k < 3; ++k) c[k] *= scale;
    }
    if (shape.coordinates > shape.dimensions) c[shape.coordinates - 1] = random.real(-1.0f, 5.0f);
    values.insert(values.end(), c, c + 4);
    for (int k = 0; k < 4; ++k) extras.push_back(random.unit());
  }
  values.insert(values.end(), extras.begin(), extras.end());
  if (family.special) make_special(random, family.anisotropic, values);
  return values;
}

std::string describe(const VkSamplerCreateInfo& s) {
  char text[256];
  std::snprintf(text, sizeof text,
                "mag %d min %d mip %d address %d %d %d border %d bias %g lod %g..%g aniso %g compare %d\n", s.magFilter,
                s.minFilter, s.mipmapMode, s.addressModeU, s.addressModeV, s.addressModeW, s.borderColor, s.mipLodBias,
                s.minLod, s.maxLod, s.anisotropyEnable ? s.maxAnisotropy : 0, s.compareEnable ? s.compareOp : -1);
  return text;
}

}  // namespace

std::string lookup(Random& random, const Family& family, const Shape& shape) {
  const Kind kind = family.kind;
  const std::string c = coordinate("c", shape.coordinates);
  if (family.unnormalized) return "textureLod(t, " + c + " * 30.0, 0.0)";
  const std::string whole = shape.dimensions == 1 ? "int" : "ivec" + std::to_string(shape.dimensions);
  const auto offset = [&] {
    std::string text = whole + "(" + std::to_string(random.between(-8, 7));
    for (uint32_t i = 1; i < shape.dimensions; ++i) text += ", " + std::to_string(random.between(-8, 7));
    return text + ")";
  };
  switch (kind) {
    case Kind::kImplicit:
      return "texture(t, " + c + ")";
    case Kind::kBias:
      return "texture(t, " + c + ", extra.w)";
    case Kind::kLod:
      return "textureLod(t, " + c + ", extra.w * 6.0)";
    case Kind::kGrad:
      return "textureGrad(t, " + c + ", " + coordinate("gx", shape.dimensions) + ", " +
             coordinate("gy", shape.dimensions) + ")";
    case Kind::kOffset:
      return random.chance(0.5f) ? "textureOffset(t, " + c + ", " + offset() + ")"
                                 : "textureLodOffset(t, " + c + ", extra.w * 6.0, " + offset() + ")";
    case Kind::kProj:
      // Divisors near 0 make footprints that the reference walks through for minutes.
      if (family.anisotropic) return "textureProj(t, vec3(c.xy, 1.5 + fract(c.z)))";
      return "textureProj(t, " + coordinate("vec4(c.xyz, 1.5 + c.w)", shape.coordinates + 1) + ")";
    case Kind::kGather: {
      const std::string component = random.chance(0.7f) ? "0" : std::to_string(random.below(4));
      if (shape.dimensions == 3 || random.chance(0.4f)) return "textureGather(t, " + c + ", " + component + ")";
      if (!random.chance(0.3f)) return "textureGatherOffset(t, " + c + ", " + offset() + ", " + component + ")";
      const std::string fourth = offset(), third = offset(), second = offset();
      return "textureGatherOffsets(t, " + c + ", ivec2[4](" + offset() + ", " + second + ", " + third + ", " + fourth +
             "), " + component + ")";
    }
    case Kind::kFetch: {
      const std::string integer = shape.coordinates == 1 ? "int" : "ivec" + std::to_string(shape.coordinates);
      const std::string real = shape.coordinates == 1 ? "float" : "vec" + std::to_string(shape.coordinates);
      return "texelFetch(t, " + integer + "(floor(" + c + " * " + real +
             "(textureSize(t, 0)) * 1.1)), int(floor(extra.w * 3.0)))";
    }
    case Kind::kQuery:
      return "vec4(textureQueryLod(t, " + coordinate("c", shape.dimensions) +
             "), float(textureQueryLevels(t)), float(textureSize(t, int(abs(base.w) * 4.0))" +
             (shape.coordinates > 1 ? ".y" : "") + "))";
    default: {
      const std::string with_reference = shape.coordinates == 1
                                             ? "vec3(c.x, 0.0, extra.x)"
                                             : "vec" + std::to_string(shape.coordinates + 1) + "(" + c + ", extra.x)";
      return random.chance(0.5f) || shape.dimensions > 2 || shape.coordinates > 2
                 ? "vec4(texture(t, " + with_reference + "), 0.0, 0.0, 1.0)"
                 : "vec4(textureLod(t, " + with_reference + ", extra.w * 4.0), 0.0, 0.0, 1.0)";
    }
  }
}

std::string result_prefix(const RandomLookup& lookup, Kind kind) {
  if (kind == Kind::kQuery) return "";
  return lookup.info.numeric == Numeric::kUint ? "u" : lookup.info.numeric == Numeric::kSint ? "i" : "";
}

VkFormat result_format(const RandomLookup& lookup, Kind kind) {
  const std::string prefix = result_prefix(lookup, kind);
  return prefix == "u"   ? VK_FORMAT_R32G32B32A32_UINT
         : prefix == "i" ? VK_FORMAT_R32G32B32A32_SINT
                         : VK_FORMAT_R32G32B32A32_SFLOAT;
}

std::string lookup_declarations(const RandomLookup& lookup, Kind kind) {
  const Numeric numeric = lookup.info.numeric;
  const std::string prefix = numeric == Numeric::kUint ? "u" : numeric == Numeric::kSint ? "i" : "";
  return "layout(binding = 0) uniform " + prefix + "sampler" + lookup.shape.suffix +
         (kind == Kind::kShadow ? "Shadow" : "") +
         " t;\nlayout(binding = 1) uniform sampler2D table;\n"
         "layout(push_constant) uniform P { vec4 base, dx, dy; };\n";
}

std::array<float, 12> random_slopes(Random& random, const Shape& shape, const VkSamplerCreateInfo& sampler) {
  std::array<float, 12> push;
  const float step = random.pick({0.002f, 0.01f, 0.05f, 0.2f});
  for (size_t k = 4; k < 12; ++k) push[k] = random.real(-step, step);
  const VkSamplerAddressMode modes[3] = {sampler.addressModeU, sampler.addressModeV, sampler.addressModeW};
  for (uint32_t k = 0; k < 4; ++k) {
    const bool cube = shape.dimensions == 3 && shape.view != VK_IMAGE_VIEW_TYPE_3D;
    const bool clamps = !cube && k < shape.dimensions && modes[k] >= VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    const float middle = random.chance(0.4f) ? static_cast<float>(random.below(2)) : random.unit();
    push[k] = clamps ? middle - (push[4 + k] + push[8 + k]) * (kSize / 2) : random.real(-1.0f, 1.0f);
  }
  return push;
}

RandomLookup random_lookup(Run& run, const Family& family) {
  Random& random = run.random;
  const Shape shape = random.pick(family.shapes);
  const VkFormat format = random_format(random, family);
  const FormatInfo& info = format_info(format);
  const ImageSpec image_spec = random_image(random, shape, format, family);
  if (shape.view == VK_IMAGE_VIEW_TYPE_CUBE_ARRAY) run.require(run.gpu.features.imageCubeArray, "imageCubeArray");
  const Image image = random_or_stand_in(run, image_spec, family.lacking ? kFiltered : kSampled);
  VkSamplerCreateInfo sampler_info = random_sampler(run, family, shape, image_spec);
  VkSamplerCustomBorderColorCreateInfoEXT custom{VK_STRUCTURE_TYPE_SAMPLER_CUSTOM_BORDER_COLOR_CREATE_INFO_EXT};
  if (family.bordered && random.chance(0.7f)) {
    run.require(run.gpu.extension_features.customBorderColors, "customBorderColors");
    for (int c = 0; c < 4; ++c) {
      if (is_integer(info))
        custom.customBorderColor.uint32[c] = random.below(100);
      else
        custom.customBorderColor.float32[c] = random.real(-1.5f, 1.5f);
    }
    custom.format = format;
    sampler_info.borderColor = is_integer(info) ? VK_BORDER_COLOR_INT_CUSTOM_EXT : VK_BORDER_COLOR_FLOAT_CUSTOM_EXT;
    sampler_info.pNext = &custom;
  }
  VkSamplerReductionModeCreateInfo reduction{VK_STRUCTURE_TYPE_SAMPLER_REDUCTION_MODE_CREATE_INFO};
  if (family.reduced) {
    run.require(run.gpu.has("VK_EXT_sampler_filter_minmax"), "VK_EXT_sampler_filter_minmax");
    reduction.reductionMode = random.chance(0.5f) ? VK_SAMPLER_REDUCTION_MODE_MIN : VK_SAMPLER_REDUCTION_MODE_MAX;
    sampler_info.pNext = &reduction;
    sampler_info.magFilter = sampler_info.minFilter = VK_FILTER_LINEAR;
  }
  const VkSampler sampler = run.sampler(sampler_info);
  // Not a buffer: helper invocations of the reference load zeros from those (deviations.md, helper-lane-loads).
  ImageSpec table_spec;
  table_spec.format = VK_FORMAT_R32G32B32A32_SFLOAT;
  table_spec.extent = {kSize, kSize * 2, 1};
  table_spec.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  const Image table = run.image(table_spec);
  const std::vector<float> coordinates = random_coordinates(random, family, shape);
  run.upload(table, 0, {reinterpret_cast<const unsigned char*>(coordinates.data()), coordinates.size() * 4});
  std::string text = std::string(info.name) + " " + std::to_string(image_spec.extent.width) + "x" +
                     std::to_string(image_spec.extent.height) + "x" + std::to_string(image_spec.extent.depth) +
                     " levels " + std::to_string(image_spec.levels) + " layers " + std::to_string(image_spec.layers) +
                     "\n" + describe(sampler_info);
  sampler_info.pNext = nullptr;
  return {shape,
          info,
          image_spec,
          sampler_info,
          {sampled(0, image, sampler), sampled(1, table, run.sampler(VK_FILTER_NEAREST))},
          std::move(text)};
}

}  // namespace vitrine::cts

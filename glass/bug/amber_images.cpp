// See amber_images.h. Of formats those whose texels are rows of equal numbers, packed ones being one number; of images
// the one level and layer that a command sees, as an image of its own.
#include "glass/bug/amber_images.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>

namespace vitrine::glass::bug {
namespace {

constexpr std::size_t kPerLine = 8;

enum class Component : std::uint8_t { kByte, kShort, kWord, kLong, kHalf, kFloat };

std::size_t bytes_of(Component component) {
  switch (component) {
    case Component::kByte:
      return 1;
    case Component::kShort:
    case Component::kHalf:
      return 2;
    case Component::kLong:
      return 8;
    default:
      return 4;
  }
}

struct Format {
  VkFormat format;
  const char* name;
  std::size_t components;
  Component component;
};

// Normalized numbers are written as the integers that they are.
constexpr Format kFormats[] = {
    {VK_FORMAT_R8_UNORM, "R8_UNORM", 1, Component::kByte},
    {VK_FORMAT_R8_SNORM, "R8_SNORM", 1, Component::kByte},
    {VK_FORMAT_R8_UINT, "R8_UINT", 1, Component::kByte},
    {VK_FORMAT_R8_SINT, "R8_SINT", 1, Component::kByte},
    {VK_FORMAT_R8_SRGB, "R8_SRGB", 1, Component::kByte},
    {VK_FORMAT_R8G8_UNORM, "R8G8_UNORM", 2, Component::kByte},
    {VK_FORMAT_R8G8_SNORM, "R8G8_SNORM", 2, Component::kByte},
    {VK_FORMAT_R8G8_UINT, "R8G8_UINT", 2, Component::kByte},
    {VK_FORMAT_R8G8_SINT, "R8G8_SINT", 2, Component::kByte},
    {VK_FORMAT_R8G8_SRGB, "R8G8_SRGB", 2, Component::kByte},
    {VK_FORMAT_R8G8B8A8_UNORM, "R8G8B8A8_UNORM", 4, Component::kByte},
    {VK_FORMAT_R8G8B8A8_SNORM, "R8G8B8A8_SNORM", 4, Component::kByte},
    {VK_FORMAT_R8G8B8A8_UINT, "R8G8B8A8_UINT", 4, Component::kByte},
    {VK_FORMAT_R8G8B8A8_SINT, "R8G8B8A8_SINT", 4, Component::kByte},
    {VK_FORMAT_R8G8B8A8_SRGB, "R8G8B8A8_SRGB", 4, Component::kByte},
    {VK_FORMAT_B8G8R8A8_UNORM, "B8G8R8A8_UNORM", 4, Component::kByte},
    {VK_FORMAT_B8G8R8A8_SNORM, "B8G8R8A8_SNORM", 4, Component::kByte},
    {VK_FORMAT_B8G8R8A8_UINT, "B8G8R8A8_UINT", 4, Component::kByte},
    {VK_FORMAT_B8G8R8A8_SINT, "B8G8R8A8_SINT", 4, Component::kByte},
    {VK_FORMAT_B8G8R8A8_SRGB, "B8G8R8A8_SRGB", 4, Component::kByte},
    {VK_FORMAT_R16_UNORM, "R16_UNORM", 1, Component::kShort},
    {VK_FORMAT_R16_SNORM, "R16_SNORM", 1, Component::kShort},
    {VK_FORMAT_R16_UINT, "R16_UINT", 1, Component::kShort},
    {VK_FORMAT_R16_SINT, "R16_SINT", 1, Component::kShort},
    {VK_FORMAT_R16_SFLOAT, "R16_SFLOAT", 1, Component::kHalf},
    {VK_FORMAT_R16G16_UNORM, "R16G16_UNORM", 2, Component::kShort},
    {VK_FORMAT_R16G16_SNORM, "R16G16_SNORM", 2, Component::kShort},
    {VK_FORMAT_R16G16_UINT, "R16G16_UINT", 2, Component::kShort},
    {VK_FORMAT_R16G16_SINT, "R16G16_SINT", 2, Component::kShort},
    {VK_FORMAT_R16G16_SFLOAT, "R16G16_SFLOAT", 2, Component::kHalf},
    {VK_FORMAT_R16G16B16A16_UNORM, "R16G16B16A16_UNORM", 4, Component::kShort},
    {VK_FORMAT_R16G16B16A16_SNORM, "R16G16B16A16_SNORM", 4, Component::kShort},
    {VK_FORMAT_R16G16B16A16_UINT, "R16G16B16A16_UINT", 4, Component::kShort},
    {VK_FORMAT_R16G16B16A16_SINT, "R16G16B16A16_SINT", 4, Component::kShort},
    {VK_FORMAT_R16G16B16A16_SFLOAT, "R16G16B16A16_SFLOAT", 4, Component::kHalf},
    {VK_FORMAT_R32_UINT, "R32_UINT", 1, Component::kWord},
    {VK_FORMAT_R32_SINT, "R32_SINT", 1, Component::kWord},
    {VK_FORMAT_R32_SFLOAT, "R32_SFLOAT", 1, Component::kFloat},
    {VK_FORMAT_R32G32_UINT, "R32G32_UINT", 2, Component::kWord},
    {VK_FORMAT_R32G32_SINT, "R32G32_SINT", 2, Component::kWord},
    {VK_FORMAT_R32G32_SFLOAT, "R32G32_SFLOAT", 2, Component::kFloat},
    {VK_FORMAT_R32G32B32A32_UINT, "R32G32B32A32_UINT", 4, Component::kWord},
    {VK_FORMAT_R32G32B32A32_SINT, "R32G32B32A32_SINT", 4, Component::kWord},
    {VK_FORMAT_R32G32B32A32_SFLOAT, "R32G32B32A32_SFLOAT", 4, Component::kFloat},
    {VK_FORMAT_D16_UNORM, "D16_UNORM", 1, Component::kShort},
    {VK_FORMAT_D32_SFLOAT, "D32_SFLOAT", 1, Component::kFloat},
    {VK_FORMAT_R64_UINT, "R64_UINT", 1, Component::kLong},
    {VK_FORMAT_R64_SINT, "R64_SINT", 1, Component::kLong},
    {VK_FORMAT_R4G4_UNORM_PACK8, "R4G4_UNORM_PACK8", 1, Component::kByte},
    {VK_FORMAT_R4G4B4A4_UNORM_PACK16, "R4G4B4A4_UNORM_PACK16", 1, Component::kShort},
    {VK_FORMAT_B4G4R4A4_UNORM_PACK16, "B4G4R4A4_UNORM_PACK16", 1, Component::kShort},
    {VK_FORMAT_R5G6B5_UNORM_PACK16, "R5G6B5_UNORM_PACK16", 1, Component::kShort},
    {VK_FORMAT_B5G6R5_UNORM_PACK16, "B5G6R5_UNORM_PACK16", 1, Component::kShort},
    {VK_FORMAT_R5G5B5A1_UNORM_PACK16, "R5G5B5A1_UNORM_PACK16", 1, Component::kShort},
    {VK_FORMAT_B5G5R5A1_UNORM_PACK16, "B5G5R5A1_UNORM_PACK16", 1, Component::kShort},
    {VK_FORMAT_A1R5G5B5_UNORM_PACK16, "A1R5G5B5_UNORM_PACK16", 1, Component::kShort},
    {VK_FORMAT_A8B8G8R8_UNORM_PACK32, "A8B8G8R8_UNORM_PACK32", 1, Component::kWord},
    {VK_FORMAT_A8B8G8R8_SNORM_PACK32, "A8B8G8R8_SNORM_PACK32", 1, Component::kWord},
    {VK_FORMAT_A8B8G8R8_UINT_PACK32, "A8B8G8R8_UINT_PACK32", 1, Component::kWord},
    {VK_FORMAT_A8B8G8R8_SINT_PACK32, "A8B8G8R8_SINT_PACK32", 1, Component::kWord},
    {VK_FORMAT_A8B8G8R8_SRGB_PACK32, "A8B8G8R8_SRGB_PACK32", 1, Component::kWord},
    {VK_FORMAT_A2R10G10B10_UNORM_PACK32, "A2R10G10B10_UNORM_PACK32", 1, Component::kWord},
    {VK_FORMAT_A2R10G10B10_UINT_PACK32, "A2R10G10B10_UINT_PACK32", 1, Component::kWord},
    {VK_FORMAT_A2B10G10R10_UNORM_PACK32, "A2B10G10R10_UNORM_PACK32", 1, Component::kWord},
    {VK_FORMAT_A2B10G10R10_UINT_PACK32, "A2B10G10R10_UINT_PACK32", 1, Component::kWord},
    {VK_FORMAT_B10G11R11_UFLOAT_PACK32, "B10G11R11_UFLOAT_PACK32", 1, Component::kWord},
    {VK_FORMAT_X8_D24_UNORM_PACK32, "X8_D24_UNORM_PACK32", 1, Component::kWord},
};

const Format& format_of(VkFormat number, const char* what) {
  for (const Format& format : kFormats)
    if (format.format == number) return format;
  throw Unspeakable{std::string(what) + " of format " + std::to_string(number)};
}

/// A number of 16 bits. Amber makes zeros of those that are too small to be normal.
float float_of_half(std::uint32_t bits) {
  const std::uint32_t exponent = bits >> 10 & 31;
  if (exponent == 31) throw Unspeakable{"texels that are no numbers"};
  if (exponent == 0 && (bits & 0x3ff) != 0) throw Unspeakable{"texels that are very small"};
  const float value =
      std::ldexp(static_cast<float>((bits & 0x3ff) | (exponent != 0 ? 0x400u : 0u)), static_cast<int>(exponent) - 25);
  return (bits & 0x8000) != 0 ? -value : value;
}

/// One number of the texels, as the language reads it.
std::string number(const std::byte* at, Component component) {
  std::uint64_t whole = 0;
  std::memcpy(&whole, at, bytes_of(component));
  const auto bits = static_cast<std::uint32_t>(whole);
  if (component == Component::kByte) return std::to_string(bits);
  char text[32];
  if (component == Component::kFloat || component == Component::kHalf) {
    const float value = component == Component::kHalf ? float_of_half(bits) : std::bit_cast<float>(bits);
    if (!std::isfinite(value)) throw Unspeakable{"texels that are no numbers"};
    std::snprintf(text, sizeof text, "%.9g", static_cast<double>(value));
    if (std::string_view(text) == "-0") return "-0.0";  // an integer has one zero
  } else {
    std::snprintf(text, sizeof text, "0x%0*llx", static_cast<int>(bytes_of(component) * 2),
                  static_cast<unsigned long long>(whole));
  }
  return text;
}

void write_texels(std::ostream& out, const Format& format, const Bytes& bytes) {
  const std::size_t step = bytes_of(format.component), count = bytes.size() / step;
  out << " DATA\n";
  for (std::size_t i = 0; i < count; ++i)
    out << number(bytes.data() + i * step, format.component) << ((i + 1) % kPerLine && i + 1 < count ? ' ' : '\n');
  out << "END\n";
}

const char* address_mode(VkSamplerAddressMode mode) {
  constexpr const char* kModes[] = {"repeat", "mirrored_repeat", "clamp_to_edge", "clamp_to_border",
                                    "mirrored_clamp_to_edge"};
  return mode >= 0 && static_cast<std::size_t>(mode) < std::size(kModes)
             ? kModes[mode]
             : throw Unspeakable{"samplers with such a mode of addresses"};
}

/// Of floats, or of integers.
const char* border_color(const std::array<std::uint32_t, 4>& bits) {
  constexpr std::uint32_t kOne = 0x3f800000;
  if (bits == std::array<std::uint32_t, 4>{0, 0, 0, 1}) return "int_opaque_black";
  if (bits == std::array<std::uint32_t, 4>{1, 1, 1, 1}) return "int_opaque_white";
  if (bits == std::array<std::uint32_t, 4>{}) return "float_transparent_black";
  if (bits == std::array<std::uint32_t, 4>{0, 0, 0, kOne}) return "float_opaque_black";
  if (bits == std::array<std::uint32_t, 4>{kOne, kOne, kOne, kOne}) return "float_opaque_white";
  throw Unspeakable{"samplers with such a border"};
}

std::string hexadecimal(std::uint64_t value, int digits) {
  char text[20];
  std::snprintf(text, sizeof text, "0x%0*llx", digits, static_cast<unsigned long long>(value));
  return text;
}

const Bytes& bytes_of(const Texels& texels, bool after) {
  return after && texels.after ? *texels.after : *texels.before;
}

/// Whether several levels can be told: Amber fills each with the first texels of the first one, and reads each back to
/// where the first one is.
bool repeats_its_first_level(const Bug& bug, std::uint32_t number) {
  const Image& image = bug.images[number];
  if (image.type != VK_IMAGE_TYPE_2D || image.texels.size() < 2) return false;
  const Texels& first = image.texels[0];
  const auto levels = static_cast<std::uint32_t>(image.texels.size());
  const texel::Extent extent = extent_shown(image);
  if (levels > texel::kMaxLevels || (extent.width >> (levels - 1)) == 0 || (extent.height >> (levels - 1)) == 0)
    return false;
  const auto begins = [&](const Texels& t, bool after) {
    const Bytes &part = bytes_of(t, after), &whole = bytes_of(first, after);
    return part.size() <= whole.size() && std::equal(part.begin(), part.end(), whole.begin());
  };
  for (std::uint32_t i = 0; i < levels; ++i) {
    const Texels& t = image.texels[i];
    if (t.level != first.level + i || t.aspect != first.aspect || t.layer != first.layer || t.layers != 1 ||
        !begins(t, false) || !begins(t, true))
      return false;
  }
  return std::ranges::all_of(bug.views, [&](const View& v) {
    return v.image != number || (v.range.baseMipLevel == first.level && v.range.levelCount == levels);
  });
}

}  // namespace

void write_numbers(std::ostream& out, const std::string& name, const Bytes& bytes, std::size_t step) {
  const std::size_t count = bytes.size() / step;
  out << "BUFFER " << name << " DATA_TYPE uint" << step * 8 << " STD430";
  if (std::all_of(bytes.begin(), bytes.end(), [](std::byte b) { return b == std::byte{0}; })) {
    out << " SIZE " << count << " FILL 0\n";
    return;
  }
  out << " DATA\n";
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + i * step, step);
    out << hexadecimal(value, static_cast<int>(step * 2)) << ((i + 1) % kPerLine && i + 1 < count ? ' ' : '\n');
  }
  out << "END\n";
}

void write_texel_buffer(std::ostream& out, const std::string& name, const Bytes& bytes, VkFormat number) {
  const Format& format = format_of(number, "texel buffers");
  if (bytes.size() % (format.components * bytes_of(format.component)) != 0)
    throw Unspeakable{"texel buffers that end inside of a texel"};
  out << "BUFFER " << name << " DATA_TYPE " << format.name << " STD430";
  write_texels(out, format, bytes);
}

const char* compare_name(VkCompareOp op, const char* what) {
  constexpr const char* kNames[] = {
      "never", "less", "equal", "less_or_equal", "greater", "not_equal", "greater_or_equal", "always"};
  if (op < 0 || static_cast<std::size_t>(op) >= std::size(kNames)) throw Unspeakable{what};
  return kNames[op];
}

VkFormat format_shown(const Bug& bug, std::uint32_t number) {
  VkFormat shown = VK_FORMAT_UNDEFINED;
  for (const View& view : bug.views) {
    if (view.image != number) continue;
    if (shown != VK_FORMAT_UNDEFINED && shown != view.format) throw Unspeakable{"images that are shown in two formats"};
    shown = view.format;
  }
  return shown == VK_FORMAT_UNDEFINED ? bug.images[number].format : shown;
}

void write_image(std::ostream& out, const std::string& name, const Bug& bug, std::uint32_t number, bool after) {
  const Image& image = bug.images[number];
  const Format& format = format_of(format_shown(bug, number), "images");
  if (image.samples != 1) throw Unspeakable{"images of several samples"};
  const bool repeats = repeats_its_first_level(bug, number);
  if (image.texels.size() != 1 && !repeats) throw Unspeakable{"images of which several levels or aspects are seen"};
  if (image.texels[0].layers != 1) throw Unspeakable{"images of which several layers are seen"};
  const Texels& texels = image.texels[0];
  const texel::Extent extent = extent_shown(image);
  const bool deep = image.type == VK_IMAGE_TYPE_3D, flat = image.type == VK_IMAGE_TYPE_1D;
  out << "IMAGE " << name << " FORMAT " << format.name;
  if (repeats) out << " MIP_LEVELS " << image.texels.size();
  out << (deep ? " DIM_3D" : flat ? " DIM_1D" : " DIM_2D") << " WIDTH " << extent.width;
  if (!flat) out << " HEIGHT " << extent.height;
  if (deep) out << " DEPTH " << extent.depth;
  write_texels(out, format, bytes_of(texels, after));
}

void write_sampler(std::ostream& out, const std::string& name, const texel::Sampler& s) {
  constexpr const char* kFilters[] = {"nearest", "linear"};
  const bool plain = s.mip_lod_bias == 0 && s.max_anisotropy <= 1 && !s.seams && !s.conversion.enabled &&
                     s.reduction == VK_SAMPLER_REDUCTION_MODE_WEIGHTED_AVERAGE;
  if (!plain || s.mag_filter > VK_FILTER_LINEAR || s.min_filter > VK_FILTER_LINEAR)
    throw Unspeakable{"samplers with biases, anisotropy, reductions or cubic filters"};
  out << "SAMPLER " << name << " MAG_FILTER " << kFilters[s.mag_filter] << " MIN_FILTER " << kFilters[s.min_filter];
  for (std::size_t i = 0; i < 3; ++i)
    out << " ADDRESS_MODE_"
        << "UVW"[i] << " " << address_mode(s.address[i]);
  out << " BORDER_COLOR " << border_color(s.border) << " MIN_LOD " << std::to_string(s.min_lod) << " MAX_LOD "
      << std::to_string(s.max_lod) << (s.unnormalized ? " UNNORMALIZED_COORDS" : "");
  if (s.compare) out << " COMPARE on COMPARE_OP " << compare_name(s.compare_op, "such a comparison of samplers");
  out << "\n";
}

void demand_plain(const View& view, const Image& image) {
  const bool plain = view.type == static_cast<VkImageViewType>(image.type);  // 1D, 2D and 3D have the same numbers
  if (!plain) throw Unspeakable{"arrays of images, cubes, or slices"};
  if (view.swizzle != std::array<std::uint8_t, 4>{0, 1, 2, 3}) throw Unspeakable{"views that swap components"};
}

texel::Extent extent_shown(const Image& image) {
  const std::uint32_t level = image.texels.empty() ? 0 : image.texels[0].level;
  const auto side = [&](std::uint32_t whole) { return std::max(whole >> level, 1u); };
  return {side(image.extent.width), side(image.extent.height), side(image.extent.depth)};
}

}  // namespace vitrine::glass::bug

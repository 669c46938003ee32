// The formats that the suite uses, one row each.
#include "harness/format.h"

#include <cmath>
#include <cstdio>
#include <cstring>
#include <stdexcept>

namespace vitrine::cts {
namespace {

#define ROW(name, bytes, b0, b1, b2, b3, numeric) \
  FormatInfo { VK_FORMAT_##name, #name, bytes, {b0, b1, b2, b3}, Numeric::numeric, 1, 1 }
#define BLOCK(name, bytes) \
  FormatInfo { VK_FORMAT_##name, #name, bytes, {8, 8, 8, 8}, Numeric::kBlock, 4, 4 }
#define ASTC(width, height)                                                                                     \
  FormatInfo{VK_FORMAT_ASTC_##width##x##height##_UNORM_BLOCK,                                                   \
             "ASTC_" #width "x" #height "_UNORM_BLOCK",                                                         \
             16,                                                                                                \
             {8, 8, 8, 8},                                                                                      \
             Numeric::kBlock,                                                                                   \
             width,                                                                                             \
             height},                                                                                           \
      FormatInfo {                                                                                              \
    VK_FORMAT_ASTC_##width##x##height##_SRGB_BLOCK, "ASTC_" #width "x" #height "_SRGB_BLOCK", 16, {8, 8, 8, 8}, \
        Numeric::kBlock, width, height                                                                          \
  }

constexpr FormatInfo kColor[] = {
    ROW(R8_UNORM, 1, 8, 0, 0, 0, kUnorm),
    ROW(R8_SNORM, 1, 8, 0, 0, 0, kSnorm),
    ROW(R8_UINT, 1, 8, 0, 0, 0, kUint),
    ROW(R8_SINT, 1, 8, 0, 0, 0, kSint),
    ROW(R8G8_UNORM, 2, 8, 8, 0, 0, kUnorm),
    ROW(R8G8_SNORM, 2, 8, 8, 0, 0, kSnorm),
    ROW(R8G8_UINT, 2, 8, 8, 0, 0, kUint),
    ROW(R8G8_SINT, 2, 8, 8, 0, 0, kSint),
    ROW(R8G8B8A8_UNORM, 4, 8, 8, 8, 8, kUnorm),
    ROW(R8G8B8A8_SNORM, 4, 8, 8, 8, 8, kSnorm),
    ROW(R8G8B8A8_UINT, 4, 8, 8, 8, 8, kUint),
    ROW(R8G8B8A8_SINT, 4, 8, 8, 8, 8, kSint),
    ROW(R8G8B8A8_SRGB, 4, 8, 8, 8, 8, kSrgb),
    ROW(B8G8R8A8_UNORM, 4, 8, 8, 8, 8, kUnorm),
    ROW(B8G8R8A8_SRGB, 4, 8, 8, 8, 8, kSrgb),
    ROW(A8B8G8R8_UNORM_PACK32, 4, 8, 8, 8, 8, kUnorm),
    ROW(R16_UNORM, 2, 16, 0, 0, 0, kUnorm),
    ROW(R16_SNORM, 2, 16, 0, 0, 0, kSnorm),
    ROW(R16_UINT, 2, 16, 0, 0, 0, kUint),
    ROW(R16_SINT, 2, 16, 0, 0, 0, kSint),
    ROW(R16_SFLOAT, 2, 16, 0, 0, 0, kFloat),
    ROW(R16G16_UNORM, 4, 16, 16, 0, 0, kUnorm),
    ROW(R16G16_SNORM, 4, 16, 16, 0, 0, kSnorm),
    ROW(R16G16_UINT, 4, 16, 16, 0, 0, kUint),
    ROW(R16G16_SINT, 4, 16, 16, 0, 0, kSint),
    ROW(R16G16_SFLOAT, 4, 16, 16, 0, 0, kFloat),
    ROW(R16G16B16A16_UNORM, 8, 16, 16, 16, 16, kUnorm),
    ROW(R16G16B16A16_SNORM, 8, 16, 16, 16, 16, kSnorm),
    ROW(R16G16B16A16_UINT, 8, 16, 16, 16, 16, kUint),
    ROW(R16G16B16A16_SINT, 8, 16, 16, 16, 16, kSint),
    ROW(R16G16B16A16_SFLOAT, 8, 16, 16, 16, 16, kFloat),
    ROW(R32_UINT, 4, 32, 0, 0, 0, kUint),
    ROW(R32_SINT, 4, 32, 0, 0, 0, kSint),
    ROW(R32_SFLOAT, 4, 32, 0, 0, 0, kFloat),
    ROW(R32G32_UINT, 8, 32, 32, 0, 0, kUint),
    ROW(R32G32_SINT, 8, 32, 32, 0, 0, kSint),
    ROW(R32G32_SFLOAT, 8, 32, 32, 0, 0, kFloat),
    ROW(R32G32B32A32_UINT, 16, 32, 32, 32, 32, kUint),
    ROW(R32G32B32A32_SINT, 16, 32, 32, 32, 32, kSint),
    ROW(R32G32B32A32_SFLOAT, 16, 32, 32, 32, 32, kFloat),
    ROW(R5G6B5_UNORM_PACK16, 2, 5, 6, 5, 0, kUnorm),
    ROW(A1R5G5B5_UNORM_PACK16, 2, 5, 5, 5, 1, kUnorm),
    ROW(B4G4R4A4_UNORM_PACK16, 2, 4, 4, 4, 4, kUnorm),
    ROW(A4R4G4B4_UNORM_PACK16, 2, 4, 4, 4, 4, kUnorm),
    ROW(A4B4G4R4_UNORM_PACK16, 2, 4, 4, 4, 4, kUnorm),
    ROW(A2B10G10R10_UNORM_PACK32, 4, 10, 10, 10, 2, kUnorm),
    ROW(A2B10G10R10_UINT_PACK32, 4, 10, 10, 10, 2, kUint),
    ROW(B10G11R11_UFLOAT_PACK32, 4, 11, 11, 10, 0, kPackedFloat),
    ROW(E5B9G9R9_UFLOAT_PACK32, 4, 9, 9, 9, 5, kPackedFloat),
};

constexpr FormatInfo kOther[] = {
    ROW(R32G32B32_SFLOAT, 12, 32, 32, 32, 0, kFloat),
    ROW(B5G6R5_UNORM_PACK16, 2, 5, 6, 5, 0, kUnorm),
    ROW(R5G5B5A1_UNORM_PACK16, 2, 1, 5, 5, 5, kUnorm),
    ROW(B5G5R5A1_UNORM_PACK16, 2, 1, 5, 5, 5, kUnorm),
    ROW(B8G8R8A8_SNORM, 4, 8, 8, 8, 8, kSnorm),
    ROW(B8G8R8A8_UINT, 4, 8, 8, 8, 8, kUint),
    ROW(B8G8R8A8_SINT, 4, 8, 8, 8, 8, kSint),
    ROW(A8B8G8R8_SNORM_PACK32, 4, 8, 8, 8, 8, kSnorm),
    ROW(A8B8G8R8_UINT_PACK32, 4, 8, 8, 8, 8, kUint),
    ROW(A8B8G8R8_SINT_PACK32, 4, 8, 8, 8, 8, kSint),
    ROW(A8B8G8R8_SRGB_PACK32, 4, 8, 8, 8, 8, kSrgb),
    ROW(A2R10G10B10_UNORM_PACK32, 4, 10, 10, 10, 2, kUnorm),
    ROW(A2R10G10B10_SNORM_PACK32, 4, 10, 10, 10, 2, kSnorm),
    ROW(A2R10G10B10_UINT_PACK32, 4, 10, 10, 10, 2, kUint),
    ROW(A2B10G10R10_SNORM_PACK32, 4, 10, 10, 10, 2, kSnorm),
    ROW(R4G4B4A4_UNORM_PACK16, 2, 4, 4, 4, 4, kUnorm),
    ROW(R8_SRGB, 1, 8, 0, 0, 0, kSrgb),
    ROW(R8G8_SRGB, 2, 8, 8, 0, 0, kSrgb),
    ROW(D16_UNORM, 2, 16, 0, 0, 0, kDepth),
    ROW(X8_D24_UNORM_PACK32, 4, 24, 0, 0, 0, kDepth),
    ROW(D32_SFLOAT, 4, 32, 0, 0, 0, kDepth),
    ROW(S8_UINT, 1, 8, 0, 0, 0, kDepth),
    ROW(D24_UNORM_S8_UINT, 4, 24, 0, 0, 0, kDepth),
    ROW(D32_SFLOAT_S8_UINT, 8, 32, 0, 0, 0, kDepth),
    BLOCK(BC1_RGB_UNORM_BLOCK, 8),
    BLOCK(BC1_RGB_SRGB_BLOCK, 8),
    BLOCK(BC1_RGBA_UNORM_BLOCK, 8),
    BLOCK(BC1_RGBA_SRGB_BLOCK, 8),
    BLOCK(BC2_UNORM_BLOCK, 16),
    BLOCK(BC2_SRGB_BLOCK, 16),
    BLOCK(BC3_UNORM_BLOCK, 16),
    BLOCK(BC3_SRGB_BLOCK, 16),
    BLOCK(BC4_UNORM_BLOCK, 8),
    BLOCK(BC4_SNORM_BLOCK, 8),
    BLOCK(BC5_UNORM_BLOCK, 16),
    BLOCK(BC5_SNORM_BLOCK, 16),
    BLOCK(BC6H_UFLOAT_BLOCK, 16),
    BLOCK(BC6H_SFLOAT_BLOCK, 16),
    BLOCK(BC7_UNORM_BLOCK, 16),
    BLOCK(BC7_SRGB_BLOCK, 16),
    BLOCK(ETC2_R8G8B8_UNORM_BLOCK, 8),
    BLOCK(ETC2_R8G8B8_SRGB_BLOCK, 8),
    BLOCK(ETC2_R8G8B8A1_UNORM_BLOCK, 8),
    BLOCK(ETC2_R8G8B8A1_SRGB_BLOCK, 8),
    BLOCK(ETC2_R8G8B8A8_UNORM_BLOCK, 16),
    BLOCK(ETC2_R8G8B8A8_SRGB_BLOCK, 16),
    BLOCK(EAC_R11_UNORM_BLOCK, 8),
    BLOCK(EAC_R11_SNORM_BLOCK, 8),
    BLOCK(EAC_R11G11_UNORM_BLOCK, 16),
    BLOCK(EAC_R11G11_SNORM_BLOCK, 16),
    ASTC(4, 4),
    ASTC(5, 4),
    ASTC(5, 5),
    ASTC(6, 5),
    ASTC(6, 6),
    ASTC(8, 5),
    ASTC(8, 6),
    ASTC(8, 8),
    ASTC(10, 5),
    ASTC(10, 6),
    ASTC(10, 8),
    ASTC(10, 10),
    ASTC(12, 10),
    ASTC(12, 12),
};

/// Channel c of a texel as raw bits.
uint32_t channel_bits(const FormatInfo& info, const unsigned char* texel, int c) {
  uint32_t first = 0;
  for (int i = 0; i < c; ++i) first += info.bits[i];
  uint64_t word = 0;
  std::memcpy(&word, texel + first / 8, std::min<size_t>(8, info.bytes - first / 8));
  return static_cast<uint32_t>((word >> (first % 8)) & ((uint64_t{1} << info.bits[c]) - 1));
}

double half_value(uint32_t h) {
  const double sign = h & 0x8000 ? -1.0 : 1.0;
  const uint32_t exponent = (h >> 10) & 31, mantissa = h & 1023;
  if (exponent == 31) return mantissa ? NAN : sign * INFINITY;
  return sign * (exponent ? std::ldexp(1024.0 + mantissa, static_cast<int>(exponent) - 25) : std::ldexp(mantissa, -24));
}

double channel_value(const FormatInfo& info, uint32_t bits, int c) {
  const uint32_t n = info.bits[c];
  const auto sign_extended = static_cast<int32_t>(bits << (32 - n)) >> (32 - n);
  switch (info.numeric) {
    case Numeric::kSint:
      return sign_extended;
    case Numeric::kSnorm:
      return sign_extended / (std::ldexp(1.0, static_cast<int>(n) - 1) - 1);
    case Numeric::kFloat: {
      float value;
      std::memcpy(&value, &bits, 4);
      return n == 32 ? value : half_value(bits);
    }
    case Numeric::kDepth: {
      float value;
      std::memcpy(&value, &bits, 4);
      return n == 32 ? value : bits;
    }
    default:
      return bits;
  }
}

}  // namespace

const std::vector<FormatInfo>& color_formats() {
  static const std::vector<FormatInfo> list(std::begin(kColor), std::end(kColor));
  return list;
}

const std::vector<FormatInfo>& all_formats() {
  static const std::vector<FormatInfo> all = [] {
    std::vector<FormatInfo> list = color_formats();
    list.insert(list.end(), std::begin(kOther), std::end(kOther));
    return list;
  }();
  return all;
}

const FormatInfo& format_info(VkFormat format) {
  for (const FormatInfo& row : all_formats())
    if (row.format == format) return row;
  throw std::runtime_error("format " + std::to_string(format) + " is not in the suite's table");
}

VkImageAspectFlags aspects_of(VkFormat format) {
  switch (format) {
    case VK_FORMAT_D16_UNORM:
    case VK_FORMAT_X8_D24_UNORM_PACK32:
    case VK_FORMAT_D32_SFLOAT:
      return VK_IMAGE_ASPECT_DEPTH_BIT;
    case VK_FORMAT_S8_UINT:
      return VK_IMAGE_ASPECT_STENCIL_BIT;
    case VK_FORMAT_D24_UNORM_S8_UINT:
    case VK_FORMAT_D32_SFLOAT_S8_UINT:
      return VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
    default:
      return VK_IMAGE_ASPECT_COLOR_BIT;
  }
}

std::string describe_texel(const FormatInfo& info, const unsigned char* texel) {
  std::string text;
  char part[48];
  for (uint32_t i = 0; i < info.bytes; ++i) {
    std::snprintf(part, sizeof part, "%02x", texel[i]);
    text += part;
  }
  if (info.numeric == Numeric::kBlock) return text;
  text += " (";
  for (int c = 0; c < 4 && info.bits[c]; ++c) {
    std::snprintf(part, sizeof part, "%s%.9g", c ? ", " : "", channel_value(info, channel_bits(info, texel, c), c));
    text += part;
  }
  return text + ")";
}

uint32_t preview_rgba(const FormatInfo& info, const unsigned char* texel) {
  if (info.numeric == Numeric::kBlock) return 0xff000000u | texel[0] | texel[1] << 8 | texel[2] << 16;
  uint32_t result = 0xff000000u;
  int channels = 0;
  for (int c = 0; c < 4 && info.bits[c]; ++c, ++channels) {
    const uint32_t bits = channel_bits(info, texel, c);
    double value = channel_value(info, bits, c);
    if (info.numeric == Numeric::kUnorm || info.numeric == Numeric::kSrgb) value /= std::ldexp(1.0, info.bits[c]) - 1;
    if (info.numeric == Numeric::kDepth && info.bits[c] < 32) value /= std::ldexp(1.0, info.bits[c]) - 1;
    if (info.numeric == Numeric::kUint || info.numeric == Numeric::kSint) value = (bits & 255) / 255.0;
    if (!(value >= 0)) value = 0;
    const uint32_t byte = value >= 1 ? 255 : static_cast<uint32_t>(value * 255 + 0.5);
    result = (result & ~(255u << (8 * c))) | byte << (8 * c);
  }
  if (channels == 1) result = 0xff000000u | (result & 255) * 0x010101u;
  return result;
}

}  // namespace vitrine::cts

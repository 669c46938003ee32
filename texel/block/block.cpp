// Decodes single texels of block-compressed formats by family.
#include "texel/block/block.h"

#include <algorithm>
#include <cstring>

#include "base/numeric.h"
#include "texel/block/astc.h"
#include "texel/block/bptc.h"
#include "texel/block/etc2.h"
#include "texel/block/s3tc_rgtc.h"
#include "texel/codec/srgb.h"

namespace vitrine::texel {
namespace {

using Bytes = std::array<std::uint8_t, 4>;
using base::bits_of;

float unorm8(std::uint8_t byte) { return static_cast<float>(byte) * (1.0f / 255.0f); }

/// One channel of an EAC block: 11 bits, as the quotients that the format names.
float eac_channel(const std::byte* block, std::uint32_t index, bool is_signed) {
  return is_signed ? static_cast<float>(decode_eac_signed(block, index)) / 1023.0f
                   : static_cast<float>(decode_eac_unsigned(block, index)) / 2047.0f;
}

/// A 16-bit component of ASTC: 65536ths cut to binary16, but 1 for the largest.
float astc_component(std::uint16_t value) {
  if (value == 0xFFFF) return 1.0f;
  return base::half_to_float(base::float_to_half_truncate(static_cast<float>(value) * (1.0f / 65536.0f)));
}

float snorm8(std::int8_t byte) { return base::max_second(static_cast<float>(byte) * (1.0f / 127.0f), -1.0f); }

}  // namespace

void decode_block_bytes(const FormatDesc& format, const std::byte* block, std::uint32_t x, std::uint32_t y,
                        std::array<std::uint8_t, 4>& out) {
  const std::uint32_t index = y * 4 + x;
  switch (format.format) {
    case VK_FORMAT_BC1_RGB_UNORM_BLOCK:
    case VK_FORMAT_BC1_RGB_SRGB_BLOCK:
      out = decode_color_block(block, index, ColorBlock::kRgb);
      return;
    case VK_FORMAT_BC1_RGBA_UNORM_BLOCK:
    case VK_FORMAT_BC1_RGBA_SRGB_BLOCK:
      out = decode_color_block(block, index, ColorBlock::kRgba);
      return;
    case VK_FORMAT_BC2_UNORM_BLOCK:
    case VK_FORMAT_BC2_SRGB_BLOCK:
      out = decode_color_block(block + 8, index, ColorBlock::kFourColors);
      out[3] = decode_explicit_alpha(block, index);
      return;
    case VK_FORMAT_BC3_UNORM_BLOCK:
    case VK_FORMAT_BC3_SRGB_BLOCK:
      out = decode_color_block(block + 8, index, ColorBlock::kFourColors);
      out[3] = decode_channel_unsigned(block, index);
      return;
    case VK_FORMAT_BC4_UNORM_BLOCK:
      out = {decode_channel_unsigned(block, index), 0, 0, 255};
      return;
    case VK_FORMAT_BC5_UNORM_BLOCK:
      out = {decode_channel_unsigned(block, index), decode_channel_unsigned(block + 8, index), 0, 255};
      return;
    case VK_FORMAT_BC7_UNORM_BLOCK:
    case VK_FORMAT_BC7_SRGB_BLOCK:
      out = decode_bc7(block, index);
      return;
    case VK_FORMAT_ETC2_R8G8B8_UNORM_BLOCK:
    case VK_FORMAT_ETC2_R8G8B8_SRGB_BLOCK:
      out = decode_etc2_color(block, index, false);
      return;
    case VK_FORMAT_ETC2_R8G8B8A1_UNORM_BLOCK:
    case VK_FORMAT_ETC2_R8G8B8A1_SRGB_BLOCK:
      out = decode_etc2_color(block, index, true);
      return;
    case VK_FORMAT_ETC2_R8G8B8A8_UNORM_BLOCK:
    case VK_FORMAT_ETC2_R8G8B8A8_SRGB_BLOCK:
      out = decode_etc2_color(block + 8, index, false);
      out[3] = decode_eac_alpha(block, index);
      return;
    default:
      out = {};
  }
}

void decode_block_bytes(const FormatDesc& format, const std::byte* block, std::uint32_t* out) {
  std::uint8_t channel[2][16];
  const auto set_byte = [&](int shift, const std::uint8_t* values) {
    for (std::size_t i = 0; i < 16; ++i) out[i] = (out[i] & ~(0xFFu << shift)) | std::uint32_t{values[i]} << shift;
  };
  switch (format.format) {
    case VK_FORMAT_BC1_RGB_UNORM_BLOCK:
    case VK_FORMAT_BC1_RGB_SRGB_BLOCK:
      return decode_color_block(block, ColorBlock::kRgb, out);
    case VK_FORMAT_BC1_RGBA_UNORM_BLOCK:
    case VK_FORMAT_BC1_RGBA_SRGB_BLOCK:
      return decode_color_block(block, ColorBlock::kRgba, out);
    case VK_FORMAT_BC3_UNORM_BLOCK:
    case VK_FORMAT_BC3_SRGB_BLOCK:
      decode_color_block(block + 8, ColorBlock::kFourColors, out);
      decode_channel_unsigned(block, channel[0]);
      return set_byte(24, channel[0]);
    case VK_FORMAT_BC4_UNORM_BLOCK:
    case VK_FORMAT_BC5_UNORM_BLOCK:
      std::fill_n(out, 16, 0xFF000000u);
      decode_channel_unsigned(block, channel[0]);
      set_byte(0, channel[0]);
      if (format.format == VK_FORMAT_BC4_UNORM_BLOCK) return;
      decode_channel_unsigned(block + 8, channel[1]);
      return set_byte(8, channel[1]);
    case VK_FORMAT_BC7_UNORM_BLOCK:
    case VK_FORMAT_BC7_SRGB_BLOCK:
      return decode_bc7(block, out);
    default:
      for (std::uint32_t i = 0; i < std::uint32_t{format.block_width} * format.block_height; ++i) {
        Bytes rgba;
        decode_block_bytes(format, block, i % format.block_width, i / format.block_width, rgba);
        std::memcpy(&out[i], rgba.data(), sizeof(out[i]));
      }
  }
}

void decode_block_texels(const FormatDesc& format, const std::byte* block, Texel* out) {
  const std::uint32_t count = std::uint32_t{format.block_width} * format.block_height;
  if (format.compression != Compression::kAstcLdr) {
    for (std::uint32_t i = 0; i < count; ++i) {
      decode_block_texel(format, block, i % format.block_width, i / format.block_width, out[i]);
    }
    return;
  }
  AstcTexels texels;
  decode_astc(block, format.block_width, format.block_height, format.is_srgb(), texels);
  for (std::uint32_t i = 0; i < count; ++i) {
    for (std::size_t c = 0; c < 4; ++c) {
      const std::uint16_t value = texels[i][c];
      const auto byte = static_cast<std::uint8_t>(value >> 8);
      const float linear = c < 3 ? kSrgbToLinearExact[byte] : unorm8(byte);
      out[i][c] = bits_of(format.is_srgb() ? linear : astc_component(value));
    }
  }
}

void decode_block_texel(const FormatDesc& format, const std::byte* block, std::uint32_t x, std::uint32_t y,
                        Texel& out) {
  const std::uint32_t index = y * 4 + x;
  if (format.format == VK_FORMAT_BC4_SNORM_BLOCK || format.format == VK_FORMAT_BC5_SNORM_BLOCK) {
    const bool two = format.format == VK_FORMAT_BC5_SNORM_BLOCK;
    const float second = two ? snorm8(decode_channel_signed(block + 8, index)) : 0.0f;
    out = {bits_of(snorm8(decode_channel_signed(block, index))), bits_of(second), 0, bits_of(1.0f)};
    return;
  }
  if (format.format == VK_FORMAT_BC6H_UFLOAT_BLOCK || format.format == VK_FORMAT_BC6H_SFLOAT_BLOCK) {
    const std::array<float, 3> rgb = decode_bc6h(block, index, format.format == VK_FORMAT_BC6H_SFLOAT_BLOCK);
    out = {bits_of(rgb[0]), bits_of(rgb[1]), bits_of(rgb[2]), bits_of(1.0f)};
    return;
  }
  if (format.compression == Compression::kAstcLdr) {
    Texel all[kMaxAstcTexels];
    decode_block_texels(format, block, all);
    out = all[y * format.block_width + x];
    return;
  }
  if (format.compression == Compression::kEac) {
    const bool is_signed = format.channel[0].numeric == Numeric::kSnorm;
    const float second = format.channel_count == 2 ? eac_channel(block + 8, index, is_signed) : 0.0f;
    out = {bits_of(eac_channel(block, index, is_signed)), bits_of(second), 0, bits_of(1.0f)};
    return;
  }
  Bytes bytes;
  decode_block_bytes(format, block, x, y, bytes);
  // The reference decodes BC1 to BC3 with its approximation; it has no ETC2.
  const bool exact = format.format == VK_FORMAT_BC7_SRGB_BLOCK || format.compression != Compression::kBc;
  const auto& srgb = exact ? kSrgbToLinearExact : kSrgbToLinear;
  for (std::size_t c = 0; c < 4; ++c) {
    out[c] = bits_of(format.is_srgb() && c < 3 ? srgb[bytes[c]] : unorm8(bytes[c]));
  }
}

}  // namespace vitrine::texel

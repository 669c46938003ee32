// Decodes single texels of block-compressed formats by family.
#include "texel/block/block.h"

#include <algorithm>

#include "base/numeric.h"
#include "texel/block/bptc.h"
#include "texel/block/s3tc_rgtc.h"
#include "texel/codec/srgb.h"

namespace vitrine::texel {
namespace {

using Bytes = std::array<std::uint8_t, 4>;
using base::bits_of;

float unorm8(std::uint8_t byte) { return static_cast<float>(byte) * (1.0f / 255.0f); }
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
    default:
      out = {};
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
  Bytes bytes;
  decode_block_bytes(format, block, x, y, bytes);
  const auto& srgb = format.format == VK_FORMAT_BC7_SRGB_BLOCK ? kSrgbToLinearExact : kSrgbToLinear;
  for (std::size_t c = 0; c < 4; ++c) {
    out[c] = bits_of(format.is_srgb() && c < 3 ? srgb[bytes[c]] : unorm8(bytes[c]));
  }
}

}  // namespace vitrine::texel

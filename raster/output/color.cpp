// How an attachment is written: blend equations as the reference reads them, and the function that gives their bits.
#include "raster/output/color.h"

#include <algorithm>
#include <cstddef>

#include "raster/output/blend.h"
#include "raster/output/byte_texels.h"
#include "raster/output/color_block.h"
#include "raster/output/color_bytes.h"
#include "raster/output/color_floats.h"
#include "raster/output/color_general.h"

namespace vitrine::raster {
namespace {

using texel::Channel;
using texel::FormatDesc;
using texel::Numeric;
using texel::StoredTexel;

/// E1: by the widest channel; formats that cannot blend ignore the request.
BlendType blend_type(const FormatDesc& format) {
  if (format.is_integer() || format.channel_count == 0) return BlendType::kNone;
  std::uint8_t widest = 0;
  for (std::size_t c = 0; c < format.channel_count; ++c) widest = std::max(widest, format.channel[c].bits);
  switch (format.channel[0].numeric) {
    case Numeric::kUnorm:
      return widest <= 8 ? BlendType::kByte : BlendType::kWord;
    case Numeric::kSnorm:  // not claimed as blendable; applications (zink) blend them on the reference all the same
    case Numeric::kSrgb:
    case Numeric::kSfloat:
    case Numeric::kUfloat:
      return BlendType::kFloat;
    default:
      return BlendType::kNone;
  }
}

/// E4: without alpha in the target, destination alpha is one.
VkBlendFactor sanitize(VkBlendFactor factor, VkBlendOp op, bool has_alpha, bool normalized) {
  if (!takes_factors(op)) return VK_BLEND_FACTOR_ONE;
  if (has_alpha) return factor;
  if (factor == VK_BLEND_FACTOR_DST_ALPHA) return VK_BLEND_FACTOR_ONE;
  if (factor == VK_BLEND_FACTOR_ONE_MINUS_DST_ALPHA) return VK_BLEND_FACTOR_ZERO;
  if (factor == VK_BLEND_FACTOR_SRC_ALPHA_SATURATE && normalized) return VK_BLEND_FACTOR_ZERO;
  return factor;
}

/// Bits of a stored texel that the write mask lets through.
StoredTexel write_bits(const FormatDesc& format, VkColorComponentFlags mask) {
  StoredTexel bits;
  for (std::size_t c = 0; c < 4; ++c) {
    if (format.rgba[c] < 0 || !(mask >> c & 1)) continue;
    const Channel& channel = format.channel[static_cast<std::size_t>(format.rgba[c])];
    for (std::uint32_t b = channel.offset; b < std::uint32_t{channel.offset} + channel.bits; ++b) {
      bits.bytes[b / 8] |= static_cast<std::byte>(1u << (b % 8));
    }
  }
  return bits;
}

bool all_channels(const FormatDesc& format, VkColorComponentFlags mask) {
  for (std::size_t c = 0; c < 4; ++c) {
    if (format.rgba[c] >= 0 && !(mask >> c & 1)) return false;
  }
  return true;
}

/// The fast function for this writer, or null.
ColorFunction fast_color_function(const ColorWriter& writer) {
  if (writer.logic) return nullptr;
  if (const ColorFunction bytes = byte_color_function(writer)) return bytes;
  return float_color_function(writer);
}

}  // namespace

ColorWriter make_general_color_writer(VkFormat format, const BlendAttachment& blend, const State& state) {
  ColorWriter writer;
  writer.format = &texel::format_desc(format);
  if (writer.format->block_bytes == 0) return writer;
  writer.write_bits = write_bits(*writer.format, blend.write_mask);
  writer.masked = !all_channels(*writer.format, blend.write_mask);
  std::copy(state.blend_constants.begin(), state.blend_constants.end(), writer.constants);
  const BlendType type = blend_type(*writer.format);
  const bool normalized = type == BlendType::kByte || type == BlendType::kWord;
  if (state.logic_op_enable) {
    // E6: a logic op disables blending; float and sRGB targets store the source whatever the op.
    writer.logic = type != BlendType::kFloat || writer.format->channel[0].numeric == Numeric::kSnorm;
    writer.logic_op = state.logic_op;
  } else if (blend.enable && blend.advances()) {
    writer.blend = type == BlendType::kNone ? type : BlendType::kAdvanced;
    writer.advanced = blend;
  } else if (blend.enable) {
    writer.blend = type;
    const bool has_alpha = writer.format->rgba[3] >= 0;
    writer.rgb = {sanitize(blend.src_color, blend.color_op, has_alpha, normalized),
                  sanitize(blend.dst_color, blend.color_op, has_alpha, normalized), blend.color_op};
    writer.alpha = {sanitize(blend.src_alpha, blend.alpha_op, has_alpha, normalized),
                    sanitize(blend.dst_alpha, blend.alpha_op, has_alpha, normalized), blend.alpha_op};
    if (!has_alpha) writer.alpha = writer.rgb;  // so that equal factors of the colour are common factors
  }
  bool writes = false;
  for (const std::byte b : writer.write_bits.bytes) writes |= b != std::byte{0};
  if (writes) writer.function = write_color_general;
  return writer;
}

ColorWriter make_color_writer(VkFormat format, const BlendAttachment& blend, const State& state) {
  ColorWriter writer = make_general_color_writer(format, blend, state);
  if (writer.function && writer.blend != BlendType::kAdvanced) {
    if (is_four_bytes(*writer.format)) set_byte_places(writer);
    if (const ColorFunction fast = fast_color_function(writer)) writer.function = fast;
    writer.block = block_color_functions(writer);
  }
  return writer;
}

}  // namespace vitrine::raster

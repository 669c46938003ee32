// Colour output in general: any format, any state, lane by lane. The fast functions give the same bits.
#include "raster/output/color.h"

#include <cstring>

#include "base/float_mode.h"
#include "raster/output/blend.h"
#include "raster/output/color_fast.h"
#include "raster/tile/block.h"
#include "texel/codec/unorm_attachment.h"

namespace vitrine::raster {
namespace {

using texel::Channel;
using texel::FormatDesc;
using texel::Numeric;
using texel::StoredTexel;
using texel::Texel;

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

/// E4: without alpha in the target, destination alpha is one. MIN and MAX take no factors.
VkBlendFactor sanitize(VkBlendFactor factor, VkBlendOp op, bool has_alpha, bool normalized) {
  if (op == VK_BLEND_OP_MIN || op == VK_BLEND_OP_MAX) return VK_BLEND_FACTOR_ONE;
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

/// Widens by bit replication.
std::uint32_t replicate(std::uint32_t value, std::uint32_t bits, std::uint32_t wide) {
  std::uint32_t result = 0;
  for (std::int32_t shift = static_cast<std::int32_t>(wide - bits); shift > -static_cast<std::int32_t>(bits);
       shift -= static_cast<std::int32_t>(bits)) {
    result |= shift >= 0 ? value << shift : value >> -shift;
  }
  return result;
}

std::uint32_t field(const std::byte* texel, const Channel& channel) {
  std::uint32_t word = 0;
  const std::size_t first = channel.offset / 8, last = (channel.offset + channel.bits - 1u) / 8;
  for (std::size_t i = first; i <= last; ++i) word |= static_cast<std::uint32_t>(texel[i]) << (8 * (i - first));
  return word >> (channel.offset % 8) & ((1u << channel.bits) - 1);
}

void set_field(StoredTexel& texel, const Channel& channel, std::uint32_t value) {
  const std::size_t first = channel.offset / 8, last = (channel.offset + channel.bits - 1u) / 8;
  const std::uint32_t word = value << (channel.offset % 8);
  for (std::size_t i = first; i <= last; ++i) texel.bytes[i] |= static_cast<std::byte>(word >> (8 * (i - first)));
}

template <int Bits>
StoredTexel blend_normalized(const ColorWriter& writer, const BlendShape& shape, const Texel& color,
                             const Texel& second, const std::byte* pixel) {
  using Ops = NormalizedBlend<Bits>;
  const auto convert = [](float x) { return Bits == 8 ? texel::unorm8_attachment(x) : texel::unorm16_attachment(x); };
  const FormatDesc& format = *writer.format;
  BlendInput<std::uint32_t> in{};
  in.has_alpha = format.rgba[3] >= 0;
  for (std::size_t c = 0; c < 4; ++c) {
    in.src[c] = convert(base::float_of(color[c]));
    in.second[c] = convert(base::float_of(second[c]));
    in.constants[c] = Bits == 8 ? constant_to_byte(writer.constants[c]) : convert(writer.constants[c]);
    if (format.rgba[c] >= 0) {
      const Channel& channel = format.channel[static_cast<std::size_t>(format.rgba[c])];
      in.dst[c] = replicate(field(pixel, channel), channel.bits, Bits);
    }
  }
  const auto result = blend_pixel<Ops>(writer, shape, in);
  StoredTexel stored;
  for (std::size_t c = 0; c < 4; ++c) {
    if (format.rgba[c] < 0) continue;
    const Channel& channel = format.channel[static_cast<std::size_t>(format.rgba[c])];
    set_field(
        stored, channel,
        Bits == 8 ? texel::narrow_unorm8(result[c], channel.bits) : texel::narrow_unorm16(result[c], channel.bits));
  }
  return stored;
}

StoredTexel blend_float(const ColorWriter& writer, const BlendShape& shape, const Texel& color, const Texel& second,
                        const std::byte* pixel) {
  const FormatDesc& format = *writer.format;
  Texel decoded;
  texel::texel_decoder(format)(format, pixel, decoded);
  BlendInput<float> in{};
  in.has_alpha = format.rgba[3] >= 0;
  const bool is_snorm = format.channel[0].numeric == Numeric::kSnorm;
  const auto clamp = [&](float x) {
    if (!format.is_srgb() && !is_snorm) return x;
    return base::min_second(base::max_second(x, is_snorm ? -1.0f : 0.0f), 1.0f);
  };
  for (std::size_t c = 0; c < 4; ++c) {
    in.src[c] = clamp(base::float_of(color[c]));
    in.second[c] = clamp(base::float_of(second[c]));
    in.constants[c] = clamp(writer.constants[c]);
    in.dst[c] = base::float_of(decoded[c]);
  }
  const auto result = blend_pixel<FloatBlend>(writer, shape, in);
  Texel bits;
  for (std::size_t c = 0; c < 4; ++c) bits[c] = base::bits_of(result[c]);
  StoredTexel stored;
  texel::encode_texel(format, texel::Encoding::kAttachment, bits, stored.bytes.data());
  return stored;
}

std::byte logic(VkLogicOp op, std::byte s, std::byte d) {
  switch (op) {
    case VK_LOGIC_OP_CLEAR:
      return std::byte{0};
    case VK_LOGIC_OP_AND:
      return s & d;
    case VK_LOGIC_OP_AND_REVERSE:
      return s & ~d;
    case VK_LOGIC_OP_COPY:
      return s;
    case VK_LOGIC_OP_AND_INVERTED:
      return ~s & d;
    case VK_LOGIC_OP_NO_OP:
      return d;
    case VK_LOGIC_OP_XOR:
      return s ^ d;
    case VK_LOGIC_OP_OR:
      return s | d;
    case VK_LOGIC_OP_NOR:
      return ~(s | d);
    case VK_LOGIC_OP_EQUIVALENT:
      return ~(s ^ d);
    case VK_LOGIC_OP_INVERT:
      return ~d;
    case VK_LOGIC_OP_OR_REVERSE:
      return s | ~d;
    case VK_LOGIC_OP_COPY_INVERTED:
      return ~s;
    case VK_LOGIC_OP_OR_INVERTED:
      return ~s | d;
    case VK_LOGIC_OP_NAND:
      return ~(s & d);
    default:
      return ~std::byte{0};
  }
}

StoredTexel shade_pixel(const ColorWriter& writer, const BlendShape& shape, const Texel& color, const Texel& second,
                        const std::byte* pixel) {
  switch (writer.blend) {
    case BlendType::kByte:
      return blend_normalized<8>(writer, shape, color, second, pixel);
    case BlendType::kWord:
      return blend_normalized<16>(writer, shape, color, second, pixel);
    case BlendType::kFloat:
      return blend_float(writer, shape, color, second, pixel);
    case BlendType::kNone:
      break;
  }
  StoredTexel stored;
  texel::encode_texel(*writer.format, texel::Encoding::kAttachment, color, stored.bytes.data());
  return stored;
}

/// Half and 11/11/10-bit targets honour denormals while they blend and store (lavapipe-shader-math.md section 1).
bool keeps_denormals(const FormatDesc& format) {
  const Channel& channel = format.channel[0];
  return channel.numeric == Numeric::kUfloat || (channel.numeric == Numeric::kSfloat && channel.bits == 16);
}

void write_general(const ColorWriter& writer, const ColorWave& wave) {
  const base::ScopedFloatMode mode(keeps_denormals(*writer.format) ? base::Denormals::kHonour
                                                                   : base::Denormals::kFlush);
  const BlendShape shape = blend_shape(writer);
  const std::size_t bytes = writer.format->block_bytes;
  base::for_each_lane(wave.mask, [&](std::size_t lane) {
    std::byte* pixel = pixel_address(wave, lane);
    Texel color, second{};
    for (std::size_t c = 0; c < 4; ++c) color[c] = wave.color[c].lane[lane];
    if (wave.second) {
      for (std::size_t c = 0; c < 4; ++c) second[c] = wave.second[c].lane[lane];
    }
    const StoredTexel stored = shade_pixel(writer, shape, color, second, pixel);
    for (std::size_t i = 0; i < bytes; ++i) {
      const std::byte value = writer.logic ? logic(writer.logic_op, stored.bytes[i], pixel[i]) : stored.bytes[i];
      pixel[i] = (value & writer.write_bits.bytes[i]) | (pixel[i] & ~writer.write_bits.bytes[i]);
    }
  });
}

}  // namespace

BlendShape::Lerp complementary(VkBlendFactor src, VkBlendFactor dst) {
  // VkBlendFactor lists f and ONE_MINUS_f next to each other from SRC_COLOR on: even is f.
  const auto pair = [](VkBlendFactor plain, VkBlendFactor inverse) {
    if (plain == VK_BLEND_FACTOR_ONE) return inverse == VK_BLEND_FACTOR_ZERO;
    const bool listed = (plain >= VK_BLEND_FACTOR_SRC_COLOR && plain < VK_BLEND_FACTOR_SRC_ALPHA_SATURATE &&
                         (plain - VK_BLEND_FACTOR_SRC_COLOR) % 2 == 0) ||
                        (plain >= VK_BLEND_FACTOR_SRC1_COLOR && (plain - VK_BLEND_FACTOR_SRC1_COLOR) % 2 == 0);
    return listed && inverse == plain + 1;
  };
  if (pair(src, dst)) return BlendShape::Lerp::kSource;
  if (pair(dst, src)) return BlendShape::Lerp::kDestination;
  return BlendShape::Lerp::kNone;
}

BlendShape blend_shape(const ColorWriter& writer) {
  const FormatDesc& format = *writer.format;
  const bool has_alpha = format.rgba[3] >= 0;
  BlendShape shape;
  const auto is_constant = [&](VkBlendFactor rgb, VkBlendFactor alpha, VkBlendFactor wanted) {
    const VkBlendFactor a = alpha == VK_BLEND_FACTOR_SRC_ALPHA_SATURATE ? VK_BLEND_FACTOR_ONE : alpha;
    return rgb == wanted && (!has_alpha || a == wanted);
  };
  shape.src_zero = is_constant(writer.rgb.src, writer.alpha.src, VK_BLEND_FACTOR_ZERO);
  shape.src_one = is_constant(writer.rgb.src, writer.alpha.src, VK_BLEND_FACTOR_ONE);
  shape.dst_zero = is_constant(writer.rgb.dst, writer.alpha.dst, VK_BLEND_FACTOR_ZERO);
  shape.dst_one = is_constant(writer.rgb.dst, writer.alpha.dst, VK_BLEND_FACTOR_ONE);
  const bool single = format.channel_count == 1;
  if (single) shape.lerp = complementary(writer.rgb.src, writer.rgb.dst);
  shape.common_factor = writer.rgb.src == writer.rgb.dst && (single || writer.alpha.src == writer.alpha.dst);
  return shape;
}

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
  if (writes) writer.function = write_general;
  return writer;
}

ColorWriter make_color_writer(VkFormat format, const BlendAttachment& blend, const State& state) {
  ColorWriter writer = make_general_color_writer(format, blend, state);
  if (writer.function) {
    if (is_four_bytes(*writer.format)) set_byte_places(writer);
    if (const ColorFunction fast = fast_color_function(writer)) writer.function = fast;
    writer.block = block_color_functions(writer);
  }
  return writer;
}

}  // namespace vitrine::raster

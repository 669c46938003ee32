// Colour output in general: any format, any state, lane by lane. The fast functions give the same bits.
#include "raster/output/color_general.h"

#include <cmath>
#include <cstring>

#include "base/float_mode.h"
#include "raster/output/advanced_blend.h"
#include "raster/output/blend.h"
#include "texel/codec/unorm_attachment.h"

namespace vitrine::raster {
namespace {

using texel::Channel;
using texel::FormatDesc;
using texel::Numeric;
using texel::StoredTexel;
using texel::Texel;

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

/// The range of a fixed-point attachment, to which fragments' colours are clamped before they are blended (Vulkan
/// 1.3.239, Blending); of floats as it is.
float clamp_to_format(const FormatDesc& format, float x) {
  switch (format.channel[0].numeric) {
    case Numeric::kUnorm:
    case Numeric::kSrgb:
      return base::min_second(base::max_second(x, 0.0f), 1.0f);
    case Numeric::kSnorm:
      return base::min_second(base::max_second(x, -1.0f), 1.0f);
    default:
      return x;
  }
}

/// A component of the destination, whose decoder multiplies by a reciprocal that is not exact: operations with steps
/// tell 0.6 from what lies next to it.
float nearest_value(const Channel& channel, float decoded) {
  if (channel.numeric != Numeric::kUnorm) return decoded;
  const auto largest = static_cast<float>((1u << channel.bits) - 1);
  return std::nearbyint(decoded * largest) / largest;
}

StoredTexel blend_with_operation(const ColorWriter& writer, const Texel& color, const std::byte* pixel) {
  const FormatDesc& format = *writer.format;
  Texel decoded;
  texel::texel_decoder(format)(format, pixel, decoded);
  std::array<float, 4> src, dst;
  for (std::size_t c = 0; c < 4; ++c) {
    src[c] = clamp_to_format(format, base::float_of(color[c]));
    dst[c] = base::float_of(decoded[c]);
    if (format.rgba[c] >= 0) dst[c] = nearest_value(format.channel[static_cast<std::size_t>(format.rgba[c])], dst[c]);
  }
  const std::array<float, 4> result = blend_advanced(writer.advanced, src, dst);
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
    case BlendType::kAdvanced:
      return blend_with_operation(writer, color, pixel);
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

}  // namespace

void write_color_general(const ColorWriter& writer, const ColorWave& wave) {
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

}  // namespace vitrine::raster

// Stored bits to values, for every plain format (lavapipe-texture-blend.md part C).
#include <cstring>

#include "base/numeric.h"
#include "texel/capabilities.h"
#include "texel/codec.h"
#include "texel/codec/rows.h"
#include "texel/codec/small_float.h"
#include "texel/codec/srgb.h"

namespace vitrine::texel {
namespace {

constexpr std::uint32_t kOneFloat = 0x3f800000u;

/// f32(1 / (2^bits - 1)): the reference multiplies by the rounded reciprocal.
constexpr float unorm_scale(std::uint32_t bits) {
  return static_cast<float>(1.0 / static_cast<double>((std::uint64_t{1} << bits) - 1));
}

constexpr auto kUnormScale = [] {
  std::array<float, 33> table{};
  for (std::uint32_t bits = 1; bits <= 32; ++bits) table[bits] = unorm_scale(bits);
  return table;
}();

constexpr std::int32_t sign_extend(std::uint32_t value, std::uint32_t bits) {
  return static_cast<std::int32_t>(value << (32 - bits)) >> (32 - bits);
}

template <Numeric kNumeric>
std::uint32_t convert(std::uint32_t raw, std::uint32_t bits) {
  using base::bits_of;
  if constexpr (kNumeric == Numeric::kUnorm) {
    return bits_of(static_cast<float>(raw) * kUnormScale[bits]);
  } else if constexpr (kNumeric == Numeric::kSnorm) {
    return bits_of(base::max_second(static_cast<float>(sign_extend(raw, bits)) * kUnormScale[bits - 1], -1.0f));
  } else if constexpr (kNumeric == Numeric::kUscaled) {
    return bits_of(static_cast<float>(raw));
  } else if constexpr (kNumeric == Numeric::kSscaled) {
    return bits_of(static_cast<float>(sign_extend(raw, bits)));
  } else if constexpr (kNumeric == Numeric::kSint) {
    return static_cast<std::uint32_t>(sign_extend(raw, bits));
  } else if constexpr (kNumeric == Numeric::kSfloat) {
    return bits == 16 ? bits_of(base::half_to_float(static_cast<std::uint16_t>(raw))) : raw;
  } else if constexpr (kNumeric == Numeric::kSrgb) {
    return bits_of(kSrgbToLinear[raw & 255]);
  } else {
    return raw;
  }
}

/// Puts decoded channels in RGBA order and fills the missing ones.
void place(const FormatDesc& format, const std::uint32_t channels[4], Texel& out) {
  const std::uint32_t one = format.kind == Kind::kFloat ? kOneFloat : 1u;
  const std::uint32_t missing[4] = {0, 0, 0, one};
  for (std::size_t i = 0; i < 4; ++i) {
    out[i] = format.rgba[i] >= 0 ? channels[format.rgba[i]] : missing[i];
  }
}

/// Elements of one type side by side.
template <class Element, Numeric kNumeric>
void decode_array(const FormatDesc& format, const std::byte* block, Texel& out) {
  constexpr std::uint32_t kBits = sizeof(Element) * 8;
  Element elements[4] = {};
  std::memcpy(elements, block, format.block_bytes);
  std::uint32_t channels[4];
  for (std::size_t i = 0; i < 4; ++i) channels[i] = convert<kNumeric>(elements[i], kBits);
  if constexpr (kNumeric == Numeric::kSrgb) {
    if (format.rgba[3] >= 0) channels[format.rgba[3]] = convert<Numeric::kUnorm>(elements[format.rgba[3]], kBits);
  }
  place(format, channels, out);
}

/// Bit fields of words.
template <Numeric kNumeric>
void decode_packed(const FormatDesc& format, const std::byte* block, Texel& out) {
  std::uint64_t word = 0;
  std::memcpy(&word, block, format.block_bytes);
  std::uint32_t channels[4] = {};
  for (std::size_t i = 0; i < format.channel_count; ++i) {
    const Channel& c = format.channel[i];
    const auto raw = static_cast<std::uint32_t>(word >> c.offset) & static_cast<std::uint32_t>((1ull << c.bits) - 1);
    channels[i] =
        kNumeric == Numeric::kSrgb && c.name == 'A' ? convert<Numeric::kUnorm>(raw, 8) : convert<kNumeric>(raw, c.bits);
  }
  place(format, channels, out);
}

void decode_b10g11r11(const FormatDesc&, const std::byte* block, Texel& out) {
  std::uint32_t word = 0;
  std::memcpy(&word, block, sizeof(word));
  out = {base::bits_of(decode_small_float(word & 0x7ff, 6)), base::bits_of(decode_small_float((word >> 11) & 0x7ff, 6)),
         base::bits_of(decode_small_float(word >> 22, 5)), kOneFloat};
}

void decode_e5b9g9r9(const FormatDesc&, const std::byte* block, Texel& out) {
  std::uint32_t word = 0;
  std::memcpy(&word, block, sizeof(word));
  float rgb[3];
  decode_shared_exponent(word, rgb);
  out = {base::bits_of(rgb[0]), base::bits_of(rgb[1]), base::bits_of(rgb[2]), kOneFloat};
}

/// The member of a family of decoders that handles a numeric format.
template <template <Numeric> class Family>
TexelDecoder choose(Numeric numeric) {
  switch (numeric) {
    case Numeric::kUnorm:
      return Family<Numeric::kUnorm>::decode;
    case Numeric::kSnorm:
      return Family<Numeric::kSnorm>::decode;
    case Numeric::kUscaled:
      return Family<Numeric::kUscaled>::decode;
    case Numeric::kSscaled:
      return Family<Numeric::kSscaled>::decode;
    case Numeric::kUint:
      return Family<Numeric::kUint>::decode;
    case Numeric::kSint:
      return Family<Numeric::kSint>::decode;
    case Numeric::kSfloat:
      return Family<Numeric::kSfloat>::decode;
    case Numeric::kSrgb:
      return Family<Numeric::kSrgb>::decode;
    default:
      return nullptr;
  }
}

template <Numeric kNumeric>
struct Bytes {
  static constexpr TexelDecoder decode = decode_array<std::uint8_t, kNumeric>;
};
template <Numeric kNumeric>
struct Halves {
  static constexpr TexelDecoder decode = decode_array<std::uint16_t, kNumeric>;
};
template <Numeric kNumeric>
struct Words {
  static constexpr TexelDecoder decode = decode_array<std::uint32_t, kNumeric>;
};
template <Numeric kNumeric>
struct Fields {
  static constexpr TexelDecoder decode = decode_packed<kNumeric>;
};

/// Whether the channels are whole elements of one size, without gaps.
bool is_array(const FormatDesc& format) {
  const std::uint32_t bits = format.channel[0].bits;
  if (bits != 8 && bits != 16 && bits != 32) return false;
  for (std::uint32_t i = 0; i < format.channel_count; ++i) {
    if (format.channel[i].bits != bits || format.channel[i].offset != i * bits) return false;
  }
  return format.channel_count * bits == format.block_bytes * 8u;
}

}  // namespace

TexelDecoder texel_decoder(const FormatDesc& format) {
  if (!can_decode(format)) return nullptr;
  if (format.format == VK_FORMAT_B10G11R11_UFLOAT_PACK32) return decode_b10g11r11;
  if (format.format == VK_FORMAT_E5B9G9R9_UFLOAT_PACK32) return decode_e5b9g9r9;
  const Numeric numeric = format.channel[0].numeric;
  if (!is_array(format)) return choose<Fields>(numeric);
  if (format.channel[0].bits == 8) return choose<Bytes>(numeric);
  return format.channel[0].bits == 16 ? choose<Halves>(numeric) : choose<Words>(numeric);
}

void decode_row(const FormatDesc& format, const std::byte* blocks, std::size_t count, Texel* out) {
  if (decode_row_simd(format, blocks, count, out)) return;
  const TexelDecoder decode = texel_decoder(format);
  if (decode == nullptr) return;
  for (std::size_t i = 0; i < count; ++i) decode(format, blocks + i * format.block_bytes, out[i]);
}

}  // namespace vitrine::texel

// Values to stored bits, for every plain format and each of the three ways to round: imageStore
// (lavapipe-texture-blend.md part B), clears (lavapipe-rasterization.md 11.1) and colour or depth output (part D, 5.3).
#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/numeric.h"
#include "texel/capabilities.h"
#include "texel/codec.h"
#include "texel/codec/rows.h"
#include "texel/codec/small_float.h"
#include "texel/codec/srgb.h"
#include "texel/codec/unorm_attachment.h"

namespace vitrine::texel {
namespace {

using base::bits_of;
using base::float_of;

constexpr std::uint32_t low_mask(std::uint32_t bits) { return static_cast<std::uint32_t>((1ull << bits) - 1); }

/// Rounds x in [0, 1] to n <= 16 bits by an addition that leaves the integer in the low mantissa bits.
std::uint32_t unorm_by_magic(float x, std::uint32_t bits) {
  const float scale = static_cast<float>(static_cast<double>(low_mask(bits)) / static_cast<double>(1u << bits));
  const float magic = static_cast<float>(1u << (23 - bits));
  return bits_of(x * scale + magic) & low_mask(bits);
}

/// The reference's cvtr(min(1, x) * 255) with saturation: scaling by 255/256 instead changes no rounding.
/// Channels that are no bytes or 16-bit words come from one (part D); 10-bit and 2-bit ones of one word from 16 bits.
std::uint32_t unorm_attachment(float x, std::uint32_t bits, bool wide) {
  if (bits == 8) return unorm8_attachment(x);
  if (bits >= 16) return unorm16_attachment(x);
  return wide ? narrow_unorm16(unorm16_attachment(x), bits) : narrow_unorm8(unorm8_attachment(x), bits);
}

std::uint32_t unorm_clear(float x, std::uint32_t bits) {
  const float clamped = x > 0.0f ? std::min(x, 1.0f) : 0.0f;  // NaN: 0
  if (bits == 8) return clamped >= 1.0f ? 255 : unorm_by_magic(clamped, 8);
  return static_cast<std::uint32_t>(base::round_half_away(clamped * static_cast<float>(low_mask(bits))));
}

std::uint32_t unorm_store(float x, std::uint32_t bits) {
  return unorm_by_magic(base::max_second(base::min_second(x, 1.0f), 0.0f), std::min(bits, 16u));
}

std::int32_t snorm(Encoding encoding, float x, std::uint32_t bits) {
  const float largest = static_cast<float>(low_mask(bits - 1));
  if (encoding == Encoding::kClear) {
    const float clamped = x > -1.0f ? std::min(x, 1.0f) : -1.0f;  // NaN: -1
    return base::round_half_away(clamped * largest);
  }
  if (encoding == Encoding::kStore) {
    return base::round_to_int(base::max_second(base::min_second(x, 1.0f), -1.0f) * largest);
  }
  if (bits == 8) return std::clamp(base::round_to_int(base::min_second(1.0f, x) * 127.0f), -128, 127);
  return base::round_to_int(base::min_second(base::max_second(x, -1.0f), 1.0f) * largest);
}

/// imageStore scales by a multiplication, so a mode that flushes denormals flushes small results.
std::uint32_t small_float_store(float x, int mantissa_bits) {
  if (x > 0.0f && x < 1.0f) {
    const float scaled = float_of(bits_of(x) & ~low_mask(static_cast<std::uint32_t>(23 - mantissa_bits))) * 0x1p-112f;
    return bits_of(scaled) >> (23 - mantissa_bits);
  }
  return encode_small_float(x, mantissa_bits);
}

std::uint32_t unsigned_float(Encoding encoding, float x, std::uint32_t bits) {
  const int mantissa_bits = static_cast<int>(bits) - 5;
  if (encoding == Encoding::kClear) return encode_small_float_clear(x, mantissa_bits);
  return encoding == Encoding::kStore ? small_float_store(x, mantissa_bits) : encode_small_float(x, mantissa_bits);
}

/// Depth: clears round in binary64, fragments in binary32.
std::uint32_t depth(Encoding encoding, std::uint32_t value, const Channel& channel) {
  const float z = float_of(value);
  if (channel.numeric == Numeric::kSfloat) {
    return encoding == Encoding::kClear ? value : bits_of(base::max_second(base::min_second(z, 1.0f), 0.0f));
  }
  const std::uint32_t largest = low_mask(channel.bits);
  if (encoding == Encoding::kClear) {
    if (!(z > 0.0f)) return 0;
    return z >= 1.0f ? largest : static_cast<std::uint32_t>(std::nearbyint(static_cast<double>(z) * largest));
  }
  const float clamped = base::max_second(base::min_second(z, 1.0f), 0.0f);
  if (channel.bits == 16) return unorm_by_magic(clamped, 16);
  return static_cast<std::uint32_t>(base::round_to_int(clamped * static_cast<float>(largest)));
}

std::uint32_t srgb(Encoding encoding, float x, const Channel& channel) {
  if (encoding == Encoding::kClear) return channel.name == 'A' ? unorm_clear(x, 8) : encode_srgb_clear(x);
  return channel.name == 'A' ? unorm8_attachment(x) : encode_srgb_attachment(x);
}

std::uint32_t encode_channel(const FormatDesc& format, Encoding encoding, const Channel& channel, std::uint32_t value) {
  const float x = float_of(value);
  const std::uint32_t bits = channel.bits;
  if (channel.name == 'D') return depth(encoding, value, channel);
  switch (channel.numeric) {
    case Numeric::kUnorm:
      if (encoding == Encoding::kAttachment) return unorm_attachment(x, bits, format.packed_bits == 32 && bits != 8);
      return encoding == Encoding::kStore ? unorm_store(x, bits) : unorm_clear(x, bits);
    case Numeric::kSnorm:
      return static_cast<std::uint32_t>(snorm(encoding, x, bits));
    case Numeric::kUint:
      return std::min(value, low_mask(bits));
    case Numeric::kSint: {
      const auto limit = static_cast<std::int32_t>(low_mask(bits - 1));
      return static_cast<std::uint32_t>(std::clamp(static_cast<std::int32_t>(value), -limit - 1, limit));
    }
    case Numeric::kSfloat:
      return bits == 16 ? base::float_to_half_truncate(x) : value;
    case Numeric::kUfloat:
      return unsigned_float(encoding, x, bits);
    case Numeric::kSrgb:
      return srgb(encoding, x, channel);
    default:
      return 0;
  }
}

template <Encoding kEncoding>
void encode_any(const FormatDesc& format, const Texel& texel, std::byte* block) {
  std::uint64_t words[2] = {};
  for (std::size_t i = 0; i < format.channel_count; ++i) {
    const Channel& channel = format.channel[i];
    const std::uint64_t value =
        encode_channel(format, kEncoding, channel, texel[format.component[i]]) & low_mask(channel.bits);
    words[channel.offset / 64] |= value << (channel.offset % 64);
  }
  std::memcpy(block, words, format.block_bytes);
}

void encode_e5b9g9r9(const FormatDesc&, const Texel& texel, std::byte* block) {
  const float rgb[3] = {float_of(texel[0]), float_of(texel[1]), float_of(texel[2])};
  const std::uint32_t word = encode_shared_exponent(rgb);
  std::memcpy(block, &word, sizeof(word));
}

/// Four 8-bit UNORM channels in any order.
template <bool kStore>
void encode_four_bytes(const FormatDesc& format, const Texel& texel, std::byte* block) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const float x = float_of(texel[format.component[i]]);
    const float clamped =
        kStore ? base::max_second(base::min_second(x, 1.0f), 0.0f) : base::min_second(base::max_second(x, 0.0f), 1.0f);
    word |= unorm_by_magic(clamped, 8) << (8 * i);
  }
  std::memcpy(block, &word, sizeof(word));
}

/// 32-bit channels are stored as they are.
void encode_words(const FormatDesc& format, const Texel& texel, std::byte* block) {
  std::memcpy(block, texel.data(), format.block_bytes);
}

template <Encoding kEncoding>
TexelEncoder choose_encoder(const FormatDesc& format) {
  const Channel& first = format.channel[0];
  const bool attached_or_stored = kEncoding != Encoding::kClear;
  if (format.format == VK_FORMAT_E5B9G9R9_UFLOAT_PACK32) return encode_e5b9g9r9;
  if (first.bits == 32 && first.name == 'R') return encode_words;
  if (attached_or_stored && format.block_bytes == 4 && format.channel_count == 4 && first.bits == 8 &&
      first.numeric == Numeric::kUnorm) {
    return encode_four_bytes<kEncoding == Encoding::kStore>;
  }
  return encode_any<kEncoding>;
}

}  // namespace

TexelEncoder texel_encoder(const FormatDesc& format, Encoding encoding) {
  if (!can_encode(format)) return nullptr;
  switch (encoding) {
    case Encoding::kStore:
      return choose_encoder<Encoding::kStore>(format);
    case Encoding::kClear:
      return choose_encoder<Encoding::kClear>(format);
    default:
      return choose_encoder<Encoding::kAttachment>(format);
  }
}

void encode_texel(const FormatDesc& format, Encoding encoding, const Texel& texel, std::byte* block) {
  encode_row(format, encoding, &texel, 1, block);
}

void encode_row(const FormatDesc& format, Encoding encoding, const Texel* texels, std::size_t count,
                std::byte* blocks) {
  if (encode_row_simd(format, encoding, texels, count, blocks)) return;
  const TexelEncoder encode = texel_encoder(format, encoding);
  if (encode == nullptr) return;
  for (std::size_t i = 0; i < count; ++i) encode(format, texels[i], blocks + i * format.block_bytes);
}

}  // namespace vitrine::texel

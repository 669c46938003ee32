// Interpolation of BC1 to BC5 in 16-bit words, with the reference's truncations (lavapipe-texture-blend.md C1).
#include "texel/block/s3tc_rgtc.h"

#include <cstring>

namespace vitrine::texel {
namespace {

using Rgb = std::array<std::uint32_t, 3>;

Rgb expand_565(std::uint32_t c) {
  const std::uint32_t r = c >> 11, g = (c >> 5) & 63, b = c & 31;
  return {r << 3 | r >> 2, g << 2 | g >> 4, b << 3 | b >> 2};
}

/// e0 + (e1 - e0) / 3 (shift 8) or * 2 / 3 (shift 7), by a product with 85 kept in 16 bits.
std::uint32_t third(std::uint32_t e0, std::uint32_t e1, int shift) {
  const std::uint32_t product = (85u * (e1 - e0)) & 0xFFFFu;
  return (e0 + ((product >> shift) & 255)) & 255;
}

std::uint32_t code_of(const std::byte* block, std::uint32_t index) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, block, sizeof(bits));
  return static_cast<std::uint32_t>(bits >> (16 + 3 * index)) & 7;
}

/// Weighted value between two endpoints; weights have 6 fractional bits less than their product's 8.
std::uint32_t between(std::uint32_t a0, std::uint32_t a1, std::uint32_t scale, std::uint32_t step) {
  const std::uint32_t weight = (scale * step) >> 6;
  const std::uint32_t product = ((a1 - a0) * weight) & 0xFFFFu;
  return (a0 + (product >> 8)) & 255;
}

}  // namespace

std::array<std::uint8_t, 4> decode_color_block(const std::byte* block, std::uint32_t index, ColorBlock kind) {
  std::uint16_t ends[2];
  std::uint32_t codes = 0;
  std::memcpy(ends, block, sizeof(ends));
  std::memcpy(&codes, block + 4, sizeof(codes));
  const Rgb e0 = expand_565(ends[0]), e1 = expand_565(ends[1]);
  const std::uint32_t code = (codes >> (2 * index)) & 3;
  const bool four = kind == ColorBlock::kFourColors || ends[0] > ends[1];
  std::array<std::uint8_t, 4> out{0, 0, 0, 255};
  if (code == 3 && !four) {
    out[3] = kind == ColorBlock::kRgba ? 0 : 255;
    return out;
  }
  for (std::size_t c = 0; c < 3; ++c) {
    std::uint32_t value = code == 0 ? e0[c] : e1[c];
    if (code >= 2) value = four ? third(e0[c], e1[c], code == 2 ? 8 : 7) : (e0[c] + e1[c] + 1) >> 1;
    out[c] = static_cast<std::uint8_t>(value);
  }
  return out;
}

void decode_color_block(const std::byte* block, ColorBlock kind, std::uint32_t out[16]) {
  // A block whose first texels have the codes 0, 1, 2, 3 gives the four colours.
  constexpr std::uint32_t kEachCode = 0xE4;
  std::byte each[8];
  std::memcpy(each, block, 4);
  std::memcpy(each + 4, &kEachCode, sizeof(kEachCode));
  std::uint32_t color[4];
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::array<std::uint8_t, 4> rgba = decode_color_block(each, i, kind);
    std::memcpy(&color[i], rgba.data(), sizeof(color[i]));
  }
  std::uint32_t codes = 0;
  std::memcpy(&codes, block + 4, sizeof(codes));
  for (std::uint32_t i = 0; i < 16; ++i) out[i] = color[(codes >> (2 * i)) & 3];
}

void decode_channel_unsigned(const std::byte* block, std::uint8_t out[16]) {
  constexpr std::uint64_t kEachCode = 0xFAC688ull << 16;  // 7, 6, ... 0, three bits each
  std::uint64_t word = 0;
  std::memcpy(&word, block, sizeof(word));
  const std::uint64_t each = (word & 0xFFFF) | kEachCode;
  std::uint8_t value[8];
  for (std::uint32_t i = 0; i < 8; ++i) {
    value[i] = decode_channel_unsigned(reinterpret_cast<const std::byte*>(&each), i);
  }
  for (std::uint32_t i = 0; i < 16; ++i) out[i] = value[(word >> (16 + 3 * i)) & 7];
}

std::uint8_t decode_explicit_alpha(const std::byte* block, std::uint32_t index) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, block, sizeof(bits));
  return static_cast<std::uint8_t>(((bits >> (4 * index)) & 15) * 17);
}

std::uint8_t decode_channel_unsigned(const std::byte* block, std::uint32_t index) {
  const std::uint32_t a0 = std::to_integer<std::uint32_t>(block[0]), a1 = std::to_integer<std::uint32_t>(block[1]);
  const std::uint32_t code = code_of(block, index);
  if (code < 2) return static_cast<std::uint8_t>(code == 0 ? a0 : a1);
  if (a0 > a1) return static_cast<std::uint8_t>(between(a0, a1, kSevenths, code - 1));
  if (code >= 6) return code == 6 ? 0 : 255;
  return static_cast<std::uint8_t>(between(a0, a1, kFifths, code - 1));
}

std::int8_t decode_channel_signed(const std::byte* block, std::uint32_t index) {
  const auto a0 = static_cast<std::int8_t>(block[0]), a1 = static_cast<std::int8_t>(block[1]);
  const std::uint32_t code = code_of(block, index);
  if (code < 2) return code == 0 ? a0 : a1;
  if (a0 <= a1 && code >= 6) return code == 6 ? -127 : 127;
  const std::uint32_t scale = a0 > a1 ? kSevenths : kFifths;
  const auto u0 = static_cast<std::uint32_t>(a0), u1 = static_cast<std::uint32_t>(a1);
  return static_cast<std::int8_t>(between(u0, u1, scale, code - 1));
}

}  // namespace vitrine::texel

// The five modes of an ETC2 colour block, and EAC channels.
#include "texel/block/etc2.h"

#include <algorithm>
#include <cstring>

namespace vitrine::texel {
namespace {

using Rgba = std::array<std::uint8_t, 4>;

struct Rgb {
  std::int32_t r = 0, g = 0, b = 0;
};

constexpr std::int32_t kModifiers[8][2] = {{2, 8},   {5, 17},  {9, 29},   {13, 42},
                                           {18, 60}, {24, 80}, {33, 106}, {47, 183}};
constexpr std::int32_t kDistances[8] = {3, 6, 11, 16, 23, 32, 41, 64};
constexpr std::int8_t kEacModifiers[16][8] = {
    {-3, -6, -9, -15, 2, 5, 8, 14}, {-3, -7, -10, -13, 2, 6, 9, 12}, {-2, -5, -8, -13, 1, 4, 7, 12},
    {-2, -4, -6, -13, 1, 3, 5, 12}, {-3, -6, -8, -12, 2, 5, 7, 11},  {-3, -7, -9, -11, 2, 6, 8, 10},
    {-4, -7, -8, -11, 3, 6, 7, 10}, {-3, -5, -8, -11, 2, 4, 7, 10},  {-2, -6, -8, -10, 1, 5, 7, 9},
    {-2, -5, -8, -10, 1, 4, 7, 9},  {-2, -4, -8, -10, 1, 3, 7, 9},   {-2, -5, -7, -10, 1, 4, 6, 9},
    {-3, -4, -7, -10, 2, 3, 6, 9},  {-1, -2, -3, -10, 0, 1, 2, 9},   {-4, -6, -8, -9, 3, 5, 7, 8},
    {-3, -5, -7, -9, 2, 4, 6, 8},
};

std::uint64_t load_big_endian(const std::byte* block) {
  std::uint64_t word = 0;
  std::memcpy(&word, block, sizeof(word));
  return __builtin_bswap64(word);
}

/// Bits high..low of a block.
std::int32_t field(std::uint64_t word, int high, int low) {
  return static_cast<std::int32_t>(word >> low & ((std::uint64_t{1} << (high - low + 1)) - 1));
}

std::int32_t sign_extend_3(std::int32_t v) { return (v ^ 4) - 4; }
std::int32_t expand_4(std::int32_t v) { return v * 17; }
std::int32_t expand_5(std::int32_t v) { return v << 3 | v >> 2; }
std::int32_t expand_6(std::int32_t v) { return v << 2 | v >> 4; }
std::int32_t expand_7(std::int32_t v) { return v << 1 | v >> 6; }

Rgba clamped(const Rgb& c) {
  const auto byte = [](std::int32_t v) { return static_cast<std::uint8_t>(std::clamp(v, 0, 255)); };
  return {byte(c.r), byte(c.g), byte(c.b), 255};
}

Rgba shifted(const Rgb& c, std::int32_t d) { return clamped({c.r + d, c.g + d, c.b + d}); }

struct Place {
  std::int32_t x, y;
  int bit;  ///< of the texel's index: columns first
};

Place place_of(std::uint32_t index) {
  const auto x = static_cast<std::int32_t>(index & 3), y = static_cast<std::int32_t>(index >> 2);
  return {x, y, x * 4 + y};
}

/// The texel's two-bit index.
std::int32_t code_of(std::uint64_t word, int bit) {
  return field(word, 16 + bit, 16 + bit) << 1 | field(word, bit, bit);
}

/// Two half blocks, each a colour and a row of modifiers; without `opaque` index 2 is transparent.
Rgba halves(std::uint64_t word, const Place& at, const Rgb base[2], bool opaque) {
  const bool second = field(word, 32, 32) != 0 ? at.y >= 2 : at.x >= 2;
  const std::int32_t* modifiers = kModifiers[second ? field(word, 36, 34) : field(word, 39, 37)];
  const std::int32_t code = code_of(word, at.bit);
  if (!opaque && code == 2) return {};
  const std::int32_t size = !opaque && code == 0 ? 0 : modifiers[code & 1];
  return shifted(base[second ? 1 : 0], code >= 2 ? -size : size);
}

Rgba t_mode(std::uint64_t word, std::int32_t code) {
  const Rgb a{expand_4(field(word, 60, 59) << 2 | field(word, 57, 56)), expand_4(field(word, 55, 52)),
              expand_4(field(word, 51, 48))};
  const Rgb b{expand_4(field(word, 47, 44)), expand_4(field(word, 43, 40)), expand_4(field(word, 39, 36))};
  const std::int32_t distance = kDistances[field(word, 35, 34) << 1 | field(word, 32, 32)];
  if (code == 0) return clamped(a);
  return shifted(b, code == 1 ? distance : code == 2 ? 0 : -distance);
}

Rgba h_mode(std::uint64_t word, std::int32_t code) {
  const Rgb a{field(word, 62, 59), field(word, 58, 56) << 1 | field(word, 52, 52),
              field(word, 51, 51) << 3 | field(word, 49, 47)};
  const Rgb b{field(word, 46, 43), field(word, 42, 39), field(word, 38, 35)};
  const bool ordered = (a.r << 8 | a.g << 4 | a.b) >= (b.r << 8 | b.g << 4 | b.b);
  const std::int32_t distance = kDistances[field(word, 34, 34) << 2 | field(word, 32, 32) << 1 | (ordered ? 1 : 0)];
  const Rgb& c = code < 2 ? a : b;
  return shifted({expand_4(c.r), expand_4(c.g), expand_4(c.b)}, (code & 1) != 0 ? -distance : distance);
}

Rgba planar_mode(std::uint64_t word, const Place& at) {
  const Rgb o{expand_6(field(word, 62, 57)), expand_7(field(word, 56, 56) << 6 | field(word, 54, 49)),
              expand_6(field(word, 48, 48) << 5 | field(word, 44, 43) << 3 | field(word, 41, 39))};
  const Rgb h{expand_6(field(word, 38, 34) << 1 | field(word, 32, 32)), expand_7(field(word, 31, 25)),
              expand_6(field(word, 24, 19))};
  const Rgb v{expand_6(field(word, 18, 13)), expand_7(field(word, 12, 6)), expand_6(field(word, 5, 0))};
  const auto plane = [&](std::int32_t Rgb::*c) {
    return (at.x * (h.*c - o.*c) + at.y * (v.*c - o.*c) + 4 * (o.*c) + 2) >> 2;
  };
  return clamped({plane(&Rgb::r), plane(&Rgb::g), plane(&Rgb::b)});
}

bool five_bits(std::int32_t v) { return v >= 0 && v <= 31; }

/// base + modifier * multiplier of an EAC channel, in units of `scale` where the multiplier is not 0.
std::int32_t eac_offset(std::uint64_t word, std::uint32_t index, std::int32_t scale) {
  const int bit = 45 - 3 * place_of(index).bit;
  const std::int32_t modifier = kEacModifiers[field(word, 51, 48)][field(word, bit + 2, bit)];
  const std::int32_t multiplier = field(word, 55, 52);
  return multiplier == 0 && scale != 1 ? modifier : modifier * multiplier * scale;
}

}  // namespace

Rgba decode_etc2_color(const std::byte* block, std::uint32_t index, bool punch_through) {
  const std::uint64_t word = load_big_endian(block);
  const Place at = place_of(index);
  const bool flag = field(word, 33, 33) != 0;  // differential; with punch-through: opaque
  if (!punch_through && !flag) {
    const Rgb base[2] = {{expand_4(field(word, 63, 60)), expand_4(field(word, 55, 52)), expand_4(field(word, 47, 44))},
                         {expand_4(field(word, 59, 56)), expand_4(field(word, 51, 48)), expand_4(field(word, 43, 40))}};
    return halves(word, at, base, true);
  }
  const bool opaque = !punch_through || flag;
  const Rgb a{field(word, 63, 59), field(word, 55, 51), field(word, 47, 43)};
  const Rgb b{a.r + sign_extend_3(field(word, 58, 56)), a.g + sign_extend_3(field(word, 50, 48)),
              a.b + sign_extend_3(field(word, 42, 40))};
  const std::int32_t code = code_of(word, at.bit);
  const bool transparent = !opaque && code == 2;
  if (!five_bits(b.r)) return transparent ? Rgba{} : t_mode(word, code);
  if (!five_bits(b.g)) return transparent ? Rgba{} : h_mode(word, code);
  if (!five_bits(b.b)) return planar_mode(word, at);
  const Rgb base[2] = {{expand_5(a.r), expand_5(a.g), expand_5(a.b)}, {expand_5(b.r), expand_5(b.g), expand_5(b.b)}};
  return halves(word, at, base, opaque);
}

std::uint8_t decode_eac_alpha(const std::byte* block, std::uint32_t index) {
  const std::uint64_t word = load_big_endian(block);
  return static_cast<std::uint8_t>(std::clamp(field(word, 63, 56) + eac_offset(word, index, 1), 0, 255));
}

std::int32_t decode_eac_unsigned(const std::byte* block, std::uint32_t index) {
  const std::uint64_t word = load_big_endian(block);
  return std::clamp(field(word, 63, 56) * 8 + 4 + eac_offset(word, index, 8), 0, 2047);
}

std::int32_t decode_eac_signed(const std::byte* block, std::uint32_t index) {
  const std::uint64_t word = load_big_endian(block);
  const std::int32_t base = std::max(static_cast<std::int32_t>(static_cast<std::int8_t>(field(word, 63, 56))), -127);
  return std::clamp(base * 8 + eac_offset(word, index, 8), -1023, 1023);
}

}  // namespace vitrine::texel

// BC6H and BC7, one texel at a time (Khronos Data Format 1.3.1, chapter 20 "BPTC Compressed Texture Image Formats").
#include "texel/block/bptc.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <string_view>
#include <utility>

#include "base/numeric.h"

namespace vitrine::texel {
namespace {

/// Bits of a 128-bit block, least significant first.
struct Bits {
  std::uint64_t word[2];
  std::uint32_t at = 0;

  explicit Bits(const std::byte* block) { std::memcpy(word, block, sizeof(word)); }
  std::uint32_t peek(std::uint32_t position, std::uint32_t count) const {
    std::uint64_t value = word[position >> 6 & 1] >> (position & 63);
    if ((position & 63) != 0 && position < 64) value |= word[1] << (64 - (position & 63));
    return static_cast<std::uint32_t>(value & ((std::uint64_t{1} << count) - 1));
  }
  std::uint32_t take(std::uint32_t count) {
    const std::uint32_t value = peek(at, count);
    at += count;
    return value;
  }
};

// Subset of each texel by partition: one bit per texel for two subsets, two bits for three.
constexpr std::uint16_t kTwoSubsets[64] = {
    0xcccc, 0x8888, 0xeeee, 0xecc8, 0xc880, 0xfeec, 0xfec8, 0xec80, 0xc800, 0xffec, 0xfe80, 0xe800, 0xffe8,
    0xff00, 0xfff0, 0xf000, 0xf710, 0x008e, 0x7100, 0x08ce, 0x008c, 0x7310, 0x3100, 0x8cce, 0x088c, 0x3110,
    0x6666, 0x366c, 0x17e8, 0x0ff0, 0x718e, 0x399c, 0xaaaa, 0xf0f0, 0x5a5a, 0x33cc, 0x3c3c, 0x55aa, 0x9696,
    0xa55a, 0x73ce, 0x13c8, 0x324c, 0x3bdc, 0x6996, 0xc33c, 0x9966, 0x0660, 0x0272, 0x04e4, 0x4e40, 0x2720,
    0xc936, 0x936c, 0x39c6, 0x639c, 0x9336, 0x9cc6, 0x817e, 0xe718, 0xccf0, 0x0fcc, 0x7744, 0xee22,
};
constexpr std::uint32_t kThreeSubsets[64] = {
    0xaa685050, 0x6a5a5040, 0x5a5a4200, 0x5450a0a8, 0xa5a50000, 0xa0a05050, 0x5555a0a0, 0x5a5a5050,
    0xaa550000, 0xaa555500, 0xaaaa5500, 0x90909090, 0x94949494, 0xa4a4a4a4, 0xa9a59450, 0x2a0a4250,
    0xa5945040, 0x0a425054, 0xa5a5a500, 0x55a0a0a0, 0xa8a85454, 0x6a6a4040, 0xa4a45000, 0x1a1a0500,
    0x0050a4a4, 0xaaa59090, 0x14696914, 0x69691400, 0xa08585a0, 0xaa821414, 0x50a4a450, 0x6a5a0200,
    0xa9a58000, 0x5090a0a8, 0xa8a09050, 0x24242424, 0x00aa5500, 0x24924924, 0x24499224, 0x50a50a50,
    0x500aa550, 0xaaaa4444, 0x66660000, 0xa5a0a5a0, 0x50a050a0, 0x69286928, 0x44aaaa44, 0x66666600,
    0xaa444444, 0x54a854a8, 0x95809580, 0x96969600, 0xa85454a8, 0x80959580, 0xaa141414, 0x96960000,
    0xaaaa1414, 0xa05050a0, 0xa0a5a5a0, 0x96000000, 0x40804080, 0xa9a8a9a8, 0xaaaaaa44, 0x2a4a5254,
};

// Texels whose index has an implicit leading zero, besides texel 0: that of the second subset of two, and those of the
// second and third subset of three.
constexpr std::uint8_t kAnchorSecondOfTwo[64] = {
    15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 2,  8, 2,  2, 8,
    8,  15, 2,  8,  2,  2,  8,  8,  2,  2,  15, 15, 6,  8,  2,  8,  15, 15, 2, 8,  2, 2,
    2,  15, 15, 6,  6,  2,  6,  8,  15, 15, 2,  2,  15, 15, 15, 15, 15, 2,  2, 15,
};
constexpr std::uint8_t kAnchorSecondOfThree[64] = {
    3, 3,  15, 15, 8, 3,  15, 15, 8,  8, 6,  6, 6,  5,  3,  3,  3, 3,  8, 15, 3, 3, 6, 10, 5, 8,  8, 6,  8,  5,  15, 15,
    8, 15, 3,  5,  6, 10, 8,  15, 15, 3, 15, 5, 15, 15, 15, 15, 3, 15, 5, 5,  5, 8, 5, 10, 5, 10, 8, 13, 15, 12, 3,  3,
};
constexpr std::uint8_t kAnchorThirdOfThree[64] = {
    15, 8, 8, 3,  15, 15, 3,  8,  15, 15, 15, 15, 15, 15, 15, 8,  15, 8,  15, 3,  15, 8,
    15, 8, 3, 15, 6,  10, 15, 15, 10, 8,  15, 3,  15, 10, 10, 8,  9,  10, 6,  15, 8,  15,
    3,  6, 6, 8,  15, 3,  15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 3,  15, 15, 8,
};

struct Partition {
  std::uint32_t subsets = 1;
  std::uint32_t number = 0;

  std::uint32_t subset(std::uint32_t texel) const {
    if (subsets == 1) return 0;
    return subsets == 2 ? (kTwoSubsets[number] >> texel) & 1u : (kThreeSubsets[number] >> (2 * texel)) & 3u;
  }
  bool is_anchor(std::uint32_t texel) const {
    if (texel == 0) return true;
    if (subsets == 2) return texel == kAnchorSecondOfTwo[number];
    return subsets == 3 && (texel == kAnchorSecondOfThree[number] || texel == kAnchorThirdOfThree[number]);
  }
  std::uint32_t anchors_before(std::uint32_t texel) const {
    std::uint32_t count = texel > 0;
    if (subsets == 2) count += texel > kAnchorSecondOfTwo[number];
    if (subsets == 3) count += (texel > kAnchorSecondOfThree[number]) + (texel > kAnchorThirdOfThree[number]);
    return count;
  }
};

/// The index of a texel in a list of `bits`-bit indices that starts at `start`.
std::uint32_t read_index(const Bits& block, const Partition& partition, std::uint32_t start, std::uint32_t bits,
                         std::uint32_t texel) {
  const std::uint32_t position = start + bits * texel - partition.anchors_before(texel);
  return block.peek(position, bits - (partition.is_anchor(texel) ? 1 : 0));
}

std::int32_t interpolate(std::int32_t a, std::int32_t b, std::uint32_t index, std::uint32_t bits) {
  constexpr std::uint8_t kWeights[3][16] = {
      {0, 21, 43, 64}, {0, 9, 18, 27, 37, 46, 55, 64}, {0, 4, 9, 13, 17, 21, 26, 30, 34, 38, 43, 47, 51, 55, 60, 64}};
  const std::int32_t weight = kWeights[bits - 2][index];
  return ((64 - weight) * a + weight * b + 32) >> 6;
}

// ---- BC7

struct UnormMode {
  std::uint8_t subsets, partition_bits, rotation_bits, selector_bits;
  std::uint8_t color_bits, alpha_bits, endpoint_p, shared_p, index_bits, second_index_bits;
};
constexpr UnormMode kUnormModes[8] = {
    {3, 4, 0, 0, 4, 0, 1, 0, 3, 0}, {2, 6, 0, 0, 6, 0, 0, 1, 3, 0}, {3, 6, 0, 0, 5, 0, 0, 0, 2, 0},
    {2, 6, 0, 0, 7, 0, 1, 0, 2, 0}, {1, 0, 2, 1, 5, 6, 0, 0, 2, 3}, {1, 0, 2, 0, 7, 8, 0, 0, 2, 2},
    {1, 0, 0, 0, 7, 7, 1, 0, 4, 0}, {2, 6, 0, 0, 5, 5, 1, 0, 2, 0},
};

using Endpoint = std::array<std::uint32_t, 4>;

/// Repeats the leading bits of an n-bit value to fill 8.
std::uint32_t widen(std::uint32_t value, std::uint32_t bits) {
  return (value << (8 - bits) | value >> (2 * bits - 8)) & 255;
}

void read_endpoints(Bits& block, const UnormMode& mode, Endpoint ends[6]) {
  const std::uint32_t count = mode.subsets * 2u;
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::uint32_t e = 0; e < count; ++e) ends[e][c] = block.take(mode.color_bits);
  }
  for (std::uint32_t e = 0; e < count; ++e) ends[e][3] = block.take(mode.alpha_bits);
  const std::uint32_t p = mode.endpoint_p | mode.shared_p;
  std::uint32_t bit = 0;
  for (std::uint32_t e = 0; e < count; ++e) {
    if (mode.endpoint_p || (mode.shared_p && e % 2 == 0)) bit = block.take(1);
    for (std::size_t c = 0; c < 3; ++c) ends[e][c] = widen(ends[e][c] << p | (bit & p), mode.color_bits + p);
    ends[e][3] = mode.alpha_bits == 0 ? 255 : widen(ends[e][3] << p | (bit & p), mode.alpha_bits + p);
  }
}

// ---- BC6H

struct FloatMode {
  bool transformed = false;  ///< endpoints after the first are differences
  std::uint8_t partition_bits = 0;
  std::uint8_t bits = 0;  ///< of an endpoint; 0: reserved mode
  std::array<std::uint8_t, 3> delta_bits{};
  /// Order of the endpoints' bits in the block: component, endpoint, range. A descending range [high:low] has its
  /// low bit first, an ascending one its high bit.
  std::string_view layout;
};
// By the five mode bits' number in the chapter: 00, 01, then 00010, 00011, 00110, ... 11111.
constexpr FloatMode kFloatModes[18] = {
    {true,
     5,
     10,
     {5, 5, 5},
     "g2[4] b2[4] b3[4] r0[9:0] g0[9:0] b0[9:0] r1[4:0] g3[4] g2[3:0] g1[4:0] b3[0] g3[3:0] b1[4:0] b3[1] "
     "b2[3:0] r2[4:0] b3[2] r3[4:0] b3[3]"},
    {true,
     5,
     7,
     {6, 6, 6},
     "g2[5] g3[4] g3[5] r0[6:0] b3[0] b3[1] b2[4] g0[6:0] b2[5] b3[2] g2[4] b0[6:0] b3[3] b3[5] b3[4] "
     "r1[5:0] g2[3:0] g1[5:0] g3[3:0] b1[5:0] b2[3:0] r2[5:0] r3[5:0]"},
    {true,
     5,
     11,
     {5, 4, 4},
     "r0[9:0] g0[9:0] b0[9:0] r1[4:0] r0[10] g2[3:0] g1[3:0] g0[10] b3[0] g3[3:0] b1[3:0] b0[10] b3[1] "
     "b2[3:0] r2[4:0] b3[2] r3[4:0] b3[3]"},
    {false, 0, 10, {10, 10, 10}, "r0[9:0] g0[9:0] b0[9:0] r1[9:0] g1[9:0] b1[9:0]"},
    {true,
     5,
     11,
     {4, 5, 4},
     "r0[9:0] g0[9:0] b0[9:0] r1[3:0] r0[10] g3[4] g2[3:0] g1[4:0] g0[10] g3[3:0] b1[3:0] b0[10] b3[1] "
     "b2[3:0] r2[3:0] b3[0] b3[2] r3[3:0] g2[4] b3[3]"},
    {true, 0, 11, {9, 9, 9}, "r0[9:0] g0[9:0] b0[9:0] r1[8:0] r0[10] g1[8:0] g0[10] b1[8:0] b0[10]"},
    {true,
     5,
     11,
     {4, 4, 5},
     "r0[9:0] g0[9:0] b0[9:0] r1[3:0] r0[10] b2[4] g2[3:0] g1[3:0] g0[10] b3[0] g3[3:0] b1[4:0] b0[10] "
     "b2[3:0] r2[3:0] b3[1] b3[2] r3[3:0] b3[4] b3[3]"},
    {true, 0, 12, {8, 8, 8}, "r0[9:0] g0[9:0] b0[9:0] r1[7:0] r0[10:11] g1[7:0] g0[10:11] b1[7:0] b0[10:11]"},
    {true,
     5,
     9,
     {5, 5, 5},
     "r0[8:0] b2[4] g0[8:0] g2[4] b0[8:0] b3[4] r1[4:0] g3[4] g2[3:0] g1[4:0] b3[0] g3[3:0] b1[4:0] b3[1] "
     "b2[3:0] r2[4:0] b3[2] r3[4:0] b3[3]"},
    {true, 0, 16, {4, 4, 4}, "r0[9:0] g0[9:0] b0[9:0] r1[3:0] r0[10:15] g1[3:0] g0[10:15] b1[3:0] b0[10:15]"},
    {true,
     5,
     8,
     {6, 5, 5},
     "r0[7:0] g3[4] b2[4] g0[7:0] b3[2] g2[4] b0[7:0] b3[3] b3[4] r1[5:0] g2[3:0] g1[4:0] b3[0] g3[3:0] "
     "b1[4:0] b3[1] b2[3:0] r2[5:0] r3[5:0]"},
    {},  // reserved
    {true,
     5,
     8,
     {5, 6, 5},
     "r0[7:0] b3[0] b2[4] g0[7:0] g2[5] g2[4] b0[7:0] g3[5] b3[4] r1[4:0] g3[4] g2[3:0] g1[5:0] g3[3:0] "
     "b1[4:0] b3[1] b2[3:0] r2[4:0] b3[2] r3[4:0] b3[3]"},
    {},  // reserved
    {true,
     5,
     8,
     {5, 5, 6},
     "r0[7:0] b3[1] b2[4] g0[7:0] b2[5] g2[4] b0[7:0] b3[5] b3[4] r1[4:0] g3[4] g2[3:0] g1[4:0] b3[0] "
     "g3[3:0] b1[5:0] b2[3:0] r2[4:0] b3[2] r3[4:0] b3[3]"},
    {},  // reserved
    {false,
     5,
     6,
     {6, 6, 6},
     "r0[5:0] g3[4] b3[0] b3[1] b2[4] g0[5:0] g2[5] b2[5] b3[2] g2[4] b0[5:0] g3[5] b3[3] b3[5] b3[4] "
     "r1[5:0] g2[3:0] g1[5:0] g3[3:0] b1[5:0] b2[3:0] r2[5:0] r3[5:0]"},
    {},  // reserved
};

using FloatEndpoints = std::array<std::array<std::int32_t, 3>, 4>;

std::uint32_t number_at(std::string_view text, std::size_t& i) {
  std::uint32_t value = 0;
  for (; i < text.size() && text[i] >= '0' && text[i] <= '9'; ++i)
    value = value * 10 + static_cast<std::uint32_t>(text[i] - '0');
  return value;
}

/// Collects the scattered bits of all endpoints as the mode's layout says.
FloatEndpoints read_endpoints(Bits& block, std::string_view layout) {
  FloatEndpoints ends{};
  for (std::size_t i = 0; i < layout.size(); ++i) {
    const std::size_t component = layout[i] == 'r' ? 0 : layout[i] == 'g' ? 1 : 2;
    std::int32_t& value = ends[static_cast<std::size_t>(layout[i + 1] - '0')][component];
    i += 3;
    const std::uint32_t first = number_at(layout, i);
    std::uint32_t last = first;
    if (layout[i] == ':') last = number_at(layout, ++i);
    ++i;
    const std::uint32_t count = (first > last ? first - last : last - first) + 1;
    for (std::uint32_t k = 0; k < count; ++k) {
      const std::uint32_t bit = first >= last ? last + k : last - k;
      value |= static_cast<std::int32_t>(block.take(1) << bit);
    }
  }
  return ends;
}

std::int32_t sign_extend(std::int32_t value, std::uint32_t bits) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(value) << (32 - bits)) >> (32 - bits);
}

std::int32_t unquantize_unsigned(std::int32_t value, std::uint32_t bits) {
  if (bits >= 15 || value == 0) return value;
  return value == (1 << bits) - 1 ? 0xFFFF : ((value << 15) + 0x4000) >> (bits - 1);
}

std::int32_t unquantize_signed(std::int32_t value, std::uint32_t bits) {
  if (bits >= 16 || value == 0) return value;
  const std::int32_t magnitude = value < 0 ? -value : value;
  const std::int32_t wide = magnitude >= (1 << (bits - 1)) - 1 ? 0x7FFF : ((magnitude << 15) + 0x4000) >> (bits - 1);
  return value < 0 ? -wide : wide;
}

/// The binary16 pattern of an interpolated value.
std::uint16_t finish(std::int32_t value, bool is_signed) {
  if (!is_signed) return static_cast<std::uint16_t>(value * 31 / 64);
  return static_cast<std::uint16_t>(value < 0 ? (-value * 31 / 32) | 0x8000 : value * 31 / 32);
}

void unquantize(const FloatMode& mode, bool is_signed, FloatEndpoints& ends) {
  const std::int32_t mask = static_cast<std::int32_t>((std::uint32_t{1} << mode.bits) - 1);
  for (std::size_t e = 0; e < 4; ++e) {
    for (std::size_t c = 0; c < 3; ++c) {
      std::int32_t& value = ends[e][c];
      if (mode.transformed && e > 0) {
        // The first endpoint still has its bits here: it is unquantized last.
        value = (ends[0][c] + sign_extend(value, mode.delta_bits[c])) & mask;
      }
    }
  }
  for (auto& end : ends) {
    for (std::int32_t& value : end) {
      value = is_signed ? unquantize_signed(sign_extend(value, mode.bits), mode.bits)
                        : unquantize_unsigned(value, mode.bits);
    }
  }
}

struct UnormBlock {
  explicit UnormBlock(const std::byte* block) : bits(block) {}

  Bits bits;
  const UnormMode* mode = nullptr;
  Partition partition;
  std::uint32_t rotation = 0;
  bool swapped = false;
  Endpoint ends[6]{};
  std::uint32_t second_start = 0;  ///< bit of the second list of indices
};

/// Everything of a block but its indices. Not for the reserved mode.
UnormBlock read_block(const std::byte* block) {
  const auto first = std::to_integer<std::uint8_t>(block[0]);
  UnormBlock out(block);
  out.mode = &kUnormModes[std::countr_zero(first)];
  out.bits.at = static_cast<std::uint32_t>(std::countr_zero(first)) + 1;
  out.partition = {out.mode->subsets, out.bits.take(out.mode->partition_bits)};
  out.rotation = out.bits.take(out.mode->rotation_bits);
  out.swapped = out.bits.take(out.mode->selector_bits) != 0;
  read_endpoints(out.bits, *out.mode, out.ends);
  out.second_start = out.bits.at + 16u * out.mode->index_bits - out.mode->subsets;
  return out;
}

std::array<std::uint8_t, 4> texel_of(const UnormBlock& block, std::uint32_t texel) {
  const std::uint32_t list_bits[2] = {block.mode->index_bits, block.mode->second_index_bits};
  std::uint32_t index[2] = {read_index(block.bits, block.partition, block.bits.at, list_bits[0], texel), 0};
  if (list_bits[1] != 0) {
    index[1] = read_index(block.bits, block.partition, block.second_start, list_bits[1], texel);
  }
  const std::size_t color_list = block.swapped ? 1 : 0;
  const std::size_t alpha_list = list_bits[1] != 0 && !block.swapped ? 1 : 0;
  const std::uint32_t subset = block.partition.subset(texel);
  std::array<std::uint8_t, 4> out;
  for (std::size_t c = 0; c < 4; ++c) {
    const std::size_t list = c < 3 ? color_list : alpha_list;
    out[c] = static_cast<std::uint8_t>(interpolate(static_cast<std::int32_t>(block.ends[subset * 2][c]),
                                                   static_cast<std::int32_t>(block.ends[subset * 2 + 1][c]),
                                                   index[list], list_bits[list]));
  }
  if (block.rotation != 0) std::swap(out[block.rotation - 1], out[3]);
  return out;
}

}  // namespace

std::array<std::uint8_t, 4> decode_bc7(const std::byte* block, std::uint32_t texel) {
  if (block[0] == std::byte{0}) return {};  // reserved
  return texel_of(read_block(block), texel);
}

void decode_bc7(const std::byte* block, std::uint32_t out[16]) {
  std::fill_n(out, 16, 0u);
  if (block[0] == std::byte{0}) return;
  const UnormBlock parsed = read_block(block);
  for (std::uint32_t i = 0; i < 16; ++i) {
    const std::array<std::uint8_t, 4> rgba = texel_of(parsed, i);
    std::memcpy(&out[i], rgba.data(), sizeof(out[i]));
  }
}

std::array<float, 3> decode_bc6h(const std::byte* block, std::uint32_t texel, bool is_signed) {
  Bits bits(block);
  const std::uint32_t code = bits.peek(0, 5);
  const bool five = (code & 2) != 0;
  bits.at = five ? 5 : 2;
  const FloatMode& mode = kFloatModes[five ? ((code >> 1 & 14) | (code & 1)) + 2 : code & 3];
  if (mode.bits == 0) return {};
  FloatEndpoints ends = read_endpoints(bits, mode.layout);
  unquantize(mode, is_signed, ends);
  Partition partition;
  if (mode.partition_bits != 0) partition = {2, bits.take(mode.partition_bits)};
  const std::uint32_t index_bits = mode.partition_bits != 0 ? 3 : 4;
  const std::uint32_t index = read_index(bits, partition, bits.at, index_bits, texel);
  const std::uint32_t subset = partition.subset(texel);
  std::array<float, 3> out;
  for (std::size_t c = 0; c < 3; ++c) {
    out[c] = base::half_to_float(
        finish(interpolate(ends[subset * 2][c], ends[subset * 2 + 1][c], index, index_bits), is_signed));
  }
  return out;
}

}  // namespace vitrine::texel

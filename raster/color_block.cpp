// Colour output of whole blocks to targets of four UNORM bytes: conversion of a wave, stores and blending of rows.
// Blending works on the bytes as they lie in memory, even and odd ones apart, so that nothing is shuffled.
#include <cstring>

#include "raster/blend.h"
#include "raster/block.h"
#include "raster/color_fast.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/color_block.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/lane_math-inl.h"
#include "raster/color_pack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::raster::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using namespace base::HWY_NAMESPACE;  // NOLINT: lane arithmetic
using base::kWaveWidth;

constexpr std::size_t kRow = 8;  // pixels

/// Where the pixels of a vector of whole quads go: the upper ones first.
alignas(64) constexpr std::int32_t kRowsOf16[16] = {0, 1, 4, 5, 8, 9, 12, 13, 2, 3, 6, 7, 10, 11, 14, 15};
alignas(64) constexpr std::int32_t kRowsOf8[8] = {0, 1, 4, 5, 2, 3, 6, 7};
alignas(64) constexpr std::int32_t kRowsOf4[4] = {0, 1, 2, 3};

void pack_bytes(const ColorWriter& writer, const base::WaveRegister* color, PackedBlock& out) {
  const BytePacker::Texels d;
  const hn::Half<BytePacker::Texels> half;
  const std::size_t n = hn::Lanes(d);
  const auto order = hn::SetTableIndices(d, n == 16 ? kRowsOf16 : n == 8 ? kRowsOf8 : kRowsOf4);
  const BytePacker packer(writer);
  for (std::size_t i = 0; i < kWaveWidth; i += n) {
    const auto rows = hn::TableLookupLanes(packer.pack(color, i), order);
    auto* top = reinterpret_cast<std::int32_t*>(out.texel) + i / 16 * 16 + i % 16 / 2;
    hn::StoreU(hn::LowerHalf(half, rows), half, top);
    hn::StoreU(hn::UpperHalf(half, rows), half, top + kRow);
  }
}

using Pixels = hn::CappedTag<std::uint32_t, kRow>;
using Bytes = hn::Repartition<std::uint8_t, Pixels>;
using Words = hn::Repartition<std::uint16_t, Pixels>;
using VB = hn::Vec<Bytes>;
using VW = hn::Vec<Words>;

HWY_INLINE VB load_row(const void* from) { return hn::LoadU(Bytes(), static_cast<const std::uint8_t*>(from)); }

/// Some pixels of a row, lane 0 in bit 0; the others are not written.
HWY_INLINE void store_some(VB v, std::byte* to, std::uint32_t bits) {
  const Pixels d;
#if HWY_TARGET <= HWY_AVX2
  hn::BlendedStore(hn::BitCast(d, v), lanes_mask_from_bits(d, bits), d, reinterpret_cast<std::uint32_t*>(to));
#else
  alignas(16) std::uint32_t texel[4];
  hn::Store(hn::BitCast(d, v), d, texel);
  for (std::size_t i = 0; i < hn::Lanes(d); ++i)
    if (bits >> i & 1) std::memcpy(to + 4 * i, texel + i, 4);
#endif
}

/// Calls write(index of the first texel, address) for every vector with a pixel in `rows`, and stores what it returns.
template <class F>
HWY_INLINE void for_each_vector(const BlockPixels& pixels, base::LaneMask rows, F&& make) {
  constexpr std::size_t n = hn::MaxLanes(Pixels());
  constexpr std::uint32_t all = (1u << n) - 1;
  std::byte* row = pixels.first;
  if (rows == base::kAllLanes) {
    for (std::size_t y = 0; y < kRow; ++y, row += pixels.pitch)
      for (std::size_t x = 0; x < kRow; x += n)
        hn::StoreU(make(kRow * y + x, row + 4 * x), Bytes(), reinterpret_cast<std::uint8_t*>(row + 4 * x));
    return;
  }
  for (std::size_t y = 0; y < kRow; ++y, row += pixels.pitch)
    for (std::size_t x = 0; x < kRow; x += n) {
      const auto bits = static_cast<std::uint32_t>(rows >> (kRow * y + x)) & all;
      if (bits != 0) store_some(make(kRow * y + x, row + 4 * x), row + 4 * x, bits);
    }
}

/// Bits of a texel that may change, in every pixel.
HWY_INLINE VB write_bits(const ColorWriter& writer) {
  std::uint32_t word;
  std::memcpy(&word, writer.write_bits.bytes.data(), sizeof(word));
  return hn::BitCast(Bytes(), hn::Set(Pixels(), word));
}

void store_rows(const ColorWriter& writer, const PackedBlock& colors, const BlockPixels& pixels, base::LaneMask rows) {
  if (!writer.masked) {
    for_each_vector(pixels, rows, [&](std::size_t i, const std::byte*) { return load_row(colors.texel + i); });
    return;
  }
  const VB change = write_bits(writer);
  for_each_vector(pixels, rows, [&](std::size_t i, const std::byte* at) {
    return hn::Or(hn::And(change, load_row(colors.texel + i)), hn::AndNot(change, load_row(at)));
  });
}

/// Operands of one vector of pixels, and what all vectors share.
struct BlendRow {
  VB src, dst;
};
struct BlendShared {
  VB constants, alpha_bytes, alpha_places;
};

/// The factor of every byte, as if all channels had it.
HWY_INLINE VB factor_of(VkBlendFactor factor, const BlendRow& row, const BlendShared& shared) {
  const VB one = hn::Set(Bytes(), 255);
  const auto alpha = [&](VB v) { return hn::TableLookupBytes(v, shared.alpha_places); };
  switch (factor) {
    case VK_BLEND_FACTOR_ONE:
      return one;
    case VK_BLEND_FACTOR_SRC_COLOR:
      return row.src;
    case VK_BLEND_FACTOR_ONE_MINUS_SRC_COLOR:
      return hn::Xor(one, row.src);
    case VK_BLEND_FACTOR_DST_COLOR:
      return row.dst;
    case VK_BLEND_FACTOR_ONE_MINUS_DST_COLOR:
      return hn::Xor(one, row.dst);
    case VK_BLEND_FACTOR_SRC_ALPHA:
      return alpha(row.src);
    case VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA:
      return hn::Xor(one, alpha(row.src));
    case VK_BLEND_FACTOR_DST_ALPHA:
      return alpha(row.dst);
    case VK_BLEND_FACTOR_ONE_MINUS_DST_ALPHA:
      return hn::Xor(one, alpha(row.dst));
    case VK_BLEND_FACTOR_CONSTANT_COLOR:
      return shared.constants;
    case VK_BLEND_FACTOR_ONE_MINUS_CONSTANT_COLOR:
      return hn::Xor(one, shared.constants);
    case VK_BLEND_FACTOR_CONSTANT_ALPHA:
      return alpha(shared.constants);
    case VK_BLEND_FACTOR_ONE_MINUS_CONSTANT_ALPHA:
      return hn::Xor(one, alpha(shared.constants));
    case VK_BLEND_FACTOR_SRC_ALPHA_SATURATE:
      return hn::Or(hn::Min(alpha(row.src), hn::Xor(one, alpha(row.dst))), shared.alpha_bytes);
    default:
      return hn::Zero(Bytes());
  }
}

/// E2 of each 16-bit lane: a * b / 255, rounded, in the upper byte.
HWY_INLINE VW mul8_high(VW a, VW b) {
  const VW t = hn::Mul(a, b);
  return hn::Add(hn::Add(t, hn::ShiftRight<8>(t)), hn::Set(Words(), 128));
}

/// E2 of each byte.
HWY_INLINE VB mul8(VB a, VB b) {
  const Words d;
  const VW low = hn::Set(d, 0xff);
  const VW aw = hn::BitCast(d, a), bw = hn::BitCast(d, b);
  const VW even = hn::ShiftRight<8>(mul8_high(hn::And(aw, low), hn::And(bw, low)));
  const VW odd = hn::AndNot(low, mul8_high(hn::ShiftRight<8>(aw), hn::ShiftRight<8>(bw)));
  return hn::BitCast(Bytes(), hn::Or(even, odd));
}

HWY_INLINE VB combine(VkBlendOp op, VB src, VB dst) {
  switch (op) {
    case VK_BLEND_OP_ADD:
      return hn::SaturatedAdd(src, dst);
    case VK_BLEND_OP_SUBTRACT:
      return hn::SaturatedSub(src, dst);
    case VK_BLEND_OP_REVERSE_SUBTRACT:
      return hn::SaturatedSub(dst, src);
    case VK_BLEND_OP_MIN:
      return hn::Min(src, dst);
    default:
      return hn::Max(src, dst);
  }
}

/// A term of the equation: `value` times the factors of rgb and alpha. A product with 255 or 0 is exact.
HWY_INLINE VB term(VkBlendFactor rgb, VkBlendFactor alpha, VB value, const BlendRow& row, const BlendShared& shared) {
  if (rgb == alpha) {
    if (rgb == VK_BLEND_FACTOR_ONE) return value;
    if (rgb == VK_BLEND_FACTOR_ZERO) return hn::Zero(Bytes());
    return mul8(value, factor_of(rgb, row, shared));
  }
  const VB factor = hn::Or(hn::And(shared.alpha_bytes, factor_of(alpha, row, shared)),
                           hn::AndNot(shared.alpha_bytes, factor_of(rgb, row, shared)));
  return mul8(value, factor);
}

void blend_rows(const ColorWriter& writer, const PackedBlock& colors, const BlockPixels& pixels, base::LaneMask rows) {
  std::uint32_t constants = 0;
  for (std::size_t c = 0; c < 4; ++c) constants |= constant_to_byte(writer.constants[c]) << shift_of(writer, c);
  const Pixels d;
  const BlendShared shared{hn::BitCast(Bytes(), hn::Set(d, constants)),
                           hn::BitCast(Bytes(), hn::Set(d, 0xffu << shift_of(writer, 3))),
                           hn::LoadDup128(Bytes(), writer.alpha_places)};
  const VB change = write_bits(writer);
  const BlendEquation rgb = writer.rgb, alpha = writer.alpha;
  const bool masked = writer.masked;
  for_each_vector(pixels, rows, [&](std::size_t i, const std::byte* at) HWY_ATTR {
    const BlendRow row{load_row(colors.texel + i), load_row(at)};
    const VB src = term(rgb.src, alpha.src, row.src, row, shared);
    const VB dst = term(rgb.dst, alpha.dst, row.dst, row, shared);
    VB result = combine(rgb.op, src, dst);
    if (alpha.op != rgb.op)
      result = hn::Or(hn::And(shared.alpha_bytes, combine(alpha.op, src, dst)), hn::AndNot(shared.alpha_bytes, result));
    return masked ? hn::Or(hn::And(change, result), hn::AndNot(change, row.dst)) : result;
  });
}

}  // namespace

const BlockColorFunctions* byte_block_functions(bool blends) {
  static constexpr BlockColorFunctions kFunctions[2] = {{pack_bytes, store_rows}, {pack_bytes, blend_rows}};
  return &kFunctions[blends ? 1 : 0];
}

}  // namespace vitrine::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vitrine::raster {

HWY_EXPORT(byte_block_functions);

void set_byte_places(ColorWriter& writer) {
  constexpr std::size_t kPlace[4] = {0, 8, 1, 9};  // of the first pixel's components in what BytePacker shuffles
  const std::size_t alpha = static_cast<std::size_t>(shift_of(writer, 3)) / 8;
  for (std::size_t p = 0; p < 4; ++p)
    for (std::size_t c = 0; c < 4; ++c) {
      writer.pack_places[4 * p + static_cast<std::size_t>(shift_of(writer, c)) / 8] =
          static_cast<std::uint8_t>(kPlace[c] + 2 * p);
      writer.alpha_places[4 * p + c] = static_cast<std::uint8_t>(4 * p + alpha);
    }
}

const BlockColorFunctions* block_color_functions(const ColorWriter& writer) {
  if (writer.logic || !is_four_bytes(*writer.format)) return nullptr;
  if (writer.blend != BlendType::kNone && reads_second_source(writer)) return nullptr;
  base::select_simd_target();
  return HWY_DYNAMIC_DISPATCH(byte_block_functions)(writer.blend != BlendType::kNone);
}

}  // namespace vitrine::raster
#endif  // HWY_ONCE

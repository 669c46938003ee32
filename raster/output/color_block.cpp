// Colour output of whole blocks to targets of four UNORM bytes: conversion of a wave, stores and blending of rows.
// Blending works on the bytes as they lie in memory, even and odd ones apart, so that nothing is shuffled.
#include "raster/output/color_block.h"

#include <cstring>

#include "raster/output/blend.h"
#include "raster/output/byte_texels.h"
#include "raster/pixel_order.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/output/color_block.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/lane_math-inl.h"
#include "raster/output/color_blend-inl.h"
#include "raster/output/color_pack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::raster::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using namespace base::HWY_NAMESPACE;  // NOLINT: lane arithmetic
using base::kWaveWidth;

constexpr std::size_t kRow = 8;  // pixels

/// Pixels of whole quads that lie side by side: the upper ones in the lower half of the vector, those below in the
/// upper.
using Pixels = BytePacker::Texels;
using Half = hn::Half<Pixels>;
using Bytes = hn::Repartition<std::uint8_t, Pixels>;
using Words = hn::Repartition<std::uint16_t, Pixels>;
using VP = hn::Vec<Pixels>;
using VB = hn::Vec<Bytes>;
using VW = hn::Vec<Words>;

alignas(64) constexpr std::int32_t kRowsOf16[16] = {0, 1, 4, 5, 8, 9, 12, 13, 2, 3, 6, 7, 10, 11, 14, 15};
alignas(64) constexpr std::int32_t kRowsOf8[8] = {0, 1, 4, 5, 2, 3, 6, 7};
alignas(64) constexpr std::int32_t kRowsOf4[4] = {0, 1, 2, 3};

/// Colours of a wave as vectors of such pixels.
class PackedColors {
 public:
  PackedColors(const ColorWriter& writer, const ColorRegisters& color)
      : packer_(writer), color_(color), order_(hn::SetTableIndices(Pixels(), kRows)) {}
  HWY_INLINE VB at(std::size_t i) const {
    return hn::BitCast(Bytes(), hn::TableLookupLanes(packer_.pack(color_, i), order_));
  }

 private:
  static constexpr std::size_t n = hn::MaxLanes(Pixels());
  static constexpr const std::int32_t* kRows = n == 16 ? kRowsOf16 : n == 8 ? kRowsOf8 : kRowsOf4;
  BytePacker packer_;
  const ColorRegisters& color_;
  decltype(hn::SetTableIndices(Pixels(), kRowsOf16)) order_;
};

/// The same, packed before.
struct StoredColors {
  const PackedBlock& block;
  HWY_INLINE VB at(std::size_t i) const {
    return hn::BitCast(Bytes(), hn::Load(hn::RebindToUnsigned<Pixels>(), block.texel + i));
  }
};

void pack_bytes(const ColorWriter& writer, const ColorRegisters& color, PackedBlock& out) {
  const PackedColors colors(writer, color);
  for (std::size_t i = 0; i < kWaveWidth; i += hn::Lanes(Pixels()))
    hn::Store(hn::BitCast(hn::RebindToUnsigned<Pixels>(), colors.at(i)), hn::RebindToUnsigned<Pixels>(), out.texel + i);
}

/// Stores the texels of `bits`, lane 0 in bit 0; there may be more bits than lanes.
template <class D>
HWY_INLINE void store_texels(D d, hn::Vec<D> v, std::byte* to, std::uint32_t bits) {
  if (bits == 0) return;
#if HWY_TARGET <= HWY_AVX2
  hn::BlendedStore(v, lanes_mask_from_bits(d, bits), d, reinterpret_cast<std::int32_t*>(to));
#else
  alignas(16) std::int32_t texel[hn::MaxLanes(d)];
  hn::Store(v, d, texel);
  for (std::size_t i = 0; i < hn::MaxLanes(d); ++i)
    if (bits >> i & 1) std::memcpy(to + 4 * i, texel + i, 4);
#endif
}

/// Where the pixels of a vector lie.
struct PixelRows {
  std::byte *top, *bottom;

  HWY_INLINE VB load() const {
    const Half d;
    return hn::BitCast(Bytes(), hn::Combine(Pixels(), hn::LoadU(d, reinterpret_cast<const std::int32_t*>(bottom)),
                                            hn::LoadU(d, reinterpret_cast<const std::int32_t*>(top))));
  }
  HWY_INLINE void store(VB v) const {
    const Half d;
    const VP texels = hn::BitCast(Pixels(), v);
    hn::StoreU(hn::LowerHalf(d, texels), d, reinterpret_cast<std::int32_t*>(top));
    hn::StoreU(hn::UpperHalf(d, texels), d, reinterpret_cast<std::int32_t*>(bottom));
  }
  /// Some of them, lane 0 in bit 0; the others are not written.
  HWY_INLINE void store_some(VB v, std::uint32_t bits_top, std::uint32_t bits_bottom) const {
    const Half d;
    const VP texels = hn::BitCast(Pixels(), v);
    store_texels(d, hn::LowerHalf(d, texels), top, bits_top);
    store_texels(d, hn::UpperHalf(d, texels), bottom, bits_bottom);
  }
};

/// The rows of a block of which some pixels are stored.
struct BlockRows {
  const BlockPixels& pixels;
  base::LaneMask rows;

  /// Stores make(index of the first lane, rows) for every vector with a pixel.
  template <class F>
  HWY_INLINE void for_each_vector(F&& make) const {
    constexpr std::size_t n = hn::MaxLanes(Pixels()), half = n / 2;
    constexpr std::uint32_t all = (1u << half) - 1;
    const bool whole = rows == base::kAllLanes;
    std::byte* row = pixels.first;
    for (std::size_t y = 0; y < kRow; y += 2, row += 2 * pixels.pitch)
      for (std::size_t x = 0; x < kRow; x += half) {
        const PixelRows at{row + 4 * x, row + pixels.pitch + 4 * x};
        const std::size_t i = kRow * y + 2 * x;
        if (whole) {
          at.store(make(i, at));
          continue;
        }
        const auto top = static_cast<std::uint32_t>(rows >> (kRow * y + x)) & all;
        const auto bottom = static_cast<std::uint32_t>(rows >> (kRow * y + kRow + x)) & all;
        if ((top | bottom) != 0) at.store_some(make(i, at), top, bottom);
      }
  }
};

/// The rows of a wave as memory would hold them if its spans lay side by side.
class SpanTexels {
 public:
  /// Of a span, from pixel i on.
  HWY_INLINE VP upper(const QuadSpan& span, std::size_t i) const { return at(0, 2 * span.first + i); }
  HWY_INLINE VP lower(const QuadSpan& span, std::size_t i) const { return at(1, 2 * span.first + i); }

#if HWY_TARGET <= HWY_AVX3
  HWY_INLINE explicit SpanTexels(const VB (&v)[4]) {
    const Pixels d;
    const auto pixels = [&](std::size_t i) HWY_ATTR { return hn::BitCast(d, v[i]); };
    for (std::size_t k = 0; k < 2; ++k) {
      row_[0][k] = hn::ConcatLowerLower(d, pixels(2 * k + 1), pixels(2 * k));
      row_[1][k] = hn::ConcatUpperUpper(d, pixels(2 * k + 1), pixels(2 * k));
    }
  }

 private:
  HWY_INLINE VP at(std::size_t row, std::size_t first) const {
    const VP index = hn::Add(hn::Iota(Pixels(), 0), hn::Set(Pixels(), static_cast<std::int32_t>(first)));
    return VP{_mm512_permutex2var_epi32(row_[row][0].raw, index.raw, row_[row][1].raw)};
  }

  VP row_[2][2];
#else
  template <std::size_t kVectors>
  HWY_INLINE explicit SpanTexels(const VB (&v)[kVectors]) {
    const Half d;
    for (std::size_t k = 0; k < kVectors; ++k) {
      const VP pixels = hn::BitCast(Pixels(), v[k]);
      hn::Store(hn::LowerHalf(d, pixels), d, row_[0] + k * hn::MaxLanes(d));
      hn::Store(hn::UpperHalf(d, pixels), d, row_[1] + k * hn::MaxLanes(d));
    }
  }

 private:
  HWY_INLINE VP at(std::size_t row, std::size_t first) const { return hn::LoadU(Pixels(), row_[row] + first); }

  alignas(64) std::int32_t row_[2][kWaveWidth / 2 + hn::MaxLanes(Pixels())];
#endif
};

/// The same for a wave of spans.
struct SpanRows {
  const BlockPixels& pixels;
  const SpanWave& wave;
  bool reads;  ///< make() looks at what is there

  template <class F>
  HWY_INLINE void for_each_vector(F&& make) const {
    constexpr std::size_t n = hn::MaxLanes(Pixels());
    alignas(64) std::byte stored[2][2 * kWaveWidth];
    if (reads) load(stored[0], stored[1]);
    VB made[kWaveWidth / n];
    for (std::size_t i = 0; i < kWaveWidth; i += n)
      made[i / n] = make(i, PixelRows{stored[0] + 2 * i, stored[1] + 2 * i});
    const SpanTexels texels(made);
    const Pixels d;
    for (const QuadSpan* span = wave.span; span != wave.span + wave.count; ++span) {
      std::byte* row = first_of(*span);
      const std::uint32_t all = (1u << 2 * span->count) - 1;
      const std::uint64_t rows = wave.rows >> 2 * span->first;
      const std::uint32_t upper = static_cast<std::uint32_t>(rows) & all;
      const std::uint32_t lower = static_cast<std::uint32_t>(rows >> 32) & all;
      for (std::size_t i = 0; i < std::size_t{2} * span->count; i += n) {
        store_texels(d, texels.upper(*span, i), row + 4 * i, upper >> i);
        store_texels(d, texels.lower(*span, i), row + pixels.pitch + 4 * i, lower >> i);
      }
    }
  }

 private:
  HWY_INLINE std::byte* first_of(const QuadSpan& span) const {
    const auto x = static_cast<std::size_t>(wave.x + span.x), y = static_cast<std::size_t>(wave.y + span.y);
    return pixels.first + y * pixels.pitch + 4 * x;
  }
  /// Only the pixels of the spans: others may be those of another thread.
  HWY_INLINE void load(std::byte* upper, std::byte* lower) const {
    for (const QuadSpan* span = wave.span; span != wave.span + wave.count; ++span) {
      const std::byte* row = first_of(*span);
      for (std::size_t q = 0; q < span->count; ++q) {
        std::memcpy(upper + 8 * (span->first + q), row + 8 * q, 8);
        std::memcpy(lower + 8 * (span->first + q), row + pixels.pitch + 8 * q, 8);
      }
    }
  }
};

/// Bits of a texel that may change, in every pixel.
HWY_INLINE VB write_bits(const ColorWriter& writer) {
  std::int32_t word;
  std::memcpy(&word, writer.write_bits.bytes.data(), sizeof(word));
  return hn::BitCast(Bytes(), hn::Set(Pixels(), word));
}

template <class Colors, class Rows>
HWY_INLINE void store_rows(const ColorWriter& writer, const Colors& colors, const Rows& rows) {
  if (!writer.masked) {
    rows.for_each_vector([&](std::size_t i, const PixelRows&) HWY_ATTR { return colors.at(i); });
    return;
  }
  const VB change = write_bits(writer);
  rows.for_each_vector([&](std::size_t i, const PixelRows& at)
                           HWY_ATTR { return hn::Or(hn::And(change, colors.at(i)), hn::AndNot(change, at.load())); });
}

/// Operands of one vector of pixels, and what all vectors share.
struct BlendRow {
  VB src, dst;
};
struct BlendShared {
  VB constants, alpha_bytes, alpha_places;
};

/// The operands of every byte, as if all channels had the same factor.
struct RowFactors {
  const BlendRow& row;
  const BlendShared& shared;

  HWY_INLINE VB alpha(VB v) const { return hn::TableLookupBytes(v, shared.alpha_places); }
  HWY_INLINE VB zero() const { return hn::Zero(Bytes()); }
  HWY_INLINE VB one() const { return hn::Set(Bytes(), 255); }
  HWY_INLINE VB complement(VB v) const { return hn::Xor(one(), v); }
  HWY_INLINE VB src() const { return row.src; }
  HWY_INLINE VB src_alpha() const { return alpha(row.src); }
  HWY_INLINE VB dst() const { return row.dst; }
  HWY_INLINE VB dst_alpha() const { return alpha(row.dst); }
  HWY_INLINE VB constant() const { return shared.constants; }
  HWY_INLINE VB constant_alpha() const { return alpha(shared.constants); }
  HWY_INLINE VB saturate() const { return hn::Or(hn::Min(src_alpha(), complement(dst_alpha())), shared.alpha_bytes); }
};

HWY_INLINE VB factor_of(VkBlendFactor factor, const BlendRow& row, const BlendShared& shared) {
  return blend_factor_lanes(factor, RowFactors{row, shared});
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

template <class Colors, class Rows>
HWY_INLINE void blend_rows(const ColorWriter& writer, const Colors& colors, const Rows& rows) {
  std::uint32_t constants = 0;
  for (std::size_t c = 0; c < 4; ++c) constants |= constant_to_byte(writer.constants[c]) << shift_of(writer, c);
  const hn::RebindToUnsigned<Pixels> d;
  const BlendShared shared{hn::BitCast(Bytes(), hn::Set(d, constants)),
                           hn::BitCast(Bytes(), hn::Set(d, 0xffu << shift_of(writer, 3))),
                           hn::LoadDup128(Bytes(), writer.alpha_places)};
  const VB change = write_bits(writer);
  const BlendEquation rgb = writer.rgb, alpha = writer.alpha;
  const bool masked = writer.masked;
  rows.for_each_vector([&](std::size_t i, const PixelRows& at) HWY_ATTR {
    const BlendRow row{colors.at(i), at.load()};
    const VB src = term(rgb.src, alpha.src, row.src, row, shared);
    const VB dst = term(rgb.dst, alpha.dst, row.dst, row, shared);
    VB result = combine(rgb.op, src, dst);
    if (alpha.op != rgb.op)
      result = hn::Or(hn::And(shared.alpha_bytes, combine(alpha.op, src, dst)), hn::AndNot(shared.alpha_bytes, result));
    return masked ? hn::Or(hn::And(change, result), hn::AndNot(change, row.dst)) : result;
  });
}

/// Stores without masks of what was packed before: nothing is combined, so nothing is taken apart again.
void store_packed(const PackedBlock& colors, const BlockPixels& pixels) {
  const hn::RebindToUnsigned<Half> d;
  constexpr std::size_t half = hn::MaxLanes(Half());
  const std::uint32_t* from = colors.texel;
  std::byte* row = pixels.first;
  for (std::size_t y = 0; y < kRow; y += 2, row += 2 * pixels.pitch)
    for (std::size_t x = 0; x < kRow; x += half, from += 2 * half) {
      hn::StoreU(hn::Load(d, from), d, reinterpret_cast<std::uint32_t*>(row + 4 * x));
      hn::StoreU(hn::Load(d, from + half), d, reinterpret_cast<std::uint32_t*>(row + pixels.pitch + 4 * x));
    }
}

template <bool kBlends>
struct ByteBlocks {
  template <class Colors, class Rows>
  static HWY_INLINE void write_colors(const ColorWriter& writer, const Colors& colors, const Rows& rows) {
    if constexpr (kBlends)
      blend_rows(writer, colors, rows);
    else
      store_rows(writer, colors, rows);
  }
  static bool reads(const ColorWriter& writer) { return kBlends || writer.masked; }
  static void write_packed(const ColorWriter& writer, const PackedBlock& colors, const BlockPixels& pixels,
                           base::LaneMask rows) {
    if (!kBlends && rows == base::kAllLanes && !writer.masked)
      store_packed(colors, pixels);
    else
      write_colors(writer, StoredColors{colors}, BlockRows{pixels, rows});
  }
  static void write(const ColorWriter& writer, const ColorRegisters& color, const BlockPixels& pixels,
                    base::LaneMask rows) {
    write_colors(writer, PackedColors(writer, color), BlockRows{pixels, rows});
  }
  static void write_packed_spans(const ColorWriter& writer, const PackedBlock& colors, const BlockPixels& pixels,
                                 const SpanWave& wave) {
    write_colors(writer, StoredColors{colors}, SpanRows{pixels, wave, reads(writer)});
  }
  static void write_spans(const ColorWriter& writer, const ColorRegisters& color, const BlockPixels& pixels,
                          const SpanWave& wave) {
    write_colors(writer, PackedColors(writer, color), SpanRows{pixels, wave, reads(writer)});
  }
  static constexpr BlockColorFunctions kFunctions{pack_bytes, write_packed, write, write_packed_spans, write_spans};
};

}  // namespace

const BlockColorFunctions* byte_block_functions(bool blends) {
  return blends ? &ByteBlocks<true>::kFunctions : &ByteBlocks<false>::kFunctions;
}

}  // namespace vitrine::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vitrine::raster {

HWY_EXPORT(byte_block_functions);

const BlockColorFunctions* block_color_functions(const ColorWriter& writer) {
  if (writer.logic || !is_four_bytes(*writer.format)) return nullptr;
  if (writer.blend != BlendType::kNone && reads_second_source(writer)) return nullptr;
  base::select_simd_target();
  return HWY_DYNAMIC_DISPATCH(byte_block_functions)(writer.blend != BlendType::kNone);
}

}  // namespace vitrine::raster
#endif  // HWY_ONCE

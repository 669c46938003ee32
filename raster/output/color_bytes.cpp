// Fast colour output for the most common targets: four UNORM bytes in any order, with and without blending. Same bits
// as the general function of color.cpp (tests compare them).
#include "raster/output/color_bytes.h"

#include <cstring>

#include "raster/output/blend.h"
#include "raster/output/byte_texels.h"
#include "raster/output/color_passes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/output/color_bytes.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/lane_math-inl.h"
#include "raster/output/color_blend-inl.h"
#include "raster/output/color_pack-inl.h"
#include "raster/output/color_srgb-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::raster::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using namespace base::HWY_NAMESPACE;  // NOLINT: lane arithmetic
using base::kWaveWidth;

/// One channel of a wave as bytes widened to 16 bits.
struct alignas(64) Bytes {
  std::uint16_t lane[kWaveWidth];
};
/// Pixels of a wave as they lie in memory.
struct alignas(64) Words {
  std::uint32_t lane[kWaveWidth];
};

/// Part D: MIN(1, x) * 255, to nearest even, saturated.
template <class V>
HWY_INLINE auto to_byte(V x) {
  const auto scaled = hn::Mul(lanes_min_second(lanes_set<V>(1.0f), x), lanes_set<V>(255.0f));
  const auto rounded = lanes_round_to_int(scaled);
  using I = decltype(rounded);
  return hn::Min(hn::Max(rounded, lanes_set<I>(0)), lanes_set<I>(255));
}

HWY_INLINE void bytes_of(const base::WaveRegister& color, Bytes& out) {
  const hn::CappedTag<float, kWaveWidth> d;
  const hn::Rebind<std::int32_t, decltype(d)> di;
  const hn::Rebind<std::int16_t, decltype(d)> d16;
  for (std::size_t i = 0; i < kWaveWidth; i += hn::Lanes(d)) {
    const auto x = hn::BitCast(d, hn::Load(di, reinterpret_cast<const std::int32_t*>(color.lane + i)));
    hn::Store(hn::DemoteTo(d16, to_byte(x)), d16, reinterpret_cast<std::int16_t*>(out.lane + i));
  }
}

/// Channel `shift` bits up in each word.
HWY_INLINE void merge(const Bytes& bytes, int shift, Words& words, bool first) {
  const hn::CappedTag<std::uint32_t, kWaveWidth> d;
  const hn::Rebind<std::uint16_t, decltype(d)> d16;
  for (std::size_t i = 0; i < kWaveWidth; i += hn::Lanes(d)) {
    const auto moved = hn::ShiftLeftSame(hn::PromoteTo(d, hn::Load(d16, bytes.lane + i)), shift);
    hn::Store(first ? moved : hn::Or(moved, hn::Load(d, words.lane + i)), d, words.lane + i);
  }
}

HWY_INLINE void extract(const Words& words, int shift, Bytes& bytes) {
  const hn::CappedTag<std::int32_t, kWaveWidth> d;
  const hn::Rebind<std::int16_t, decltype(d)> d16;
  for (std::size_t i = 0; i < kWaveWidth; i += hn::Lanes(d)) {
    const auto word = hn::BitCast(hn::RebindToUnsigned<decltype(d)>(),
                                  hn::Load(d, reinterpret_cast<const std::int32_t*>(words.lane + i)));
    const auto byte = hn::And(hn::ShiftRightSame(word, shift), hn::Set(hn::RebindToUnsigned<decltype(d)>(), 255u));
    hn::Store(hn::DemoteTo(d16, hn::BitCast(d, byte)), d16, reinterpret_cast<std::int16_t*>(bytes.lane + i));
  }
}

HWY_INLINE std::uint32_t write_word(const ColorWriter& writer) {
  std::uint32_t word;
  std::memcpy(&word, writer.write_bits.bytes.data(), sizeof(word));
  return word;
}

/// Two whole quads side by side: two rows of four pixels.
HWY_INLINE void store_pair(const std::uint32_t* quads, std::byte* top, std::byte* bottom) {
  const hn::FixedTag<std::uint64_t, 2> d;
  const auto left = hn::Load(d, reinterpret_cast<const std::uint64_t*>(quads));
  const auto right = hn::Load(d, reinterpret_cast<const std::uint64_t*>(quads + 4));
  hn::StoreU(hn::InterleaveLower(d, left, right), d, reinterpret_cast<std::uint64_t*>(top));
  hn::StoreU(hn::InterleaveUpper(d, left, right), d, reinterpret_cast<std::uint64_t*>(bottom));
}

/// Pixels of a quad of which some are covered.
HWY_INLINE void store_some(const std::uint32_t* quad, std::uint32_t covered, std::byte* top, std::byte* bottom) {
#if HWY_TARGET <= HWY_AVX2
  const hn::FixedTag<std::uint32_t, 4> d;
  const auto texels = hn::Load(d, quad);
  hn::BlendedStore(texels, lanes_mask_from_bits(d, covered & 3), d, reinterpret_cast<std::uint32_t*>(top));
  // The lower pixels are lanes 2 and 3: the store begins two pixels before them.
  hn::BlendedStore(texels, lanes_mask_from_bits(d, covered & 12), d, reinterpret_cast<std::uint32_t*>(bottom) - 2);
#else
  if (covered & 1) std::memcpy(top, quad, 4);
  if (covered & 2) std::memcpy(top + 4, quad + 1, 4);
  if (covered & 4) std::memcpy(bottom, quad + 2, 4);
  if (covered & 8) std::memcpy(bottom + 4, quad + 3, 4);
#endif
}

/// Stores the lanes of `mask`: two rows of two pixels per quad.
void scatter(const ColorWave& wave, base::LaneMask mask, const Words& words) {
  const texel::LevelLayout& level = wave.view->level[0];
  std::byte* const origin = wave.view->block(0, wave.layer, wave.sample, 0, 0, 0);
  for (std::size_t q = 0; q < base::kQuadsPerWave; ++q) {
    const auto covered = static_cast<std::uint32_t>(mask >> (4 * q) & 0xf);
    if (covered == 0) continue;
    std::byte* const top = origin + wave.quads->y[q] * level.row_pitch + std::size_t{wave.quads->x[q]} * 4;
    std::byte* const bottom = top + level.row_pitch;
    const std::uint32_t* const quad = words.lane + 4 * q;
    if (q + 1 < base::kQuadsPerWave && (mask >> (4 * q) & 0xff) == 0xff &&
        wave.quads->x[q + 1] == wave.quads->x[q] + 2 && wave.quads->y[q + 1] == wave.quads->y[q]) {
      store_pair(quad, top, bottom);
      ++q;
      continue;
    }
    if (covered == 0xf) {
      std::memcpy(top, quad, 8);
      std::memcpy(bottom, quad + 2, 8);
      continue;
    }
    store_some(quad, covered, top, bottom);
  }
}

/// Loads the covered lanes of these quads; others are left as they are.
void gather(const ColorWave& wave, base::LaneMask mask, Words& words) {
  const texel::LevelLayout& level = wave.view->level[0];
  const std::byte* const origin = wave.view->block(0, wave.layer, wave.sample, 0, 0, 0);
  for (std::size_t q = 0; q < base::kQuadsPerWave; ++q) {
    const auto covered = static_cast<std::uint32_t>(mask >> (4 * q) & 0xf);
    if (covered == 0) continue;
    const std::byte* const top = origin + wave.quads->y[q] * level.row_pitch + std::size_t{wave.quads->x[q]} * 4;
    const std::byte* const bottom = top + level.row_pitch;
    std::uint32_t* const quad = words.lane + 4 * q;
    if (covered == 0xf) {
      std::memcpy(quad, top, 8);
      std::memcpy(quad + 2, bottom, 8);
      continue;
    }
    if (covered & 1) std::memcpy(quad, top, 4);
    if (covered & 2) std::memcpy(quad + 1, top + 4, 4);
    if (covered & 4) std::memcpy(quad + 2, bottom, 4);
    if (covered & 8) std::memcpy(quad + 3, bottom + 4, 4);
  }
}

template <class Packer>
HWY_INLINE void store_packed(const ColorWriter& writer, const ColorWave& wave) {
  Words words;
  const Packer packer(writer);
  const typename Packer::Texels d;
  for (std::size_t i = 0; i < kWaveWidth; i += hn::Lanes(d))
    hn::Store(packer.pack(wave.color, i), d, reinterpret_cast<std::int32_t*>(words.lane + i));
  const std::uint32_t keep = ~write_word(writer);
  if (keep == 0) {
    scatter(wave, wave.mask, words);
    return;
  }
  for_each_pass(wave, [&](std::uint32_t quads) {
    const base::LaneMask mask = wave.mask & lanes_of(quads);
    Words old{};
    gather(wave, mask, old);
    for (std::size_t i = 0; i < kWaveWidth; ++i) old.lane[i] = (old.lane[i] & keep) | (words.lane[i] & ~keep);
    scatter(wave, mask, old);
  });
}

void store_bytes(const ColorWriter& writer, const ColorWave& wave) { store_packed<BytePacker>(writer, wave); }
void store_srgb(const ColorWriter& writer, const ColorWave& wave) { store_packed<SrgbPacker>(writer, wave); }

using U16 = hn::CappedTag<std::uint16_t, kWaveWidth>;
using V16 = hn::Vec<U16>;

/// E2: a * b / 255, rounded.
HWY_INLINE V16 mul8(V16 a, V16 b) {
  const V16 t = hn::Mul(a, b);
  const V16 u = hn::Add(t, hn::ShiftRight<8>(t));
  return hn::ShiftRight<8>(hn::Add(u, hn::Set(U16(), 128)));
}

/// Everything blending a wave needs, one channel at a time.
struct ByteOperands {
  Bytes src[4], dst[4];
  std::uint16_t constants[4];
};

/// The operands of channel c in lanes i.., as blend_factor asks for them.
struct ByteFactors {
  const ByteOperands& in;
  std::size_t c, i;

  HWY_INLINE V16 load(const Bytes& bytes) const { return hn::Load(U16(), bytes.lane + i); }
  HWY_INLINE V16 zero() const { return hn::Zero(U16()); }
  HWY_INLINE V16 one() const { return hn::Set(U16(), 255); }
  HWY_INLINE V16 complement(V16 v) const { return hn::Sub(one(), v); }
  HWY_INLINE V16 src() const { return load(in.src[c]); }
  HWY_INLINE V16 src_alpha() const { return load(in.src[3]); }
  HWY_INLINE V16 dst() const { return load(in.dst[c]); }
  HWY_INLINE V16 dst_alpha() const { return load(in.dst[3]); }
  HWY_INLINE V16 constant() const { return hn::Set(U16(), in.constants[c]); }
  HWY_INLINE V16 constant_alpha() const { return hn::Set(U16(), in.constants[3]); }
  HWY_INLINE V16 saturate() const { return c == 3 ? one() : hn::Min(src_alpha(), complement(dst_alpha())); }
};

HWY_INLINE V16 combine8(VkBlendOp op, V16 src, V16 dst) {
  switch (op) {
    case VK_BLEND_OP_ADD:
      return hn::Min(hn::Add(src, dst), hn::Set(U16(), 255));
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

void blend_channel8(const BlendEquation& equation, const ByteOperands& in, std::size_t c, Bytes& out) {
  const U16 d;
  for (std::size_t i = 0; i < kWaveWidth; i += hn::Lanes(d)) {
    const V16 src = mul8(hn::Load(d, in.src[c].lane + i), blend_factor_lanes(equation.src, ByteFactors{in, c, i}));
    const V16 dst = mul8(hn::Load(d, in.dst[c].lane + i), blend_factor_lanes(equation.dst, ByteFactors{in, c, i}));
    hn::Store(combine8(equation.op, src, dst), d, out.lane + i);
  }
}

void blend_bytes(const ColorWriter& writer, const ColorWave& wave) {
  ByteOperands in;
  for (std::size_t c = 0; c < 4; ++c) {
    bytes_of(wave.color[c], in.src[c]);
    in.constants[c] = static_cast<std::uint16_t>(constant_to_byte(writer.constants[c]));
  }
  const std::uint32_t keep = ~write_word(writer);
  for_each_pass(wave, [&](std::uint32_t quads) {
    const base::LaneMask mask = wave.mask & lanes_of(quads);
    Words old{}, words;
    gather(wave, mask, old);
    for (std::size_t c = 0; c < 4; ++c) extract(old, shift_of(writer, c), in.dst[c]);
    for (std::size_t c = 0; c < 4; ++c) {
      Bytes result;
      blend_channel8(c < 3 ? writer.rgb : writer.alpha, in, c, result);
      merge(result, shift_of(writer, c), words, c == 0);
    }
    if (keep != 0) {
      for (std::size_t i = 0; i < kWaveWidth; ++i) words.lane[i] = (old.lane[i] & keep) | (words.lane[i] & ~keep);
    }
    scatter(wave, mask, words);
  });
}

HWY_INLINE VF clamp_float(VF x) {
  const F32 d;
  return lanes_min_second(lanes_max_second(x, hn::Zero(d)), hn::Set(d, 1.0f));
}

/// A channel of stored texels in binary32.
HWY_INLINE void decode_channel(const Words& words, int shift, bool srgb, Floats& out) {
  const F32 d;
  const hn::Rebind<std::int32_t, F32> di;
  for (std::size_t i = 0; i < kWaveWidth; i += hn::Lanes(d)) {
    const auto word = hn::Load(di, reinterpret_cast<const std::int32_t*>(words.lane + i));
    const auto code = hn::And(hn::ShiftRightSame(word, shift), hn::Set(di, 255));
    const VF value = srgb ? hn::GatherIndex(d, texel::kSrgbToLinear.data(), code)
                          : hn::Mul(hn::ConvertTo(d, code), hn::Set(d, 1.0f / 255.0f));
    hn::Store(value, d, out.lane + i);
  }
}

void blend_srgb(const ColorWriter& writer, const ColorWave& wave) {
  const F32 d;
  const BlendShape shape = blend_shape(writer);
  FloatOperands in;
  set_constants(writer, in);
  for (std::size_t c = 0; c < 4; ++c) {
    for (std::size_t i = 0; i < kWaveWidth; i += hn::Lanes(d))
      hn::Store(clamp_float(hn::Load(d, reinterpret_cast<const float*>(wave.color[c].lane + i))), d,
                in.src[c].lane + i);
    in.constants[c] = base::min_second(base::max_second(in.constants[c], 0.0f), 1.0f);
  }
  const SrgbPacker packer(writer);
  const SrgbPacker::Texels texels;
  const std::uint32_t keep = ~write_word(writer);
  for_each_pass(wave, [&](std::uint32_t quads) {
    const base::LaneMask mask = wave.mask & lanes_of(quads);
    Words old{}, words;
    gather(wave, mask, old);
    for (std::size_t c = 0; c < 4; ++c) decode_channel(old, shift_of(writer, c), c < 3, in.dst[c]);
    base::WaveRegister result[4];
    for (std::size_t c = 0; c < 4; ++c)
      for (std::size_t i = 0; i < kWaveWidth; i += hn::Lanes(d))
        hn::Store(blend_floats(c < 3 ? writer.rgb : writer.alpha, shape, in, c, i), d,
                  reinterpret_cast<float*>(result[c].lane + i));
    for (std::size_t i = 0; i < kWaveWidth; i += hn::Lanes(texels))
      hn::Store(packer.pack(result, i), texels, reinterpret_cast<std::int32_t*>(words.lane + i));
    if (keep != 0) {
      for (std::size_t i = 0; i < kWaveWidth; ++i) words.lane[i] = (old.lane[i] & keep) | (words.lane[i] & ~keep);
    }
    scatter(wave, mask, words);
  });
}

}  // namespace

ColorFunction choose_byte_function(bool srgb, bool blends) {
  if (srgb) return blends ? blend_srgb : store_srgb;
  return blends ? blend_bytes : store_bytes;
}

}  // namespace vitrine::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vitrine::raster {

HWY_EXPORT(choose_byte_function);

ColorFunction byte_color_function(const ColorWriter& writer) {
  const bool srgb = is_four_srgb_bytes(*writer.format);
  if (srgb ? texel::encodes_by_cpu() : !is_four_bytes(*writer.format)) return nullptr;
  const bool blends = writer.blend != BlendType::kNone;
  if (blends && reads_second_source(writer)) return nullptr;
  base::select_simd_target();
  return HWY_DYNAMIC_DISPATCH(choose_byte_function)(srgb, blends);
}

}  // namespace vitrine::raster
#endif  // HWY_ONCE

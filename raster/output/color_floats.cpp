// Fast colour output for targets of one, two or four channels in the order R, G, B, A: binary16 and 32-bit words of any
// type, with masks; the floats also blended. Same bits as the general function of color.cpp (tests compare them).
#include "raster/output/color_floats.h"

#include <cstring>

#include "base/float_mode.h"
#include "raster/output/blend.h"
#include "raster/output/color_passes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/output/color_floats.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/lane_math-inl.h"
#include "raster/output/color_blend-inl.h"
#include "texel/codec/half-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::raster::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using base::kWaveWidth;

/// The texels of a wave as they lie in memory, lane after lane.
template <class T, std::size_t kCount>
struct WaveTexels {
  using Element = T;
  static constexpr std::size_t kChannels = kCount, kBytes = kCount * sizeof(T);
  alignas(64) T element[kWaveWidth * kCount];
};

using Elements16 = hn::Rebind<std::uint16_t, F32>;
using Elements32 = hn::RebindToUnsigned<F32>;

HWY_INLINE hn::Vec<Elements16> to_elements(Elements16, VF value) {
  return texel::HWY_NAMESPACE::halves_of_floats(value);
}
HWY_INLINE hn::Vec<Elements32> to_elements(Elements32, VF value) { return hn::BitCast(Elements32(), value); }
HWY_INLINE VF to_floats(hn::Vec<Elements16> halves) { return texel::HWY_NAMESPACE::floats_of_halves(halves); }
HWY_INLINE VF to_floats(hn::Vec<Elements32> words) { return hn::BitCast(F32(), words); }

/// Four colours of floats to texels; channels that the texels lack are not read.
template <class Texels, class Color>
HWY_INLINE void pack(const Color& color, Texels& out) {
  const hn::Rebind<typename Texels::Element, F32> d;
  const auto channel = [&](std::size_t c, std::size_t i) HWY_ATTR {
    return to_elements(d, hn::Load(F32(), reinterpret_cast<const float*>(color[c].lane) + i));
  };
  for (std::size_t i = 0; i < kWaveWidth; i += hn::Lanes(F32())) {
    auto* to = out.element + Texels::kChannels * i;
    if constexpr (Texels::kChannels == 1)
      hn::Store(channel(0, i), d, to);
    else if constexpr (Texels::kChannels == 2)
      hn::StoreInterleaved2(channel(0, i), channel(1, i), d, to);
    else
      hn::StoreInterleaved4(channel(0, i), channel(1, i), channel(2, i), channel(3, i), d, to);
  }
}

template <class Texels>
HWY_INLINE void unpack(const Texels& texels, Floats out[4]) {
  const hn::Rebind<typename Texels::Element, F32> d;
  for (std::size_t i = 0; i < kWaveWidth; i += hn::Lanes(F32())) {
    const auto* from = texels.element + Texels::kChannels * i;
    hn::Vec<decltype(d)> channel[4];
    if constexpr (Texels::kChannels == 1)
      channel[0] = hn::Load(d, from);
    else if constexpr (Texels::kChannels == 2)
      hn::LoadInterleaved2(d, from, channel[0], channel[1]);
    else
      hn::LoadInterleaved4(d, from, channel[0], channel[1], channel[2], channel[3]);
    for (std::size_t c = 0; c < Texels::kChannels; ++c) hn::Store(to_floats(channel[c]), F32(), out[c].lane + i);
  }
}

/// Calls row(address of two pixels of an attachment, their two texels of the wave, which are covered: bits 0 and 1).
template <class Texels, class Row>
HWY_INLINE void for_each_row(const ColorWave& wave, base::LaneMask mask, Texels& texels, Row&& row) {
  const std::size_t pitch = wave.view->level[0].row_pitch;
  std::byte* const origin = wave.view->block(0, wave.layer, wave.sample, 0, 0, 0);
  for (std::size_t q = 0; mask != 0; ++q, mask >>= 4) {
    std::byte* const top = origin + wave.quads->y[q] * pitch + wave.quads->x[q] * Texels::kBytes;
    auto* const quad = texels.element + 4 * Texels::kChannels * q;
    if (mask & 3) row(top, quad, mask & 3);
    if (mask & 12) row(top + pitch, quad + 2 * Texels::kChannels, mask >> 2 & 3);
  }
}

/// Stores the lanes of `mask`.
template <class Texels>
HWY_INLINE void scatter(const ColorWave& wave, base::LaneMask mask, const Texels& texels) {
  constexpr std::size_t n = Texels::kBytes;
  for_each_row(wave, mask, texels, [](std::byte* to, const auto* from, std::uint64_t covered) HWY_ATTR {
    if (covered == 3)
      std::memcpy(to, from, 2 * n);
    else if (covered == 1)
      std::memcpy(to, from, n);
    else
      std::memcpy(to + n, from + Texels::kChannels, n);
  });
}

/// Loads the lanes of `mask`; others are left as they are.
template <class Texels>
HWY_INLINE void gather(const ColorWave& wave, base::LaneMask mask, Texels& texels) {
  constexpr std::size_t n = Texels::kBytes;
  for_each_row(wave, mask, texels, [](const std::byte* from, auto* to, std::uint64_t covered) HWY_ATTR {
    if (covered == 3)
      std::memcpy(to, from, 2 * n);
    else if (covered == 1)
      std::memcpy(to, from, n);
    else
      std::memcpy(to + Texels::kChannels, from + n, n);
  });
}

/// Keeps what the write mask protects of `old`.
template <class Texels>
HWY_INLINE void merge(const ColorWriter& writer, const Texels& old, Texels& texels) {
  const hn::FixedTag<std::uint8_t, 16> d;
  alignas(16) std::uint8_t pattern[16];
  for (std::size_t i = 0; i < 16; ++i)
    pattern[i] = static_cast<std::uint8_t>(writer.write_bits.bytes[i % Texels::kBytes]);
  const auto change = hn::Load(d, pattern);
  auto* to = reinterpret_cast<std::uint8_t*>(texels.element);
  const auto* from = reinterpret_cast<const std::uint8_t*>(old.element);
  for (std::size_t i = 0; i < sizeof(texels.element); i += 16)
    hn::Store(hn::Or(hn::And(change, hn::Load(d, to + i)), hn::AndNot(change, hn::Load(d, from + i))), d, to + i);
}

template <class Texels>
void store_texels(const ColorWriter& writer, const ColorWave& wave) {
  Texels texels;
  pack(wave.color, texels);
  if (!writer.masked) return scatter(wave, wave.mask, texels);
  for_each_pass(wave, [&](std::uint32_t quads) HWY_ATTR {
    const base::LaneMask mask = wave.mask & lanes_of(quads);
    Texels old{}, result = texels;
    gather(wave, mask, old);
    merge(writer, old, result);
    scatter(wave, mask, result);
  });
}

HWY_INLINE void set_sources(const ColorWriter& writer, const ColorWave& wave, FloatOperands& in) {
  for (std::size_t c = 0; c < 4; ++c) {
    std::memcpy(in.src[c].lane, wave.color[c].lane, sizeof(in.src[c].lane));
    if (wave.second)
      std::memcpy(in.second[c].lane, wave.second[c].lane, sizeof(in.second[c].lane));
    else
      in.second[c] = {};
  }
  set_constants(writer, in);
}

template <class Texels>
void blend_texels(const ColorWriter& writer, const ColorWave& wave) {
  // Halves are blended with denormals (lavapipe-shader-math.md section 1).
  const base::ScopedFloatMode mode(sizeof(typename Texels::Element) == 2 ? base::Denormals::kHonour
                                                                         : base::Denormals::kFlush);
  const BlendShape shape = blend_shape(writer);
  FloatOperands in;
  set_sources(writer, wave, in);
  for_each_pass(wave, [&](std::uint32_t quads) HWY_ATTR {
    const base::LaneMask mask = wave.mask & lanes_of(quads);
    Texels old{}, texels;
    gather(wave, mask, old);
    unpack(old, in.dst);
    Floats result[4];
    for (std::size_t c = 0; c < Texels::kChannels; ++c)
      for (std::size_t i = 0; i < kWaveWidth; i += hn::Lanes(F32()))
        hn::Store(blend_floats(c < 3 ? writer.rgb : writer.alpha, shape, in, c, i), F32(), result[c].lane + i);
    pack(result, texels);
    if (writer.masked) merge(writer, old, texels);
    scatter(wave, mask, texels);
  });
}

template <class Element>
ColorFunction choose_function(std::size_t channels, bool blends) {
  using One = WaveTexels<Element, 1>;
  using Two = WaveTexels<Element, 2>;
  using Four = WaveTexels<Element, 4>;
  switch (channels) {
    case 1:
      return blends ? blend_texels<One> : store_texels<One>;
    case 2:
      return blends ? blend_texels<Two> : store_texels<Two>;
    case 4:
      return blends ? blend_texels<Four> : store_texels<Four>;
    default:
      return nullptr;
  }
}

}  // namespace

ColorFunction choose_float_function(std::size_t bits, std::size_t channels, bool blends) {
  return bits == 16 ? choose_function<std::uint16_t>(channels, blends)
                    : choose_function<std::uint32_t>(channels, blends);
}

}  // namespace vitrine::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vitrine::raster {

HWY_EXPORT(choose_float_function);

ColorFunction float_color_function(const ColorWriter& writer) {
  const texel::FormatDesc& format = *writer.format;
  if (!format.plain || format.channel_count == 0) return nullptr;
  const texel::Channel& first = format.channel[0];
  const bool is_float = first.numeric == texel::Numeric::kSfloat;
  const bool is_integer = first.numeric == texel::Numeric::kUint || first.numeric == texel::Numeric::kSint;
  if (!(is_float && (first.bits == 16 || first.bits == 32)) && !(is_integer && first.bits == 32)) return nullptr;
  for (std::size_t c = 0; c < format.channel_count; ++c) {
    const texel::Channel& channel = format.channel[c];
    if (channel.bits != first.bits || channel.numeric != first.numeric || format.rgba[c] != static_cast<std::int8_t>(c))
      return nullptr;
  }
  base::select_simd_target();
  return HWY_DYNAMIC_DISPATCH(choose_float_function)(first.bits, format.channel_count,
                                                     writer.blend != BlendType::kNone);
}

}  // namespace vitrine::raster
#endif  // HWY_ONCE

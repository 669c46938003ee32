// One texel per lane as values: words loaded one by one, converted by SIMD. The twin of fetch_texel.

#include <bit>

#include "texel/sampler/wave/block-inl.h"
#include "texel/sampler/wave/fetch-inl.h"
#include "texel/sampler/wave/pairs-inl.h"
#include "texel/sampler/wave/state-inl.h"

#if defined(VITRINE_TEXEL_WAVE_TEXELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_TEXEL_WAVE_TEXELS_INL_H_
#undef VITRINE_TEXEL_WAVE_TEXELS_INL_H_
#else
#define VITRINE_TEXEL_WAVE_TEXELS_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {

/// Components R, G, B, A of a wave; only those that were asked for are valid.
struct WaveTexels {
  FloatLanes c[4];
};

/// Bit c: component c is wanted.
using Components = std::uint32_t;

/// Where the texels of one tap are.
struct TexelPlaces {
  IntLanes offset;  ///< bytes from the view's base: of the texel, or of its block
  IntLanes inner;   ///< compressed: index inside the block
};

/// Stores where texels (x, y, z) of lanes first.. lie; x, y, z inside the level.
template <std::uint32_t kDims>
HWY_INLINE void place_texels(const FormatDesc& format, const LevelLanes& level, VI x, VI y, VI z, std::size_t first,
                             TexelPlaces& out) {
  VI origin = level.origin;
  if (format.is_compressed()) {
    VI inner_x, inner_y = splat(0);
    x = split_block(x, format.block_width, inner_x);
    if (kDims > 1) y = split_block(y, format.block_height, inner_y);
    const VI inner = hn::Add(hn::Mul(inner_y, splat(static_cast<std::int32_t>(format.block_width))), inner_x);
    hn::Store(inner, DI(), out.inner.lane + first);
  }
  if (kDims > 1) origin = hn::Add(origin, hn::Mul(y, level.row_pitch));
  if (kDims > 2) origin = hn::Add(origin, hn::Mul(z, level.slice_pitch));
  hn::Store(hn::Add(origin, hn::Mul(x, splat(static_cast<std::int32_t>(format.block_bytes)))), DI(),
            out.offset.lane + first);
}

using WordLanes = base::WaveRegister;

/// Texels of the lanes of a vector, one by one, which is faster than gathering; and nothing beside them: that may be
/// another tile's, which is being written, or lie behind a buffer.
template <std::size_t kBytes>
HWY_INLINE void load_lanes_of_texels(const std::byte* base, const IntLanes& offset, std::size_t first,
                                     WordLanes words[4]) {
  constexpr std::size_t kWords = (kBytes + 3) / 4;
  if constexpr (kBytes == 8) {
    const WordPair pair = load_word_pairs(base, hn::Load(DI(), offset.lane + first));
    hn::Store(pair.first, DU(), words[0].lane + first);
    return hn::Store(pair.second, DU(), words[1].lane + first);
  } else if constexpr (kBytes == 16) {
    VU quad[4];
    load_word_quads(base, hn::Load(DI(), offset.lane + first), quad);
    for (std::size_t i = 0; i < 4; ++i) hn::Store(quad[i], DU(), words[i].lane + first);
    return;
  }
  for (std::size_t lane = first; lane < first + hn::MaxLanes(DI()); ++lane) {
    std::uint32_t word[kWords] = {};
    std::memcpy(word, base + offset.lane[lane], kBytes);
    for (std::size_t i = 0; i < kWords; ++i) words[i].lane[lane] = word[i];
  }
}

/// The same of the lanes that `wanted` has bits for, the vector's first one lowest; 0 for the others.
template <std::size_t kBytes>
HWY_INLINE void load_wanted_lanes(const std::byte* base, base::LaneMask wanted, IntLanes& offset, std::size_t first,
                                  WordLanes words[4]) {
  if (wanted == base::first_lanes(hn::Lanes(DI()))) return load_lanes_of_texels<kBytes>(base, offset, first, words);
  const auto none = hn::Not(lanes_mask_from_bits(DU(), wanted));
  if (wanted != 0) {
    // Lanes that want no texel get one that another wants: wherever else they read, another tile may be writing.
    const VI shared = splat(offset.lane[first + static_cast<std::size_t>(std::countr_zero(wanted))]);
    hn::BlendedStore(shared, hn::RebindMask(DI(), none), DI(), offset.lane + first);
    load_lanes_of_texels<kBytes>(base, offset, first, words);
  }
  for (std::size_t i = 0; i < (kBytes + 3) / 4; ++i)
    hn::BlendedStore(hn::Zero(DU()), none, DU(), words[i].lane + first);
}

/// What body<bytes of a texel>() of a plain format returns.
template <class Body>
HWY_INLINE auto by_texel_bytes(const FormatDesc& format, Body&& body) {
  switch (format.block_bytes) {
    case 1:
      return body.template operator()<1>();
    case 2:
      return body.template operator()<2>();
    case 3:
      return body.template operator()<3>();
    case 4:
      return body.template operator()<4>();
    case 6:
      return body.template operator()<6>();
    case 8:
      return body.template operator()<8>();
    case 12:
      return body.template operator()<12>();
    default:
      return body.template operator()<16>();
  }
}

template <Numeric kNumeric>
inline HWY_NOINLINE void convert_words(const FormatDesc& format, const WordLanes words[4], Components wanted,
                                       WaveTexels& out) {
  constexpr bool kInteger = kNumeric == Numeric::kUint || kNumeric == Numeric::kSint;
  for (std::size_t c = 0; c < 4; ++c) {
    if ((wanted >> c & 1) == 0) continue;
    float* to = out.c[c].lane;
    const std::int8_t index = format.rgba[c];
    if (index < 0) {
      const VU one = kInteger ? hn::Set(DU(), 1u) : hn::Set(DU(), 0x3f800000u);
      const VF missing = as_float(c == 3 ? one : hn::Zero(DU()));
      for (std::size_t i = 0; i < base::kWaveWidth; i += hn::Lanes(DF())) hn::Store(missing, DF(), to + i);
      continue;
    }
    const Channel channel = format.channel[static_cast<std::size_t>(index)];
    const std::uint32_t* from = words[channel.offset / 32].lane;
    for (std::size_t i = 0; i < base::kWaveWidth; i += hn::Lanes(DF())) {
      hn::Store(convert_field<kNumeric>(hn::Load(DU(), from + i), channel), DF(), to + i);
    }
  }
}

/// E5B9G9R9: mantissa * 2^(E - 24).
HWY_INLINE TexelLanes split_shared_exponent(VU word) {
  const VU exponent = hn::Add(hn::ShiftRight<27>(word), hn::Set(DU(), 103u));
  const VF scale = as_float(hn::ShiftLeft<23>(exponent));
  const auto mantissa = [&](int shift) HWY_ATTR {
    const VU field = hn::And(hn::ShiftRightSame(word, shift), hn::Set(DU(), 511u));
    return hn::Mul(lanes_int_to_float(hn::BitCast(DI(), field)), scale);
  };
  return {mantissa(0), mantissa(9), mantissa(18), splat(1.0f)};
}

inline HWY_NOINLINE void convert_shared_exponent(const WordLanes& words, WaveTexels& out) {
  for (std::size_t i = 0; i < base::kWaveWidth; i += hn::Lanes(DF())) {
    const TexelLanes texel = split_shared_exponent(hn::Load(DU(), words.lane + i));
    hn::Store(texel.r, DF(), out.c[0].lane + i);
    hn::Store(texel.g, DF(), out.c[1].lane + i);
    hn::Store(texel.b, DF(), out.c[2].lane + i);
    hn::Store(texel.a, DF(), out.c[3].lane + i);
  }
}

inline HWY_NOINLINE void fetch_blocks(const ImageView& view, const TexelPlaces& places, base::LaneMask active,
                                      WaveTexels& out) {
  BlockCache& cache = block_cache();
  base::for_each_lane(active, [&](std::size_t lane) {
    const Texel& texel = cache.texels(*view.format, view.base + places.offset.lane[lane])[places.inner.lane[lane]];
    for (std::size_t c = 0; c < 4; ++c) std::memcpy(&out.c[c].lane[lane], &texel[c], sizeof(float));
  });
}

/// The texels at `places`. Compressed ones of active lanes only.
inline HWY_NOINLINE void fetch_texels(const ImageView& view, const TexelPlaces& places, base::LaneMask active,
                                      Components wanted, WaveTexels& out) {
  WordLanes words[4];
  if (view.format->is_compressed()) {
    if (!decode_s3tc(*view.format, view.base, places.offset, places.inner, words[0].lane)) {
      return fetch_blocks(view, places, active, out);
    }
    return view.format->is_srgb()
               ? convert_words<Numeric::kSrgb>(format_desc(VK_FORMAT_R8G8B8A8_SRGB), words, wanted, out)
               : convert_words<Numeric::kUnorm>(format_desc(VK_FORMAT_R8G8B8A8_UNORM), words, wanted, out);
  }
  const FormatDesc& format = *view.format;
  by_texel_bytes(format, [&]<std::size_t kBytes>() {
    for (std::size_t first = 0; first < base::kWaveWidth; first += hn::MaxLanes(DI()))
      load_lanes_of_texels<kBytes>(view.base, places.offset, first, words);
  });
  if (format.format == VK_FORMAT_E5B9G9R9_UFLOAT_PACK32) return convert_shared_exponent(words[0], out);
  by_numeric(format.channel[0].numeric,
             [&]<Numeric kNumeric>() { convert_words<kNumeric>(format, words, wanted, out); });
}

/// Components of the format that the results need, through the view's mapping.
inline Components wanted_components(const ImageView& view, const SampleResult& result) {
  Components wanted = 0;
  for (std::size_t c = 0; c < 4; ++c) {
    if (result[c] != nullptr && view.swizzle[c] < 4) wanted |= 1u << view.swizzle[c];
  }
  return wanted;
}

/// Results through the view's mapping.
inline HWY_NOINLINE void store_texels(const ImageView& view, const WaveTexels& texels, base::LaneMask active,
                                      const SampleResult& result) {
  const VU one = hn::Set(DU(), view.format->is_integer() ? 1u : 0x3f800000u);
  for (std::size_t c = 0; c < 4; ++c) {
    if (result[c] == nullptr) continue;
    const std::uint8_t source = view.swizzle[c];
    for (std::size_t i = 0; i < base::kWaveWidth; i += hn::Lanes(DU())) {
      VU value = source == 5 ? one : hn::Zero(DU());
      if (source < 4) value = as_unsigned(hn::Load(DF(), texels.c[source].lane + i));
      store_lanes(value, active, i, *result[c]);
    }
  }
}

}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

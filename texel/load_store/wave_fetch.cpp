// Reads texels by integer coordinates with SIMD (lavapipe-texture-blend.md A10): the twin of fetch and fetch_buffer.
#include <cstring>

#include "texel/load_store/wave_access.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "texel/load_store/wave_fetch.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "texel/load_store/wave_places-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {
namespace {

/// Lanes that want no texel get the place of one that does: wherever else they read, another tile may be writing.
HWY_INLINE void share_place(Places& places) {
  if (places.wanted == base::kAllLanes) return;
  const VI shared = splat(places.offset.lane[std::countr_zero(places.wanted)]);
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DI())) {
    const VI offset = hn::Load(DI(), places.offset.lane + first);
    hn::Store(hn::IfThenElse(places.valid(first), offset, shared), DI(), places.offset.lane + first);
  }
}

/// Adjacent texels of whole words.
template <std::size_t kBytes>
HWY_INLINE void load_adjacent(const std::byte* from, std::size_t first, WordLanes words[4]) {
  const auto* source = reinterpret_cast<const std::uint32_t*>(from);
  VU v[4];
  if constexpr (kBytes == 4) v[0] = hn::LoadU(DU(), source);
  if constexpr (kBytes == 8) hn::LoadInterleaved2(DU(), source, v[0], v[1]);
  if constexpr (kBytes == 16) hn::LoadInterleaved4(DU(), source, v[0], v[1], v[2], v[3]);
  for (std::size_t i = 0; i < kBytes / 4; ++i) hn::Store(v[i], DU(), words[i].lane + first);
}

/// Texels one by one, which is faster than gathering, and nothing beside them: that may be another tile's, which is
/// being written, or lie behind a buffer.
template <std::size_t kBytes>
HWY_NOINLINE void load_texels(const std::byte* base, const Places& places, WordLanes words[4]) {
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DI())) {
    if constexpr (kBytes == 4 || kBytes == 8 || kBytes == 16) {
      if (places.adjacent(first, kBytes)) {
        load_adjacent<kBytes>(base + places.offset.lane[first], first, words);
        continue;
      }
    }
    load_lanes_of_texels<kBytes>(base, places.offset, first, words);
  }
}

HWY_INLINE void load_texels(const FormatDesc& format, const std::byte* base, Places& places, WordLanes words[4]) {
  if (places.wanted == 0) {
    std::memset(words, 0, 4 * sizeof(WordLanes));
    return;
  }
  share_place(places);
  by_texel_bytes(format, [&]<std::size_t kBytes>() { load_texels<kBytes>(base, places, words); });
}

/// Texels where `valid`, what lies outside elsewhere, through a component mapping; stored for active lanes only.
template <Numeric kNumeric>
HWY_NOINLINE void put_texels(const FormatDesc& format, const std::array<std::uint8_t, 4>& swizzle,
                             const WordLanes words[4], base::LaneMask valid, base::LaneMask active,
                             const SampleResult& result) {
  constexpr bool kInteger = kNumeric == Numeric::kUint || kNumeric == Numeric::kSint;
  const VF one = kInteger ? as_float(hn::Set(DU(), 1u)) : splat(1.0f);
  for (std::size_t c = 0; c < 4; ++c) {
    if (result[c] == nullptr) continue;
    const std::uint8_t source = swizzle[c];
    const std::int8_t index = source < 4 ? format.rgba[source] : std::int8_t{-1};
    if (index < 0) {
      const VF constant = source == 3 || source == 5 ? one : splat(0.0f);
      for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DF()))
        store_lanes(as_unsigned(constant), active, first, *result[c]);
      continue;
    }
    const Channel channel = format.channel[static_cast<std::size_t>(index)];
    const WordLanes& from = words[channel.offset / 32];
    if ((valid & active) == base::kAllLanes) {
      for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DF())) {
        const VF value = convert_field<kNumeric>(hn::Load(DU(), from.lane + first), channel);
        hn::Store(as_unsigned(value), DU(), result[c]->lane + first);
      }
      continue;
    }
    for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DF())) {
      const VU value = as_unsigned(convert_field<kNumeric>(hn::Load(DU(), from.lane + first), channel));
      store_lanes(hn::IfThenElseZero(lanes_mask_from_bits(DU(), valid >> first), value), active, first, *result[c]);
    }
  }
}

void fetch_image(const ImageView& view, const FetchRequest& request, const SampleResult& result) {
  by_numeric(view.format->channel[0].numeric, [&]<Numeric kNumeric>() {
    Places places;
    place_texels(view, request, places);
    WordLanes words[4];
    load_texels(*view.format, view.base, places, words);
    put_texels<kNumeric>(*view.format, view.swizzle, words, places.wanted, request.active, result);
  });
}

void fetch_buffer_texels(const BufferTexelView& view, base::LaneMask active, const base::WaveRegister& index,
                         const SampleResult& result) {
  constexpr std::array<std::uint8_t, 4> kIdentity{0, 1, 2, 3};
  by_numeric(view.format->channel[0].numeric, [&]<Numeric kNumeric>() {
    Places places;
    place_texels(view, active, index, places);
    WordLanes words[4];
    load_texels(*view.format, view.data, places, words);
    put_texels<kNumeric>(*view.format, kIdentity, words, places.wanted, active, result);
  });
}

}  // namespace
}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vitrine::texel {
namespace {

HWY_EXPORT(fetch_image);
HWY_EXPORT(fetch_buffer_texels);

/// Whether the vectors here convert its texels. Those of unsigned floats include shared exponents.
bool has_vector_conversion(const FormatDesc& format) {
  const Numeric numeric = format.channel[0].numeric;
  return numeric != Numeric::kUfloat && numeric != Numeric::kUscaled && numeric != Numeric::kSscaled;
}

}  // namespace

bool fetch_wave(const ImageView& view, const FetchRequest& request, const SampleResult& result) {
  if (!has_vector_conversion(*view.format) || !offsets_fit(view)) return false;
  base::select_simd_target();
  HWY_DYNAMIC_DISPATCH(fetch_image)(view, request, result);
  return true;
}

bool fetch_buffer_wave(const BufferTexelView& view, base::LaneMask active, const base::WaveRegister& index,
                       const SampleResult& result) {
  if (!has_vector_conversion(*view.format) || !offsets_fit(view)) return false;
  base::select_simd_target();
  HWY_DYNAMIC_DISPATCH(fetch_buffer_texels)(view, active, index, result);
  return true;
}

}  // namespace vitrine::texel

#endif

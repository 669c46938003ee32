// Reads texels by integer coordinates with SIMD (lavapipe-texture-blend.md A10): the twin of fetch and fetch_buffer.
#include "texel/sampler/wave_fetch.h"

#include <algorithm>
#include <bit>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "texel/sampler/wave_fetch.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "texel/sampler/wave_texels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {
namespace {

HWY_INLINE VI load_or_zero(const base::WaveRegister* values, std::size_t first) {
  return values != nullptr ? load_ints(values, first) : splat(0);
}

/// 0 <= i < size.
HWY_INLINE hn::Mask<DI> within(VI i, VI size) { return hn::And(hn::Not(hn::Lt(i, splat(0))), hn::Lt(i, size)); }

/// Texels where `valid`, what lies outside elsewhere, through a component mapping; stored for active lanes only.
template <Numeric kNumeric>
HWY_INLINE void put_masked(const FormatDesc& format, const TexelLanes& texel, hn::Mask<DI> valid,
                           const std::array<std::uint8_t, 4>& swizzle, base::LaneMask active, std::size_t first,
                           base::WaveRegister result[4]) {
  constexpr bool kInteger = kNumeric == Numeric::kUint || kNumeric == Numeric::kSint;
  const VF one = kInteger ? as_float(hn::Set(DU(), 1u)) : splat(1.0f);
  const auto mask = hn::RebindMask(DF(), valid);
  const VF alpha = format.rgba[3] < 0 ? texel.a : hn::IfThenElseZero(mask, texel.a);
  const VF all[6] = {hn::IfThenElseZero(mask, texel.r),
                     hn::IfThenElseZero(mask, texel.g),
                     hn::IfThenElseZero(mask, texel.b),
                     alpha,
                     splat(0.0f),
                     one};
  const auto lanes = lanes_mask_from_bits(DU(), active >> first);
  for (std::size_t c = 0; c < 4; ++c) {
    hn::BlendedStore(as_unsigned(all[swizzle[c]]), lanes, DU(), result[c].lane + first);
  }
}

HWY_INLINE bool any_active(base::LaneMask active, std::size_t first) {
  return ((active >> first) & base::first_lanes(hn::Lanes(DF()))) != 0;
}

/// Where the texels of a wave lie in the memory of a view.
struct Places {
  IntLanes offset;            ///< bytes; anything where no texel is wanted
  base::LaneMask wanted = 0;  ///< the lane is active and inside the level

  HWY_INLINE hn::Mask<DI> valid(std::size_t first) const { return lanes_mask_from_bits(DI(), wanted >> first); }
};

/// One level of a view, or that of each lane.
struct LevelFields {
  VI width, height, pitch, origin;
};

/// The level of all lanes, if it is one for all of them and exists; else level_count.
HWY_INLINE std::uint32_t common_level(const ImageView& view, const base::WaveRegister* lod) {
  if (lod == nullptr) return 0;
  const VI level = hn::Set(DI(), static_cast<std::int32_t>(lod->lane[0]));
  auto differs = hn::Ne(level, level);
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DI()))
    differs = hn::Or(differs, hn::Ne(load_ints(lod, first), level));
  return hn::AllFalse(DI(), differs) ? std::min(lod->lane[0], view.level_count) : view.level_count;
}

/// Calls place(first lane, in which lanes the level exists, its fields) for every vector of lanes.
template <class Place>
HWY_INLINE void for_each_level(const ImageView& view, const base::WaveRegister* lod, Place&& place) {
  const auto integer = [](auto value) { return static_cast<std::int32_t>(value); };
  if (const std::uint32_t common = common_level(view, lod); common < view.level_count) {
    const LevelLayout& level = view.level[common];
    const LevelFields fields{splat(integer(level.extent.width)), splat(integer(level.extent.height)),
                             splat(integer(level.row_pitch)), splat(integer(level.offset))};
    for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DI()))
      place(first, hn::Eq(splat(0), splat(0)), fields);
    return;
  }
  alignas(64) std::int32_t width[kMaxLevels] = {}, height[kMaxLevels] = {}, pitch[kMaxLevels], origin[kMaxLevels];
  for (std::uint32_t i = 0; i < view.level_count; ++i) {
    width[i] = integer(view.level[i].extent.width);
    height[i] = integer(view.level[i].extent.height);
    pitch[i] = integer(view.level[i].row_pitch);
    origin[i] = integer(view.level[i].offset);
  }
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DI())) {
    VI level = load_or_zero(lod, first);
    const auto exists = within(level, splat(integer(view.level_count)));
    level = hn::IfThenElseZero(exists, level);
    place(first, exists,
          LevelFields{hn::GatherIndex(DI(), width, level), hn::GatherIndex(DI(), height, level),
                      hn::GatherIndex(DI(), pitch, level), hn::GatherIndex(DI(), origin, level)});
  }
}

void place_texels(const ImageView& view, const FetchRequest& request, Places& out) {
  const bool layered = view.type != VK_IMAGE_VIEW_TYPE_2D;
  const VI texel_bytes = splat(static_cast<std::int32_t>(view.format->block_bytes));
  const VI layer_stride = splat(static_cast<std::int32_t>(view.layer_stride));
  const VI layer_count = splat(static_cast<std::int32_t>(view.layer_count));
  for_each_level(view, request.lod, [&](std::size_t first, hn::Mask<DI> exists, const LevelFields& level) HWY_ATTR {
    const VI x = hn::Add(load_or_zero(request.coord[0], first), load_or_zero(request.offset[0], first));
    const VI y = hn::Add(load_or_zero(request.coord[1], first), load_or_zero(request.offset[1], first));
    const auto active = hn::RebindMask(DI(), lanes_mask_from_bits(DU(), request.active >> first));
    auto valid = hn::And(hn::And(active, exists), hn::And(within(x, level.width), within(y, level.height)));
    VI offset = hn::Add(hn::Add(level.origin, hn::Mul(y, level.pitch)), hn::Mul(x, texel_bytes));
    if (layered) {
      const VI layer = load_or_zero(request.coord[2], first);
      valid = hn::And(valid, within(layer, layer_count));
      offset = hn::Add(offset, hn::Mul(layer, layer_stride));
    }
    hn::Store(offset, DI(), out.offset.lane + first);
    out.wanted |= static_cast<base::LaneMask>(lanes_mask_bits(DI(), valid)) << first;
  });
}

/// Lanes that want no texel get the place of one that does: wherever else they read, another tile may be writing.
HWY_INLINE void share_place(Places& places) {
  const VI shared = splat(places.offset.lane[std::countr_zero(places.wanted)]);
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DI())) {
    const VI offset = hn::Load(DI(), places.offset.lane + first);
    hn::Store(hn::IfThenElse(places.valid(first), offset, shared), DI(), places.offset.lane + first);
  }
}

/// Texels of less than a word, and nothing beside them: that may be another tile's, which is being written.
template <class Texel>
HWY_INLINE void load_short_texels(const std::byte* base, const IntLanes& offset, WordLanes& words) {
  for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane) {
    Texel texel;
    std::memcpy(&texel, base + offset.lane[lane], sizeof(texel));
    words.lane[lane] = texel;
  }
}

/// Texels word by word: gathering is slower than as many loads.
HWY_INLINE void load_texels(const FormatDesc& format, const std::byte* base, const IntLanes& offset,
                            WordLanes words[4]) {
  if (format.block_bytes == 1) return load_short_texels<std::uint8_t>(base, offset, words[0]);
  if (format.block_bytes == 2) return load_short_texels<std::uint16_t>(base, offset, words[0]);
  switch ((format.block_bytes + 3) / 4) {
    case 1:
      return load_words<1>(base, offset, words);
    case 2:
      return load_words<2>(base, offset, words);
    case 3:
      return load_words<3>(base, offset, words);
    default:
      return load_words<4>(base, offset, words);
  }
}

/// The texels of lanes first.., converted.
template <Numeric kNumeric>
HWY_INLINE TexelLanes convert_lanes(const FormatDesc& format, const WordLanes words[4], std::size_t first) {
  constexpr bool kInteger = kNumeric == Numeric::kUint || kNumeric == Numeric::kSint;
  const VF one = kInteger ? as_float(hn::Set(DU(), 1u)) : splat(1.0f);
  const auto channel = [&](std::int8_t index, VF missing) HWY_ATTR {
    if (index < 0) return missing;
    const Channel& described = format.channel[static_cast<std::size_t>(index)];
    return convert_field<kNumeric>(hn::Load(DU(), words[described.offset / 32].lane + first), described);
  };
  return {channel(format.rgba[0], splat(0.0f)), channel(format.rgba[1], splat(0.0f)),
          channel(format.rgba[2], splat(0.0f)), channel(format.rgba[3], one)};
}

template <Numeric kNumeric>
void fetch_image(const ImageView& view, const FetchRequest& request, base::WaveRegister result[4]) {
  Places places;
  place_texels(view, request, places);
  WordLanes words[4];
  if (places.wanted != 0) {
    share_place(places);
    load_texels(*view.format, view.base, places.offset, words);
  } else {
    std::memset(words, 0, sizeof(words));
  }
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DF())) {
    if (!any_active(request.active, first)) continue;
    put_masked<kNumeric>(*view.format, convert_lanes<kNumeric>(*view.format, words, first), places.valid(first),
                         view.swizzle, request.active, first, result);
  }
}

template <Numeric kNumeric>
void fetch_texels(const BufferTexelView& view, base::LaneMask active, const base::WaveRegister& index,
                  base::WaveRegister result[4]) {
  constexpr std::array<std::uint8_t, 4> kIdentity{0, 1, 2, 3};
  const VI count = splat(static_cast<std::int32_t>(view.count));
  const VI texel_bytes = splat(static_cast<std::int32_t>(view.format->block_bytes));
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DF())) {
    if (!any_active(active, first)) continue;
    const VI i = load_ints(&index, first);
    const auto valid = within(i, count);
    const VI offset = hn::IfThenElseZero(valid, hn::Mul(i, texel_bytes));
    put_masked<kNumeric>(*view.format, fetch_lanes<kNumeric>(*view.format, view.data, offset), valid, kIdentity, active,
                         first, result);
  }
}

/// Calls body<numeric>() for the numeric formats that have a vector conversion.
template <class Body>
bool by_numeric(const FormatDesc& format, Body body) {
  switch (format.channel[0].numeric) {
    case Numeric::kUnorm:
      return body.template operator()<Numeric::kUnorm>(), true;
    case Numeric::kSnorm:
      return body.template operator()<Numeric::kSnorm>(), true;
    case Numeric::kUint:
      return body.template operator()<Numeric::kUint>(), true;
    case Numeric::kSint:
      return body.template operator()<Numeric::kSint>(), true;
    case Numeric::kSfloat:
      return body.template operator()<Numeric::kSfloat>(), true;
    case Numeric::kSrgb:
      return body.template operator()<Numeric::kSrgb>(), true;
    default:
      return false;
  }
}

bool fetch_image_any(const ImageView& view, const FetchRequest& request, base::WaveRegister result[4]) {
  return by_numeric(*view.format, [&]<Numeric kNumeric>() { fetch_image<kNumeric>(view, request, result); });
}

bool fetch_texels_any(const BufferTexelView& view, base::LaneMask active, const base::WaveRegister& index,
                      base::WaveRegister result[4]) {
  return by_numeric(*view.format, [&]<Numeric kNumeric>() { fetch_texels<kNumeric>(view, active, index, result); });
}

}  // namespace
}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vitrine::texel {
namespace {

HWY_EXPORT(fetch_image_any);
HWY_EXPORT(fetch_texels_any);

constexpr std::uint64_t kSpanLimit = (std::uint64_t{1} << 31) - 64;

bool image_supported(const ImageView& view, const FetchRequest& request) {
  const bool flat = view.type != VK_IMAGE_VIEW_TYPE_1D && view.type != VK_IMAGE_VIEW_TYPE_1D_ARRAY &&
                    view.type != VK_IMAGE_VIEW_TYPE_3D;
  const LevelLayout& last = view.level[view.level_count - 1];
  const std::uint64_t span = (view.layer_count - 1) * view.layer_stride + last.offset + last.sample_stride;
  return flat && view.format->plain && view.samples == 1 && request.sample == nullptr && span < kSpanLimit;
}

}  // namespace

bool fetch_wave(const ImageView& view, const FetchRequest& request, base::WaveRegister result[4]) {
  if (!image_supported(view, request)) return false;
  base::select_simd_target();
  return HWY_DYNAMIC_DISPATCH(fetch_image_any)(view, request, result);
}

bool fetch_buffer_wave(const BufferTexelView& view, base::LaneMask active, const base::WaveRegister& index,
                       base::WaveRegister result[4]) {
  // Narrower texels would be read with bytes that may lie behind the buffer.
  const bool words = view.format->block_bytes % 4 == 0 && view.format->plain;
  if (!words || view.count == 0 || view.count * view.format->block_bytes >= kSpanLimit) return false;
  base::select_simd_target();
  return HWY_DYNAMIC_DISPATCH(fetch_texels_any)(view, active, index, result);
}

}  // namespace vitrine::texel

#endif

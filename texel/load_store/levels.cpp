// Loads the words of texels that integer coordinates name (lavapipe-texture-blend.md A10) in levels that the lanes
// choose, or moved by offsets.
#include <algorithm>

#include "texel/load_store/shape.h"
#include "texel/load_store/wave_access.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "texel/load_store/levels.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "texel/sampler/wave/texels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {
namespace {

HWY_INLINE VI load_or_zero(const base::WaveRegister* values, std::size_t first) {
  return values != nullptr ? load_ints(values, first) : splat(0);
}

/// Where the texels of a wave lie in memory.
struct Places {
  IntLanes offset;            ///< bytes; anything where no texel is wanted
  base::LaneMask wanted = 0;  ///< the lane is active and inside the level
};

/// One level of a view, or that of each lane.
struct LevelFields {
  VI width, height, depth, pitch, slice_pitch, sample_stride, origin;
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
  const std::uint32_t common = common_level(view, lod);
  if (common >= view.min_level && common < view.level_count) {
    const LevelLayout& level = view.level[common];
    const LevelFields fields{splat(integer(level.extent.width)), splat(integer(level.extent.height)),
                             splat(integer(level.extent.depth)), splat(integer(level.row_pitch)),
                             splat(integer(level.slice_pitch)),  splat(integer(level.sample_stride)),
                             splat(integer(level.offset))};
    for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DI()))
      place(first, hn::Eq(splat(0), splat(0)), fields);
    return;
  }
  struct alignas(64) Table {
    std::int32_t of[kMaxLevels] = {};
  };
  Table width, height, depth, pitch, slice_pitch, sample_stride, origin;
  for (std::uint32_t i = 0; i < view.level_count; ++i) {
    const LevelLayout& level = view.level[i];
    width.of[i] = integer(level.extent.width);
    height.of[i] = integer(level.extent.height);
    depth.of[i] = integer(level.extent.depth);
    pitch.of[i] = integer(level.row_pitch);
    slice_pitch.of[i] = integer(level.slice_pitch);
    sample_stride.of[i] = integer(level.sample_stride);
    origin.of[i] = integer(level.offset);
  }
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DI())) {
    VI level = load_or_zero(lod, first);
    const auto exists = hn::And(within(level, splat(integer(view.level_count))),
                                hn::Not(hn::Lt(level, splat(integer(view.min_level)))));
    level = hn::IfThenElseZero(exists, level);
    const auto of = [level](const Table& table) HWY_ATTR { return hn::GatherIndex(DI(), table.of, level); };
    place(first, exists,
          LevelFields{of(width), of(height), of(depth), of(pitch), of(slice_pitch), of(sample_stride), of(origin)});
  }
}

/// Of views whose bytes' offsets fit 31 bits.
HWY_NOINLINE void place_texels(const ImageView& view, const FetchRequest& request, Places& out) {
  const Shape shape = shape_of(view.type);
  const auto count = [](std::uint64_t value) { return splat(static_cast<std::int32_t>(value)); };
  const VI texel_bytes = count(view.format->block_bytes), layer_stride = count(view.layer_stride);
  const VI layer_count = count(view.layer_count), samples = count(view.samples);
  for_each_level(view, request.lod, [&](std::size_t first, hn::Mask<DI> exists, const LevelFields& level) HWY_ATTR {
    const auto at = [&](std::uint32_t i) HWY_ATTR {
      const VI coord = load_or_zero(request.coord[i], first);
      return request.offset[i] == nullptr ? coord : hn::Add(coord, load_ints(request.offset[i], first));
    };
    const auto active = hn::RebindMask(DI(), lanes_mask_from_bits(DU(), request.active >> first));
    auto valid = hn::And(active, exists);
    VI offset = level.origin;
    const auto step = [&](VI i, VI size, VI stride) HWY_ATTR {
      valid = hn::And(valid, within(i, size));
      offset = hn::Add(offset, hn::Mul(i, stride));
    };
    step(at(0), level.width, texel_bytes);
    if (shape.dims > 1) step(at(1), level.height, level.pitch);
    if (shape.dims > 2) step(at(2), level.depth, level.slice_pitch);
    if (shape.layered) step(load_or_zero(request.coord[shape.dims], first), layer_count, layer_stride);
    if (request.sample != nullptr) step(load_ints(request.sample, first), samples, level.sample_stride);
    hn::Store(offset, DI(), out.offset.lane + first);
    out.wanted |= static_cast<base::LaneMask>(lanes_mask_bits(DI(), valid)) << first;
  });
}

template <std::size_t kBytes>
HWY_NOINLINE void load_places(const std::byte* base, Places& places, WordLanes words[4]) {
  for (std::size_t first = 0; first < base::kWaveWidth; first += hn::Lanes(DI())) {
    const base::LaneMask wanted = places.wanted >> first & base::first_lanes(hn::Lanes(DI()));
    load_wanted_lanes<kBytes>(base, wanted, places.offset, first, words);
  }
}

void load_of_levels(const ImageView& view, const FetchRequest& request, WordLanes words[4]) {
  Places places;
  place_texels(view, request, places);
  by_texel_bytes(*view.format, [&]<std::size_t kBytes>() { load_places<kBytes>(view.base, places, words); });
}

}  // namespace
}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vitrine::texel {
namespace {

HWY_EXPORT(load_of_levels);

}  // namespace

void load_levels(const ImageView& view, const FetchRequest& request, base::WaveRegister words[4]) {
  base::select_simd_target();
  HWY_DYNAMIC_DISPATCH(load_of_levels)(view, request, words);
}

}  // namespace vitrine::texel

#endif

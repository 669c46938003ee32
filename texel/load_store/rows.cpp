// Loads and stores the words of texels that integer coordinates name (lavapipe-texture-blend.md A10): those of
// neighbours in memory as vectors.
#include <cstring>

#include "texel/load_store/wave_access.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "texel/load_store/rows.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "texel/sampler/wave/texels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {
namespace {

inline constexpr std::size_t kLanes = hn::MaxLanes(DU());
inline constexpr std::size_t kHalf = kLanes / 2;

/// Whether halves of a vector are looked at, too: workgroups are often eight wide.
template <std::size_t kBytes>
inline constexpr bool kInHalves = kLanes == 16 && (kBytes == 1 || kBytes == 2 || kBytes == 4);

/// Whether texels in a row are loaded and stored as vectors.
template <std::size_t kBytes>
inline constexpr bool kInRows = kBytes == 1 || kBytes == 2 || kBytes == 4 || kBytes == 8 || kBytes == 16;

/// `kCount` adjacent texels of at most a word.
template <std::size_t kBytes, std::size_t kCount>
HWY_INLINE void load_narrow(const std::byte* from, std::uint32_t* to) {
  const hn::CappedTag<std::uint32_t, kCount> d;
  if constexpr (kBytes == 4) {
    hn::Store(hn::LoadU(d, reinterpret_cast<const std::uint32_t*>(from)), d, to);
  } else if constexpr (kBytes == 2) {
    const hn::Rebind<std::uint16_t, decltype(d)> d16;
    hn::Store(hn::PromoteTo(d, hn::LoadU(d16, reinterpret_cast<const std::uint16_t*>(from))), d, to);
  } else {
    const hn::Rebind<std::uint8_t, decltype(d)> d8;
    hn::Store(hn::PromoteTo(d, hn::LoadU(d8, reinterpret_cast<const std::uint8_t*>(from))), d, to);
  }
}

template <std::size_t kBytes, std::size_t kCount>
HWY_INLINE void load_adjacent(const std::byte* from, std::size_t first, base::WaveRegister words[4]) {
  const auto* source = reinterpret_cast<const std::uint32_t*>(from);
  VU v[4];
  if constexpr (kBytes <= 4) return load_narrow<kBytes, kCount>(from, words[0].lane + first);
  if constexpr (kBytes == 8) hn::LoadInterleaved2(DU(), source, v[0], v[1]);
  if constexpr (kBytes == 16) hn::LoadInterleaved4(DU(), source, v[0], v[1], v[2], v[3]);
  for (std::size_t i = 0; i < kBytes / 4; ++i) hn::Store(v[i], DU(), words[i].lane + first);
}

template <std::size_t kBytes, std::size_t kCount>
HWY_INLINE void store_narrow(const std::uint32_t* from, std::byte* to) {
  const hn::CappedTag<std::uint32_t, kCount> d;
  const auto word = hn::Load(d, from);
  if constexpr (kBytes == 1) {
    const hn::Rebind<std::uint8_t, decltype(d)> d8;
    hn::StoreU(hn::DemoteTo(d8, hn::BitCast(hn::RebindToSigned<decltype(d)>(), word)), d8,
               reinterpret_cast<std::uint8_t*>(to));
  } else if constexpr (kBytes == 2) {
    const hn::Rebind<std::uint16_t, decltype(d)> d16;
    hn::StoreU(hn::DemoteTo(d16, hn::BitCast(hn::RebindToSigned<decltype(d)>(), word)), d16,
               reinterpret_cast<std::uint16_t*>(to));
  } else {
    hn::StoreU(word, d, reinterpret_cast<std::uint32_t*>(to));
  }
}

template <std::size_t kBytes, std::size_t kCount>
HWY_INLINE void store_adjacent(const base::WaveRegister words[4], std::size_t first, std::byte* to) {
  auto* target = reinterpret_cast<std::uint32_t*>(to);
  const auto word = [&](std::size_t i) HWY_ATTR { return hn::Load(DU(), words[i].lane + first); };
  if constexpr (kBytes <= 4) {
    store_narrow<kBytes, kCount>(words[0].lane + first, to);
  } else if constexpr (kBytes == 8) {
    hn::StoreInterleaved2(word(0), word(1), DU(), target);
  } else {
    hn::StoreInterleaved4(word(0), word(1), word(2), word(3), DU(), target);
  }
}

/// Where the texels of the active lanes of a vector lie, in bytes from the base, and which of them are inside: a bit
/// for each.
HWY_INLINE base::LaneMask place_lanes(const TexelGrid& grid, base::LaneMask active, std::size_t first,
                                      IntLanes& offset) {
  auto valid = lanes_mask_from_bits(DI(), active >> first);
  VI place = splat(0);
  for (std::size_t i = 0; i < grid.axis_count; ++i) {
    const TexelAxis& axis = grid.axis[i];
    const VI at = load_ints(axis.coord, first);
    valid = hn::And(valid, within(at, splat(axis.size)));
    place = hn::Add(place, hn::Mul(at, splat(axis.stride)));
  }
  hn::Store(place, DI(), offset.lane + first);
  return static_cast<base::LaneMask>(lanes_mask_bits(DI(), valid));
}

/// Whether kCount lanes have successive first coordinates and the others in common, all inside; their first texel.
/// Tells by coordinates, not by places, so that these need not be computed.
template <std::size_t kBytes, std::size_t kCount>
HWY_INLINE std::byte* row_of(const TexelGrid& grid, std::size_t first) {
  const hn::CappedTag<std::int32_t, kCount> d;
  const auto coordinates = [&](const TexelAxis& axis) HWY_ATTR {
    return hn::Load(d, reinterpret_cast<const std::int32_t*>(axis.coord->lane + first));
  };
  const std::uint32_t x = grid.axis[0].coord->lane[first];
  const auto size = static_cast<std::uint32_t>(grid.axis[0].size);
  if (size < kCount || x > size - kCount) return nullptr;
  auto same = hn::Eq(coordinates(grid.axis[0]), hn::Add(hn::Set(d, static_cast<std::int32_t>(x)), hn::Iota(d, 0)));
  std::byte* at = grid.base + std::size_t{x} * kBytes;
  for (std::size_t i = 1; i < grid.axis_count; ++i) {
    const TexelAxis& axis = grid.axis[i];
    const std::uint32_t coord = axis.coord->lane[first];
    if (coord >= static_cast<std::uint32_t>(axis.size)) return nullptr;
    same = hn::And(same, hn::Eq(coordinates(axis), hn::Set(d, static_cast<std::int32_t>(coord))));
    at += std::ptrdiff_t{static_cast<std::int32_t>(coord)} * axis.stride;
  }
  return hn::AllTrue(d, same) ? at : nullptr;
}

/// Calls row<lanes>(first lane, first texel) for vectors or halves of vectors that are rows, all lanes active, and
/// others(first lane) for other vectors.
template <std::size_t kBytes, class Row, class Others>
HWY_INLINE void by_rows(const TexelGrid& grid, base::LaneMask active, Row&& row, Others&& others) {
  for (std::size_t first = 0; first < base::kWaveWidth; first += kLanes) {
    if constexpr (kInRows<kBytes>) {
      const base::LaneMask all = base::first_lanes(kLanes);
      if ((active >> first & all) == all) {
        if (std::byte* const texels = row_of<kBytes, kLanes>(grid, first)) {
          row.template operator()<kLanes>(first, texels);
          continue;
        }
        if constexpr (kInHalves<kBytes>) {
          std::byte* const low = row_of<kBytes, kHalf>(grid, first);
          std::byte* const high = low != nullptr ? row_of<kBytes, kHalf>(grid, first + kHalf) : nullptr;
          if (high != nullptr) {
            row.template operator()<kHalf>(first, low);
            row.template operator()<kHalf>(first + kHalf, high);
            continue;
          }
        }
      }
    }
    others(first);
  }
}

/// Texels of a vector that is no row. What lies outside is 0.
template <std::size_t kBytes>
HWY_NOINLINE void load_others(const TexelGrid& grid, base::LaneMask active, std::size_t first,
                              base::WaveRegister words[4]) {
  IntLanes offset;
  const base::LaneMask wanted = place_lanes(grid, active, first, offset);
  load_wanted_lanes<kBytes>(grid.base, wanted, offset, first, words);
}

template <std::size_t kBytes>
HWY_NOINLINE void load_texels(const TexelGrid& grid, base::LaneMask active, base::WaveRegister words[4]) {
  by_rows<kBytes>(
      grid, active,
      [&]<std::size_t kCount>(std::size_t first, const std::byte* texels)
          HWY_ATTR { load_adjacent<kBytes, kCount>(texels, first, words); },
      [&](std::size_t first) HWY_ATTR { load_others<kBytes>(grid, active, first, words); });
}

template <std::size_t kBytes>
HWY_NOINLINE void store_others(const TexelGrid& grid, base::LaneMask active, std::size_t first,
                               const base::WaveRegister words[4]) {
  constexpr std::size_t kWords = (kBytes + 3) / 4;
  IntLanes offset;
  base::for_each_lane(place_lanes(grid, active, first, offset) << first, [&](std::size_t lane) {
    std::uint32_t texel[kWords];
    for (std::size_t i = 0; i < kWords; ++i) texel[i] = words[i].lane[lane];
    std::memcpy(grid.base + offset.lane[lane], texel, kBytes);
  });
}

template <std::size_t kBytes>
HWY_NOINLINE void store_texels(const TexelGrid& grid, base::LaneMask active, const base::WaveRegister words[4]) {
  by_rows<kBytes>(
      grid, active,
      [&]<std::size_t kCount>(std::size_t first, std::byte* texels)
          HWY_ATTR { store_adjacent<kBytes, kCount>(words, first, texels); },
      [&](std::size_t first) HWY_ATTR { store_others<kBytes>(grid, active, first, words); });
}

PreparedFetch::Load load_of(const FormatDesc& format) {
  return by_texel_bytes(format, []<std::size_t kBytes>() -> PreparedFetch::Load { return load_texels<kBytes>; });
}

PreparedStore::Store store_of(const FormatDesc& format) {
  return by_texel_bytes(format, []<std::size_t kBytes>() -> PreparedStore::Store { return store_texels<kBytes>; });
}

}  // namespace
}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vitrine::texel {
namespace {

HWY_EXPORT(load_of);
HWY_EXPORT(store_of);

}  // namespace

PreparedFetch::Load texel_load(const FormatDesc& format) {
  base::select_simd_target();
  return HWY_DYNAMIC_DISPATCH(load_of)(format);
}

PreparedStore::Store texel_store(const FormatDesc& format) {
  base::select_simd_target();
  return HWY_DYNAMIC_DISPATCH(store_of)(format);
}

}  // namespace vitrine::texel

#endif

// Averages of two by two texels by SIMD, from bytes to bytes (lavapipe-texture-blend.md A3).
#include "texel/transfer/halve_rows.h"

#include <algorithm>
#include <cstring>
#include <type_traits>

#include "texel/codec/rows.h"
#include "texel/codec/srgb.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "texel/transfer/halve_rows.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "texel/codec/byte_blend-inl.h"
#include "texel/codec/four_bytes-inl.h"
#include "texel/codec/half-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {
namespace {

constexpr std::size_t kChunk = 64;

/// Texels of one row by turns, each T a texel.
template <class T>
struct Pairs {
  alignas(64) T first[kChunk]{};
  alignas(64) T second[kChunk]{};

  HWY_INLINE void split(const std::byte* from, std::size_t count) {
    const hn::ScalableTag<T> d;
    const auto* source = reinterpret_cast<const T*>(from);
    const std::size_t lanes = hn::Lanes(d);
    std::size_t i = 0;
    for (; i + lanes <= count; i += lanes) {
      const auto low = hn::LoadU(d, source + 2 * i), high = hn::LoadU(d, source + 2 * i + lanes);
      hn::Store(hn::ConcatEven(d, high, low), d, first + i);
      hn::Store(hn::ConcatOdd(d, high, low), d, second + i);
    }
    for (; i < count; ++i) {
      std::memcpy(&first[i], from + 2 * i * sizeof(T), sizeof(T));
      std::memcpy(&second[i], from + (2 * i + 1) * sizeof(T), sizeof(T));
    }
  }
};

/// Calls body(start, n) with both rows split, for at most kChunk texels at a time.
template <class T, class Body>
HWY_INLINE void for_each_chunk(const HalvedRow& row, Body&& body) {
  Pairs<T> upper, lower;
  for (std::size_t start = 0; start < row.count; start += kChunk) {
    const std::size_t n = std::min(kChunk, row.count - start);
    upper.split(row.upper + 2 * start * sizeof(T), n);
    lower.split(row.lower + 2 * start * sizeof(T), n);
    body(start, n, upper, lower);
  }
}

void halve_words(const HalvedRow& row) {
  const hn::ScalableTag<std::uint32_t> d;
  const hn::RebindToSigned<decltype(d)> di;
  const auto weight_y = spread_weight(hn::Set(di, row.byte_weight_y));
  alignas(64) std::int32_t weight[kChunk]{};
  alignas(64) std::uint32_t out[kChunk];
  for_each_chunk<std::uint32_t>(row, [&](std::size_t start, std::size_t n, const auto& upper, const auto& lower) {
    std::copy_n(row.byte_weight_x + start, n, weight);
    for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
      const auto x = spread_weight(hn::Load(di, weight + i));
      const auto blend = [&](const Pairs<std::uint32_t>& pairs) {
        return blend_bytes(x, unpack_bytes(hn::Load(d, pairs.first + i)), unpack_bytes(hn::Load(d, pairs.second + i)));
      };
      hn::Store(pack_bytes(blend_bytes(weight_y, blend(upper), blend(lower))), d, out + i);
    }
    std::memcpy(row.out + 4 * start, out, 4 * n);
  });
}

using D = ComponentTag;
using DI = hn::RebindToSigned<D>;

HWY_INLINE ComponentLanes mix(ComponentLanes weight, ComponentLanes a, ComponentLanes b) {
  return lanes_fma(weight, hn::Sub(b, a), a);
}

/// Blocks of 128 bits 0, 2, ... of two vectors one after the other, or 1, 3, ...
#if HWY_TARGET <= HWY_AVX3
HWY_INLINE ComponentLanes even_blocks(ComponentLanes low, ComponentLanes high) {
  return ComponentLanes{_mm512_shuffle_f32x4(low.raw, high.raw, 0x88)};
}
HWY_INLINE ComponentLanes odd_blocks(ComponentLanes low, ComponentLanes high) {
  return ComponentLanes{_mm512_shuffle_f32x4(low.raw, high.raw, 0xDD)};
}
#elif HWY_TARGET <= HWY_AVX2
HWY_INLINE ComponentLanes even_blocks(ComponentLanes low, ComponentLanes high) {
  return hn::ConcatLowerLower(D(), high, low);
}
HWY_INLINE ComponentLanes odd_blocks(ComponentLanes low, ComponentLanes high) {
  return hn::ConcatUpperUpper(D(), high, low);
}
#else
HWY_INLINE ComponentLanes even_blocks(ComponentLanes low, ComponentLanes) { return low; }
HWY_INLINE ComponentLanes odd_blocks(ComponentLanes, ComponentLanes high) { return high; }
#endif

/// Four values of one component.
struct Square {
  ComponentLanes upper[2], lower[2];
};

/// Of values in [0, 1], as is the result.
HWY_INLINE ComponentLanes average(ComponentLanes x, ComponentLanes y, const Square& s) {
  return mix(y, mix(x, s.upper[0], s.upper[1]), mix(x, s.lower[0], s.lower[1]));
}

/// srgb_codes, in [0, 255] as x is in [0, 1]. RSQRTPS has no instance for 512 bits: halves from the start.
template <class Rsqrt>
HWY_INLINE CodeLanes codes_of_values(ComponentLanes x) {
#if HWY_TARGET <= HWY_AVX3
  const hn::Half<D> half;
  return hn::Combine(DI(), srgb_codes(Rsqrt(), hn::UpperHalf(half, x)), srgb_codes(Rsqrt(), hn::LowerHalf(half, x)));
#else
  return srgb_codes(Rsqrt(), x);
#endif
}

/// The averages of a b over c d, one component of a vector of texels at a time.
template <class Rsqrt>
HWY_INLINE CodeLanes average_srgb_bytes(ComponentLanes weight_x, ComponentLanes weight_y, CodeLanes a, CodeLanes b,
                                        CodeLanes c, CodeLanes d) {
  const auto byte = [](CodeLanes word, auto shift)
                        HWY_ATTR { return hn::And(hn::ShiftRight<shift()>(word), hn::Set(DI(), 255)); };
  const auto color = [&](auto shift) HWY_ATTR {
    const auto value = [&](CodeLanes word) HWY_ATTR { return srgb_to_linear(byte(word, shift)); };
    const Square square{{value(a), value(b)}, {value(c), value(d)}};
    return hn::ShiftLeft<shift()>(codes_of_values<Rsqrt>(average(weight_x, weight_y, square)));
  };
  const auto opacity = [&](CodeLanes word)
                           HWY_ATTR { return unorm_values(byte(word, std::integral_constant<int, 24>())); };
  const Square alpha{{opacity(a), opacity(b)}, {opacity(c), opacity(d)}};
  const CodeLanes texels = hn::ShiftLeft<24>(unorm_codes(average(weight_x, weight_y, alpha)));
  return hn::Or(hn::Or(texels, color(std::integral_constant<int, 0>())),
                hn::Or(color(std::integral_constant<int, 8>()), color(std::integral_constant<int, 16>())));
}

/// The averages of texels a b over c d of 11, 11 and 10 bits.
HWY_INLINE CodeLanes average_small_floats(ComponentLanes weight_x, ComponentLanes weight_y, CodeLanes a, CodeLanes b,
                                          CodeLanes c, CodeLanes d) {
  const auto channel = [&](auto shift, auto bits) HWY_ATTR {
    const auto value = [&](CodeLanes word) HWY_ATTR {
      const auto mask = hn::Set(DI(), ((1 << bits()) - 1) << (15 - bits()));
      const auto moved = shift() < 15 - bits() ? hn::ShiftLeft<15 - bits()>(word)
                                               : hn::ShiftRight<std::max(0, shift() + bits() - 15)>(word);
      const hn::Rebind<std::uint16_t, D> d16;
      return floats_of_halves_quieted(hn::DemoteTo(d16, hn::And(moved, mask)));
    };
    const Square square{{value(a), value(b)}, {value(c), value(d)}};
    return hn::ShiftLeft<shift()>(
        hn::BitCast(DI(), unsigned_floats_of_floats(average(weight_x, weight_y, square), bits())));
  };
  using std::integral_constant;
  return hn::Or(hn::Or(channel(integral_constant<int, 0>(), integral_constant<int, 11>()),
                       channel(integral_constant<int, 11>(), integral_constant<int, 11>())),
                channel(integral_constant<int, 22>(), integral_constant<int, 10>()));
}

/// Texels of one word; average_of(weight x, weight y, a, b, c, d) averages vectors of texels a b over c d.
template <class Average>
HWY_INLINE void halve_pairs_of_words(const HalvedRow& row, Average&& average_of) {
  const auto weight_y = hn::Set(D(), row.weight_y);
  const std::size_t lanes = hn::Lanes(D());
  const auto average_pairs = [&](const std::byte* upper, const std::byte* lower, const float* weight) HWY_ATTR {
    const auto load = [&](const std::byte* from, std::size_t i)
                          HWY_ATTR { return hn::LoadU(DI(), reinterpret_cast<const std::int32_t*>(from) + i * lanes); };
    const auto top0 = load(upper, 0), top1 = load(upper, 1), bottom0 = load(lower, 0), bottom1 = load(lower, 1);
    return average_of(hn::LoadU(D(), weight), weight_y, hn::ConcatEven(DI(), top1, top0),
                      hn::ConcatOdd(DI(), top1, top0), hn::ConcatEven(DI(), bottom1, bottom0),
                      hn::ConcatOdd(DI(), bottom1, bottom0));
  };
  std::size_t i = 0;
  for (; i + lanes <= row.count; i += lanes) {
    hn::StoreU(average_pairs(row.upper + 8 * i, row.lower + 8 * i, row.weight_x + i), DI(),
               reinterpret_cast<std::int32_t*>(row.out + 4 * i));
  }
  if (i == row.count) return;
  const std::size_t left = row.count - i;
  alignas(64) std::byte upper[8 * hn::MaxLanes(D())]{}, lower[8 * hn::MaxLanes(D())]{};
  alignas(64) float weight[hn::MaxLanes(D())]{};
  alignas(64) std::int32_t out[hn::MaxLanes(D())];
  std::memcpy(upper, row.upper + 8 * i, 8 * left);
  std::memcpy(lower, row.lower + 8 * i, 8 * left);
  std::copy_n(row.weight_x + i, left, weight);
  hn::Store(average_pairs(upper, lower, weight), DI(), out);
  std::memcpy(row.out + 4 * i, out, 4 * left);
}

template <class Rsqrt>
void halve_srgb(const HalvedRow& row) {
  halve_pairs_of_words(row, [](auto x, auto y, auto a, auto b, auto c, auto d)
                                HWY_ATTR { return average_srgb_bytes<Rsqrt>(x, y, a, b, c, d); });
}
/// Only where cpu_has_rsqrt().
void halve_srgb_bytes(const HalvedRow& row) { halve_srgb<RsqrtOfCpu>(row); }
void halve_srgb_bytes_by_table(const HalvedRow& row) { halve_srgb<RsqrtByTable>(row); }
void halve_small_floats(const HalvedRow& row) {
  halve_pairs_of_words(row, [](auto x, auto y, auto a, auto b, auto c, auto d)
                                HWY_ATTR { return average_small_floats(x, y, a, b, c, d); });
}

/// Texels of one byte: pairs of them are 16-bit lanes.
void halve_single_bytes(const HalvedRow& row) {
  constexpr std::size_t kLanes = hn::MaxLanes(D16());
  const hn::Rebind<std::uint8_t, D16> d8;
  const hn::Rebind<std::int16_t, DI> d_half;
  const V16 weight_y = hn::Set(D16(), static_cast<std::int16_t>(128 * row.byte_weight_y));
  const auto average_pairs = [&](const std::byte* upper, const std::byte* lower, const std::int32_t* weight) HWY_ATTR {
    const auto half = [&](std::size_t i)
                          HWY_ATTR { return hn::DemoteTo(d_half, hn::LoadU(DI(), weight + i * hn::Lanes(DI()))); };
    const V16 weight_x = hn::ShiftLeft<7>(hn::Combine(D16(), half(1), half(0)));
    const auto blend = [](V16 w, V16 a, V16 b) HWY_ATTR { return hn::Add(a, rounded_product(w, hn::Sub(b, a))); };
    const auto mix_pairs = [&](const std::byte* from) HWY_ATTR {
      const hn::RebindToUnsigned<D16> pairs;
      const auto pair = hn::LoadU(pairs, reinterpret_cast<const std::uint16_t*>(from));
      return blend(weight_x, hn::BitCast(D16(), hn::And(pair, hn::Set(pairs, std::uint16_t{255}))),
                   hn::BitCast(D16(), hn::ShiftRight<8>(pair)));
    };
    return hn::DemoteTo(d8, blend(weight_y, mix_pairs(upper), mix_pairs(lower)));
  };
  std::size_t i = 0;
  for (; i + kLanes <= row.count; i += kLanes) {
    hn::StoreU(average_pairs(row.upper + 2 * i, row.lower + 2 * i, row.byte_weight_x + i), d8,
               reinterpret_cast<std::uint8_t*>(row.out + i));
  }
  if (i == row.count) return;
  const std::size_t left = row.count - i;
  alignas(64) std::byte upper[2 * kLanes]{}, lower[2 * kLanes]{};
  alignas(64) std::int32_t weight[kLanes]{};
  alignas(64) std::uint8_t out[kLanes];
  std::memcpy(upper, row.upper + 2 * i, 2 * left);
  std::memcpy(lower, row.lower + 2 * i, 2 * left);
  std::copy_n(row.byte_weight_x + i, left, weight);
  hn::Store(average_pairs(upper, lower, weight), d8, out);
  std::memcpy(row.out + i, out, left);
}

/// A vector of halves or floats.
template <bool kHalves>
HWY_INLINE ComponentLanes load_components(const std::byte* from, std::size_t vector) {
  if constexpr (kHalves) {
    const hn::Rebind<std::uint16_t, D> d16;
    return floats_of_halves_quieted(
        hn::LoadU(d16, reinterpret_cast<const std::uint16_t*>(from) + vector * hn::Lanes(D())));
  } else {
    return hn::LoadU(D(), reinterpret_cast<const float*>(from) + vector * hn::Lanes(D()));
  }
}
template <bool kHalves>
HWY_INLINE void store_components(ComponentLanes value, std::byte* to) {
  if constexpr (kHalves) {
    hn::StoreU(halves_of_floats(value), hn::Rebind<std::uint16_t, D>(), reinterpret_cast<std::uint16_t*>(to));
  } else {
    hn::StoreU(value, D(), reinterpret_cast<float*>(to));
  }
}

/// Four weights, or of two components as many as a vector holds texels.
template <std::size_t kComponents>
HWY_INLINE ComponentLanes load_weights(const float* from) {
  if constexpr (kComponents == 4)
    return hn::LoadDup128(D(), from);
  else
    return hn::ZeroExtendVector(D(), hn::LoadU(hn::Half<D>(), from));
}

/// The components of some texels at a time: blocks of 128 bits are texels of four, 64 bits texels of two.
template <bool kHalves, std::size_t kComponents>
HWY_INLINE void halve_components(const HalvedRow& row) {
  constexpr std::size_t kTexel = kComponents * (kHalves ? 2 : 4);
  const hn::Repartition<double, D> d64;
  const auto texel_of_lane = hn::IndicesFromVec(D(), hn::ShiftRight < kComponents == 4 ? 2 : 1 > (hn::Iota(DI(), 0)));
  const auto weight_y = hn::Set(D(), row.weight_y);
  const std::size_t texels = hn::Lanes(D()) / kComponents;
  alignas(64) std::byte upper[8 * hn::MaxLanes(D())]{}, lower[8 * hn::MaxLanes(D())]{}, out[4 * hn::MaxLanes(D())];
  alignas(64) float weight[hn::MaxLanes(D())]{};
  for (std::size_t i = 0; i < row.count; i += texels) {
    const std::size_t n = std::min(texels, row.count - i);
    const auto mix_pairs = [&](ComponentLanes x, const std::byte* from) HWY_ATTR {
      const auto low = load_components<kHalves>(from, 0), high = load_components<kHalves>(from, 1);
      if constexpr (kComponents == 4) {
        return mix(x, even_blocks(low, high), odd_blocks(low, high));
      } else {
        const auto a = hn::BitCast(d64, low), b = hn::BitCast(d64, high);
        return mix(x, hn::BitCast(D(), hn::ConcatEven(d64, b, a)), hn::BitCast(D(), hn::ConcatOdd(d64, b, a)));
      }
    };
    const std::byte *top = row.upper + 2 * kTexel * i, *bottom = row.lower + 2 * kTexel * i;
    // Of four components, as many weights are read, whatever the size of vectors.
    if (i + (kComponents == 4 ? 4 : texels) <= row.count) {
      const auto x = hn::TableLookupLanes(load_weights<kComponents>(row.weight_x + i), texel_of_lane);
      store_components<kHalves>(mix(weight_y, mix_pairs(x, top), mix_pairs(x, bottom)), row.out + kTexel * i);
      continue;
    }
    std::copy_n(row.weight_x + i, n, weight);
    const auto x = hn::TableLookupLanes(hn::Load(D(), weight), texel_of_lane);
    std::memcpy(upper, top, 2 * kTexel * n);
    std::memcpy(lower, bottom, 2 * kTexel * n);
    store_components<kHalves>(mix(weight_y, mix_pairs(x, upper), mix_pairs(x, lower)), out);
    std::memcpy(row.out + kTexel * i, out, kTexel * n);
  }
}

void halve_four_halves(const HalvedRow& row) { halve_components<true, 4>(row); }
void halve_two_halves(const HalvedRow& row) { halve_components<true, 2>(row); }
void halve_texels(const HalvedRow& row) { halve_components<false, 4>(row); }

}  // namespace
}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vitrine::texel {
namespace {

HWY_EXPORT(halve_words);
HWY_EXPORT(halve_single_bytes);
HWY_EXPORT(halve_small_floats);
HWY_EXPORT(halve_srgb_bytes);
HWY_EXPORT(halve_srgb_bytes_by_table);
HWY_EXPORT(halve_four_halves);
HWY_EXPORT(halve_texels);
HWY_EXPORT(halve_two_halves);

}  // namespace

RowHalver texel_halver() {
  base::select_simd_target();
  return HWY_DYNAMIC_DISPATCH(halve_texels);
}

RowHalver word_halver() {
  base::select_simd_target();
  return HWY_DYNAMIC_DISPATCH(halve_words);
}

RowHalver row_halver(const FormatDesc& format, bool bytes) {
  base::select_simd_target();
  if (bytes && format.block_bytes == 1 && format.channel[0].bits == 8) return HWY_DYNAMIC_DISPATCH(halve_single_bytes);
  if (bytes) return is_four_bytes(format) ? HWY_DYNAMIC_DISPATCH(halve_words) : nullptr;
  if (format.format == VK_FORMAT_B10G11R11_UFLOAT_PACK32) return HWY_DYNAMIC_DISPATCH(halve_small_floats);
  if (is_four_halves(format)) return HWY_DYNAMIC_DISPATCH(halve_four_halves);
  if (format.format == VK_FORMAT_R16G16_SFLOAT) return HWY_DYNAMIC_DISPATCH(halve_two_halves);
  if (format.format == VK_FORMAT_R32G32B32A32_SFLOAT) return texel_halver();
  if (!is_srgb_bytes(format)) return nullptr;
  return cpu_has_rsqrt() ? HWY_DYNAMIC_DISPATCH(halve_srgb_bytes) : HWY_DYNAMIC_DISPATCH(halve_srgb_bytes_by_table);
}

}  // namespace vitrine::texel

#endif

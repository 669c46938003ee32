// Averages of two by two texels by SIMD, from bytes to bytes (lavapipe-texture-blend.md A3).
#include "texel/transfer/halve_rows.h"

#include <algorithm>
#include <cstring>

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

/// Four values of one component.
struct Square {
  ComponentLanes upper[2], lower[2];
};

HWY_INLINE ComponentLanes average(ComponentLanes x, ComponentLanes y, const Square& s) {
  const ComponentLanes value = mix(y, mix(x, s.upper[0], s.upper[1]), mix(x, s.lower[0], s.lower[1]));
  return lanes_min_second(lanes_max_second(value, hn::Zero(D())), hn::Set(D(), 1.0f));
}

/// One component of a vector of texels at a time.
void halve_srgb_bytes(const HalvedRow& row) {
  const auto weight_y = hn::Set(D(), row.weight_y);
  alignas(64) float weight[kChunk]{};
  alignas(64) std::int32_t out[kChunk];
  for_each_chunk<std::int32_t>(row, [&](std::size_t start, std::size_t n, const auto& upper, const auto& lower) {
    std::copy_n(row.weight_x + start, n, weight);
    for (std::size_t i = 0; i < n; i += hn::Lanes(D())) {
      const auto weight_x = hn::Load(D(), weight + i);
      const auto a = hn::Load(DI(), upper.first + i), b = hn::Load(DI(), upper.second + i);
      const auto c = hn::Load(DI(), lower.first + i), d = hn::Load(DI(), lower.second + i);
      const auto byte = [](CodeLanes word, int shift) {
        return hn::And(hn::ShiftRightSame(word, shift), hn::Set(DI(), 255));
      };
      const auto opacity = [&](CodeLanes word) { return unorm_values(byte(word, 24)); };
      const Square alpha{{opacity(a), opacity(b)}, {opacity(c), opacity(d)}};
      CodeLanes texels = hn::ShiftLeft<24>(unorm_codes(average(weight_x, weight_y, alpha)));
      for (int shift = 0; shift < 24; shift += 8) {
        const auto value = [&](CodeLanes word) { return srgb_to_linear(byte(word, shift)); };
        const Square color{{value(a), value(b)}, {value(c), value(d)}};
        const CodeLanes code = srgb_codes(RsqrtOfCpu(), average(weight_x, weight_y, color));
        const CodeLanes clamped = hn::Min(hn::Max(code, hn::Zero(DI())), hn::Set(DI(), 255));
        texels = hn::Or(texels, hn::ShiftLeftSame(clamped, shift));
      }
      hn::Store(texels, DI(), out + i);
    }
    std::memcpy(row.out + 4 * start, out, 4 * n);
  });
}

/// The components of some texels at a time.
void halve_four_halves(const HalvedRow& row) {
  const hn::Rebind<std::uint16_t, D> d16;
  const auto texel_of_lane = hn::IndicesFromVec(D(), hn::ShiftRight<2>(hn::Iota(DI(), 0)));
  const auto weight_y = hn::Set(D(), row.weight_y);
  float weight[kChunk + hn::MaxLanes(D())]{};
  alignas(64) std::uint16_t out[4 * kChunk];
  for_each_chunk<std::uint64_t>(row, [&](std::size_t start, std::size_t n, const auto& upper, const auto& lower) {
    std::copy_n(row.weight_x + start, n, weight);
    for (std::size_t i = 0; i < 4 * n; i += hn::Lanes(D())) {
      const auto x = hn::TableLookupLanes(hn::LoadU(D(), weight + i / 4), texel_of_lane);
      const auto load = [&](const std::uint64_t* texels) {
        return floats_of_halves(hn::LoadU(d16, reinterpret_cast<const std::uint16_t*>(texels) + i));
      };
      const auto top = mix(x, load(upper.first), load(upper.second));
      const auto bottom = mix(x, load(lower.first), load(lower.second));
      hn::StoreU(halves_of_floats(mix(weight_y, top, bottom)), d16, out + i);
    }
    std::memcpy(row.out + 8 * start, out, 8 * n);
  });
}

}  // namespace
}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vitrine::texel {
namespace {

HWY_EXPORT(halve_words);
HWY_EXPORT(halve_srgb_bytes);
HWY_EXPORT(halve_four_halves);

}  // namespace

RowHalver row_halver(const FormatDesc& format, bool bytes) {
  base::select_simd_target();
  if (bytes) return is_four_bytes(format) ? HWY_DYNAMIC_DISPATCH(halve_words) : nullptr;
  if (is_four_halves(format)) return HWY_DYNAMIC_DISPATCH(halve_four_halves);
  return is_srgb_bytes(format) && cpu_has_rsqrt() ? HWY_DYNAMIC_DISPATCH(halve_srgb_bytes) : nullptr;
}

}  // namespace vitrine::texel

#endif

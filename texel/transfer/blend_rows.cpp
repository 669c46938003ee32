// Row blends by SIMD (lavapipe-texture-blend.md A3): a + ((w * (b - a) + 128) >> 8) on bytes, fma(w, b - a, a) on
// floats.
#include "texel/transfer/blend_rows.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "texel/transfer/blend_rows.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "texel/codec/byte_blend-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::texel::HWY_NAMESPACE {
namespace {

constexpr std::size_t kChunk = 256;

void blend_word_columns(const std::uint32_t* source, const std::int32_t* first, const std::int32_t* second,
                        const std::int32_t* weight, std::size_t count, std::uint32_t* out) {
  const hn::ScalableTag<std::uint32_t> d;
  const hn::RebindToSigned<decltype(d)> di;
  alignas(64) std::uint32_t a[kChunk], b[kChunk], blended[kChunk];
  alignas(64) std::int32_t weights[kChunk];
  for (std::size_t start = 0; start < count; start += kChunk) {
    const std::size_t n = std::min(kChunk, count - start);
    for (std::size_t i = 0; i < n; ++i) {
      a[i] = source[first[start + i]];
      b[i] = source[second[start + i]];
    }
    std::copy_n(weight + start, n, weights);
    for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
      const auto w = spread_weight(hn::Load(di, weights + i));
      const auto mixed = blend_bytes(w, unpack_bytes(hn::Load(d, a + i)), unpack_bytes(hn::Load(d, b + i)));
      hn::Store(pack_bytes(mixed), d, blended + i);
    }
    std::copy_n(blended, n, out + start);
  }
}

void blend_word_rows(const std::uint32_t* a, const std::uint32_t* b, std::int32_t weight, std::size_t count,
                     std::uint32_t* out) {
  const hn::ScalableTag<std::uint32_t> d;
  const auto w = spread_weight(hn::Set(hn::RebindToSigned<decltype(d)>(), weight));
  const std::size_t lanes = hn::Lanes(d);
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    const auto mixed = blend_bytes(w, unpack_bytes(hn::LoadU(d, a + i)), unpack_bytes(hn::LoadU(d, b + i)));
    hn::StoreU(pack_bytes(mixed), d, out + i);
  }
  if (i == count) return;
  alignas(64) std::uint32_t rest[3][64] = {};
  std::copy_n(a + i, count - i, rest[0]);
  std::copy_n(b + i, count - i, rest[1]);
  hn::Store(pack_bytes(blend_bytes(w, unpack_bytes(hn::Load(d, rest[0])), unpack_bytes(hn::Load(d, rest[1])))), d,
            rest[2]);
  std::copy_n(rest[2], count - i, out + i);
}

using D4 = hn::Full128<float>;

HWY_INLINE hn::Vec<D4> load_texel(const Texel& texel) {
  return hn::BitCast(D4(), hn::LoadU(hn::RebindToUnsigned<D4>(), texel.data()));
}
HWY_INLINE void store_texel(hn::Vec<D4> value, Texel& texel) {
  hn::StoreU(hn::BitCast(hn::RebindToUnsigned<D4>(), value), hn::RebindToUnsigned<D4>(), texel.data());
}

void blend_texel_columns(const Texel* source, const std::int32_t* first, const std::int32_t* second,
                         const float* weight, std::size_t count, Texel* out) {
  for (std::size_t i = 0; i < count; ++i) {
    const auto a = load_texel(source[first[i]]), b = load_texel(source[second[i]]);
    store_texel(lanes_fma(hn::Set(D4(), weight[i]), hn::Sub(b, a), a), out[i]);
  }
}

void blend_texel_rows(const Texel* a, const Texel* b, float weight, std::size_t count, Texel* out) {
  const auto w = hn::Set(D4(), weight);
  for (std::size_t i = 0; i < count; ++i) {
    const auto first = load_texel(a[i]);
    store_texel(lanes_fma(w, hn::Sub(load_texel(b[i]), first), first), out[i]);
  }
}

}  // namespace
}  // namespace vitrine::texel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vitrine::texel {
namespace {

HWY_EXPORT(blend_word_columns);
HWY_EXPORT(blend_word_rows);
HWY_EXPORT(blend_texel_columns);
HWY_EXPORT(blend_texel_rows);

}  // namespace

void blend_columns(const std::uint32_t* source, const std::int32_t* first, const std::int32_t* second,
                   const std::int32_t* weight, std::size_t count, std::uint32_t* out) {
  base::select_simd_target();
  HWY_DYNAMIC_DISPATCH(blend_word_columns)(source, first, second, weight, count, out);
}

void blend_columns(const Texel* source, const std::int32_t* first, const std::int32_t* second, const float* weight,
                   std::size_t count, Texel* out) {
  base::select_simd_target();
  HWY_DYNAMIC_DISPATCH(blend_texel_columns)(source, first, second, weight, count, out);
}

void blend_rows(const std::uint32_t* a, const std::uint32_t* b, std::int32_t weight, std::size_t count,
                std::uint32_t* out) {
  base::select_simd_target();
  HWY_DYNAMIC_DISPATCH(blend_word_rows)(a, b, weight, count, out);
}

void blend_rows(const Texel* a, const Texel* b, float weight, std::size_t count, Texel* out) {
  base::select_simd_target();
  HWY_DYNAMIC_DISPATCH(blend_texel_rows)(a, b, weight, count, out);
}

}  // namespace vitrine::texel

#endif

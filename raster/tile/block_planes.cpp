// Planes over whole blocks and waves of spans, a vector of lanes at a time.
#include "raster/tile/block_planes.h"

#include "base/simd.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/tile/block_planes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/lane_math-inl.h"
#include "base/x86_arithmetic-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::raster::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using base::HWY_NAMESPACE::x86_fma;
using base::HWY_NAMESPACE::x86_mul;

/// Places of the lanes of one row of quads.
alignas(64) constexpr float kRowX[16] = {0, 1, 0, 1, 2, 3, 2, 3, 4, 5, 4, 5, 6, 7, 6, 7};
alignas(64) constexpr float kRowY[16] = {0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1};

template <bool kScales>
HWY_INLINE void evaluate_planes(const PlaneSet& planes, const BlockVarying* varying, std::size_t count, float x,
                                float y, const float* scale) {
  const hn::CappedTag<float, 16> f;
  const std::size_t n = hn::Lanes(f);
  for (std::size_t i = 0; i < 16; i += n) {
    // The sums are exact: whole numbers, or halves on top of them.
    const auto fx = hn::Add(hn::Set(f, x), hn::Load(f, kRowX + i));
    const auto y0 = hn::Add(hn::Set(f, y), hn::Load(f, kRowY + i)), y1 = hn::Add(y0, hn::Set(f, 2.0f));
    const auto y2 = hn::Add(y0, hn::Set(f, 4.0f)), y3 = hn::Add(y0, hn::Set(f, 6.0f));
    for (std::size_t k = 0; k < count; ++k) {
      const std::uint32_t plane = varying[k].plane;
      float* out = varying[k].out + i;
      const auto inner = x86_fma(hn::Set(f, planes.dadx[plane]), fx, hn::Set(f, planes.a0[plane]));
      const auto dady = hn::Set(f, planes.dady[plane]);
      const auto store = [&](auto row_y, std::size_t r) {
        auto v = x86_fma(dady, row_y, inner);
        if constexpr (kScales) v = x86_mul(v, hn::Load(f, scale + 16 * r + i));
        hn::Store(v, f, out + 16 * r);
      };
      store(y0, 0);
      store(y1, 1);
      store(y2, 2);
      store(y3, 3);
    }
  }
}

void evaluate_all(const PlaneSet& planes, const BlockVarying* varying, std::size_t count, float x, float y,
                  const float* scale) {
  if (scale)
    evaluate_planes<true>(planes, varying, count, x, y, scale);
  else
    evaluate_planes<false>(planes, varying, count, x, y, nullptr);
}

/// Places of the quads of lanes 0..15, and of the lanes in their quads.
alignas(64) constexpr std::uint32_t kQuadShift[16] = {0, 0, 0, 0, 4, 4, 4, 4, 8, 8, 8, 8, 12, 12, 12, 12};
alignas(64) constexpr std::uint32_t kQuadX[16] = {0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1};
alignas(64) constexpr std::uint32_t kQuadY[16] = {0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1};

template <bool kScales>
HWY_INLINE void evaluate_places(const PlaneSet& planes, const BlockVarying* varying, std::size_t count,
                                const SpanWave& wave, float center, const float* scale) {
  const hn::CappedTag<float, 16> f;
  const hn::RebindToUnsigned<decltype(f)> u;
  const hn::RebindToSigned<decltype(f)> i32;
  const auto shift = hn::Load(u, kQuadShift), nibble = hn::Set(u, 30);
  // `first`: the window's; `quads`: four bits each.
  const auto place = [&](int first, std::uint64_t quads, const std::uint32_t* in_quad) HWY_ATTR {
    const auto twice = hn::And(hn::Shr(hn::Set(u, static_cast<std::uint32_t>(quads) << 1), shift), nibble);
    const auto whole = hn::Add(hn::Or(twice, hn::Load(u, in_quad)), hn::Set(u, static_cast<std::uint32_t>(first)));
    // The sum is exact: a whole number, or a half on top of it.
    return hn::Add(hn::ConvertTo(f, hn::BitCast(i32, whole)), hn::Set(f, center));
  };
  constexpr std::size_t n = hn::MaxLanes(f);
  for (std::size_t i = 0; i < base::kWaveWidth; i += 4 * n) {
    // Four vectors at a time, so that the coefficients are fetched once for them.
    const auto x_of = [&](std::size_t j) HWY_ATTR { return place(wave.x, wave.quad_x >> (i + j * n), kQuadX); };
    const auto y_of = [&](std::size_t j) HWY_ATTR { return place(wave.y, wave.quad_y >> (i + j * n), kQuadY); };
    const auto x0 = x_of(0), x1 = x_of(1), x2 = x_of(2), x3 = x_of(3);
    const auto y0 = y_of(0), y1 = y_of(1), y2 = y_of(2), y3 = y_of(3);
    for (const BlockVarying* v = varying; v != varying + count; ++v) {
      const auto a0 = hn::Set(f, planes.a0[v->plane]), dadx = hn::Set(f, planes.dadx[v->plane]);
      const auto dady = hn::Set(f, planes.dady[v->plane]);
      float* out = v->out + i;
      const auto store = [&](auto x, auto y, std::size_t j) HWY_ATTR {
        auto value = x86_fma(dady, y, x86_fma(dadx, x, a0));
        if constexpr (kScales) value = x86_mul(value, hn::Load(f, scale + i + j * n));
        hn::Store(value, f, out + j * n);
      };
      store(x0, y0, 0);
      store(x1, y1, 1);
      store(x2, y2, 2);
      store(x3, y3, 3);
    }
  }
}

void evaluate_in_spans(const PlaneSet& planes, const BlockVarying* varying, std::size_t count, const SpanWave& wave,
                       float center, const float* scale) {
  if (scale)
    evaluate_places<true>(planes, varying, count, wave, center, scale);
  else
    evaluate_places<false>(planes, varying, count, wave, center, nullptr);
}

}  // namespace
}  // namespace vitrine::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vitrine::raster {

HWY_EXPORT(evaluate_all);
HWY_EXPORT(evaluate_in_spans);

void evaluate_block(const PlaneSet& planes, const BlockVarying* varying, std::size_t count, float x, float y,
                    const float* scale) {
  HWY_DYNAMIC_DISPATCH(evaluate_all)(planes, varying, count, x, y, scale);
}

void evaluate_spans(const PlaneSet& planes, const BlockVarying* varying, std::size_t count, const SpanWave& wave,
                    float center, const float* scale) {
  HWY_DYNAMIC_DISPATCH(evaluate_in_spans)(planes, varying, count, wave, center, scale);
}

}  // namespace vitrine::raster
#endif

// Planes over whole blocks: varyings in quad order, depth tests in row order, where a row of the attachment is a
// vector.
#include <cstring>

#include "base/simd.h"
#include "raster/block.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/block_planes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/lane_math-inl.h"
#include "raster/depth_formats-inl.h"
#include "raster/lane_bits-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::raster::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using base::HWY_NAMESPACE::lanes_fma;
using base::HWY_NAMESPACE::lanes_mask_from_bits;
using base::HWY_NAMESPACE::lanes_max_second;
using base::HWY_NAMESPACE::lanes_min_second;

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
      const auto inner = lanes_fma(hn::Set(f, planes.dadx[plane]), fx, hn::Set(f, planes.a0[plane]));
      const auto dady = hn::Set(f, planes.dady[plane]);
      const auto store = [&](auto row_y, std::size_t r) {
        auto v = lanes_fma(dady, row_y, inner);
        if constexpr (kScales) v = hn::Mul(v, hn::Load(f, scale + 16 * r + i));
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

/// Square of `kSide` pixels.
template <class Format, std::size_t kSide>
HWY_INLINE base::LaneMask test_rows(const BlockDepthTest& test, const DepthPlane& plane, float x, float y,
                                    const BlockPixels& pixels, base::LaneMask rows) {
  const hn::CappedTag<float, kSide> f;
  const hn::RebindToSigned<decltype(f)> d;
  constexpr std::size_t n = hn::MaxLanes(f);
  constexpr std::uint32_t all = (1u << n) - 1;
  const auto zero = hn::Zero(f), one = hn::Set(f, 1.0f), offset = hn::Set(f, plane.offset);
  const auto dady = hn::Set(f, plane.dady);
  const DepthRange clamp = test.clamp ? *test.clamp : DepthRange{0, 1};
  const auto low = hn::Set(f, clamp.low), high = hn::Set(f, clamp.high);
  const VkCompareOp op = test.compare;
  const bool clamps = test.clamp != nullptr, write = test.write;
  base::LaneMask passed = 0;
  for (std::size_t c = 0; c < kSide; c += n) {
    const auto fx = hn::Add(hn::Set(f, x), hn::Iota(f, static_cast<float>(c)));
    const auto inner = lanes_fma(hn::Set(f, plane.dadx), fx, hn::Set(f, plane.a0));
    for (std::size_t r = 0; r < kSide; ++r) {
      const auto covered = static_cast<std::uint32_t>(rows >> (kSide * r + c)) & all;
      if (covered == 0) continue;
      auto z = hn::Add(lanes_fma(dady, hn::Set(f, y + static_cast<float>(r)), inner), offset);
      z = lanes_max_second(lanes_min_second(z, one), zero);
      if (clamps) z = lanes_max_second(lanes_min_second(z, high), low);
      std::byte* texels = pixels.first + r * pixels.pitch + c * Format::kBytes;
      const auto value = Format::encode(z);
      const auto stored = Format::load_row(d, texels);
      const auto bits = static_cast<std::uint32_t>(bits_of_mask(compare<Format>(op, value, stored))) & covered;
      passed |= base::LaneMask{bits} << (kSide * r + c);
      if (!write || bits == 0) continue;
      Format::store_row(bits == all ? value : hn::IfThenElse(lanes_mask_from_bits(d, bits), value, stored), texels);
    }
  }
  return passed;
}

template <std::size_t kSide>
HWY_INLINE base::LaneMask test_square(const BlockDepthTest& test, const DepthPlane& plane, float x, float y,
                                      const BlockPixels& pixels, base::LaneMask rows) {
  switch (test.format) {
    case DepthFormat::kD16:
      return test_rows<D16, kSide>(test, plane, x, y, pixels, rows);
    case DepthFormat::kD24:
      return test_rows<D24, kSide>(test, plane, x, y, pixels, rows);
    case DepthFormat::kD32:
      return test_rows<D32, kSide>(test, plane, x, y, pixels, rows);
    default:
      return rows;
  }
}

}  // namespace

base::LaneMask test_block(const BlockDepthTest& test, const DepthPlane& plane, float x, float y,
                          const BlockPixels& pixels, base::LaneMask rows) {
  return test_square<8>(test, plane, x, y, pixels, rows);
}
base::LaneMask test_window(const BlockDepthTest& test, const DepthPlane& plane, float x, float y,
                           const BlockPixels& pixels, base::LaneMask rows) {
  return test_square<4>(test, plane, x, y, pixels, rows);
}

}  // namespace vitrine::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vitrine::raster {

HWY_EXPORT(evaluate_all);
HWY_EXPORT(test_block);
HWY_EXPORT(test_window);

void evaluate_block(const PlaneSet& planes, const BlockVarying* varying, std::size_t count, float x, float y,
                    const float* scale) {
  HWY_DYNAMIC_DISPATCH(evaluate_all)(planes, varying, count, x, y, scale);
}

base::LaneMask test_block_depth(const BlockDepthTest& test, const DepthPlane& plane, float x, float y,
                                const BlockPixels& pixels, base::LaneMask rows) {
  return HWY_DYNAMIC_DISPATCH(test_block)(test, plane, x, y, pixels, rows);
}

std::uint32_t test_window_depth(const BlockDepthTest& test, const DepthPlane& plane, float x, float y,
                                const BlockPixels& pixels, std::uint32_t rows) {
  return static_cast<std::uint32_t>(HWY_DYNAMIC_DISPATCH(test_window)(test, plane, x, y, pixels, rows));
}

}  // namespace vitrine::raster
#endif

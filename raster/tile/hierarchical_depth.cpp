// Limits of stored depths and what they hide. A plane's depth, each of whose steps is rounded, still never falls where
// its argument rises: the corner of a block to which it falls has the depth that passes first, bit for bit.
#include "raster/tile/hierarchical_depth.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/simd.h"
#include "raster/output/depth_compare.h"
#include "raster/plan.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/tile/hierarchical_depth.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/lane_math-inl.h"
#include "raster/lane_bits-inl.h"
#include "raster/output/depth_formats-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::raster::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using base::HWY_NAMESPACE::lanes_cast;
using base::HWY_NAMESPACE::lanes_fma;
using base::HWY_NAMESPACE::lanes_max_second;
using base::HWY_NAMESPACE::lanes_min_second;

/// First pixels of the 16 blocks of two rows of them.
alignas(64) constexpr float kBlockX[16] = {0, 8, 0, 8, 16, 24, 16, 24, 32, 40, 32, 40, 48, 56, 48, 56};
alignas(64) constexpr float kBlockY[16] = {0, 0, 8, 8, 0, 0, 8, 8, 0, 0, 8, 8, 0, 0, 8, 8};

/// (x, y): the point of the block at place 0 whose depth passes first.
template <class Format>
HWY_INLINE base::LaneMask unhidden_of(const HierarchicalDepth& depths, const BlockDepthTest& test,
                                      const DepthPlane& plane, float x, float y, base::LaneMask places) {
  const hn::CappedTag<float, 16> f;
  const hn::RebindToSigned<decltype(f)> d;
  const std::size_t n = hn::Lanes(f);
  base::LaneMask result = 0;
  for (std::size_t i = 0; i < base::kWaveWidth; i += n) {
    if ((places >> i & base::first_lanes(n)) == 0) continue;
    const auto fx = hn::Add(hn::Set(f, x), hn::Load(f, kBlockX + i % 16));
    const auto fy = hn::Add(hn::Set(f, y + static_cast<float>(i - i % 16)), hn::Load(f, kBlockY + i % 16));
    const auto inner = lanes_fma(hn::Set(f, plane.dadx), fx, hn::Set(f, plane.a0));
    auto z = hn::Add(lanes_fma(hn::Set(f, plane.dady), fy, inner), hn::Set(f, plane.offset));
    z = lanes_max_second(lanes_min_second(z, hn::Set(f, 1.0f)), hn::Zero(f));
    if (test.clamp)
      z = lanes_max_second(lanes_min_second(z, hn::Set(f, test.clamp->high)), hn::Set(f, test.clamp->low));
    const auto passes = compare<Format>(test.compare, Format::encode(z), hn::Load(d, depths.limit + i));
    result |= (bits_of_mask(passes) & base::first_lanes(n)) << i;
  }
  return (result | ~depths.known) & places;
}

/// The limit of vectors of stored depths.
template <class Format, bool kLargest>
struct Limit {
  template <class V>
  static HWY_INLINE V of(V a, V b) {
    if constexpr (std::is_same_v<Format, D32>) {
      const auto fa = lanes_cast<float>(a), fb = lanes_cast<float>(b);
      return lanes_cast<std::int32_t>(kLargest ? hn::Max(fa, fb) : hn::Min(fa, fb));
    } else {
      return kLargest ? hn::Max(a, b) : hn::Min(a, b);
    }
  }
  template <class V>
  static HWY_INLINE std::int32_t across(V v) {
    alignas(64) std::int32_t lanes[16];
    const hn::DFromV<V> d;
    for (std::size_t n = hn::Lanes(d); n > 1; n /= 2) {
      hn::Store(v, d, lanes);
      v = of(v, hn::LoadU(d, lanes + n / 2));
    }
    return hn::GetLane(v);
  }
};

/// False: depths that are not numbers let everything pass.
template <class Format, bool kLargest>
HWY_INLINE bool find_limit(const BlockPixels* samples, std::uint32_t sample_count, std::size_t place_bytes_x,
                           std::size_t place_y, std::int32_t& limit) {
  const hn::CappedTag<std::int32_t, kBlockSize> d;
  const std::size_t n = hn::Lanes(d);
  auto found = hn::Zero(d);
  auto unordered = hn::MaskFromVec(found);
  for (std::uint32_t s = 0; s < sample_count; ++s) {
    const std::byte* row = samples[s].first + place_y * samples[s].pitch + place_bytes_x;
    if (s == 0) found = Format::load_row(d, row);
    for (int y = 0; y < kBlockSize; ++y, row += samples[s].pitch) {
      for (std::size_t x = 0; x < kBlockSize; x += n) {
        const auto stored = Format::load_row(d, row + x * Format::kBytes);
        if constexpr (std::is_same_v<Format, D32>)
          unordered = hn::Or(unordered, hn::RebindMask(d, hn::IsNaN(lanes_cast<float>(stored))));
        found = Limit<Format, kLargest>::of(found, stored);
      }
    }
  }
  if (!hn::AllFalse(d, unordered)) return false;
  limit = Limit<Format, kLargest>::across(found);
  return true;
}

template <class Format>
void learn_of(HierarchicalDepth& depths, const BlockPixels* samples, std::uint32_t sample_count,
              base::LaneMask places) {
  for (base::LaneMask left = places; left != 0; left &= left - 1) {
    const auto place = static_cast<std::uint32_t>(std::countr_zero(left));
    const auto x = static_cast<std::size_t>(lane_x(place) * kBlockSize * Format::kBytes);
    const auto y = static_cast<std::size_t>(lane_y(place) * kBlockSize);
    const bool numbers = depths.largest ? find_limit<Format, true>(samples, sample_count, x, y, depths.limit[place])
                                        : find_limit<Format, false>(samples, sample_count, x, y, depths.limit[place]);
    if (numbers)
      depths.known |= base::LaneMask{1} << place;
    else
      depths.known &= ~(base::LaneMask{1} << place);
  }
}

}  // namespace

base::LaneMask unhidden(const HierarchicalDepth& depths, const BlockDepthTest& test, const DepthPlane& plane, float x,
                        float y, base::LaneMask places) {
  switch (test.format) {
    case DepthFormat::kD16:
      return unhidden_of<D16>(depths, test, plane, x, y, places);
    case DepthFormat::kD24:
      return unhidden_of<D24>(depths, test, plane, x, y, places);
    default:
      return unhidden_of<D32>(depths, test, plane, x, y, places);
  }
}

void learn(HierarchicalDepth& depths, DepthFormat format, const BlockPixels* samples, std::uint32_t sample_count,
           base::LaneMask places) {
  switch (format) {
    case DepthFormat::kD16:
      return learn_of<D16>(depths, samples, sample_count, places);
    case DepthFormat::kD24:
      return learn_of<D24>(depths, samples, sample_count, places);
    default:
      return learn_of<D32>(depths, samples, sample_count, places);
  }
}

}  // namespace vitrine::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vitrine::raster {
namespace {

HWY_EXPORT(unhidden);
HWY_EXPORT(learn);

/// Looks at a block that may be in vain, in a tile's life.
constexpr std::uint8_t kPatience = 4;

}  // namespace

void HierarchicalDepth::reset() {
  known = exhausted = 0;
  std::fill(std::begin(vain), std::end(vain), std::uint8_t{0});
}

void HierarchicalDepth::begin_draw(const PipelinePlan& plan) {
  if (!plan.tests.depth_write) return;
  const VkCompareOp compare = plan.state->depth_compare;
  const bool kept = compare == VK_COMPARE_OP_NEVER || compare == VK_COMPARE_OP_EQUAL ||
                    (largest ? passes_nearer(compare) : passes_farther(compare));
  // Depths without restriction may be stored that are not numbers.
  if (!kept || !plan.restricts_depth) known = 0;
}

base::LaneMask unhidden_blocks(const HierarchicalDepth& depths, const HierarchicalTest& test, base::LaneMask places) {
  const bool nearer = passes_nearer(test.test.compare);
  const DepthPlane& plane = test.plane;
  const bool finite =
      std::isfinite(plane.a0) && std::isfinite(plane.dadx) && std::isfinite(plane.dady) && std::isfinite(plane.offset);
  if (!finite || depths.largest != nearer) return places;
  const auto [left, right] = std::minmax_element(test.locations->x, test.locations->x + test.locations->count);
  const auto [top, bottom] = std::minmax_element(test.locations->y, test.locations->y + test.locations->count);
  const auto corner = [](bool low, std::int32_t first, std::int32_t last) {
    return low ? static_cast<float>(first) / 256 : static_cast<float>(kBlockSize - 1) + static_cast<float>(last) / 256;
  };
  const float x = test.x + corner((plane.dadx >= 0) == nearer, *left, *right);
  const float y = test.y + corner((plane.dady >= 0) == nearer, *top, *bottom);
  return HWY_DYNAMIC_DISPATCH(unhidden)(depths, test.test, plane, x, y, places);
}

void learn_depths(HierarchicalDepth& depths, const HierarchicalTest& test, const BlockPixels* samples,
                  std::uint32_t sample_count, base::LaneMask places) {
  const bool nearer = passes_nearer(test.test.compare);
  if (depths.largest != nearer) {
    depths.known = 0;
    depths.largest = nearer;
  }
  places &= ~depths.exhausted;
  if (places == 0) return;
  HWY_DYNAMIC_DISPATCH(learn)(depths, test.test.format, samples, sample_count, places);
  for (base::LaneMask left = unhidden_blocks(depths, test, places); left != 0; left &= left - 1) {
    const auto place = static_cast<std::uint32_t>(std::countr_zero(left));
    if (++depths.vain[place] == kPatience) depths.exhausted |= base::LaneMask{1} << place;
  }
}

}  // namespace vitrine::raster
#endif

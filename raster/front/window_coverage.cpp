// Edge functions of one triangle over the 64 or 16 pixels of its window.
#include "raster/front/window_coverage.h"

#include "base/simd.h"
#include "raster/primitive.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/front/window_coverage.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "raster/lane_bits-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::raster::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using I = hn::CappedTag<std::int32_t, 16>;
using V = hn::Vec<I>;

/// Places of the 16 lanes of one row of quads of a block.
alignas(64) constexpr std::int32_t kRowX[16] = {0, 1, 0, 1, 2, 3, 2, 3, 4, 5, 4, 5, 6, 7, 6, 7};
alignas(64) constexpr std::int32_t kRowY[16] = {0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1};

/// Places of the 16 lanes of a window of 4x4 pixels.
alignas(64) constexpr std::int32_t kWindowX[16] = {0, 1, 0, 1, 2, 3, 2, 3, 0, 1, 0, 1, 2, 3, 2, 3};
alignas(64) constexpr std::int32_t kWindowY[16] = {0, 0, 1, 1, 0, 0, 1, 1, 2, 2, 3, 3, 2, 2, 3, 3};

/// Values of three edges at lanes [i, i + n) of the places (x, y), and their steps two rows down.
struct WindowEdges {
  V row[3], down[3];

  HWY_INLINE WindowEdges(const std::int32_t* places_x, const std::int32_t* places_y, const std::int32_t* step_x,
                         const std::int32_t* step_y, const std::int32_t* origin) {
    const I d;
    const V x = hn::Load(d, places_x), y = hn::Load(d, places_y);
    for (std::size_t e = 0; e < 3; ++e) {
      const V within = hn::Add(hn::Mul(x, hn::Set(d, step_x[e])), hn::Mul(y, hn::Set(d, step_y[e])));
      row[e] = hn::Add(within, hn::Set(d, origin[e]));
      down[e] = hn::Set(d, 2 * step_y[e]);
    }
  }
  HWY_INLINE base::LaneMask outside() const {
    const V sign = hn::Or(row[0], hn::Or(row[1], row[2]));
    return bits_of_mask(hn::Lt(sign, hn::Zero(I()))) & base::first_lanes(hn::Lanes(I()));
  }
  HWY_INLINE void step() {
    for (std::size_t e = 0; e < 3; ++e) row[e] = hn::Add(row[e], down[e]);
  }
};

/// The 64 pixels of a window.
base::LaneMask window_lanes(const std::int32_t* step_x, const std::int32_t* step_y, const std::int32_t* origin) {
  const std::size_t n = hn::Lanes(I());
  base::LaneMask outside = 0;
  for (std::size_t i = 0; i < 16; i += n) {
    WindowEdges edges(kRowX + i, kRowY + i, step_x, step_y, origin);
    for (std::size_t r = 0; r < 4; ++r) {
      outside |= edges.outside() << (r * 16 + i);
      edges.step();
    }
  }
  return ~outside;
}

/// Its first 4x4 pixels: quads 0, 1, 4 and 5 as 16 lanes.
base::LaneMask small_window_lanes(const std::int32_t* step_x, const std::int32_t* step_y, const std::int32_t* origin) {
  const std::size_t n = hn::Lanes(I());
  base::LaneMask outside = 0;
  for (std::size_t i = 0; i < 16; i += n)
    outside |= WindowEdges(kWindowX + i, kWindowY + i, step_x, step_y, origin).outside() << i;
  return ~outside;
}

}  // namespace vitrine::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vitrine::raster {

HWY_EXPORT(window_lanes);
HWY_EXPORT(small_window_lanes);

base::LaneMask cover_window(const std::int32_t corner_x[3], const std::int32_t corner_y[3], int x, int y, bool small) {
  std::int32_t step_x[3], step_y[3], origin[3];
  for (int e = 0; e < 3; ++e) {
    const int n = e == 2 ? 0 : e + 1;
    const std::int32_t a = corner_y[e] - corner_y[n], b = corner_x[e] - corner_x[n];
    step_x[e] = -256 * a;
    step_y[e] = 256 * b;
    origin[e] = a * (corner_x[e] - x * 256) - b * (corner_y[e] - y * 256) - (owns_edge(a, b) ? 0 : 1);
  }
  if (!small) return HWY_DYNAMIC_DISPATCH(window_lanes)(step_x, step_y, origin);
  return block_of_small_window(HWY_DYNAMIC_DISPATCH(small_window_lanes)(step_x, step_y, origin));
}

}  // namespace vitrine::raster
#endif

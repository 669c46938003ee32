// Edge set-up per tile and evaluation over blocks of 64 lanes.
#include "raster/tile/coverage.h"

#include <algorithm>
#include <bit>

#include "base/simd.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/tile/coverage.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "raster/lane_bits-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::raster::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using I = hn::CappedTag<std::int32_t, 16>;
using V = hn::Vec<I>;

/// Places of the 16 lanes of one row of quads.
alignas(64) constexpr std::int32_t kRowX[16] = {0, 1, 0, 1, 2, 3, 2, 3, 4, 5, 4, 5, 6, 7, 6, 7};
alignas(64) constexpr std::int32_t kRowY[16] = {0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1};

alignas(64) constexpr std::int32_t kColumns[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

/// Lanes where origin + x*step_x + y*step_y >= 0 for all edges; (x, y) is the lane's place.
base::LaneMask inside_lanes(std::uint32_t count, const std::int32_t* step_x, const std::int32_t* step_y,
                            const std::int32_t* origin) {
  const I d;
  const std::size_t n = hn::Lanes(d);
  base::LaneMask mask = 0;
  for (std::size_t i = 0; i < 16; i += n) {
    const V x = hn::Load(d, kRowX + i), y = hn::Load(d, kRowY + i);
    const V zero = hn::Zero(d);
    V row[4] = {zero, zero, zero, zero}, down[4] = {zero, zero, zero, zero};
    for (std::uint32_t e = 0; e < count; ++e) {
      row[e] =
          hn::Add(hn::Set(d, origin[e]), hn::Add(hn::Mul(x, hn::Set(d, step_x[e])), hn::Mul(y, hn::Set(d, step_y[e]))));
      down[e] = hn::Set(d, 2 * step_y[e]);
    }
    for (std::size_t r = 0; r < 4; ++r) {
      V sign = row[0];
      for (std::uint32_t e = 1; e < count; ++e) sign = hn::Or(sign, row[e]);
      for (std::uint32_t e = 0; e < count; ++e) row[e] = hn::Add(row[e], down[e]);
      const auto outside = hn::Lt(sign, zero);
      const base::LaneMask bits = bits_of_mask(outside) & base::first_lanes(n);
      mask |= bits << (r * 16 + i);
    }
  }
  return ~mask;
}

/// The same for the blocks of a tile and up to kEdges edges. What an edge adds from pixel to pixel is common to all
/// blocks.
template <std::size_t kEdges>
HWY_INLINE void inside_blocks_of(const TileEdges& edges, std::uint32_t sample, base::LaneMask places,
                                 base::LaneMask* out) {
  const I d;
  const std::size_t n = hn::Lanes(d);
  const V zero = hn::Zero(d);
  // What an edge's highest value in a block exceeds the one at its first pixel by.
  std::int32_t rise[kEdges] = {};
  for (std::uint32_t e = 0; e < edges.count; ++e)
    rise[e] = (kBlockSize - 1) * (std::max(edges.step_x[e], 0) + std::max(edges.step_y[e], 0));
  for (std::size_t i = 0; i < 16; i += n) {
    const V x = hn::Load(d, kRowX + i), y = hn::Load(d, kRowY + i);
    V within[kEdges], down[kEdges];
    for (std::size_t e = 0; e < kEdges; ++e) within[e] = down[e] = zero;
    for (std::uint32_t e = 0; e < edges.count; ++e) {
      within[e] = hn::Add(hn::Mul(x, hn::Set(d, edges.step_x[e])), hn::Mul(y, hn::Set(d, edges.step_y[e])));
      down[e] = hn::Set(d, 2 * edges.step_y[e]);
    }
    for (base::LaneMask left = places; left != 0; left &= left - 1) {
      const auto place = static_cast<std::uint32_t>(std::countr_zero(left));
      const int bx = lane_x(place) * kBlockSize, by = lane_y(place) * kBlockSize;
      std::int32_t first[kEdges] = {}, missed = 0;
      for (std::uint32_t e = 0; e < edges.count; ++e) {
        first[e] = edges.f[sample][e] + bx * edges.step_x[e] + by * edges.step_y[e];
        missed |= first[e] + rise[e];
      }
      if (missed < 0) {
        out[place] = 0;
        continue;
      }
      V row[kEdges];
      for (std::size_t e = 0; e < kEdges; ++e) row[e] = hn::Add(within[e], hn::Set(d, first[e]));
      base::LaneMask outside = 0;
      for (std::size_t r = 0; r < 4; ++r) {
        // Edges that are not there have value and step 0.
        V sign = row[0];
        for (std::size_t e = 1; e < kEdges; ++e) sign = hn::Or(sign, row[e]);
        outside |= (bits_of_mask(hn::Lt(sign, zero)) & base::first_lanes(n)) << (r * 16 + i);
        for (std::size_t e = 0; e < kEdges; ++e) row[e] = hn::Add(row[e], down[e]);
      }
      out[place] = (i == 0 ? base::kAllLanes : out[place]) & ~outside;
    }
  }
}

void inside_blocks(const TileEdges& edges, std::uint32_t sample, base::LaneMask places, base::LaneMask* out) {
  if (edges.count <= 3)
    inside_blocks_of<3>(edges, sample, places, out);
  else
    inside_blocks_of<4>(edges, sample, places, out);
}

bool large_window_rows(const TileEdges& edges, const PixelRect& rect, LargeWindow& out) {
  const I d;
  constexpr std::size_t n = hn::MaxLanes(I()), kVectors = kLargeWindow / n;
  V row[3][kVectors], down[3];
  for (std::size_t e = 0; e < 3; ++e) {
    down[e] = hn::Set(d, edges.step_y[e]);
    for (std::size_t v = 0; v < kVectors; ++v)
      row[e][v] =
          hn::Add(hn::Set(d, edges.f[0][e]), hn::Mul(hn::Load(d, kColumns + v * n), hn::Set(d, edges.step_x[e])));
  }
  const auto outside_next = [&]() HWY_ATTR {
    std::uint64_t outside = 0;
    for (std::size_t v = 0; v < kVectors; ++v) {
      const V sign = hn::Or(row[0][v], hn::Or(row[1][v], row[2][v]));
      for (std::size_t e = 0; e < 3; ++e) row[e][v] = hn::Add(row[e][v], down[e]);
      outside |= (bits_of_mask(hn::Lt(sign, hn::Zero(d))) & base::first_lanes(n)) << (v * n);
    }
    return outside;
  };
  const auto first_bits = [](int count) { return base::first_lanes(static_cast<std::size_t>(count)); };
  const std::uint64_t columns = (first_bits(rect.x1 + 1) & ~first_bits(rect.x0)) * 0x0001000100010001;
  const int last = rect.y1 / 4;
  std::uint64_t any = 0;
  for (std::uint64_t& word : out.rows) word = 0;
  for (int w = 0; w <= last; ++w) {
    const std::uint64_t first = outside_next(), second = outside_next(), third = outside_next(),
                        fourth = outside_next();
    std::uint64_t word = columns & ~(first | second << 16 | (third << 32 | fourth << 48));
    if (4 * w < rect.y0) word &= ~first_bits(16 * (rect.y0 - 4 * w));
    if (w == last) word &= first_bits(16 * (rect.y1 % 4 + 1));
    out.rows[w] = word;
    any |= word;
  }
  return any != 0;
}

}  // namespace vitrine::raster::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vitrine::raster {
namespace {

HWY_EXPORT(inside_lanes);
HWY_EXPORT(inside_blocks);
HWY_EXPORT(large_window_rows);

/// Whether all of a triangle lies so near to a tile that it touches that its edge functions fit 32 bits there.
bool is_small_triangle(const Primitive& p) {
  constexpr std::int32_t kReach = 32 * 256;
  if (p.kind != PrimitiveKind::kTriangle) return false;
  const auto [left, right] = std::minmax({p.x[0], p.x[1], p.x[2]});
  const auto [top, bottom] = std::minmax({p.y[0], p.y[1], p.y[2]});
  return right - left <= kReach && bottom - top <= kReach;
}

/// The edges of such a triangle, single-sampled; none is dropped.
void make_small_edges(const Primitive& p, int tile_x, int tile_y, TileEdges& out) {
  out.count = 3;
  for (int e = 0; e < 3; ++e) {
    const int n = e == 2 ? 0 : e + 1;
    const std::int32_t a = p.y[e] - p.y[n], b = p.x[e] - p.x[n];
    const std::int32_t last = owns_edge(a, b) ? 0 : 1;
    out.step_x[e] = -a;
    out.step_y[e] = b;
    out.f[0][e] = (a * (p.x[e] - tile_x * 256) - b * (p.y[e] - tile_y * 256) - last) >> 8;
  }
}

/// False if the tile is outside. Edges that have all of it inside are dropped.
bool place_edges(const PrimitiveEdges& edges, int tile_x, int tile_y, const SampleLocations& samples, TileEdges& out) {
  out.count = 0;
  for (std::uint32_t i = 0; i < edges.count; ++i) {
    const PrimitiveEdge& e = edges.edge[i];
    const std::int64_t low = std::min<std::int64_t>(0, -63 * e.a) + std::min<std::int64_t>(0, 63 * e.b);
    const std::int64_t high = std::max<std::int64_t>(0, -63 * e.a) + std::max<std::int64_t>(0, 63 * e.b);
    std::int64_t f[kMaxSamples];
    bool touches = false, covers = true;
    for (std::uint32_t s = 0; s < samples.count; ++s) {
      const std::int64_t sx = samples.x[s], sy = samples.y[s];
      f[s] = ((e.c - 1 - e.a * sx + e.b * sy) >> 8) - e.a * tile_x + e.b * tile_y;
      touches |= f[s] + high >= 0;
      covers &= f[s] + low >= 0;
    }
    if (!touches) return false;
    if (covers) continue;
    const std::uint32_t k = out.count++;
    out.step_x[k] = static_cast<std::int32_t>(-e.a);
    out.step_y[k] = static_cast<std::int32_t>(e.b);
    for (std::uint32_t s = 0; s < samples.count; ++s) out.f[s][k] = static_cast<std::int32_t>(f[s]);
  }
  return true;
}

}  // namespace

bool make_tile_edges(const Primitive& primitive, int tile_x, int tile_y, const SampleLocations& samples,
                     TileEdges& out) {
  if (samples.count == 1 && is_small_triangle(primitive)) {
    make_small_edges(primitive, tile_x, tile_y, out);
    return true;
  }
  out.count = 0;
  if (primitive.kind == PrimitiveKind::kRectangle) return true;  // its bounds say all
  return place_edges(edges_of(primitive), tile_x, tile_y, samples, out);
}

bool make_touched_edges(const Primitive& primitive, int tile_x, int tile_y, const SampleLocations& samples,
                        TileEdges& out) {
  PrimitiveEdges edges = edges_of(primitive);
  for (std::uint32_t i = 0; i < edges.count; ++i) {
    PrimitiveEdge& e = edges.edge[i];
    // From the pixel's centre to that corner of it that lies most inside, which the fill rule does not move.
    e.c += 128 * (std::abs(e.a) + std::abs(e.b)) - (owns_edge(e.a, e.b) ? 1 : 0);
  }
  SampleLocations centers{samples.count, {}, {}};
  const std::int32_t center = samples.count > 1 ? 128 : 0;
  std::fill(std::begin(centers.x), std::end(centers.x), center);
  std::fill(std::begin(centers.y), std::end(centers.y), center);
  return place_edges(edges, tile_x, tile_y, centers, out);
}

void cover_blocks(const TileEdges& edges, std::uint32_t sample, base::LaneMask places, base::LaneMask out[64]) {
  HWY_DYNAMIC_DISPATCH(inside_blocks)(edges, sample, places, out);
}

void classify_blocks(const TileEdges& edges, std::uint32_t samples, base::LaneMask& any, base::LaneMask& all) {
  any = all = base::kAllLanes;
  if (edges.count == 0) return;
  std::int32_t step_x[4], step_y[4], most[4], least[4];
  for (std::uint32_t e = 0; e < edges.count; ++e) {
    const std::int32_t x = 7 * edges.step_x[e], y = 7 * edges.step_y[e];
    step_x[e] = kBlockSize * edges.step_x[e];
    step_y[e] = kBlockSize * edges.step_y[e];
    std::int32_t high = edges.f[0][e], low = high;
    for (std::uint32_t s = 1; s < samples; ++s) {
      high = std::max(high, edges.f[s][e]);
      low = std::min(low, edges.f[s][e]);
    }
    most[e] = high + std::max(x, 0) + std::max(y, 0);
    least[e] = low + std::min(x, 0) + std::min(y, 0);
  }
  any = HWY_DYNAMIC_DISPATCH(inside_lanes)(edges.count, step_x, step_y, most);
  all = HWY_DYNAMIC_DISPATCH(inside_lanes)(edges.count, step_x, step_y, least);
}

bool cover_large_window(const TileEdges& edges, const PixelRect& rect, LargeWindow& out) {
  return HWY_DYNAMIC_DISPATCH(large_window_rows)(edges, rect, out);
}

}  // namespace vitrine::raster
#endif

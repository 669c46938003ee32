// One primitive in a tile: its blocks are covered, rejected where they are hidden, and tested.
#include "raster/tile/rasterize.h"

#include <algorithm>
#include <bit>

#include "base/lane_count.h"
#include "raster/tile/block_shade.h"
#include "raster/tile/coverage.h"
#include "raster/tile/discard_rectangles.h"
#include "raster/tile/early_tests.h"
#include "raster/tile/fragment.h"
#include "raster/tile/observed.h"
#include "raster/tile/pack.h"
#include "raster/tile/spans.h"
#include "raster/tile/windows.h"

namespace vitrine::raster {
namespace {

BlockCoverage block_of(const TileCoverage& coverage, std::uint32_t place, std::uint32_t samples) {
  BlockCoverage block;
  for (std::uint32_t s = 0; s < samples; ++s) block.lanes[s] = coverage.lanes[s][place];
  return block;
}

/// Whether something else than its edges limits the pixels of a primitive.
bool is_cut(const PipelinePlan& plan, const Primitive& p) {
  if (plan.raster_samples > 1 || p.kind != PrimitiveKind::kTriangle || plan.overestimates) return true;
  const PixelRect& region = plan.region[p.viewport];
  if (p.x0 > region.x0 && p.y0 > region.y0 && p.x1 < region.x1 && p.y1 < region.y1) return false;
  const auto [left, right] = std::minmax({p.x[0], p.x[1], p.x[2]});
  const auto [top, bottom] = std::minmax({p.y[0], p.y[1], p.y[2]});
  return p.x0 != (left + 255) >> 8 || p.y0 != (top + 255) >> 8 || p.x1 != (right - 1) >> 8 || p.y1 != (bottom - 1) >> 8;
}

/// Where the grid of a primitive's blocks starts: pixels from the tile's first one, even.
struct GridOrigin {
  int x = 0, y = 0;
  bool operator==(const GridOrigin&) const = default;
};

/// Sides of primitives whose blocks do not keep to the tile's grid, in pixels.
constexpr int kOwnGridReach = 2 * kBlockSize;

/// The start of a grid with as few blocks as possible over pixels [first, last] of a tile, the first of them at the
/// start or the last of them at the end of a block.
int grid_start(int first, int last, bool from_start) {
  const int begin = first & ~1, end = (last + 2) & ~1;
  const int span = (end - begin + kBlockSize - 1) & ~(kBlockSize - 1);
  return std::clamp(from_start ? begin : end - span, 0, kTileSize - span);
}

/// Small primitives have a grid of their own that puts most of their pixels into one block: the block starts or ends
/// where the bounds do, on the side to which the centre of mass lies.
GridOrigin grid_origin(const Primitive& p, const PixelRect& rect) {
  if (rect.x1 - rect.x0 >= kOwnGridReach - 1 || rect.y1 - rect.y0 >= kOwnGridReach - 1) return {};
  const auto leans_back = [&](const std::int32_t* at, int first, int last) {
    return p.kind != PrimitiveKind::kTriangle || 2 * (at[0] + at[1] + at[2]) < 3 * 256 * (first + last);
  };
  return {grid_start(rect.x0, rect.x1, leans_back(p.x, p.x0, p.x1)),
          grid_start(rect.y0, rect.y1, leans_back(p.y, p.y0, p.y1))};
}

/// Moves a primitive's edges and bounds in the tile to another first pixel.
void move_origin(const SampleLocations& locations, GridOrigin origin, TileEdges& edges, PixelRect& rect) {
  for (std::uint32_t s = 0; s < locations.count; ++s)
    for (std::uint32_t e = 0; e < edges.count; ++e)
      edges.f[s][e] += origin.x * edges.step_x[e] + origin.y * edges.step_y[e];
  rect = {rect.x0 - origin.x, rect.y0 - origin.y, rect.x1 - origin.x, rect.y1 - origin.y};
}

/// 1: the first column or row of pixels lies outside of the scissor, and has samples in its farther half alone
/// (deviations.md, multisample-scissor).
GridOrigin leaked_pixels(const PipelinePlan& plan, const Primitive& primitive) {
  if (!plan.as_reference.leaks_scissor || primitive.kind != PrimitiveKind::kTriangle) return {0, 0};
  const PixelRect& region = plan.region[primitive.viewport];
  return {primitive.x0 + 1 == region.x0 ? 1 : 0, primitive.y0 + 1 == region.y0 ? 1 : 0};
}

/// Covered lanes of the blocks among `places` that a primitive touches; returns their places. `rect`: the primitive's,
/// from the first block on.
base::LaneMask cover_tile(const PipelinePlan& plan, const Primitive& primitive, const TileEdges& edges,
                          const PixelRect& rect, base::LaneMask places, TileCoverage& out) {
  const auto [bx0, by0, bx1, by1] = blocks_of(rect);
  base::LaneMask any = base::kAllLanes, all = edges.count == 0 ? base::kAllLanes : 0;
  if (edges.count != 0 && (bx1 - bx0 + 1) * (by1 - by0 + 1) > 9) classify_blocks(edges, plan.raster_samples, any, all);
  any &= places;
  base::LaneMask cut = 0;
  const GridOrigin leak = leaked_pixels(plan, primitive);
  if (is_cut(plan, primitive))
    cut = any & ~rect_lanes((rect.x0 + leak.x + kBlockSize - 1) / kBlockSize,
                            (rect.y0 + leak.y + kBlockSize - 1) / kBlockSize, (rect.x1 + 1) / kBlockSize - 1,
                            (rect.y1 + 1) / kBlockSize - 1);
  for (std::uint32_t s = 0; s < plan.raster_samples; ++s) {
    base::LaneMask* lanes = out.lanes[s];
    if ((any & all) != 0) std::fill_n(lanes, base::kWaveWidth, base::kAllLanes);
    cover_blocks(edges, s, any & ~all, lanes);
    for (base::LaneMask left = cut; left != 0; left &= left - 1) {
      const auto place = static_cast<std::uint32_t>(std::countr_zero(left));
      const int x = lane_x(place) * kBlockSize, y = lane_y(place) * kBlockSize;
      const int left_out = leak.x != 0 && plan.locations->x[s] < 128, above = leak.y != 0 && plan.locations->y[s] < 128;
      lanes[place] &= rect_lanes(rect.x0 + left_out - x, rect.y0 + above - y, rect.x1 - x, rect.y1 - y);
    }
  }
  for (std::uint32_t s = plan.raster_samples; s < plan.samples; ++s)
    std::copy_n(out.lanes[0], base::kWaveWidth, out.lanes[s]);
  return any;
}

/// Edges of what a primitive covers in the tile, or, with conservative rasterization, of what it touches.
bool make_edges(const TileWorker& worker, const Primitive& p, TileEdges& edges) {
  const PipelinePlan& plan = *worker.draw->plan;
  const bool touched = plan.overestimates && p.kind == PrimitiveKind::kTriangle;
  return (touched ? make_touched_edges : make_tile_edges)(p, worker.target.x, worker.target.y, *plan.locations, edges);
}

/// 8.2.
void mask_samples(const PipelinePlan& plan, TileCoverage& out) {
  for (std::uint32_t s = 0; s < plan.samples; ++s)
    if ((plan.sample_mask >> s & 1) == 0) std::fill_n(out.lanes[s], base::kWaveWidth, 0);
}

/// Vulkan 1.3.239, Discard Rectangles Test: takes what it discards from the coverage of the blocks at `places`.
void discard_rectangles(const TileWorker& worker, GridOrigin origin, base::LaneMask places, TileCoverage& out) {
  const PipelinePlan& plan = *worker.draw->plan;
  for (; places != 0; places &= places - 1) {
    const auto place = static_cast<std::uint32_t>(std::countr_zero(places));
    const base::LaneMask kept = undiscarded_lanes(plan, worker.target.x + origin.x + lane_x(place) * kBlockSize,
                                                  worker.target.y + origin.y + lane_y(place) * kBlockSize);
    for (std::uint32_t s = 0; s < plan.samples; ++s) out.lanes[s][place] &= kept;
  }
}

/// Early tests of the blocks at `places` of a grid.
void test_tile(TileWorker& worker, const Primitive& primitive, GridOrigin origin, base::LaneMask places,
               TileCoverage& coverage) {
  const PipelinePlan& plan = *worker.draw->plan;
  const TileTarget& target = worker.target;
  const int x = target.x + origin.x, y = target.y + origin.y;
  if (plan.tests_rows) {
    const base::LaneMask owned =
        places & rect_lanes(0, 0, (target.right - x) / kBlockSize - 1, (target.bottom - y) / kBlockSize - 1);
    base::LaneMask hidden = 0;
    for (std::uint32_t s = 0; s < plan.samples; ++s)
      hidden |=
          test_blocks(worker, primitive, s, x, y, owned, coverage.lanes[s], plan.depth_order == TestOrder::kEarly);
    for (base::LaneMask left = plan.samples > 1 ? hidden : 0; left != 0; left &= left - 1) {
      const auto place = static_cast<std::uint32_t>(std::countr_zero(left));
      if (any_sample(block_of(coverage, place, plan.samples), plan.samples) != 0) hidden &= ~(left & -left);
    }
    if (hidden != 0 && plan.hides_blocks && origin == GridOrigin{}) learn_hidden_places(worker, primitive, hidden);
    places &= ~owned;
  }
  for (; places != 0; places &= places - 1) {
    const auto place = static_cast<std::uint32_t>(std::countr_zero(places));
    BlockCoverage block = block_of(coverage, place, plan.samples);
    test_any_block(worker, primitive, x + lane_x(place) * kBlockSize, y + lane_y(place) * kBlockSize, block);
    for (std::uint32_t s = 0; s < plan.samples; ++s) coverage.lanes[s][place] = block.lanes[s];
  }
}

/// Whether scissor and discard rectangles take nothing of a part of a primitive.
bool is_inside(const TileWorker& worker, const Primitive& p, const PixelRect& rect) {
  const TileTarget& target = worker.target;
  return leaked_pixels(*worker.draw->plan, p) == GridOrigin{} && !worker.draw->plan->discards &&
         is_inside_region(*worker.draw->plan, p, target.x + rect.x0, target.y + rect.y0, target.x + rect.x1,
                          target.y + rect.y1);
}

/// Whether a primitive none of whose edges cuts the tile has whole blocks alone.
bool is_whole(const TileWorker& worker, const PixelRect& rect) {
  const TileTarget& target = worker.target;
  return ((rect.x0 | rect.y0 | (rect.x1 + 1) | (rect.y1 + 1)) & (kBlockSize - 1)) == 0 &&
         target.x + rect.x1 < target.right && target.y + rect.y1 < target.bottom;
}

/// Of `places`, blocks that no test has touched, of a draw that has no more tests: they can be shaded together.
base::LaneMask untouched_blocks(const TileWorker& worker, base::LaneMask places) {
  const PipelinePlan& plan = *worker.draw->plan;
  // Quads that wait may have to be shaded in between.
  if (worker.wave.quads != 0 || !plan.shades || !plan.shades_blocks || plan.may_kill ||
      plan.depth_order == TestOrder::kLate || plan.fragment->writes_memory)
    return 0;
  const TileTarget& target = worker.target;
  base::LaneMask untouched = places & rect_lanes(0, 0, (target.right - target.x) / kBlockSize - 1,
                                                 (target.bottom - target.y) / kBlockSize - 1);
  for (base::LaneMask left = untouched; left != 0; left &= left - 1) {
    const base::LaneMask(*lanes)[base::kWaveWidth] = worker.covered.lanes;
    const auto place = static_cast<std::uint32_t>(std::countr_zero(left));
    if (!std::all_of(lanes, lanes + plan.samples, [&](const auto& of) { return of[place] == base::kAllLanes; }))
      untouched &= ~(left & -left);
  }
  return untouched;
}

/// Shades and counts those of an observed primitive. Returns the other ones.
base::LaneMask count_untouched(TileWorker& worker, const Primitive& primitive, base::LaneMask places) {
  const base::LaneMask untouched = untouched_blocks(worker, places);
  if (untouched == 0) return places;
  count_whole_blocks(worker, untouched);
  shade_whole_blocks(worker, primitive, untouched, false);
  return places & ~untouched;
}

/// Rows of a block's pixels, moved by less than a block.
base::LaneMask moved_rows(base::LaneMask rows, int x, int y) {
  const base::LaneMask columns = x >= 0 ? 0xffu << x & 0xffu : 0xffu >> -x;
  rows = (x >= 0 ? rows << x : rows >> -x) & columns * 0x0101010101010101;
  return y >= 0 ? rows << 8 * y : rows >> -8 * y;
}

/// As cover_tile(), for a primitive with a window.
base::LaneMask cover_by_window(const TileWorker& worker, const Primitive& primitive, base::LaneMask places,
                               TileCoverage& out) {
  const base::LaneMask rows = rows_of_quads(primitive.window);
  const int x = (primitive.x0 & ~1) - worker.target.x, y = (primitive.y0 & ~1) - worker.target.y;
  for (base::LaneMask left = places; left != 0; left &= left - 1) {
    const auto place = static_cast<std::uint32_t>(std::countr_zero(left));
    const base::LaneMask lanes =
        quads_of_rows(moved_rows(rows, x - lane_x(place) * kBlockSize, y - lane_y(place) * kBlockSize));
    for (std::uint32_t s = 0; s < worker.draw->plan->samples; ++s) out.lanes[s][place] = lanes;
  }
  return places;
}

/// An observed primitive inside the draw region, all of whose blocks are tested before any is shaded; `whole`: it
/// covers all pixels of them. `edges`: unless it has a window.
void rasterize_counted(TileWorker& worker, const Primitive& primitive, const TileEdges& edges, const PixelRect& rect,
                       bool whole) {
  const PipelinePlan& plan = *worker.draw->plan;
  const bool tests = plan.depth_order == TestOrder::kEarly || plan.early_reject;
  base::LaneMask places = places_of(rect), tested = places;
  if (tests && plan.hides_blocks && (worker.hierarchy.known & places) != 0)
    tested = unhidden_places(worker, primitive, places);
  const base::LaneMask uncovered = whole ? places & ~tested : 0;  // need not be
  places &= ~uncovered;
  places = primitive.window != 0 ? cover_by_window(worker, primitive, places, worker.covered)
                                 : cover_tile(plan, primitive, edges, rect, places, worker.covered);
  const std::uint64_t generated =
      base::count_lanes(uncovered) * base::kWaveWidth + count_fragments(plan, worker.covered, places);
  worker.numbers.generated += generated;
  if (reads_rasterized(worker)) worker.rasterized = worker.covered;
  places &= tested;
  if (tests) {
    test_tile(worker, primitive, {}, places, worker.covered);
    count_early_tests(worker, places, generated);
  }
  if (!plan.shades) worker.numbers.passed += count_fragments(plan, worker.covered, places);
  BlockCoverage rasterized{};
  for (places = count_untouched(worker, primitive, places); places != 0; places &= places - 1) {
    const auto place = static_cast<std::uint32_t>(std::countr_zero(places));
    if (reads_rasterized(worker)) rasterized = block_of(worker.rasterized, place, plan.samples);
    emit_observed_block(worker, primitive, worker.target.x + lane_x(place) * kBlockSize,
                        worker.target.y + lane_y(place) * kBlockSize, rasterized,
                        block_of(worker.covered, place, plan.samples));
  }
}

/// The part of a tile a primitive may cover, pixels relative to the tile.
PixelRect rect_in_tile(const TileTarget& target, const Primitive& p) {
  return intersect({p.x0 - target.x, p.y0 - target.y, p.x1 - target.x, p.y1 - target.y},
                   {0, 0, kTileSize - 1, kTileSize - 1});
}

}  // namespace

void rasterize_primitive(TileWorker& worker, const Primitive& primitive) {
  const PipelinePlan& plan = *worker.draw->plan;
  const bool in_order = plan.in_order || plan.state->ordered_attachment_access;
  if (in_order && worker.wave.quads != 0) shade_wave(worker, worker.wave);
  if (primitive.window != 0) {
    emit_window(worker, primitive);
    return;
  }
  TileEdges edges;
  if (!make_edges(worker, primitive, edges)) return;
  PixelRect rect = rect_in_tile(worker.target, primitive);
  if (rect.empty()) return;
  base::LaneMask places = base::kAllLanes;
  if (plan.hides_blocks && worker.hierarchy.known != 0) {
    places = places_of(rect);
    if ((worker.hierarchy.known & places) != 0) places = unhidden_places(worker, primitive, places);
    if (places == 0) return;
  }
  if (emit_large_window(worker, primitive, edges, rect)) return;
  places &= places_of(rect);
  // Fragments of several pixels lie on a grid of their own, which that of blocks is a part of.
  const GridOrigin origin = plan.rates.any ? GridOrigin{} : grid_origin(primitive, rect);
  if (origin != GridOrigin{}) {
    move_origin(*plan.locations, origin, edges, rect);
    places = places_of(rect);
  }
  places = cover_tile(plan, primitive, edges, rect, places, worker.covered);
  if (places == 0) return;
  if (plan.discards) discard_rectangles(worker, origin, places, worker.covered);
  mask_samples(plan, worker.covered);
  if (reads_rasterized(worker)) worker.rasterized = worker.covered;
  if (plan.depth_order == TestOrder::kEarly || plan.early_reject)
    test_tile(worker, primitive, origin, places, worker.covered);
  if (edges.count == 0 && !plan.rates.any && origin == GridOrigin{}) {
    const base::LaneMask untouched = untouched_blocks(worker, places);
    shade_whole_blocks(worker, primitive, untouched, false);
    places &= ~untouched;
  }
  BlockCoverage rasterized{};
  for (base::LaneMask left = places; left != 0; left &= left - 1) {
    const auto place = static_cast<std::uint32_t>(std::countr_zero(left));
    const int x = worker.target.x + origin.x + lane_x(place) * kBlockSize;
    const int y = worker.target.y + origin.y + lane_y(place) * kBlockSize;
    if (reads_rasterized(worker)) rasterized = block_of(worker.rasterized, place, plan.samples);
    emit_block(worker, primitive, x, y, rasterized, block_of(worker.covered, place, plan.samples));
  }
}

void rasterize_observed_primitive(TileWorker& worker, const Primitive& primitive, bool hidden) {
  const PipelinePlan& plan = *worker.draw->plan;
  const bool in_order = plan.in_order || plan.state->ordered_attachment_access;
  if (in_order && worker.wave.quads != 0) shade_wave(worker, worker.wave);
  const PixelRect rect = rect_in_tile(worker.target, primitive);
  if (rect.empty()) return;
  // Late tests of quads that wait may change what early tests of later blocks see.
  const bool waits = worker.wave.quads != 0;
  const bool counted = worker.counts_tiles && !(plan.early_reject && waits) && is_inside(worker, primitive, rect);
  TileEdges edges;
  if (counted && primitive.window != 0) return rasterize_counted(worker, primitive, edges, rect, false);
  if (!make_edges(worker, primitive, edges)) return;
  base::LaneMask left = places_of(rect);
  if (counted) {
    const bool whole = edges.count == 0 && is_whole(worker, rect);
    if (!whole || waits || !worker.has_whole_blocks) return rasterize_counted(worker, primitive, edges, rect, whole);
    worker.numbers.generated += base::count_lanes(left) * base::kWaveWidth;
    count_whole_blocks(worker, left);
    return shade_whole_blocks(worker, primitive, left, hidden);
  }
  left = cover_tile(plan, primitive, edges, rect, left, worker.covered);
  for (; left != 0; left &= left - 1) {
    const auto place = static_cast<std::uint32_t>(std::countr_zero(left));
    const int x = worker.target.x + lane_x(place) * kBlockSize, y = worker.target.y + lane_y(place) * kBlockSize;
    BlockCoverage block = block_of(worker.covered, place, plan.samples), rasterized{};
    observe_block(worker, primitive, x, y, block, rasterized);
    emit_observed_block(worker, primitive, x, y, rasterized, block);
  }
}

}  // namespace vitrine::raster

// Rasterization of a tile: coverage block by block, tests before shading, packing.
#include "raster/tile.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstring>

#include "base/float_mode.h"
#include "raster/spans.h"
#include "texel/transfer.h"

namespace vitrine::raster {
namespace {

/// Positions of the quads of a block.
constexpr QuadPositions block_offsets() {
  QuadPositions offsets{};
  for (std::uint32_t q = 0; q < base::kQuadsPerWave; ++q) {
    offsets.x[q] = static_cast<std::uint16_t>(lane_x(4 * q));
    offsets.y[q] = static_cast<std::uint16_t>(lane_y(4 * q));
  }
  return offsets;
}
constexpr QuadPositions kBlockOffsets = block_offsets();

/// Makes planes of the pool the current ones. Those before stay taken as long as the wave uses them.
void set_current_planes(TileWorker& worker, const Primitive* primitive, PlaneSet* planes) {
  const PackedWave& wave = worker.wave;
  const bool used = wave.slots != 0 && wave.planes.set[wave.slots - 1] == worker.planes;
  if (worker.planes && !used) worker.pool.give_back(worker.planes);
  worker.planes = planes;
  worker.planes_of = primitive;
}

/// Whether rows of a square may be read and written without looking at their pixels: it lies inside all attachments,
/// and inside the tile, beside which other threads are at work (windows do not keep to the grid of blocks).
bool owns_square(const TileWorker& worker, int x, int y, int side) {
  const TileTarget& target = worker.target;
  return x >= target.x && y >= target.y && x + side <= target.right && y + side <= target.bottom;
}
bool owns_block(const TileWorker& worker, int x, int y) { return owns_square(worker, x, y, kBlockSize); }

/// Whether quads of the block at (x, y) wait in the packed wave. `quads`: their lowest lanes.
bool waits_in_wave(const TileWorker& worker, int x, int y, base::LaneMask quads) {
  if (worker.wave.quads == 0) return false;
  const auto column = static_cast<std::uint32_t>(x - worker.target.x) / 2;
  const std::uint32_t* row = worker.packed.row + (y - worker.target.y) / 2;
  // Bits 0, 4, 8 and 12 of 16 become neighbours.
  quads |= quads >> 3;
  quads |= quads >> 6;
  const auto wanted = [&](std::uint32_t r) { return static_cast<std::uint32_t>(quads >> (16 * r)) & 15; };
  return (((row[0] >> column & wanted(0)) | (row[1] >> column & wanted(1)) | (row[2] >> column & wanted(2)) |
           (row[3] >> column & wanted(3)))) != 0;
}

/// Tests a block before shading, whatever is tested and wherever it lies. Writes unless the test is only a preview of a
/// late one.
void test_any_block(TileWorker& worker, const Primitive& primitive, int x, int y, BlockCoverage& block) {
  const PipelinePlan& plan = *worker.draw->plan;
  const DepthPlane plane = depth_plane(current_planes(worker, primitive), primitive);
  QuadPositions quads;
  place_block(x, y, quads);
  DepthRange range[base::kQuadsPerWave];
  const bool clamps = plan.state->depth_clamp;
  if (clamps) {
    const ViewportTransform& viewport = plan.viewport[primitive.viewport];
    std::fill_n(range, base::kQuadsPerWave, DepthRange{viewport.z_min, viewport.z_max});
  }
  for (std::uint32_t s = 0; s < plan.samples; ++s) {
    if (!block.lanes[s]) continue;
    if (plan.depth_test) {
      const float dx = plan.locations->pixel_x(s), dy = plan.locations->pixel_y(s);
      evaluate_block_depth(plane, static_cast<float>(x) + dx, static_cast<float>(y) + dy, plan.restricts_depth,
                           worker.depth);
      if (clamps) clamp_depth(range, plan.restricts_depth, base::kQuadsPerWave, worker.depth);
    }
    block.lanes[s] = test_depth_stencil(plan, worker.target.depth_stencil[s], quads, primitive.front ? 0xffffu : 0,
                                        worker.depth, nullptr, block.lanes[s], plan.depth_order == TestOrder::kEarly);
  }
}

/// Whether the coverage before early tests is wanted: copies of it right after it was made stall.
bool reads_rasterized(const TileWorker& worker) { return worker.draw->plan->frag.sample_mask_in != kNoReg; }

/// A block none of whose quads is empty makes a wave of its own.
void append_full_block(TileWorker& worker, const Primitive& primitive, int x, int y, const BlockCoverage& rasterized,
                       const BlockCoverage& block) {
  PackedWave& wave = worker.block;
  wave.quads = base::kQuadsPerWave;
  wave.slots = 1;
  wave.primitive[0] = &primitive;
  wave.planes.set[0] = &current_planes(worker, primitive);
  wave.planes.end[0] = base::kQuadsPerWave;
  std::memset(wave.slot, 0, sizeof(wave.slot));
  place_block(x, y, wave.position);
  std::memcpy(wave.coverage, block.lanes, sizeof(wave.coverage));
  if (reads_rasterized(worker)) std::memcpy(wave.rasterized, rasterized.lanes, sizeof(wave.rasterized));
  shade_wave(worker, wave);
}

/// The quads of `quads` (lowest lanes) that fit the wave, at most `room`, into its places from `first` on. Returns how
/// many.
std::uint32_t fill_places(TileWorker& worker, int x, int y, base::LaneMask& quads, std::uint32_t first,
                          std::uint32_t room, base::LaneMask lanes, base::LaneMask& coverage) {
  PackedWave& wave = worker.wave;
  const auto column = static_cast<std::uint32_t>(x - worker.target.x),
             row = static_cast<std::uint32_t>(y - worker.target.y);
  std::uint32_t q = first;
  for (; quads != 0 && q != first + room; quads &= quads - 1, ++q) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(quads));
    wave.position.x[q] = static_cast<std::uint16_t>(x + lane_x(lane));
    wave.position.y[q] = static_cast<std::uint16_t>(y + lane_y(lane));
    worker.packed.row[(row + static_cast<std::uint32_t>(lane_y(lane))) / 2] |=
        1u << ((column + static_cast<std::uint32_t>(lane_x(lane))) / 2);
    coverage |= (lanes >> lane & 15) << (4 * q);
  }
  return q - first;
}

/// Lanes of `quads` moved together, to the places from `first` on.
base::LaneMask compress_quads(base::LaneMask lanes, base::LaneMask quads, std::uint32_t first, std::uint32_t count) {
  base::LaneMask result = 0;
  for (std::uint32_t q = first; q != first + count; ++q, quads &= quads - 1)
    result |= (lanes >> std::countr_zero(quads) & 15) << (4 * q);
  return result;
}

}  // namespace

void append_quads(TileWorker& worker, const Primitive& primitive, int x, int y, const BlockCoverage& rasterized,
                  const BlockCoverage& block, base::LaneMask quads) {
  PackedWave& wave = worker.wave;
  const PlaneSet& planes = current_planes(worker, primitive);
  const std::uint32_t samples = worker.draw->plan->samples;
  while (quads != 0) {
    if (wave.quads == 0) {
      worker.packed = {};
      for (std::uint32_t s = 0; s < samples; ++s) wave.coverage[s] = wave.rasterized[s] = 0;
    }
    if (wave.slots == 0 || wave.primitive[wave.slots - 1] != &primitive) {
      wave.planes.set[wave.slots] = &planes;
      wave.primitive[wave.slots++] = &primitive;
    }
    const std::uint32_t first = wave.quads;
    const base::LaneMask before = quads;
    const std::uint32_t count =
        fill_places(worker, x, y, quads, first, base::kQuadsPerWave - first, block.lanes[0], wave.coverage[0]);
    for (std::uint32_t s = 1; s < samples; ++s)
      wave.coverage[s] |= compress_quads(block.lanes[s], before, first, count);
    for (std::uint32_t s = 0; reads_rasterized(worker) && s < samples; ++s)
      wave.rasterized[s] |= compress_quads(rasterized.lanes[s], before, first, count);
    wave.quads = first + count;
    std::fill(wave.slot + first, wave.slot + wave.quads, static_cast<std::uint8_t>(wave.slots - 1));
    wave.planes.end[wave.slots - 1] = static_cast<std::uint8_t>(wave.quads);
    if (wave.quads == base::kQuadsPerWave) shade_wave(worker, wave);
  }
}

namespace {

/// Quads of a block from which on it is shaded on its own: fewer would waste more lanes than packing costs.
constexpr std::uint32_t kNearlyFull = 12, kNearlyFullIfShort = 2;

/// A block's coverage after early tests, to the wave.
void emit_block(TileWorker& worker, const Primitive& primitive, int x, int y, const BlockCoverage& rasterized,
                const BlockCoverage& block) {
  const PipelinePlan& plan = *worker.draw->plan;
  base::LaneMask any = any_sample(block, plan.samples);
  if (!any) return;
  if (!plan.shades) {
    for (std::uint32_t s = 0; worker.counts && s < plan.samples; ++s)
      worker.samples_passed += static_cast<std::uint64_t>(std::popcount(block.lanes[s]));
    return;
  }
  constexpr base::LaneMask kLowestLanes = 0x1111111111111111;
  any |= any >> 1;
  const base::LaneMask quads = (any | any >> 2) & kLowestLanes;
  const bool whole = quads == kLowestLanes;
  // The product's upper four bits are the sum of the 16 nibbles: the number of quads, modulo 16.
  const bool nearly =
      whole || (quads * kLowestLanes) >> 60 >= (worker.block_draw.is_short ? kNearlyFullIfShort : kNearlyFull);
  const bool alone = nearly && plan.shades_blocks && owns_block(worker, x, y);
  if (!whole && !alone) {
    append_quads(worker, primitive, x, y, rasterized, block, quads);
    return;
  }
  // Quads on the same pixels come first.
  if (waits_in_wave(worker, x, y, quads)) shade_wave(worker, worker.wave);
  if (alone)
    shade_block(worker, primitive, x, y, block);
  else
    append_full_block(worker, primitive, x, y, rasterized, block);
}

/// A primitive whose coverage the front end found.
void emit_window(TileWorker& worker, const Primitive& primitive) {
  const PipelinePlan& plan = *worker.draw->plan;
  const TileTarget& target = worker.target;
  const int x = primitive.x0 & ~1, y = primitive.y0 & ~1;
  BlockCoverage block{{primitive.window}};
  if (x < target.x || y < target.y || x + 8 > target.x + kTileSize || y + 8 > target.y + kTileSize) {
    block.lanes[0] &=
        rect_lanes(target.x - x, target.y - y, target.x + kTileSize - 1 - x, target.y + kTileSize - 1 - y);
    if (block.lanes[0] == 0) return;
  }
  BlockCoverage rasterized{};
  if (reads_rasterized(worker)) rasterized = block;
  if (plan.depth_order == TestOrder::kEarly || plan.early_reject) {
    if (plan.tests_rows && owns_block(worker, x, y))
      test_blocks(worker, primitive, 0, x, y, 1, block.lanes, plan.depth_order == TestOrder::kEarly);
    else
      test_any_block(worker, primitive, x, y, block);
    if (block.lanes[0] == 0) return;
  }
  if (!plan.shades) {
    if (worker.counts) worker.samples_passed += static_cast<std::uint64_t>(std::popcount(block.lanes[0]));
    return;
  }
  base::LaneMask any = block.lanes[0] | block.lanes[0] >> 1;
  any = (any | any >> 2) & 0x1111111111111111;
  append_quads(worker, primitive, x, y, rasterized, block, any);
}

/// The lanes of a window's first 4x4 pixels.
constexpr base::LaneMask kSmallWindow = 0x00ff00ff;

/// Whether a primitive may go into a group: a window that nothing cuts.
bool is_small_window(const TileWorker& worker, const Primitive& primitive) {
  return primitive.window != 0 && (primitive.window & ~kSmallWindow) == 0 &&
         owns_square(worker, primitive.x0 & ~1, primitive.y0 & ~1, 4);
}

/// Small windows of one draw and one viewport. Each step is done for all of them before the next, so that none waits
/// for the results of the one before.
void emit_small_windows(TileWorker& worker, const Primitive* const* primitives, std::uint32_t count) {
  const PipelinePlan& plan = *worker.draw->plan;
  DepthWindow windows[kWindowGroup];
  PlaneSet* planes[kWindowGroup];
  for (std::uint32_t i = 0; i < count; ++i) {
    const Primitive& primitive = *primitives[i];
    planes[i] = worker.pool.take();
    compute_planes(plan, primitive, *planes[i]);
    const auto quads = static_cast<std::uint32_t>((primitive.window & 0xff) | (primitive.window >> 8 & 0xff00));
    windows[i] = {depth_plane(*planes[i], primitive), primitive.x0 & ~1, primitive.y0 & ~1, transpose_window(quads)};
  }
  if (plan.depth_order == TestOrder::kEarly || plan.early_reject)
    test_windows(worker, primitives[0]->viewport, windows, count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const Primitive& primitive = *primitives[i];
    const DepthWindow& window = windows[i];
    if (window.rows == 0 || !plan.shades) {
      worker.pool.give_back(planes[i]);
      if (worker.counts) worker.samples_passed += static_cast<std::uint64_t>(std::popcount(window.rows));
      continue;
    }
    set_current_planes(worker, &primitive, planes[i]);
    const base::LaneMask quads = transpose_window(window.rows);
    const BlockCoverage block{{(quads & 0xff) | (quads & 0xff00) << 8}}, rasterized{{primitive.window}};
    base::LaneMask any = block.lanes[0] | block.lanes[0] >> 1;
    any = (any | any >> 2) & 0x1111111111111111;
    append_quads(worker, primitive, window.x, window.y, rasterized, block, any);
  }
}

/// Where a tile's work starts.
struct TileStart {
  std::size_t item = 0;
  std::uint32_t primitive = 0;
};

/// Walks the primitives of a tile some steps ahead of the work on them and asks for their memory: the front end filled
/// more than the caches near the core hold.
class Prefetcher {
 public:
  Prefetcher(const std::vector<TileItem>& items, TileStart start)
      : end_(items.data() + items.size()),
        primitive_{items.data() + start.item, start.primitive},
        vertices_(primitive_) {
    for (std::uint32_t i = 0; i < kPrimitivesAhead; ++i) ask_for_primitive();
    for (std::uint32_t i = 0; i < kVerticesAhead; ++i) ask_for_vertices();
  }
  /// To be called once per primitive.
  void step() {
    ask_for_primitive();
    ask_for_vertices();
  }

 private:
  /// How many primitives lie between the one at work and the one asked for, or the one whose vertices are.
  static constexpr std::uint32_t kPrimitivesAhead = 8, kVerticesAhead = 4;

  struct Cursor {
    const TileItem* item;
    std::uint32_t k;
  };

  /// The next primitive, or null at the end.
  const Primitive* next(Cursor& cursor) const {
    while (cursor.item != end_ && cursor.k >= cursor.item->count) cursor = {cursor.item + 1, 0};
    return cursor.item == end_ ? nullptr : cursor.item->primitives + cursor.item->index[cursor.k++];
  }
  void ask_for_primitive() {
    const TileItem* before = primitive_.item;
    const Primitive* primitive = next(primitive_);
    if (!primitive) return;
    __builtin_prefetch(primitive);
    __builtin_prefetch(reinterpret_cast<const std::byte*>(primitive + 1) - 1);
    if (primitive_.item != before && primitive_.item + 1 != end_) __builtin_prefetch(primitive_.item[1].index);
  }
  void ask_for_vertices() {
    if (const Primitive* primitive = next(vertices_))
      for (const Vertex* vertex : primitive->v) __builtin_prefetch(vertex);
  }

  const TileItem* end_;
  Cursor primitive_, vertices_;
};

/// The primitives of one item, groups of small windows together.
void rasterize_primitives(TileWorker& worker, const TileItem& item, std::uint32_t first, Prefetcher& prefetcher) {
  const PipelinePlan& plan = *worker.draw->plan;
  const bool tests = plan.depth_order == TestOrder::kEarly || plan.early_reject;
  const bool groups =
      plan.windows && !plan.in_order && !plan.state->ordered_attachment_access && (!tests || plan.tests_rows);
  const Primitive* group[kWindowGroup];
  std::uint32_t count = 0;
  for (std::uint32_t k = first; k < item.count; ++k) {
    prefetcher.step();
    const Primitive& primitive = item.primitives[item.index[k]];
    const bool small = groups && is_small_window(worker, primitive);
    if (count != 0 && (!small || count == kWindowGroup || group[0]->viewport != primitive.viewport)) {
      emit_small_windows(worker, group, count);
      count = 0;
    }
    if (small)
      group[count++] = &primitive;
    else
      rasterize_primitive(worker, primitive);
  }
  if (count != 0) emit_small_windows(worker, group, count);
}

BlockCoverage block_of(const TileCoverage& coverage, std::uint32_t place, std::uint32_t samples) {
  BlockCoverage block;
  for (std::uint32_t s = 0; s < samples; ++s) block.lanes[s] = coverage.lanes[s][place];
  return block;
}

/// Whether something else than its edges limits the pixels of a primitive.
bool is_cut(const PipelinePlan& plan, const Primitive& p) {
  if (plan.raster_samples > 1 || p.kind != PrimitiveKind::kTriangle) return true;
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

/// Blocks with pixels of `rect`, which is in the tile.
PixelRect blocks_of(const PixelRect& rect) {
  return {rect.x0 / kBlockSize, rect.y0 / kBlockSize, rect.x1 / kBlockSize, rect.y1 / kBlockSize};
}

base::LaneMask places_of(const PixelRect& rect) {
  const auto [bx0, by0, bx1, by1] = blocks_of(rect);
  return rect_lanes(bx0, by0, bx1, by1);
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
  if (is_cut(plan, primitive))
    cut = any & ~rect_lanes((rect.x0 + kBlockSize - 1) / kBlockSize, (rect.y0 + kBlockSize - 1) / kBlockSize,
                            (rect.x1 + 1) / kBlockSize - 1, (rect.y1 + 1) / kBlockSize - 1);
  for (std::uint32_t s = 0; s < plan.raster_samples; ++s) {
    base::LaneMask* lanes = out.lanes[s];
    if ((any & all) != 0) std::fill_n(lanes, base::kWaveWidth, base::kAllLanes);
    cover_blocks(edges, s, any & ~all, lanes);
    for (base::LaneMask left = cut; left != 0; left &= left - 1) {
      const auto place = static_cast<std::uint32_t>(std::countr_zero(left));
      const int x = lane_x(place) * kBlockSize, y = lane_y(place) * kBlockSize;
      lanes[place] &= rect_lanes(rect.x0 - x, rect.y0 - y, rect.x1 - x, rect.y1 - y);
    }
  }
  for (std::uint32_t s = plan.raster_samples; s < plan.samples; ++s)
    std::copy_n(out.lanes[0], base::kWaveWidth, out.lanes[s]);
  for (std::uint32_t s = 0; s < plan.samples; ++s)
    if ((plan.sample_mask >> s & 1) == 0) std::fill_n(out.lanes[s], base::kWaveWidth, 0);
  return any;
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

}  // namespace

void learn_hidden_rect(TileWorker& worker, const Primitive& primitive, const PixelRect& rect) {
  const TileTarget& target = worker.target;
  const base::LaneMask owned =
      rect_lanes(0, 0, (target.right - target.x) / kBlockSize - 1, (target.bottom - target.y) / kBlockSize - 1);
  learn_hidden_places(worker, primitive, places_of(rect) & owned);
}

namespace {

/// The part of a tile a primitive may cover, pixels relative to the tile.
PixelRect rect_in_tile(const TileTarget& target, const Primitive& p) {
  return intersect({p.x0 - target.x, p.y0 - target.y, p.x1 - target.x, p.y1 - target.y},
                   {0, 0, kTileSize - 1, kTileSize - 1});
}

void begin_draw(TileWorker& worker, const DrawRecord* draw) {
  worker.draw = draw;
  worker.counts = draw->call.queries.occlusion || draw->call.queries.statistics;
  worker.wave.quads = worker.wave.slots = 0;
  if (draw->plan->shades && !(worker.bound == draw->fragment)) {
    worker.runner.bind(draw->fragment);
    worker.bound = draw->fragment;
  }
  begin_blocks(worker);
  worker.hierarchy.begin_draw(*draw->plan);
}

void end_draw(TileWorker& worker) {
  if (!worker.draw) return;
  if (worker.wave.quads) shade_wave(worker, worker.wave);
  const QueryCounters& queries = worker.draw->call.queries;
  if (queries.occlusion && worker.samples_passed)
    queries.occlusion->fetch_add(worker.samples_passed, std::memory_order_relaxed);
  if (queries.statistics && worker.fragment_invocations)
    queries.statistics[7].fetch_add(worker.fragment_invocations, std::memory_order_relaxed);
  worker.samples_passed = worker.fragment_invocations = 0;
  worker.draw = nullptr;
}

void clear_tile(TileWorker& worker, const ClearCommand& clear) {
  const TileTarget& target = worker.target;
  if (target.layer < clear.base_layer || target.layer - clear.base_layer >= clear.layer_count) return;
  const PixelRect rect =
      intersect(clear.rect, {target.x, target.y, target.x + kTileSize - 1, target.y + kTileSize - 1});
  if (rect.empty()) return;
  const texel::ImageView& view = *clear.view;
  if (&view == &worker.pass->depth) worker.hierarchy.reset();
  const std::size_t bytes = view.format->block_bytes, width = static_cast<std::size_t>(rect.x1 - rect.x0 + 1);
  for (std::uint32_t s = 0; s < std::max<std::uint32_t>(view.samples, 1); ++s) {
    std::byte* first =
        view.block(0, target.layer, s, static_cast<std::uint32_t>(rect.x0), static_cast<std::uint32_t>(rect.y0), 0);
    texel::fill_rows(first, view.level[0].row_pitch, width * bytes, static_cast<std::size_t>(rect.y1 - rect.y0 + 1),
                     clear.value, bytes);
  }
}

/// Whether a primitive replaces every colour of the tile, so that nothing drawn before it can be seen.
bool hides_tile(const TileWorker& worker, const PipelinePlan& plan, const Primitive& p) {
  if (!plan.replaces_colors || p.kind != PrimitiveKind::kTriangle) return false;
  const TileTarget& target = worker.target;
  const VkRect2D& area = worker.pass->render_area;
  const int right = std::min(target.x + kTileSize, area.offset.x + static_cast<int>(area.extent.width)) - 1;
  const int bottom = std::min(target.y + kTileSize, area.offset.y + static_cast<int>(area.extent.height)) - 1;
  if (p.x0 > target.x || p.y0 > target.y || p.x1 < right || p.y1 < bottom) return false;
  TileEdges edges;
  return make_tile_edges(p, target.x, target.y, *plan.locations, edges) && edges.count == 0;
}

/// Whether the draw of an item does more than give colours.
bool leaves_traces(const TileItem& item) {
  if (item.clear) return false;
  const PipelinePlan& plan = *item.draw->plan;
  const QueryCounters& queries = item.draw->call.queries;
  return queries.occlusion || queries.statistics || plan.depth_order != TestOrder::kNone ||
         (plan.fragment && plan.fragment->writes_memory);
}

/// The last primitive that hides the colours of everything before it, if nothing before it can be noticed otherwise.
/// Clears of depth and stencil stay to be done.
TileStart first_visible(const TileWorker& worker, const std::vector<TileItem>& items) {
  for (std::size_t i = items.size(); i-- > 0;) {
    const TileItem& item = items[i];
    if (item.clear) continue;
    if (leaves_traces(item)) return {};
    const PipelinePlan& plan = *item.draw->plan;
    for (std::uint32_t k = plan.replaces_colors ? item.count : 0; k-- > 0;)
      if (hides_tile(worker, plan, item.primitives[item.index[k]])) {
        const bool noticed = std::any_of(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(i), leaves_traces);
        return noticed ? TileStart{} : TileStart{i, k};
      }
  }
  return {};
}

void set_target(TileWorker& worker, const PassDesc& pass, const TileGrid& grid, std::uint32_t tile) {
  worker.pass = &pass;
  TileTarget& target = worker.target;
  const std::uint32_t in_layer = tile % (grid.columns * grid.rows);
  target.layer = tile / (grid.columns * grid.rows);
  target.x = static_cast<int>(in_layer % grid.columns) * kTileSize;
  target.y = static_cast<int>(in_layer / grid.columns) * kTileSize;
  target.right = target.x + kTileSize;
  target.bottom = target.y + kTileSize;
  const auto cut = [&](const texel::ImageView& view) {
    if (!view.format) return;
    target.right = std::min(target.right, static_cast<int>(view.level[0].extent.width));
    target.bottom = std::min(target.bottom, static_cast<int>(view.level[0].extent.height));
  };
  for (std::uint32_t i = 0; i < pass.color_count; ++i) cut(pass.color[i]);
  cut(pass.depth);
  for (std::uint32_t s = 0; s < std::clamp<std::uint32_t>(pass.samples, 1, kMaxSamples); ++s) {
    DepthStencilTarget& out = target.depth_stencil[s];
    out = {};
    out.format = depth_format(pass.depth);
    if (pass.depth.format && target.layer < pass.depth.layer_count) {
      out.depth = pass.depth.block(0, target.layer, s, 0, 0, 0);
      out.depth_pitch = pass.depth.level[0].row_pitch;
      out.width = static_cast<int>(pass.depth.level[0].extent.width);
      out.height = static_cast<int>(pass.depth.level[0].extent.height);
    }
    if (pass.stencil.format && target.layer < pass.stencil.layer_count) {
      out.stencil = pass.stencil.block(0, target.layer, s, 0, 0, 0);
      out.stencil_pitch = pass.stencil.level[0].row_pitch;
    }
  }
}

}  // namespace

void release_planes(TileWorker& worker, const PackedWave& wave) {
  for (std::uint32_t slot = 0; slot < wave.slots; ++slot)
    if (wave.planes.set[slot] != worker.planes) worker.pool.give_back(wave.planes.set[slot]);
}

const PlaneSet& current_planes(TileWorker& worker, const Primitive& primitive) {
  if (worker.planes_of == &primitive) return *worker.planes;
  set_current_planes(worker, nullptr, nullptr);
  PlaneSet* planes = worker.pool.take();
  compute_planes(*worker.draw->plan, primitive, *planes);
  set_current_planes(worker, &primitive, planes);
  return *planes;
}

void place_block(int x, int y, QuadPositions& out) {
  for (std::uint32_t q = 0; q < base::kQuadsPerWave; ++q) {
    out.x[q] = static_cast<std::uint16_t>(x + kBlockOffsets.x[q]);
    out.y[q] = static_cast<std::uint16_t>(y + kBlockOffsets.y[q]);
  }
}

void rasterize_primitive(TileWorker& worker, const Primitive& primitive) {
  const PipelinePlan& plan = *worker.draw->plan;
  const bool in_order = plan.in_order || plan.state->ordered_attachment_access;
  if (in_order && worker.wave.quads != 0) shade_wave(worker, worker.wave);
  if (primitive.window != 0) {
    emit_window(worker, primitive);
    return;
  }
  TileEdges edges;
  if (!make_tile_edges(primitive, worker.target.x, worker.target.y, *plan.locations, edges)) return;
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
  const GridOrigin origin = grid_origin(primitive, rect);
  if (origin != GridOrigin{}) {
    move_origin(*plan.locations, origin, edges, rect);
    places = places_of(rect);
  }
  places = cover_tile(plan, primitive, edges, rect, places, worker.covered);
  if (places == 0) return;
  if (reads_rasterized(worker)) worker.rasterized = worker.covered;
  if (plan.depth_order == TestOrder::kEarly || plan.early_reject)
    test_tile(worker, primitive, origin, places, worker.covered);
  BlockCoverage rasterized{};
  for (base::LaneMask left = places; left != 0; left &= left - 1) {
    const auto place = static_cast<std::uint32_t>(std::countr_zero(left));
    const int x = worker.target.x + origin.x + lane_x(place) * kBlockSize;
    const int y = worker.target.y + origin.y + lane_y(place) * kBlockSize;
    if (reads_rasterized(worker)) rasterized = block_of(worker.rasterized, place, plan.samples);
    emit_block(worker, primitive, x, y, rasterized, block_of(worker.covered, place, plan.samples));
  }
}

void process_tile(TileWorker& worker, const PassDesc& pass, const TileGrid& grid, std::uint32_t tile,
                  const std::vector<TileItem>& items) {
  const base::ScopedFloatMode mode(base::Denormals::kFlush);
  set_target(worker, pass, grid, tile);
  worker.draw = nullptr;
  worker.planes = nullptr;
  worker.planes_of = nullptr;
  worker.pool.reset();
  if (pass.depth.format) worker.hierarchy.reset();
  const TileStart start = first_visible(worker, items);
  Prefetcher prefetcher(items, start);
  for (std::size_t i = 0; i < items.size(); ++i) {
    const TileItem& item = items[i];
    if (i < start.item && (item.draw || !item.clear->view->format->is_depth_stencil())) continue;
    if (item.clear) {
      end_draw(worker);
      clear_tile(worker, *item.clear);
      continue;
    }
    if (item.draw != worker.draw) {
      end_draw(worker);
      begin_draw(worker, item.draw);
    }
    rasterize_primitives(worker, item, i == start.item ? start.primitive : 0, prefetcher);
  }
  end_draw(worker);
}

}  // namespace vitrine::raster

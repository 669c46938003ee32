// The work of a tile: its clears and primitives in order, from the first one that can be seen on.
#include "raster/tile/tile.h"

#include <algorithm>
#include <atomic>
#include <optional>

#include "base/float_mode.h"
#include "raster/plan/fragment_operations.h"
#include "raster/tile/block_shade.h"
#include "raster/tile/coverage.h"
#include "raster/tile/fragment.h"
#include "raster/tile/observed.h"
#include "raster/tile/rasterize.h"
#include "raster/tile/windows.h"
#include "spirv/counted_runs.h"
#include "texel/transfer.h"

namespace vitrine::raster {
namespace {

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

/// The same for an observed draw: one by one. The colours of those before `visible` are hidden.
void rasterize_observed(TileWorker& worker, const TileItem& item, std::uint32_t first, std::uint32_t visible) {
  for (std::uint32_t k = first; k < item.count; ++k)
    rasterize_observed_primitive(worker, item.primitives[item.index[k]], k < visible);
}

void begin_draw(TileWorker& worker, const DrawRecord* draw, std::uint32_t tile) {
  worker.draw = draw;
  if (draw->call.observer || draw->call.tile_observer) begin_observed(worker, tile);
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
  if (worker.fragment_invocations && fragments_have_effects(*worker.draw->plan))
    queries.count(Statistic::kFragmentInvocations, worker.fragment_invocations);
  worker.samples_passed = worker.fragment_invocations = 0;
  if (worker.watch) end_observed(worker);
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
  if (!plan.replaces_colors || !is_area(p.kind)) return false;
  const TileTarget& target = worker.target;
  const PixelRect area = pixel_rect(worker.pass->render_area);
  const int right = std::min(target.x + kTileSize - 1, area.x1), bottom = std::min(target.y + kTileSize - 1, area.y1);
  if (p.x0 > target.x || p.y0 > target.y || p.x1 < right || p.y1 < bottom) return false;
  TileEdges edges;
  return make_tile_edges(p, target.x, target.y, *plan.locations, edges) && edges.count == 0;
}

/// Whether the draw of an item does more than give colours that whoever observes it is not told of.
bool leaves_marks(const TileItem& item) {
  if (item.clear) return false;
  const PipelinePlan& plan = *item.draw->plan;
  const QueryCounters& queries = item.draw->call.queries;
  return queries.occlusion || queries.statistics || plan.depth_order != TestOrder::kNone ||
         (plan.fragment && plan.fragment->writes_memory);
}

/// Whether somebody observes the draw of an item.
bool is_observed(const TileItem& item) {
  return !item.clear && (item.draw->call.fragment_resources.command || item.draw->call.observer);
}

/// Whether somebody observes the tile: all draws of a pass have the same observer of tiles.
bool is_watched(const TileWorker& worker, const std::vector<TileItem>& items) {
  const auto drawn = std::find_if(items.begin(), items.end(), [](const TileItem& item) { return !item.clear; });
  const TileObserver* const observer = drawn == items.end() ? nullptr : drawn->draw->call.tile_observer;
  return observer && observer->watches(place_of(worker));
}

/// Whether the draw of an item does more than give colours.
bool leaves_traces(const TileItem& item) { return is_observed(item) || leaves_marks(item); }

/// The last primitive that hides the colours of everything before it, if nothing before it can be noticed otherwise.
/// Clears of depth and stencil stay to be done.
TileStart first_visible(const TileWorker& worker, const std::vector<TileItem>& items, bool (*leaves)(const TileItem&)) {
  for (std::size_t i = items.size(); i-- > 0;) {
    const TileItem& item = items[i];
    if (item.clear) continue;
    if (leaves(item)) return {};
    const PipelinePlan& plan = *item.draw->plan;
    for (std::uint32_t k = plan.replaces_colors ? item.count : 0; k-- > 0;)
      if (hides_tile(worker, plan, item.primitives[item.index[k]])) {
        const bool noticed = std::any_of(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(i), leaves);
        return noticed ? TileStart{} : TileStart{i, k};
      }
  }
  return {};
}

/// Where the colours start of which those who observe draws can be told without drawing what lies before: no shader
/// before could do anything else if it read colours that nobody has written.
TileStart first_told(const TileWorker& worker, const std::vector<TileItem>& items) {
  const TileStart start = first_visible(worker, items, leaves_marks);
  const auto runs_freely = [](const TileItem& item) {
    return !item.clear && (!item.draw->fragment.bound || !spirv::is_counted(*item.draw->fragment.bound));
  };
  const auto end = items.begin() + static_cast<std::ptrdiff_t>(start.item) + (start.primitive != 0 ? 1 : 0);
  return std::any_of(items.begin(), end, runs_freely) ? TileStart{} : start;
}

/// How many of the item's primitives are in front of `visible`.
std::uint32_t hidden_of(const TileItem& item, std::size_t index, const TileStart& visible) {
  if (index != visible.item) return index < visible.item ? item.count : 0;
  return visible.primitive;
}

void set_target(TileWorker& worker, const PassDesc& pass, const TileGrid& grid, std::uint32_t tile) {
  worker.pass = &pass;
  TileTarget& target = worker.target;
  const std::uint32_t in_layer = tile % (grid.columns * grid.rows);
  target.layer = tile / (grid.columns * grid.rows);
  target.x = static_cast<int>(in_layer % grid.columns) * kTileSize;
  target.y = static_cast<int>(in_layer / grid.columns) * kTileSize;
  const VkExtent2D room = cut_to_attachments(
      pass, {static_cast<std::uint32_t>(target.x + kTileSize), static_cast<std::uint32_t>(target.y + kTileSize)});
  target.right = static_cast<int>(room.width);
  target.bottom = static_cast<int>(room.height);
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

void process_tile(TileWorker& worker, const PassDesc& pass, const TileGrid& grid, std::uint32_t tile,
                  const std::vector<TileItem>& items) {
  const base::ScopedFloatMode mode(base::Denormals::kFlush);
  set_target(worker, pass, grid, tile);
  worker.draw = nullptr;
  worker.watch.reset();
  worker.planes = nullptr;
  worker.planes_of = nullptr;
  worker.pool.reset();
  if (pass.depth.format) worker.hierarchy.reset();
  const TileStart start = is_watched(worker, items) ? TileStart{} : first_visible(worker, items, leaves_traces);
  std::optional<TileStart> visible;  // colours from here on; of what is before, observers of draws are only told
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
      begin_draw(worker, item.draw, tile);
      if (worker.watch && worker.has_whole_blocks && !visible) visible = first_told(worker, items);
    }
    const std::uint32_t first = i == start.item ? start.primitive : 0;
    if (worker.watch)
      rasterize_observed(worker, item, first, hidden_of(item, i, visible.value_or(TileStart{})));
    else
      rasterize_primitives(worker, item, first, prefetcher);
  }
  end_draw(worker);
}

}  // namespace vitrine::raster

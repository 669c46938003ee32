// The pass: keeps draws and clears in order, runs the front end over chunks and the back end over tiles.
#include "raster/pass.h"

#include <algorithm>
#include <deque>
#include <mutex>
#include <optional>
#include <vector>

#include "base/float_mode.h"
#include "base/lasting.h"
#include "base/shake.h"
#include "base/simd.h"
#include "base/workers.h"
#include "raster/arena.h"
#include "raster/front/assembly.h"
#include "raster/front/collected.h"
#include "raster/front/front.h"
#include "raster/front/rectangles.h"
#include "raster/plan/make_plan.h"
#include "raster/tile/tile.h"
#include "texel/transfer.h"

namespace vitrine::raster {
namespace {

/// Positions that are gathered before the front end runs, and bytes of its results before the back end runs.
constexpr std::uint64_t kPendingPositions = std::uint64_t{256} << 10;
constexpr std::size_t kBinBytes = std::size_t{48} << 20;
/// Positions of clipped triangles that wait for the end of their batch (lavapipe-rasterization.md 9.2), which is cut
/// then.
constexpr std::uint64_t kLongestBatch = 4 * kPendingPositions;
/// Runs that are gathered before they are cut into chunks.
constexpr std::size_t kPendingRuns = 4096;
/// Bytes of draws and plans before the pass works off all it has.
constexpr std::size_t kRecordBytes = std::size_t{32} << 20;
/// Below this many positions waking another thread costs more than it brings.
constexpr std::uint64_t kInlinePositions = 512;

struct Worker {
  Arena arena;
  FrontScratch front;
  TileWorker tile;
};

/// A chunk or a clear, in API order.
struct Command {
  const ClearCommand* clear = nullptr;
  Chunk chunk;
  ChunkOutput output;
  bool done = false;  ///< the front end has run
};

/// Memory of a pass, kept for the next one.
struct Scratch {
  std::vector<std::unique_ptr<Worker>> workers;
  Arena arena;          ///< draws, clears, plans
  Arena run_arenas[2];  ///< runs of the commands in one; those of commands that are kept move to the other
  std::vector<Command> commands;
  std::vector<std::vector<TileItem>> items;  ///< by tile
  std::vector<std::uint32_t> touched;        ///< tiles with items
  std::vector<std::uint64_t> weights;        ///< by tile; of those without items, anything
  std::vector<Run> runs;
  std::deque<spirv::BoundShader> bound;
  std::deque<ViewLayer> view_layers;
  std::deque<PrimitiveInstances> instances;
};

class ScratchPool {
 public:
  std::unique_ptr<Scratch> lease() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return std::make_unique<Scratch>();
    std::unique_ptr<Scratch> scratch = std::move(free_.back());
    free_.pop_back();
    return scratch;
  }
  void give_back(std::unique_ptr<Scratch> scratch) noexcept {
    const std::lock_guard lock(mutex_);
    try {
      free_.push_back(std::move(scratch));
    } catch (const std::bad_alloc&) {
      // Freed instead.
    }
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Scratch>> free_;
};

ScratchPool& scratch_pool() {
  static ScratchPool& pool = base::lasting([] { return ScratchPool(); });
  return pool;
}

/// Cuts the render area to what all attachments have, so that no draw leaves memory.
void cut_render_area(PassDesc& desc) {
  const VkExtent2D room = cut_to_attachments(desc, {UINT32_MAX, UINT32_MAX});
  const VkRect2D& area = desc.render_area;
  const std::int64_t right = std::min(std::int64_t{area.offset.x} + area.extent.width, std::int64_t{room.width});
  const std::int64_t bottom = std::min(std::int64_t{area.offset.y} + area.extent.height, std::int64_t{room.height});
  const std::int64_t x = std::max(area.offset.x, 0), y = std::max(area.offset.y, 0);
  desc.render_area = {{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)},
                      {static_cast<std::uint32_t>(std::clamp<std::int64_t>(right - x, 0, 1 << 15)),
                       static_cast<std::uint32_t>(std::clamp<std::int64_t>(bottom - y, 0, 1 << 15))}};
}

bool same_resources(const spirv::ResourceTable& a, const spirv::ResourceTable& b) {
  return std::equal(std::begin(a.set), std::end(a.set), std::begin(b.set)) &&
         std::equal(std::begin(a.set_size), std::end(a.set_size), std::begin(b.set_size)) &&
         a.push_constants == b.push_constants && a.command == b.command;
}

/// Segments are longer without indices.
bool same_segments(const DrawRecord& last, const DrawCall& call) {
  const bool counts = last.plan->rectangles.any || last.plan->as_reference.segment != 0;
  return !counts || (last.call.index_data == nullptr) == (call.index_data == nullptr);
}

}  // namespace

struct Pass::Impl {
  PassDesc desc;
  TileGrid grid;
  std::unique_ptr<Scratch> scratch = scratch_pool().lease();
  bool broken = false;  ///< an exception left the scratch memory in between: nothing in it may be used again
  const DrawRecord* last = nullptr;
  std::uint64_t pending_positions = 0;
  std::size_t run_arena = 0;  ///< the one in use
  spirv::Fault unreported;

  explicit Impl(const PassDesc& pass_desc) : desc(pass_desc) {
    base::select_simd_target();
    cut_render_area(desc);
    const auto tiles = [](std::int32_t offset, std::uint32_t extent) {
      return (static_cast<std::uint32_t>(offset) + extent + kTileSize - 1) / kTileSize;
    };
    std::uint32_t views = 0;
    for (std::uint32_t mask = desc.view_mask; mask != 0; mask >>= 1) ++views;
    grid = {tiles(desc.render_area.offset.x, desc.render_area.extent.width),
            tiles(desc.render_area.offset.y, desc.render_area.extent.height),
            std::max({desc.layers, views, std::uint32_t{1}})};
    if (scratch->items.size() < grid.count()) scratch->items.resize(grid.count());
    scratch->workers.resize(std::max(scratch->workers.size(), base::worker_count()));
    for (std::unique_ptr<Worker>& worker : scratch->workers)
      if (!worker) worker = std::make_unique<Worker>();
  }

  ~Impl() {
    if (!broken) scratch_pool().give_back(std::move(scratch));
  }

  /// Work that an exception may leave half done: until done() the pass counts as broken.
  struct Unfinished {
    explicit Unfinished(Impl& impl) : impl_(impl) { impl.broken = true; }
    void done() { impl_.broken = false; }
    Impl& impl_;
  };

  Stage bind_stage(const spirv::Shader* shader, const NativeShader* native, const spirv::ResourceTable& resources,
                   spirv::Fault& fault, const Stage& previous) {
    if (native) return {nullptr, native};
    if (!shader) return {};
    if (previous.bound && &previous.bound->shader() == shader && same_resources(previous.bound->resources(), resources))
      return previous;
    return {&scratch->bound.emplace_back(*shader, resources, fault), nullptr};
  }

  /// The record of a draw, or null if it draws nothing.
  const DrawRecord* record_draw(const DrawCall& call) {
    DrawRecord* record = new (scratch->arena.take<DrawRecord>(1)) DrawRecord{};
    record->call = call;
    const bool same = last && last->call.state == call.state && last->call.vertex == call.vertex &&
                      last->call.control == call.control && last->call.evaluation == call.evaluation &&
                      last->call.geometry == call.geometry && last->call.fragment == call.fragment &&
                      last->call.native_vertex == call.native_vertex &&
                      last->call.native_fragment == call.native_fragment &&
                      last->call.general_path == call.general_path &&
                      last->call.takes_general_path() == call.takes_general_path() && same_segments(*last, call);
    if (same) {
      record->plan = last->plan;
    } else {
      PipelinePlan* plan = new (scratch->arena.take<PipelinePlan>(1)) PipelinePlan{};
      if (!make_plan(call, desc, *plan)) return nullptr;
      record->plan = plan;
    }
    spirv::Fault& fault = call.fault ? *call.fault : unreported;
    record->vertex =
        bind_stage(call.vertex, call.native_vertex, call.vertex_resources, fault, last ? last->vertex : Stage{});
    const auto bind_between = [&](const spirv::Shader* shader, Stage DrawRecord::*stage) {
      record->*stage = bind_stage(shader, nullptr, call.vertex_resources, fault, last ? last->*stage : Stage{});
    };
    bind_between(call.control, &DrawRecord::control);
    bind_between(call.evaluation, &DrawRecord::evaluation);
    bind_between(call.geometry, &DrawRecord::geometry);
    record->fragment = bind_stage(call.fragment, call.native_fragment, call.fragment_resources, fault,
                                  last ? last->fragment : Stage{});
    if (call.tile_observer)
      record->instances = &scratch->instances.emplace_back(call.first_instance, call.instance_count > 1);
    last = record;
    return record;
  }

  /// Turns the gathered runs into chunks of about kChunkPositions. Chunks that count are worked on at once, in order.
  void cut_chunks(const DrawRecord* record, std::uint32_t view, std::uint32_t* primitive_count = nullptr,
                  std::uint32_t* stipple_counter = nullptr, ViewLayer* view_layer = nullptr) {
    const std::vector<Run>& runs = scratch->runs;
    const PipelinePlan& plan = *record->plan;
    const TopologyShape& shape = plan.shape;
    Run* stored = scratch->run_arenas[run_arena].take<Run>(runs.size());
    std::copy(runs.begin(), runs.end(), stored);
    std::size_t first = 0;
    std::uint32_t positions = 0;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      positions += run_span(shape, runs[i]).count();
      pending_positions += std::uint64_t{run_span(shape, runs[i]).count()} * plan.position_weight;
      if (positions < plan.chunk_positions && i + 1 < runs.size()) continue;
      const auto count = static_cast<std::uint32_t>(i + 1 - first);
      scratch->commands.push_back(
          {nullptr, {record, stored + first, count, view, primitive_count, stipple_counter, view_layer}, {}});
      if (primitive_count || stipple_counter || view_layer) front_item(scratch->commands.size() - 1, 0);
      first = i + 1;
      positions = 0;
    }
    scratch->runs.clear();
    if (pending_positions >= kPendingPositions) run_front(true);
  }

  void draw_view(const DrawRecord* record, std::uint32_t view, ViewLayer* view_layer = nullptr) {
    const bool stippled_strip = record->plan->state->line_stipple && record->plan->draws_lines;
    const std::uint32_t limit = stippled_strip ? kStippledChunkPositions : record->plan->chunk_positions;
    const RectanglePlan& rectangles = record->plan->rectangles;
    const std::uint32_t segment = rectangles.any ? rectangles.segment : record->plan->as_reference.segment;
    const std::uint32_t piece = segment != 0 ? segment : piece_of(record->plan->shape, limit);
    // Chunks that count are worked on at once, so that all instances can count in the same place.
    std::uint32_t* const counters = scratch->arena.take<std::uint32_t>(2);
    std::vector<Run>& runs = scratch->runs;
    std::uint64_t positions = 0;
    bool continues = false;  // a run goes on with a stippled strip
    const auto cut = [&] {
      if (runs.empty()) return;
      cut_chunks(record, view, record->plan->counts_primitives ? counters : nullptr, continues ? counters + 1 : nullptr,
                 view_layer);
      positions = 0;
      continues = false;
    };
    for (std::uint32_t instance = record->call.skipped_instances; instance < record->call.instance_count; ++instance) {
      RunCutter cutter(record->call, record->plan->shape, instance, piece, record->plan->as_reference.numbers_segments);
      counters[0] = counters[1] = 0;
      bool any = false;
      for (Run run; cutter.next(run); any = true) {
        const bool full = runs.size() >= kPendingRuns || positions >= kPendingPositions;
        // A stippled strip that is cut hands its counter on from chunk to chunk.
        if (full && !(stippled_strip && run.begin != 0)) cut();
        continues |= stippled_strip && run.begin != 0;
        positions += std::uint64_t{run_span(record->plan->shape, run).count()} * record->plan->position_weight;
        runs.push_back(run);
      }
      if (!any) break;  // too few vertices: no instance has a primitive
      if (record->plan->counts_primitives || continues) cut();
    }
    cut();
  }

  void front_item(std::size_t index, std::size_t worker_index) {
    Command& command = scratch->commands[index];
    if (command.clear || command.done || works_in_order(command)) return;
    command.done = true;
    Worker& worker = *scratch->workers[worker_index];
    command.output = process_chunk(command.chunk, desc, grid, worker.arena, worker.front);
  }

  void add_item(std::uint32_t tile, const TileItem& item) {
    std::vector<TileItem>& items = scratch->items[tile];
    if (items.empty()) scratch->touched.push_back(tile);
    items.push_back(item);
  }

  void add_clear(const ClearCommand& clear) {
    const PixelRect& r = clear.rect;
    const std::uint32_t end = std::min(grid.layers, clear.base_layer + clear.layer_count);
    for (std::uint32_t layer = clear.base_layer; layer < end; ++layer)
      for (int y = r.y0 / kTileSize; y <= r.y1 / kTileSize; ++y)
        for (int x = r.x0 / kTileSize; x <= r.x1 / kTileSize; ++x)
          add_item(grid.index(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), layer),
                   {&clear, nullptr, nullptr, nullptr, 0});
  }

  /// Clears that no draw comes before or after need no tiles: whole rows go to memory faster. False if there are
  /// others.
  bool run_clears_alone() {
    std::vector<Command>& commands = scratch->commands;
    if (!scratch->touched.empty()) return false;
    if (!std::all_of(commands.begin(), commands.end(), [](const Command& c) { return c.clear != nullptr; }))
      return false;
    for (const Command& command : commands) {
      const ClearCommand& clear = *command.clear;
      if (clear.base_layer >= grid.layers) continue;
      const PixelRect& r = clear.rect;
      const VkRect2D area{{r.x0, r.y0},
                          {static_cast<std::uint32_t>(r.x1 - r.x0 + 1), static_cast<std::uint32_t>(r.y1 - r.y0 + 1)}};
      texel::fill_view(*clear.view, 0, area, clear.base_layer,
                       std::min(clear.layer_count, grid.layers - clear.base_layer), clear.value);
    }
    commands.clear();
    return true;
  }

  /// Chunks that may share batches of clipped triangles, and whose vertices cannot be shaded again without notice.
  static bool works_in_order(const Command& command) {
    if (command.clear || command.chunk.view_layer) return false;
    const DrawRecord& draw = *command.chunk.draw;
    return draw.plan->rectangles.any && (draw.call.queries.statistics || draw.call.feedback || draw.call.observer ||
                                         draw.plan->vertex->writes_memory ||
                                         (draw.plan->stages.geometry && draw.plan->stages.geometry->writes_memory));
  }

  /// Whether a batch of clipped triangles may go on from a command to the next one (ChunkOutput).
  bool shares_batch(std::size_t index) const {
    if (index + 1 >= scratch->commands.size()) return false;
    const Command &a = scratch->commands[index], &b = scratch->commands[index + 1];
    if (a.clear || b.clear || a.chunk.draw != b.chunk.draw || a.chunk.view != b.chunk.view) return false;
    if (a.chunk.view_layer) return false;  // they have been worked on, in order
    return works_in_order(a) || (a.output.ends_clipped && b.output.begins_clipped);
  }

  /// The first command behind those from `first` on that share a batch.
  std::size_t batch_end(std::size_t first) const {
    std::size_t end = first + 1;
    while (shares_batch(end - 1)) ++end;
    return end;
  }

  /// Works in order on chunks that share a batch, again or for the first time.
  void join_batch(std::size_t first, std::size_t end) {
    if (end - first == 1 && !works_in_order(scratch->commands[first])) return;
    ClippedBatch batch;
    batch.begin(*scratch->commands[first].chunk.draw->plan);
    for (std::size_t i = first; i < end; ++i) {
      Command& command = scratch->commands[i];
      command.chunk.batch = &batch;
      command.chunk.ends_batch = i + 1 == end;
      command.output = process_chunk(command.chunk, desc, grid, scratch->workers[0]->arena, scratch->workers[0]->front);
    }
  }

  std::size_t arena_bytes() const {
    std::size_t bytes = 0;
    for (const std::unique_ptr<Worker>& worker : scratch->workers) bytes += worker->arena.used();
    return bytes;
  }

  /// Runs the front end of commands from `first` on: of all, but of few at a time where stages may make many primitives
  /// of one. Returns the first command whose front end has not run.
  std::size_t run_some(std::size_t first) {
    std::vector<Command>& commands = scratch->commands;
    const std::size_t few = 2 * base::worker_count();
    std::size_t end = first + 1;
    while (end < commands.size() && (end - first < few || !amplifies(commands[end]))) ++end;
    if (pending_positions < kInlinePositions && !base::shakes(base::ShakeKind::kOrder)) {
      for (std::size_t i = first; i < end; ++i) front_item(i, 0);
    } else {
      base::parallel_for(end - first, [&](std::size_t i, std::size_t worker) { front_item(first + i, worker); });
    }
    return end;
  }

  /// Whether a chunk may leave more than its positions tell. Not where it may share a batch with those before it, which
  /// need a look at it.
  static bool amplifies(const Command& command) {
    return !command.clear && !command.chunk.draw->plan->rectangles.any && command.chunk.draw->plan->stages.any();
  }

  /// Hands the results of a command to the tiles.
  void hand_over(const Command& command) {
    if (command.clear) add_clear(*command.clear);
    if (command.output.capture) write_capture(*command.chunk.draw, *command.output.capture);
    for (std::uint32_t i = 0; i < command.output.range_count; ++i) {
      const TileRange& range = command.output.ranges[i];
      add_item(range.tile, {nullptr, command.chunk.draw, command.output.primitives, range.index, range.count});
    }
  }

  /// Whether a batch may go on from the last command to what the draw has yet.
  bool may_go_on(std::size_t index) const {
    const Command& command = scratch->commands[index];
    if (command.clear || command.chunk.view_layer || command.chunk.primitive_count) return false;
    return works_in_order(command) || command.output.ends_clipped;
  }

  /// Keeps the commands from `first` on for the next time, as if their front end had not run.
  void keep(std::size_t first) {
    std::vector<Command>& commands = scratch->commands;
    commands.erase(commands.begin(), commands.begin() + static_cast<std::ptrdiff_t>(first));
    Arena& from = scratch->run_arenas[run_arena];
    run_arena ^= 1;
    pending_positions = 0;
    for (Command& command : commands) {
      Chunk& chunk = command.chunk;
      Run* const runs = scratch->run_arenas[run_arena].take<Run>(chunk.run_count);
      std::copy_n(chunk.runs, chunk.run_count, runs);
      chunk.runs = runs;
      command.done = false;
      command.output = {};
      pending_positions += positions_of(chunk);
    }
    from.reset();
  }

  /// Runs the front end of everything recorded and hands its results to the tiles, in order. `more`: of a draw that
  /// goes on; a batch at its end is kept for what follows, unless it is too long.
  void run_front(bool more = false) {
    std::vector<Command>& commands = scratch->commands;
    if (commands.empty()) return;
    std::size_t handed = 0;
    for (bool kept = false; !kept && handed < commands.size();) {
      const std::size_t behind = run_some(handed);
      while (handed < behind) {
        const std::size_t end = batch_end(handed);
        kept =
            more && end == commands.size() && may_go_on(end - 1) && (handed != 0 || pending_positions < kLongestBatch);
        if (kept) break;
        join_batch(handed, end);
        for (; handed < end; ++handed) hand_over(commands[handed]);
      }
      for (std::unique_ptr<Worker>& worker : scratch->workers) worker->front.forget_stages();
      if (kept && handed == 0) return;
      if (arena_bytes() >= kBinBytes) run_back();
    }
    keep(handed);
  }

  /// Those with more primitives than the mean first, so that none of them is begun when the other threads have
  /// nothing left. The others stay in their order, in which neighbours find primitives in the caches.
  void sort_tiles() {
    if (base::worker_count() == 1) return;
    std::vector<std::uint32_t>& touched = scratch->touched;
    std::vector<std::uint64_t>& weights = scratch->weights;
    weights.resize(scratch->items.size());
    std::uint64_t sum = 0, most = 0;
    for (const std::uint32_t tile : touched) {
      std::uint64_t weight = 0;
      for (const TileItem& item : scratch->items[tile]) weight += 1 + item.count;
      weights[tile] = weight;
      sum += weight;
      most = std::max(most, weight);
    }
    const std::uint64_t mean = sum / std::max<std::size_t>(touched.size(), 1) + 1;
    if (most < 2 * mean) return;
    std::stable_sort(touched.begin(), touched.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return weights[a] / mean > weights[b] / mean; });
  }

  /// Draws what the tiles have.
  void run_back() {
    std::vector<std::uint32_t>& touched = scratch->touched;
    sort_tiles();
    base::parallel_for(touched.size(), [&](std::size_t i, std::size_t worker) {
      std::vector<TileItem>& items = scratch->items[touched[i]];
      process_tile(scratch->workers[worker]->tile, desc, grid, touched[i], items);
      items.clear();
    });
    touched.clear();
    for (std::unique_ptr<Worker>& worker : scratch->workers) {
      worker->tile.bound = {};
      worker->arena.reset();
    }
  }

  void clear(const texel::ImageView& view, const texel::StoredTexel& value, const VkRect2D& rect,
             std::uint32_t base_layer, std::uint32_t layer_count) {
    if (!view.format || grid.count() == 0) return;
    ClearCommand* command = new (scratch->arena.take<ClearCommand>(1)) ClearCommand{};
    const PixelRect tiles{0, 0, static_cast<int>(grid.columns) * kTileSize - 1,
                          static_cast<int>(grid.rows) * kTileSize - 1};
    const texel::Extent& extent = view.level[0].extent;
    const PixelRect image = pixel_rect({{0, 0}, {extent.width, extent.height}});
    command->view = &view;
    command->value = value;
    command->rect = intersect(tiles, intersect(image, pixel_rect(rect)));
    command->base_layer = base_layer;
    command->layer_count = std::min(layer_count, view.layer_count - std::min(base_layer, view.layer_count));
    if (!command->rect.empty() && command->layer_count) scratch->commands.push_back({command, {}, {}});
  }
};

Pass::Pass(const PassDesc& desc) : impl_(std::make_unique<Impl>(desc)) {}

Pass::~Pass() {
  if (impl_->broken) return;
  try {
    flush();
  } catch (...) {
    // flush() reports to who calls it; here only what nobody waits for is left.
  }
}

void Pass::clear_color(std::uint32_t attachment, const VkClearColorValue& value, const VkRect2D& rect,
                       std::uint32_t base_layer, std::uint32_t layer_count) {
  if (attachment >= impl_->desc.color_count || !impl_->desc.color[attachment].format) return;
  const texel::ImageView& view = impl_->desc.color[attachment];
  impl_->clear(view, texel::encode_clear_color(*view.format, value), rect, base_layer, layer_count);
}

void Pass::clear_depth_stencil(VkImageAspectFlags aspects, const VkClearDepthStencilValue& value, const VkRect2D& rect,
                               std::uint32_t base_layer, std::uint32_t layer_count) {
  const texel::ImageView &depth = impl_->desc.depth, &stencil = impl_->desc.stencil;
  if ((aspects & VK_IMAGE_ASPECT_DEPTH_BIT) != 0 && depth.format)
    impl_->clear(depth, texel::encode_clear_depth(*depth.format, value.depth), rect, base_layer, layer_count);
  if ((aspects & VK_IMAGE_ASPECT_STENCIL_BIT) != 0 && stencil.format)
    impl_->clear(stencil, texel::encode_clear_stencil(value.stencil), rect, base_layer, layer_count);
}

void Pass::draw(const DrawCall& draw) {
  if (draw.count == 0 || draw.instance_count == 0 || impl_->grid.count() == 0 || !draw.state) return;
  if (impl_->scratch->arena.used() >= kRecordBytes) flush();
  Impl::Unfinished unfinished(*impl_);
  const DrawRecord* record = impl_->record_draw(draw);
  if (!record) return unfinished.done();
  if (impl_->desc.view_mask == 0) impl_->draw_view(record, 0);
  ViewLayer* const view_layer =
      record->plan->as_reference.first_layer ? &impl_->scratch->view_layers.emplace_back() : nullptr;
  for (std::uint32_t view = 0; view < 32; ++view)
    if ((impl_->desc.view_mask >> view & 1) != 0) impl_->draw_view(record, view, view_layer);
  unfinished.done();
}

void Pass::flush() {
  Impl::Unfinished unfinished(*impl_);
  if (!impl_->run_clears_alone()) impl_->run_front();
  impl_->run_back();
  impl_->last = nullptr;
  impl_->scratch->bound.clear();
  impl_->scratch->view_layers.clear();
  impl_->scratch->instances.clear();
  impl_->scratch->arena.reset();
  unfinished.done();
}

}  // namespace vitrine::raster

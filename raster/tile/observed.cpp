// Fragments on their way through the fragment operations, for who observes (Vulkan 1.3.239, Fragment Operations).
#include "raster/tile/observed.h"

#include <algorithm>
#include <bit>

#include "base/lane_count.h"
#include "raster/draw_watches.h"
#include "raster/tile/block_inputs.h"
#include "raster/tile/discard_rectangles.h"
#include "raster/tile/early_tests.h"

namespace vitrine::raster {
namespace {

using base::LaneMask;

SampleLanes left_samples(const TileWorker& worker) { return {worker.told.left, worker.draw->plan->samples}; }

LaneMask any_of(SampleLanes samples) {
  LaneMask any = 0;
  for (const LaneMask lanes : samples) any |= lanes;
  return any;
}

std::uint64_t& ended_by(TileWorker& worker, FragmentTest test) {
  return worker.numbers.ended[static_cast<std::size_t>(test)];
}

/// Takes `lost[s]` from what is left, for all samples.
void tell_failed(TileWorker& worker, FragmentTest test, const LaneMask* lost) {
  const std::uint32_t samples = worker.draw->plan->samples;
  LaneMask any = 0;
  for (std::uint32_t s = 0; s < samples; ++s) {
    worker.told.left[s] &= ~lost[s];
    any |= lost[s];
  }
  if (any == 0) return;
  if (worker.tells_numbers)
    ended_by(worker, test) += base::count_lanes(any & ~any_of(left_samples(worker)));
  else
    worker.watch->failed(worker.told.group, test, {lost, samples}, left_samples(worker));
}

void count_written(TileWorker& worker, const texel::ImageView& view, SampleLanes written) {
  std::uint64_t texels = 0;
  for (const LaneMask lanes : written) texels += base::count_lanes(lanes);
  worker.numbers.texels += texels;
  worker.numbers.bytes += texels * view.format->block_bytes;
}

void tell_written(TileWorker& worker, const texel::ImageView& view, const LaneMask* lanes) {
  const SampleLanes written{lanes, worker.draw->plan->samples};
  if (worker.tells_numbers)
    count_written(worker, view, written);
  else if (any_of(written) != 0)
    worker.watch->written(worker.told.group, view, written);
}

LaneMask lanes_of_quads(std::uint32_t quads) {
  LaneMask lanes = 0;
  for (std::uint32_t q = 0; q < base::kQuadsPerWave; ++q)
    if ((quads >> q & 1) != 0) lanes |= LaneMask{15} << (4 * q);
  return lanes;
}

/// Lanes whose stencil value is replaced, by whatever.
LaneMask stencil_writes(const State& state, const FailedTests& failed, LaneMask passed, LaneMask front) {
  LaneMask written = 0;
  for (const bool faces : {true, false}) {
    const StencilFace& face = faces ? state.front : state.back;
    const LaneMask lanes = faces ? front : ~front;
    if (face.write_mask == 0) continue;
    if (face.fail != VK_STENCIL_OP_KEEP) written |= failed.stencil & lanes;
    if (face.depth_fail != VK_STENCIL_OP_KEEP) written |= failed.depth & lanes;
    if (face.pass != VK_STENCIL_OP_KEEP) written |= passed & lanes;
  }
  return written;
}

const PixelRect& region_of(const PipelinePlan& plan, const Primitive& primitive) {
  const bool wide = primitive.kind != PrimitiveKind::kTriangle && primitive.viewport == 0;
  return wide ? plan.wide_region : plan.region[primitive.viewport];
}

/// The pixels of a block inside the primitive's draw region.
LaneMask scissor_lanes(const PipelinePlan& plan, const Primitive& primitive, int x, int y) {
  if (is_inside_region(plan, primitive, x, y, x + kBlockSize - 1, y + kBlockSize - 1)) return base::kAllLanes;
  const PixelRect& region = region_of(plan, primitive);
  return rect_lanes(region.x0 - x, region.y0 - y, region.x1 - x, region.y1 - y);
}

/// Early tests of a block: row by row if there is depth alone.
void test_block(TileWorker& worker, const Primitive& primitive, int x, int y, BlockCoverage& block,
                FailedTests* failed) {
  const PipelinePlan& plan = *worker.draw->plan;
  if (!plan.tests_rows || !owns_square(worker, x, y, kBlockSize))
    return test_any_block(worker, primitive, x, y, block, failed);
  for (std::uint32_t s = 0; s < plan.samples; ++s) {
    const LaneMask before = block.lanes[s];
    if (before == 0) continue;
    test_blocks(worker, primitive, s, x, y, 1, &block.lanes[s], plan.depth_order == TestOrder::kEarly);
    failed[s].depth = before & ~block.lanes[s];
  }
}

void tell_generated(TileWorker& worker, const Primitive& primitive, int x, int y, const BlockCoverage& block) {
  BlockInputs inputs(worker, primitive, x, y, block);
  const bool known = worker.draw->call.tile_observer != nullptr && worker.draw->plan->fragment != nullptr;
  worker.told.group.inputs = known ? &inputs : nullptr;
  worker.watch->generated(worker.told.group, left_samples(worker));
  worker.told.group.inputs = nullptr;
}

bool has_full_mask(const PipelinePlan& plan) { return plan.sample_mask == (1u << plan.samples) - 1; }

/// No sample can be lost, and whole blocks are shaded at once.
bool has_whole_blocks(const PipelinePlan& plan) {
  return plan.shades && plan.shades_blocks && !plan.may_kill && plan.depth_order == TestOrder::kNone &&
         !plan.early_reject && has_full_mask(plan);
}

}  // namespace

void begin_observed(TileWorker& worker, std::uint32_t tile) {
  const DrawCall& call = worker.draw->call;
  const spirv::ObservedCommand* const command = call.vertex_resources.command;
  std::unique_ptr<DrawWatch> one =
      call.tile_observer ? call.tile_observer->watch_tile(command, place_of(worker)) : nullptr;
  if (call.observer) {
    worker.watch = call.observer->watch_tile(command, tile);
    if (!worker.watch) worker.watch = std::make_unique<DrawWatch>();
  }
  if (one && worker.watch) {
    auto both = std::make_unique<DrawWatches>();
    both->add(std::move(worker.watch));
    both->add(std::move(one));
    worker.watch = std::move(both);
  } else if (one) {
    worker.watch = std::move(one);
  }
  worker.told.group.instances = worker.draw->instances;
  const PipelinePlan& plan = *worker.draw->plan;
  const bool tests = plan.depth_order == TestOrder::kEarly || plan.early_reject;
  worker.tells_numbers = worker.watch && worker.watch->takes_numbers();
  worker.counts_tiles = worker.tells_numbers && has_full_mask(plan) && (plan.tests_rows || !tests);
  worker.has_whole_blocks = worker.tells_numbers && has_whole_blocks(plan);
  worker.numbers = {};
}

void end_observed(TileWorker& worker) {
  if (worker.tells_numbers) worker.watch->numbers(worker.numbers);
  worker.watch.reset();
}

bool is_inside_region(const PipelinePlan& plan, const Primitive& primitive, int x0, int y0, int x1, int y1) {
  const PixelRect& region = region_of(plan, primitive);
  return x0 >= region.x0 && y0 >= region.y0 && x1 <= region.x1 && y1 <= region.y1;
}

void count_whole_blocks(TileWorker& worker, LaneMask places) {
  const PipelinePlan& plan = *worker.draw->plan;
  const std::uint64_t pixels = base::count_lanes(places) * base::kWaveWidth;
  worker.numbers.passed += pixels;
  for (std::uint32_t i = 0; i < plan.color_count; ++i) {
    const texel::ImageView& view = worker.pass->color[i];
    if (!plan.writer[i].function || worker.target.layer >= view.layer_count) continue;
    worker.numbers.texels += pixels * plan.samples;
    worker.numbers.bytes += pixels * plan.samples * view.format->block_bytes;
  }
  worker.watch->shaded_blocks(places);
}

std::uint64_t count_fragments(const PipelinePlan& plan, const TileCoverage& coverage, LaneMask places) {
  std::uint64_t fragments = 0;
  for (; places != 0; places &= places - 1) {
    const auto place = static_cast<std::uint32_t>(std::countr_zero(places));
    LaneMask any = 0;
    for (std::uint32_t s = 0; s < plan.samples; ++s) any |= coverage.lanes[s][place];
    fragments += base::count_lanes(any);
  }
  return fragments;
}

void count_early_tests(TileWorker& worker, LaneMask places, std::uint64_t tested) {
  const PipelinePlan& plan = *worker.draw->plan;
  ended_by(worker, FragmentTest::kDepth) += tested - count_fragments(plan, worker.covered, places);
  if (plan.depth_order != TestOrder::kEarly || !plan.tests.depth_write) return;
  for (; places != 0; places &= places - 1) {
    const auto place = static_cast<std::uint32_t>(std::countr_zero(places));
    for (std::uint32_t s = 0; s < plan.samples; ++s)
      count_written(worker, worker.pass->depth, {&worker.covered.lanes[s][place], 1});
  }
}

void observe_block(TileWorker& worker, const Primitive& primitive, int x, int y, BlockCoverage& block,
                   BlockCoverage& rasterized) {
  const PipelinePlan& plan = *worker.draw->plan;
  if (any_sample(block, plan.samples) == 0) return;
  tell_block(worker, primitive, x, y, block);
  if (worker.tells_numbers)
    worker.numbers.generated += base::count_lanes(any_of(left_samples(worker)));
  else
    tell_generated(worker, primitive, x, y, block);
  if (plan.discards) {
    const LaneMask kept = undiscarded_lanes(plan, x, y);
    for (std::uint32_t s = 0; s < plan.samples; ++s) block.lanes[s] &= kept;
    tell_lost(worker, FragmentTest::kDiscardRectangle, block.lanes, 0, plan.samples);
  }
  if (const LaneMask inside = scissor_lanes(plan, primitive, x, y); inside != base::kAllLanes) {
    for (std::uint32_t s = 0; s < plan.samples; ++s) block.lanes[s] &= inside;
    tell_lost(worker, FragmentTest::kScissor, block.lanes, 0, plan.samples);
  }
  if (plan.sample_mask != (1u << plan.samples) - 1) {
    for (std::uint32_t s = 0; s < plan.samples; ++s)
      if ((plan.sample_mask >> s & 1) == 0) block.lanes[s] = 0;
    tell_lost(worker, FragmentTest::kSampleMask, block.lanes, 0, plan.samples);
  }
  rasterized = block;
  if (plan.depth_order == TestOrder::kEarly || plan.early_reject) {
    FailedTests failed[kMaxSamples];
    // Depths are worked out for those who watch pixels alone.
    for (std::uint32_t s = 0; worker.draw->call.tile_observer && s < plan.samples; ++s)
      tell_block_depths(worker, primitive, x, y, s);
    test_block(worker, primitive, x, y, block, failed);
    tell_tests(worker, failed, primitive.front ? 0xffffu : 0, 0, plan.samples, plan.depth_order == TestOrder::kEarly);
  }
  if (!plan.shades) tell_passed(worker);
}

void tell_block(TileWorker& worker, const Primitive& primitive, int x, int y, const BlockCoverage& block) {
  FragmentGroup& group = worker.told.group;
  std::copy_n(block.lanes, worker.draw->plan->samples, worker.told.left);
  if (worker.tells_numbers) return;
  place_block(x, y, group.position);
  std::fill(std::begin(group.primitive), std::end(group.primitive), primitive.id);
  std::fill(std::begin(group.from), std::end(group.from), &primitive);
  group.layer = worker.target.layer;
}

void tell_shaded_block(TileWorker& worker, int x, int y, LaneMask invocations, LaneMask helpers) {
  if (worker.tells_numbers && invocations == base::kAllLanes) {
    const int column = (x - worker.target.x) / kBlockSize, row = (y - worker.target.y) / kBlockSize;
    return worker.watch->shaded_blocks(rect_lanes(column, row, column, row));
  }
  if (worker.tells_numbers) place_block(x, y, worker.told.group.position);
  worker.watch->shaded(worker.told.group, invocations, helpers);
}

void tell_wave(TileWorker& worker, const PackedWave& wave) {
  FragmentGroup& group = worker.told.group;
  group.position = wave.position;
  for (std::uint32_t q = 0; q < wave.quads && !worker.tells_numbers; ++q) {
    group.from[q] = wave.primitive[wave.slot[q]];
    group.primitive[q] = group.from[q]->id;
  }
  if (!worker.tells_numbers) std::fill(group.from + wave.quads, std::end(group.from), nullptr);
  group.layer = worker.target.layer;
  std::copy_n(wave.coverage, worker.draw->plan->samples, worker.told.left);
}

void tell_fragments(TileWorker& worker) {
  tell_wave(worker, worker.wave);
  worker.told.group.rate = worker.coarse.rate;
}

void tell_lost(TileWorker& worker, FragmentTest test, const LaneMask* kept, std::uint32_t first, std::uint32_t end) {
  LaneMask lost[kMaxSamples] = {};
  for (std::uint32_t s = first; s < end; ++s) lost[s] = worker.told.left[s] & ~kept[s];
  tell_failed(worker, test, lost);
}

void tell_tests(TileWorker& worker, const FailedTests* failed, std::uint32_t front, std::uint32_t first,
                std::uint32_t end, bool writes) {
  const PipelinePlan& plan = *worker.draw->plan;
  LaneMask bounds[kMaxSamples] = {}, stencil[kMaxSamples] = {}, depth[kMaxSamples] = {};
  for (std::uint32_t s = first; s < end; ++s) {
    bounds[s] = failed[s].depth_bounds;
    stencil[s] = failed[s].stencil;
    depth[s] = failed[s].depth;
  }
  tell_failed(worker, FragmentTest::kDepthBounds, bounds);
  tell_failed(worker, FragmentTest::kStencil, stencil);
  tell_failed(worker, FragmentTest::kDepth, depth);
  if (!writes) return;
  LaneMask passed[kMaxSamples] = {}, replaced[kMaxSamples] = {};
  for (std::uint32_t s = first; s < end; ++s) {
    passed[s] = worker.told.left[s];
    replaced[s] = stencil_writes(*plan.state, failed[s], passed[s], lanes_of_quads(front));
  }
  if (plan.tests.depth_write) tell_written(worker, worker.pass->depth, passed);
  if (plan.tests.stencil) tell_written(worker, worker.pass->stencil, replaced);
}

void tell_block_depths(TileWorker& worker, const Primitive& primitive, int x, int y, std::uint32_t sample) {
  if (!worker.draw->plan->tests.depth) return;
  block_depths(worker, primitive, x, y, sample);
  worker.watch->testing(worker.told.group, sample, worker.depth);
}

void tell_colors(TileWorker& worker, const texel::ImageView& view, const LaneMask* kept, std::uint32_t first,
                 std::uint32_t end) {
  if (worker.tells_numbers) return count_written(worker, view, {kept + first, kept + end});
  LaneMask lanes[kMaxSamples] = {};
  std::copy(kept + first, kept + end, lanes + first);
  tell_written(worker, view, lanes);
}

void tell_passed(TileWorker& worker) {
  const SampleLanes left = left_samples(worker);
  if (worker.tells_numbers)
    worker.numbers.passed += base::count_lanes(any_of(left));
  else if (any_of(left) != 0)
    worker.watch->passed(worker.told.group, left);
}

}  // namespace vitrine::raster

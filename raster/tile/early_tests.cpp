// The worker's tile, its target and its primitives brought to the tests of block_depth.h and hierarchical_depth.h.
#include "raster/tile/early_tests.h"

#include <algorithm>

#include "raster/tile/primitive_planes.h"

namespace vitrine::raster {

namespace {

using base::LaneMask;

BlockPixels depth_pixels(const DepthStencilTarget& target, int x, int y) {
  return {target.depth + static_cast<std::uint64_t>(y) * target.depth_pitch +
              static_cast<std::uint64_t>(x) * depth_bytes(target.format),
          target.depth_pitch};
}

BlockDepthTest depth_test(const PipelinePlan& plan, const DepthStencilTarget& target, bool write,
                          const DepthRange& range) {
  return {target.format, plan.state->depth_compare, write && plan.tests.depth_write,
          plan.clamps_depth ? &range : nullptr, plan.restricts_depth};
}

/// `range`: room for the primitive's depth clamp.
HierarchicalTest hierarchical_test(TileWorker& worker, const Primitive& primitive, DepthRange& range) {
  const PipelinePlan& plan = *worker.draw->plan;
  const TileTarget& target = worker.target;
  range = depth_range(plan, primitive.viewport);
  return {depth_test(plan, target.depth_stencil[0], false, range),
          depth_plane(current_planes(worker, primitive), primitive), static_cast<float>(target.x),
          static_cast<float>(target.y), plan.locations};
}

}  // namespace

void block_depths(TileWorker& worker, const Primitive& primitive, int x, int y, std::uint32_t sample) {
  const PipelinePlan& plan = *worker.draw->plan;
  const DepthPlane plane = depth_plane(current_planes(worker, primitive), primitive);
  const float dx = plan.locations->pixel_x(sample), dy = plan.locations->pixel_y(sample);
  evaluate_block_depth(plane, static_cast<float>(x) + dx, static_cast<float>(y) + dy, plan.restricts_depth,
                       worker.depth);
  if (!plan.clamps_depth) return;
  DepthRange range[base::kQuadsPerWave];
  std::fill_n(range, base::kQuadsPerWave, depth_range(plan, primitive.viewport));
  clamp_depth(range, plan.restricts_depth, base::kQuadsPerWave, worker.depth);
}

void test_any_block(TileWorker& worker, const Primitive& primitive, int x, int y, BlockCoverage& block,
                    FailedTests* failed) {
  const PipelinePlan& plan = *worker.draw->plan;
  QuadPositions quads;
  place_block(x, y, quads);
  for (std::uint32_t s = 0; s < plan.samples; ++s) {
    if (!block.lanes[s]) continue;
    if (plan.tests.depth) block_depths(worker, primitive, x, y, s);
    block.lanes[s] = test_depth_stencil(plan.tests, worker.target.depth_stencil[s], quads,
                                        primitive.front ? 0xffffu : 0, worker.depth, nullptr, block.lanes[s],
                                        plan.depth_order == TestOrder::kEarly, failed ? failed + s : nullptr);
    if (!plan.as_reference.first_sample_depth) continue;
    std::fill(block.lanes + s, block.lanes + plan.samples, block.lanes[s]);
    break;
  }
}

LaneMask test_blocks(TileWorker& worker, const Primitive& primitive, std::uint32_t sample, int x, int y,
                     LaneMask places, LaneMask* lanes, bool write) {
  const PipelinePlan& plan = *worker.draw->plan;
  const DepthStencilTarget& target = worker.target.depth_stencil[sample];
  const float dx = plan.locations->pixel_x(sample), dy = plan.locations->pixel_y(sample);
  const DepthPlane plane = depth_plane(current_planes(worker, primitive), primitive);
  const DepthRange range = depth_range(plan, primitive.viewport);
  return test_block_depths(depth_test(plan, target, write, range), plane, static_cast<float>(x) + dx,
                           static_cast<float>(y) + dy, depth_pixels(target, x, y), places, lanes);
}

void test_windows(TileWorker& worker, std::uint32_t viewport, DepthWindow* windows, std::size_t count) {
  const PipelinePlan& plan = *worker.draw->plan;
  const DepthStencilTarget& target = worker.target.depth_stencil[0];
  const DepthRange range = depth_range(plan, viewport);
  test_window_depths(depth_test(plan, target, plan.depth_order == TestOrder::kEarly, range), depth_pixels(target, 0, 0),
                     windows, count);
}

bool test_large_window(TileWorker& worker, const Primitive& primitive, int x, int y, LargeWindow& window) {
  const PipelinePlan& plan = *worker.draw->plan;
  const DepthStencilTarget& target = worker.target.depth_stencil[0];
  const DepthPlane plane = depth_plane(current_planes(worker, primitive), primitive);
  const DepthRange range = depth_range(plan, primitive.viewport);
  return test_large_window_depths(depth_test(plan, target, plan.depth_order == TestOrder::kEarly, range), plane,
                                  static_cast<float>(x), static_cast<float>(y), depth_pixels(target, x, y), window);
}

LaneMask unhidden_places(TileWorker& worker, const Primitive& primitive, LaneMask places) {
  DepthRange range;
  return unhidden_blocks(worker.hierarchy, hierarchical_test(worker, primitive, range), places);
}

void learn_hidden_places(TileWorker& worker, const Primitive& primitive, LaneMask places) {
  DepthRange range;
  const TileTarget& target = worker.target;
  const std::uint32_t samples = worker.draw->plan->samples;
  BlockPixels pixels[kMaxSamples];
  for (std::uint32_t s = 0; s < samples; ++s) pixels[s] = depth_pixels(target.depth_stencil[s], target.x, target.y);
  learn_depths(worker.hierarchy, hierarchical_test(worker, primitive, range), pixels, samples, places);
}

void learn_hidden_rect(TileWorker& worker, const Primitive& primitive, const PixelRect& rect) {
  const TileTarget& target = worker.target;
  const base::LaneMask owned =
      rect_lanes(0, 0, (target.right - target.x) / kBlockSize - 1, (target.bottom - target.y) / kBlockSize - 1);
  learn_hidden_places(worker, primitive, places_of(rect) & owned);
}

}  // namespace vitrine::raster

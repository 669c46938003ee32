// Primitives whose coverage the front end found: windows of 8x8 pixels one by one, those of 4x4 in groups.
#include "raster/tile/windows.h"

#include <bit>

#include "raster/tile/early_tests.h"
#include "raster/tile/fragment_outputs.h"
#include "raster/tile/pack.h"
#include "raster/tile/primitive_planes.h"

namespace vitrine::raster {

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
    if (plan.tests_rows && owns_square(worker, x, y, kBlockSize))
      test_blocks(worker, primitive, 0, x, y, 1, block.lanes, plan.depth_order == TestOrder::kEarly);
    else
      test_any_block(worker, primitive, x, y, block);
    if (block.lanes[0] == 0) return;
  }
  if (!plan.shades) {
    count_samples(worker, block.lanes[0]);
    return;
  }
  append_quads(worker, primitive, x, y, rasterized, block, base::quads_of_lanes(block.lanes[0]));
}

bool is_small_window(const TileWorker& worker, const Primitive& primitive) {
  return primitive.window != 0 && (primitive.window & ~kSmallWindow) == 0 &&
         owns_square(worker, primitive.x0 & ~1, primitive.y0 & ~1, 4);
}

void emit_small_windows(TileWorker& worker, const Primitive* const* primitives, std::uint32_t count) {
  const PipelinePlan& plan = *worker.draw->plan;
  DepthWindow windows[kWindowGroup];
  PlaneSet* planes[kWindowGroup];
  for (std::uint32_t i = 0; i < count; ++i) {
    const Primitive& primitive = *primitives[i];
    planes[i] = worker.pool.take();
    compute_planes(plan, primitive, *planes[i]);
    windows[i] = {depth_plane(*planes[i], primitive), primitive.x0 & ~1, primitive.y0 & ~1,
                  transpose_window(quads_of_small_window(primitive.window))};
  }
  if (plan.depth_order == TestOrder::kEarly || plan.early_reject)
    test_windows(worker, primitives[0]->viewport, windows, count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const Primitive& primitive = *primitives[i];
    const DepthWindow& window = windows[i];
    if (window.rows == 0 || !plan.shades) {
      worker.pool.give_back(planes[i]);
      count_samples(worker, window.rows);
      continue;
    }
    set_current_planes(worker, &primitive, planes[i]);
    const BlockCoverage block{{block_of_small_window(transpose_window(window.rows))}}, rasterized{{primitive.window}};
    append_quads(worker, primitive, window.x, window.y, rasterized, block, base::quads_of_lanes(block.lanes[0]));
  }
}

}  // namespace vitrine::raster

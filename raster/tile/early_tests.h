// Tests of a primitive's coverage in the tile at hand, most of them before shading: depth row by row where a draw
// allows (PipelinePlan::tests_rows), anything else quad by quad; and what the limits of stored depths hide.
#pragma once

#include <cstddef>
#include <cstdint>

#include "raster/pixel_rect.h"
#include "raster/tile/worker.h"

namespace vitrine::raster {

/// The depths of a primitive in a sample of the block at (x, y), clamped, into worker.depth.
void block_depths(TileWorker& worker, const Primitive& primitive, int x, int y, std::uint32_t sample);

/// Tests a block before shading, whatever is tested and wherever it lies. Writes unless the test is only a preview of a
/// late one. `failed`: what failed, by sample, for observers; or null.
void test_any_block(TileWorker& worker, const Primitive& primitive, int x, int y, BlockCoverage& block,
                    FailedTests* failed = nullptr);

/// Depth test, in one sample, of the blocks at the quad-ordered places of `places`, all of which lie inside all
/// attachments; the block at place 0 is at (x, y). Cuts lanes[place] to what passed and returns where nothing did.
base::LaneMask test_blocks(TileWorker& worker, const Primitive& primitive, std::uint32_t sample, int x, int y,
                           base::LaneMask places, base::LaneMask* lanes, bool write);

/// Early depth test of windows inside all attachments whose primitives have one viewport; single-sampled.
void test_windows(TileWorker& worker, std::uint32_t viewport, DepthWindow* windows, std::size_t count);

/// Early depth test of the large window at (x, y), inside all attachments; single-sampled. False: nothing passed.
bool test_large_window(TileWorker& worker, const Primitive& primitive, int x, int y, LargeWindow& window);

/// Those of `places`, of the tile, in which a sample of the primitive may pass the early test.
base::LaneMask unhidden_places(TileWorker& worker, const Primitive& primitive, base::LaneMask places);

/// Nothing of the primitive passed in `places`, which lie inside all attachments: others may be rejected at once.
void learn_hidden_places(TileWorker& worker, const Primitive& primitive, base::LaneMask places);

/// The same for the blocks with pixels of `rect`, which is in the tile.
void learn_hidden_rect(TileWorker& worker, const Primitive& primitive, const PixelRect& rect);

}  // namespace vitrine::raster

// What the watch of an observed draw is told of fragments: blocks before they are shaded, packed waves while they are.
#pragma once

#include "raster/tile/worker.h"

namespace vitrine::raster {

/// The tile at hand, for who observes tiles.
inline TilePlace place_of(const TileWorker& worker) {
  return {worker.pass, worker.target.x, worker.target.y, worker.target.layer};
}
/// Begins to watch the tile for its draw, if anybody does.
void begin_observed(TileWorker& worker, std::uint32_t tile);
/// The draw is done in the tile.
void end_observed(TileWorker& worker);

/// Whether pixels (x0, y0) to (x1, y1) are inside the primitive's draw region.
bool is_inside_region(const PipelinePlan& plan, const Primitive& primitive, int x0, int y0, int x1, int y1);
/// Counts blocks of the tile none of whose samples a test can take any more as shaded, passed and written.
void count_whole_blocks(TileWorker& worker, base::LaneMask places);
/// Fragments in blocks of a tile.
std::uint64_t count_fragments(const PipelinePlan& plan, const TileCoverage& coverage, base::LaneMask places);
/// Counts early tests that took depth alone into account: of `tested` fragments worker.covered has those, in blocks of
/// `places`, that have passed.
void count_early_tests(TileWorker& worker, base::LaneMask places, std::uint64_t tested);

/// A block of `primitive` at (x, y): what discard rectangles, scissor, sample mask and early tests leave of it, told.
/// On return `rasterized` is what they were before the early tests.
void observe_block(TileWorker& worker, const Primitive& primitive, int x, int y, BlockCoverage& block,
                   BlockCoverage& rasterized);

/// The block's fragments are those that what follows is about.
void tell_block(TileWorker& worker, const Primitive& primitive, int x, int y, const BlockCoverage& block);
/// An invocation of each pixel of `invocations` has shaded the block that was told of; `helpers` helped.
void tell_shaded_block(TileWorker& worker, int x, int y, base::LaneMask invocations, base::LaneMask helpers);
/// The wave's fragments are those that what follows is about.
void tell_wave(TileWorker& worker, const PackedWave& wave);
/// The same of the fragments of the packed wave where they may cover several pixels, for what the shader does.
void tell_fragments(TileWorker& worker);
/// Of the samples [first, end) those that are no longer in `kept` failed a test.
void tell_lost(TileWorker& worker, FragmentTest test, const base::LaneMask* kept, std::uint32_t first,
               std::uint32_t end);
/// Tests of depth and stencil, by sample; `front`: bit q is the facing of quad q. `writes`: they have written, too.
void tell_tests(TileWorker& worker, const FailedTests* failed, std::uint32_t front, std::uint32_t first,
                std::uint32_t end, bool writes);
/// The depth test, of a sample of the block at (x, y), compares the primitive's depths.
void tell_block_depths(TileWorker& worker, const Primitive& primitive, int x, int y, std::uint32_t sample);
/// Samples [first, end) of `kept` have been written to a colour attachment.
void tell_colors(TileWorker& worker, const texel::ImageView& view, const base::LaneMask* kept, std::uint32_t first,
                 std::uint32_t end);
/// What is left has passed.
void tell_passed(TileWorker& worker);

}  // namespace vitrine::raster

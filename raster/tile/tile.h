// The back end: one tile at a time, its primitives in API order (design.md section 3). Covered quads are packed into
// waves across primitives of a draw, shaded, tested and written. Sections cited are of lavapipe-rasterization.md.
#pragma once

#include <cstdint>
#include <vector>

#include "raster/output/depth_stencil.h"
#include "raster/primitive.h"
#include "raster/tile/block.h"
#include "raster/tile/coverage.h"
#include "raster/tile/hierarchical_depth.h"
#include "raster/tile/interpolate.h"
#include "texel/codec.h"

namespace vitrine::raster {

/// A clear in the order of the draws.
struct ClearCommand {
  const texel::ImageView* view;
  texel::StoredTexel value;
  PixelRect rect;
  std::uint32_t base_layer, layer_count;
};

/// What a tile has to do next: a clear, or primitives of one chunk.
struct TileItem {
  const ClearCommand* clear;
  const DrawRecord* draw;
  const Primitive* primitives;
  const std::uint32_t* index;
  std::uint32_t count;
};

/// Coverage of one block by sample, in quad order.
struct BlockCoverage {
  base::LaneMask lanes[kMaxSamples];
};

/// Coverage of all blocks of a tile by sample and quad-ordered place.
struct TileCoverage {
  base::LaneMask lanes[kMaxSamples][base::kWaveWidth];
};

inline base::LaneMask any_sample(const BlockCoverage& block, std::uint32_t samples) {
  base::LaneMask any = block.lanes[0];
  for (std::uint32_t s = 1; s < samples; ++s) any |= block.lanes[s];
  return any;
}

/// Quads waiting to be shaded, of one draw.
struct PackedWave {
  std::uint32_t quads = 0;
  std::uint32_t slots = 0;
  QuadPositions position;
  std::uint8_t slot[base::kQuadsPerWave];
  const Primitive* primitive[base::kQuadsPerWave];  ///< by slot
  WavePlanes planes;                                ///< likewise
  base::LaneMask coverage[kMaxSamples];             ///< by sample of the attachments
  base::LaneMask rasterized[kMaxSamples];           ///< before early tests: gl_SampleMask as an input (8.5)
};

/// Quads of a tile: bit x / 2 of row y / 2.
struct QuadMap {
  std::uint32_t row[kTileSize / 2];
};

/// Windows that are tested together: their planes are there before the first depth is read.
inline constexpr std::uint32_t kWindowGroup = 8;

/// Planes of the primitives in a wave, in a group of windows, and of the one being rasterized.
class PlanePool {
 public:
  void reset() {
    for (std::uint32_t i = 0; i < kCount; ++i) free_[i] = static_cast<std::uint8_t>(i);
    free_count_ = kCount;
  }
  PlaneSet* take() { return &set_[free_[--free_count_]]; }
  void give_back(const PlaneSet* set) { free_[free_count_++] = static_cast<std::uint8_t>(set - set_); }

 private:
  static constexpr std::uint32_t kCount = base::kQuadsPerWave + kWindowGroup + 1;
  PlaneSet set_[kCount];
  std::uint8_t free_[kCount];
  std::uint32_t free_count_ = 0;
};

/// The tile being worked on.
struct TileTarget {
  int x = 0, y = 0;  ///< first pixel
  std::uint32_t layer = 0;
  int right = 0, bottom = 0;  ///< where the tile or the smallest attachment ends
  DepthStencilTarget depth_stencil[kMaxSamples];
};

/// What whole blocks of a draw share (block_shade.cpp).
struct BlockDraw {
  bool is_short = false;              ///< the shader: see spirv::is_short()
  bool solid = false;                 ///< every fragment has the colours `color`: the shader need not run
  std::vector<BlockVarying> varying;  ///< perspective ones, then linear ones
  std::size_t perspective = 0;
  PackedBlock color[kMaxColorAttachments];
};

/// Working memory of one thread, kept between tiles.
struct TileWorker {
  const PassDesc* pass = nullptr;
  TileTarget target;
  const DrawRecord* draw = nullptr;  ///< of the packed wave
  PackedWave wave;                   ///< being packed
  QuadMap packed;                    ///< its quads
  PackedWave block;                  ///< one whole block, shaded at once
  BlockDraw block_draw;
  TileCoverage covered, rasterized;  ///< of the primitive being rasterized: what passed so far, and before any test
  HierarchicalDepth hierarchy;
  StageRunner runner;
  Stage bound;
  PlanePool pool;
  PlaneSet* planes = nullptr;  ///< of the pool: of `planes_of`; null: of none
  const Primitive* planes_of = nullptr;
  WavePoints center, place;
  alignas(64) float reciprocal_w[base::kWaveWidth];
  alignas(64) float depth[base::kWaveWidth];
  base::WaveRegister color[4], second[4];
  alignas(64) float line_coverage[base::kWaveWidth];  ///< smooth lines: what alpha is multiplied with
  bool counts = false;                                ///< the draw has queries
  std::uint64_t samples_passed = 0;                   ///< not yet added to the draw's query
  std::uint64_t fragment_invocations = 0;             ///< likewise
};

/// Does `items` of one tile in order. Flushes denormals while it works.
void process_tile(TileWorker& worker, const PassDesc& pass, const TileGrid& grid, std::uint32_t tile,
                  const std::vector<TileItem>& items);

/// Covers, tests early and packs one primitive (rasterize.cpp).
void rasterize_primitive(TileWorker& worker, const Primitive& primitive);

/// Tests a block before shading, whatever is tested and wherever it lies. Writes unless the test is only a preview of a
/// late one.
void test_any_block(TileWorker& worker, const Primitive& primitive, int x, int y, BlockCoverage& block);

/// A primitive whose coverage the front end found (windows.cpp).
void emit_window(TileWorker& worker, const Primitive& primitive);

/// Whether such a primitive may go into a group: a window of 4x4 pixels that nothing cuts.
bool is_small_window(const TileWorker& worker, const Primitive& primitive);

/// Small windows of one draw and one viewport, at most kWindowGroup. Each step is done for all of them before the next,
/// so that none waits for the results of the one before.
void emit_small_windows(TileWorker& worker, const Primitive* const* primitives, std::uint32_t count);

/// Prepares worker.block_draw for the draw just bound, if its plan shades blocks.
void begin_blocks(TileWorker& worker);

/// Shades, tests late and writes a block inside all attachments whose first pixel is (x, y), in the framebuffer.
void shade_block(TileWorker& worker, const Primitive& primitive, int x, int y, const BlockCoverage& block);

/// Whether rows of a square may be read and written without looking at their pixels: it lies inside all attachments,
/// and inside the tile, beside which other threads are at work (windows do not keep to the grid of blocks).
inline bool owns_square(const TileWorker& worker, int x, int y, int side) {
  const TileTarget& target = worker.target;
  return x >= target.x && y >= target.y && x + side <= target.right && y + side <= target.bottom;
}

/// Whether the coverage before early tests is wanted: copies of it right after it was made stall.
inline bool reads_rasterized(const TileWorker& worker) { return worker.draw->plan->frag.sample_mask_in != kNoReg; }

/// A block's coverage after early tests, to a wave (pack.cpp).
void emit_block(TileWorker& worker, const Primitive& primitive, int x, int y, const BlockCoverage& rasterized,
                const BlockCoverage& block);

/// Makes planes of the pool the current ones. Those before stay taken as long as the wave uses them.
void set_current_planes(TileWorker& worker, const Primitive* primitive, PlaneSet* planes);

/// Appends the quads of a block whose lowest lanes are set in `quads` to the packed wave.
void append_quads(TileWorker& worker, const Primitive& primitive, int x, int y, const BlockCoverage& rasterized,
                  const BlockCoverage& block, base::LaneMask quads);

/// Planes of a wave's primitives may be used again, but for the current ones.
void release_planes(TileWorker& worker, const PackedWave& wave);

/// Planes of the primitive being rasterized.
const PlaneSet& current_planes(TileWorker& worker, const Primitive& primitive);

/// Positions of the quads of the block at (x, y).
void place_block(int x, int y, QuadPositions& out);

/// Depth test, in one sample, of the blocks at the quad-ordered places of `places`, all of which lie inside all
/// attachments; the block at place 0 is at (x, y). Cuts lanes[place] to what passed and returns where nothing did.
base::LaneMask test_blocks(TileWorker& worker, const Primitive& primitive, std::uint32_t sample, int x, int y,
                           base::LaneMask places, base::LaneMask* lanes, bool write);

/// Those of `places`, of the tile, in which a sample of the primitive may pass the early test.
base::LaneMask unhidden_places(TileWorker& worker, const Primitive& primitive, base::LaneMask places);

/// Nothing of the primitive passed in `places`, which lie inside all attachments: others may be rejected at once.
void learn_hidden_places(TileWorker& worker, const Primitive& primitive, base::LaneMask places);

/// Early depth test of the large window at (x, y), inside all attachments; single-sampled. False: nothing passed.
bool test_large_window(TileWorker& worker, const Primitive& primitive, int x, int y, LargeWindow& window);

/// The same for the blocks with pixels of `rect`, which is in the tile.
void learn_hidden_rect(TileWorker& worker, const Primitive& primitive, const PixelRect& rect);

/// Early depth test of windows inside all attachments whose primitives have one viewport; single-sampled.
void test_windows(TileWorker& worker, std::uint32_t viewport, DepthWindow* windows, std::size_t count);

/// Shades, tests and writes the quads of `wave`, one of the worker's; empties it (fragment.cpp).
void shade_wave(TileWorker& worker, PackedWave& wave);

}  // namespace vitrine::raster

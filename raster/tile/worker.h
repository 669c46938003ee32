// The working memory of one thread in the back end: the tile at hand, its stored depths' limits, the wave being packed,
// planes, and what one run of the fragment shader needs. Values with no more than trivial functions; who works on them
// stands beside it, from tile.h down to fragment.h.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "raster/observe.h"
#include "raster/output/color_block.h"
#include "raster/output/depth_stencil.h"
#include "raster/pass_desc.h"
#include "raster/pixel_order.h"
#include "raster/primitive.h"
#include "raster/tile/block_planes.h"
#include "raster/tile/hierarchical_depth.h"
#include "raster/tile/interpolate.h"

namespace vitrine::raster {

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
  base::LaneMask rasterized[kMaxSamples];           ///< before early tests: gl_SampleMask as an input
                                                    ///< (lavapipe-rasterization.md 8.5)
};

/// Fragments of more than one pixel, or of one in draws that have both. The quads of the packed wave are then quads of
/// such fragments, which lie in one block; each consists of as many quads of pixels as a fragment has pixels, numbered
/// row by row.
struct CoarseWave {
  FragmentRate rate = 0;  ///< of all of the wave
  /// Of the pixels, by quad of pixels and sample; lanes as those of the wave. What PackedWave has of these is not used.
  base::LaneMask coverage[kMaxFragmentPixels][kMaxSamples];
  base::LaneMask rasterized[kMaxFragmentPixels][kMaxSamples];
};

/// Quads of a tile: bit x / 2 of row y / 2.
struct QuadMap {
  std::uint32_t row[kTileSize / 2];

  void add(std::uint32_t x, std::uint32_t y) { row[y / 2] |= 1u << x / 2; }
  /// Of a row of quads from (x, y) on, which are in the map; bit 0 is the first.
  std::uint32_t from(std::uint32_t x, std::uint32_t y) const { return row[y / 2] >> x / 2; }
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

/// What whole blocks of a draw share (block_shade.h).
struct BlockDraw {
  bool is_short = false;              ///< the shader: see spirv::is_short()
  bool solid = false;                 ///< every fragment has the colours `color`: the shader need not run
  bool counted = false;               ///< but who observes it wants to know how often it would
  std::vector<BlockVarying> varying;  ///< perspective ones, then linear ones
  std::size_t perspective = 0;
  PackedBlock color[kMaxColorAttachments];
};

/// The fragments that the watch of an observed draw is told of.
struct ToldFragments {
  FragmentGroup group;
  base::LaneMask left[kMaxSamples];  ///< those that have failed no test, by sample
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
  std::unique_ptr<DrawWatch> watch;                   ///< null: nobody observes the draw
  ToldFragments told;
  bool tells_numbers = false;     ///< the watch wants no more, which are
  FragmentNumbers numbers;        ///< not yet told
  bool counts_tiles = false;      ///< likewise, and primitives are tested by the tile where they can be
  bool has_whole_blocks = false;  ///< likewise, and nothing can take samples of what a primitive covers
  CoarseWave coarse;              ///< the rest of `wave`, where FragmentRates::any
};

/// Whether rows of a square may be read and written without looking at their pixels: it lies inside all attachments,
/// and inside the tile, beside which other threads are at work (windows do not keep to the grid of blocks).
inline bool owns_square(const TileWorker& worker, int x, int y, int side) {
  const TileTarget& target = worker.target;
  return x >= target.x && y >= target.y && x + side <= target.right && y + side <= target.bottom;
}

/// Whether the coverage before early tests is wanted: copies of it right after it was made stall.
inline bool reads_rasterized(const TileWorker& worker) { return worker.draw->plan->frag.sample_mask_in != kNoReg; }

}  // namespace vitrine::raster

// Hierarchical depth rejection: of each 8x8 block of a tile the one stored depth that hides least. A primitive that it
// hides wherever it may lie in the block is neither covered nor tested there. Knows nothing of stencil and of blocks
// that the attachment does not hold as a whole.
#pragma once

#include <cstdint>

#include "base/lanes.h"
#include "raster/sample_locations.h"
#include "raster/tile/block_depth.h"

namespace vitrine::raster {

/// What is known of a tile's stored depths, by quad-ordered place of the block.
struct HierarchicalDepth {
  alignas(64) std::int32_t limit[base::kWaveWidth];  ///< as encoded: the largest of the block, or the smallest
  base::LaneMask known = 0;                          ///< blocks whose limit holds
  bool largest = true;                               ///< which limits these are
  base::LaneMask exhausted = 0;                      ///< blocks not looked at again: it was in vain too often
  std::uint8_t vain[base::kWaveWidth];               ///< looks that did not help

  /// Nothing is known of the tile.
  void reset();
  /// Drops what a draw may change.
  void begin_draw(const PipelinePlan& plan);
};

/// The places of one primitive's test in a tile whose first pixel is (x, y).
struct HierarchicalTest {
  BlockDepthTest test;
  DepthPlane plane;
  float x, y;
  const SampleLocations* locations;
};

/// Those of `places` in which a sample of the primitive may pass.
base::LaneMask unhidden_blocks(const HierarchicalDepth& depths, const HierarchicalTest& test, base::LaneMask places);

/// Looks at the stored depths of `places`, in which nothing of the primitive passed. `samples`: the tile's pixels, by
/// sample.
void learn_depths(HierarchicalDepth& depths, const HierarchicalTest& test, const BlockPixels* samples,
                  std::uint32_t sample_count, base::LaneMask places);

}  // namespace vitrine::raster

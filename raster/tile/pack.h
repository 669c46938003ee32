// Blocks on the way to the shader: quads are packed into waves across primitives of a draw, blocks with few empty quads
// are shaded on their own.
#pragma once

#include "base/lanes.h"
#include "raster/tile/worker.h"

namespace vitrine::raster {

/// Appends the quads of a block whose lowest lanes are set in `quads` to the packed wave.
void append_quads(TileWorker& worker, const Primitive& primitive, int x, int y, const BlockCoverage& rasterized,
                  const BlockCoverage& block, base::LaneMask quads);

/// A block's coverage after early tests, to a wave.
void emit_block(TileWorker& worker, const Primitive& primitive, int x, int y, const BlockCoverage& rasterized,
                const BlockCoverage& block);

/// The same for an observed draw: blocks without empty quads are shaded on their own.
void emit_observed_block(TileWorker& worker, const Primitive& primitive, int x, int y, const BlockCoverage& rasterized,
                         const BlockCoverage& block);

}  // namespace vitrine::raster

// Blocks of draws whose fragments may cover several pixels, on the way to the shader.
#pragma once

#include "raster/tile/worker.h"

namespace vitrine::raster {

/// A block's coverage after early tests, to the packed wave, as quads of fragments. (x, y) is on the framebuffer's grid
/// of blocks, so that no fragment lies in two.
void emit_coarse_block(TileWorker& worker, const Primitive& primitive, int x, int y, const BlockCoverage& rasterized,
                       const BlockCoverage& block);

}  // namespace vitrine::raster

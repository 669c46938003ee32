// One primitive in a tile: which of the four ways it takes, and the longest of them, blocks. The ways, the words for
// them and why all give the same bits: docs/raster.md.
#pragma once

#include "raster/tile/worker.h"

namespace vitrine::raster {

/// Covers, tests early and packs one primitive.
void rasterize_primitive(TileWorker& worker, const Primitive& primitive);

/// The same for an observed draw, block by block of the tile's grid. `hidden`: its colours need not be written.
void rasterize_observed_primitive(TileWorker& worker, const Primitive& primitive, bool hidden);

}  // namespace vitrine::raster

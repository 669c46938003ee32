// Triangles in a window of 16x16 pixels beside packed waves: from coverage by rows to waves of one primitive's quads
// that lie side by side (raster/pixel_order.h: SpanWave), whose pixels are read and written a row at a time.
#pragma once

#include "raster/tile/coverage.h"
#include "raster/tile/worker.h"

namespace vitrine::raster {

/// A triangle that lies in a window of 16x16 pixels of the worker's tile, covered, tested and shaded. `rect`: its
/// pixels in the tile; `edges`: its edges there. False: it has to go another way.
bool emit_large_window(TileWorker& worker, const Primitive& primitive, TileEdges& edges, const PixelRect& rect);

}  // namespace vitrine::raster

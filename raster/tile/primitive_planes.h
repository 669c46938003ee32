// Planes of the primitives a worker has at hand: computed once for each, kept as long as a wave of quads needs them.
#pragma once

#include "raster/tile/worker.h"

namespace vitrine::raster {

/// Planes of the primitive being rasterized.
const PlaneSet& current_planes(TileWorker& worker, const Primitive& primitive);

/// Makes planes of the pool the current ones. Those before stay taken as long as the wave uses them.
void set_current_planes(TileWorker& worker, const Primitive* primitive, PlaneSet* planes);

/// Planes of a wave's primitives may be used again, but for the current ones.
void release_planes(TileWorker& worker, const PackedWave& wave);

}  // namespace vitrine::raster

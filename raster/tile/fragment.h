// Shading of packed waves.
#pragma once

#include "raster/tile/worker.h"

namespace vitrine::raster {

/// Shades, tests and writes the quads of `wave`, one of the worker's; empties it.
void shade_wave(TileWorker& worker, PackedWave& wave);

}  // namespace vitrine::raster

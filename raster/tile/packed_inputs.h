// Inputs of the fragment shader for a packed wave: everything there is, wherever it is wanted.
#pragma once

#include "raster/tile/shade_run.h"

namespace vitrine::raster {

/// The evaluation points that all runs of the wave share: worker.center, and run.scale.
void begin_packed_inputs(ShadeRun& run);

/// All inputs of one run.
void set_packed_inputs(ShadeRun& run);

/// What one of the registers gets that hold a varying, of all lanes of one run.
void read_varying(ShadeRun& run, const VaryingRead& read, base::WaveRegister& out);

}  // namespace vitrine::raster

// The tessellation stages.
#pragma once

#include "raster/front/stages/stage_scratch.h"

namespace vitrine::raster {

/// The patches of StageScratch in, primitives assembled or handed to run_geometry().
void run_tessellation(const StageContext& context);

}  // namespace vitrine::raster

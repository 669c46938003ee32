// Whether a draw takes the reference's route for windows: a guard band, and rectangles.
#pragma once

#include "raster/pass_desc.h"
#include "raster/plan.h"

namespace vitrine::raster {

/// lavapipe-rasterization.md 9.1 and 9.2. After the varyings are known, before the viewports.
void plan_rectangles(PipelinePlan& plan, const DrawCall& draw, const PassDesc& pass);

}  // namespace vitrine::raster

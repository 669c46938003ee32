// What goes from the last stage before rasterization to the fragment shader, and what comes out of that.
#pragma once

#include "raster/plan.h"

namespace vitrine::raster {

/// The fragment shader's registers, and the varyings between the stages in the order of a Vertex record. Turns smooth
/// lines off where their four varyings find no place.
void plan_varyings(PipelinePlan& plan);

}  // namespace vitrine::raster

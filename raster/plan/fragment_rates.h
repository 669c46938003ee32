// Whether fragments of a draw may cover more than one pixel.
#pragma once

#include "raster/pass_desc.h"
#include "raster/plan.h"

namespace vitrine::raster {

/// plan.rates. Wants what plan_rasterization() and plan_vertex_outputs() fill in.
void plan_fragment_rates(PipelinePlan& plan, const PassDesc& pass);

}  // namespace vitrine::raster

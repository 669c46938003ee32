// Derives a draw's plan from its state and shader interfaces.
#pragma once

#include "raster/pass_desc.h"
#include "raster/plan.h"

namespace vitrine::raster {

/// Fills `plan`. False if nothing can be drawn (a sample mask of 0, no samples).
bool make_plan(const DrawCall& draw, const PassDesc& pass, PipelinePlan& plan);

}  // namespace vitrine::raster

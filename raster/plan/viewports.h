// Viewports and scissors of a draw (lavapipe-rasterization.md 1.1, 3.3).
#pragma once

#include "raster/pass_desc.h"
#include "raster/plan.h"

namespace vitrine::raster {

/// Viewport transforms and the regions of the framebuffer that may be drawn to. Wants plan.out and plan.stages.
void plan_viewports(PipelinePlan& plan, const PassDesc& pass);

}  // namespace vitrine::raster

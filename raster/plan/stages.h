// Tessellation and geometry stages of a draw, what it assembles, how it is cut into chunks, and what it captures.
#pragma once

#include "raster/plan.h"

namespace vitrine::raster {

/// Topology, stages between vertex shader and rasterization, size of chunks. False if nothing can be drawn.
bool plan_stages(const DrawCall& draw, PipelinePlan& plan);

/// Which outputs of the last stage before rasterization transform feedback captures.
void plan_captures(PipelinePlan& plan);

}  // namespace vitrine::raster

// What the plan takes from the interfaces of the stages before rasterization.
#pragma once

#include "raster/plan.h"

namespace vitrine::raster {

/// Where the vertex shader's inputs come from: attributes and built-ins.
void plan_vertex_inputs(PipelinePlan& plan);

/// Registers of the last stage before rasterization (PipelinePlan::outputs) that fixed function reads.
void plan_vertex_outputs(PipelinePlan& plan);

}  // namespace vitrine::raster

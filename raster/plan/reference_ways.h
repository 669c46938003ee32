// Which ways of the reference a draw takes against the specification: those that somebody asked for.
#pragma once

#include "raster/pass_desc.h"
#include "raster/plan.h"

namespace vitrine::raster {

/// Fills PipelinePlan::as_reference, and takes from the plan what the reference does not heed. After the varyings are
/// known, before everything else that follows from them.
void plan_reference_ways(PipelinePlan& plan, const DrawCall& draw, const PassDesc& pass);

}  // namespace vitrine::raster

// Whether a draw takes the reference's route for windows: a guard band, and rectangles.
#pragma once

#include "raster/pass_desc.h"
#include "raster/plan.h"

namespace vitrine::raster {

/// Primitives that the reference works on at a time: of a strip, list or fan, in draws with indices and without.
std::uint32_t segment_of(const TopologyShape& shape, bool indexed);

/// Whether a fragment input has a value that is not interpolated; gl_PrimitiveID has.
bool reads_flat(const PipelinePlan& plan);

/// lavapipe-rasterization.md 9.1 and 9.2. After the varyings are known, before the viewports.
void plan_rectangles(PipelinePlan& plan, const DrawCall& draw, const PassDesc& pass);

}  // namespace vitrine::raster

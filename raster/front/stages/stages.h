// Tessellation and geometry stages of a chunk (Vulkan 1.3.239, Tessellation; Geometry Shading): vertices go from stage
// to stage through stage memory, in waves of patches, domain points and primitives; what the last stage gives is
// assembled in API order.
#pragma once

#include "raster/front/stages/stage_scratch.h"

namespace vitrine::raster {

/// Shades the chunk's vertices, runs the stages, and appends the visible primitives to context.primitives. Returns
/// whether triangles that might have formed rectangles went through the clipper.
bool process_stages(const StageContext& context);

}  // namespace vitrine::raster

// The geometry stage.
#pragma once

#include <span>

#include "raster/front/stages/stage_scratch.h"

namespace vitrine::raster {

/// Primitives in, primitives assembled.
/// Returns whether triangles that might have formed rectangles went through the clipper.
bool run_geometry(const StageContext& context, std::span<const GeometryInput> inputs);

}  // namespace vitrine::raster

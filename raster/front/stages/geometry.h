// The geometry stage.
#pragma once

#include <span>

#include "raster/front/stages/stage_scratch.h"

namespace vitrine::raster {

/// Primitives in, primitives assembled.
void run_geometry(const StageContext& context, std::span<const GeometryInput> inputs);

}  // namespace vitrine::raster

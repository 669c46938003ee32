// Setup of lines and points, which rasterize as polygons (lavapipe-rasterization.md 6 and 7).
#pragma once

#include "raster/arena.h"
#include "raster/front/setup.h"

namespace vitrine::raster {

void setup_line(const SetupContext& context, const Vertex* v1, const Vertex* v2, bool front);
/// 6.5: two triangles around the line, with records in `arena`. Flat values of both ends are the same.
void setup_smooth_line(SetupContext context, Arena& arena, const Vertex* v0, const Vertex* v1, bool front);
void setup_point(const SetupContext& context, const Vertex* v, bool front);

}  // namespace vitrine::raster

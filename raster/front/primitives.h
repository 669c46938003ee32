// The front end's second half: primitives of shaded vertices go through cull distances, clipping, culling and polygon
// modes to setup. Which positions of a draw form them is input assembly (assembly.h).
#pragma once

#include <span>

#include "raster/front/assembly.h"
#include "raster/front/primitive_context.h"

namespace vitrine::raster {

/// Whether the first and the last segment of a chunk went through the clipper (ChunkOutput).
struct ClippedEnds {
  bool first = false, last = false;
};

/// Culls, clips and sets up the primitives of a chunk whose vertices are shaded.
ClippedEnds process_primitives(const PrimitiveContext& context);

/// The same for a segment's strips of a geometry shader, whose triangles may form rectangles; `clips`: they go through
/// the clipper (lavapipe-rasterization.md 9.2).
void process_strips(const PrimitiveContext& context, std::span<const ListedPrimitive> listed, bool clips);

/// The same for primitives of the last stage's vertices.
void process_listed(const PrimitiveContext& context, std::span<const ListedPrimitive> listed);

}  // namespace vitrine::raster

// The front end's second half: primitives of shaded vertices go through cull distances, clipping, culling and polygon
// modes to setup. Which positions of a draw form them is input assembly (assembly.h).
#pragma once

#include <span>

#include "raster/arena.h"
#include "raster/front/assembly.h"
#include "raster/front/chunk.h"
#include "raster/front/primitive_list.h"
#include "raster/front/vertex_scratch.h"
#include "raster/pass_desc.h"

namespace vitrine::raster {

/// What the primitives of a chunk are made from, and where they go.
struct PrimitiveContext {
  const Chunk& chunk;
  const PassDesc& pass;
  Arena& arena;
  const VertexScratch& vertices;
  PrimitiveList& primitives;  ///< what is visible is appended
};

/// Whether the first and the last segment of a chunk went through the clipper (ChunkOutput).
struct ClippedEnds {
  bool first = false, last = false;
};

/// Culls, clips and sets up the primitives of a chunk whose vertices are shaded.
ClippedEnds process_primitives(const PrimitiveContext& context);

/// The same for primitives of the last stage's vertices.
void process_listed(const PrimitiveContext& context, std::span<const ListedPrimitive> listed);

}  // namespace vitrine::raster

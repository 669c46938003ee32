// The front end's primitive half: primitives of shaded vertices through cull distances, clipping, culling and polygon
// modes to setup.
#pragma once

#include <span>

#include "raster/arena.h"
#include "raster/front/assembly.h"
#include "raster/front/chunk.h"
#include "raster/front/primitive_list.h"
#include "raster/front/vertex_scratch.h"
#include "raster/pass_desc.h"

namespace vitrine::raster {

/// What assembly works with.
struct AssembleContext {
  const Chunk& chunk;
  const PassDesc& pass;
  Arena& arena;
  const VertexScratch& vertices;
  PrimitiveList& primitives;  ///< what is visible is appended
};

/// Assembles, culls, clips and sets up the primitives of a chunk whose vertices are shaded.
void assemble_chunk(const AssembleContext& context);

/// The same for primitives of the last stage's vertices.
void assemble_listed(const AssembleContext& context, std::span<const ListedPrimitive> listed);

}  // namespace vitrine::raster

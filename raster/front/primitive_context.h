// What the second half of the front end works with.
#pragma once

#include "raster/arena.h"
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

}  // namespace vitrine::raster

// Which vertices a chunk needs: index de-duplication, one slot for each distinct one.
#pragma once

#include <cstdint>

#include "raster/front/chunk.h"
#include "raster/front/vertex_scratch.h"

namespace vitrine::raster {

/// Room for `count` vertices in the scratch arrays that have one element per vertex.
void reserve_vertices(VertexScratch& scratch, std::uint32_t count);

/// Slots of all positions of a chunk, one per distinct (index, instance); returns the number of vertices to shade.
std::uint32_t gather_vertices(const Chunk& chunk, VertexScratch& scratch);

}  // namespace vitrine::raster

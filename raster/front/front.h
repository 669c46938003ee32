// The front end: one chunk of a draw from vertex fetch to per-tile lists of primitives (docs/design.md section 3).
// gather -> vertex shader (vertices) -> tessellation and geometry (stages/) -> primitives: clip, cull -> setup -> bin.
// Before, the pass has cut the draw into runs (assembly.h), and those into chunks (raster/pass.cpp).
#pragma once

#include "raster/arena.h"
#include "raster/front/bin.h"
#include "raster/front/chunk.h"
#include "raster/front/feedback.h"
#include "raster/front/primitive_list.h"
#include "raster/front/stages/stage_scratch.h"
#include "raster/front/vertex_scratch.h"
#include "raster/pass_desc.h"

namespace vitrine::raster {

/// Working memory of one thread, kept between chunks.
struct FrontScratch {
  VertexScratch vertices;
  PrimitiveList primitives;
  BinScratch bins;
  StageScratch stages;
  CaptureScratch capture;

  /// The stages that were bound are gone.
  void forget_stages() {
    vertices.bound = {};
    stages.bound_control = stages.bound_evaluation = stages.bound_geometry = {};
  }
};

/// The whole front end for a chunk; what it leaves lies in `arena`. Flushes denormals while it works.
ChunkOutput process_chunk(const Chunk& chunk, const PassDesc& pass, const TileGrid& grid, Arena& arena,
                          FrontScratch& scratch);

}  // namespace vitrine::raster

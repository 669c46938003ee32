// The front end's vertex half: waves of the vertex shader, the viewport transform, records.
#pragma once

#include <cstdint>

#include "raster/arena.h"
#include "raster/front/chunk.h"
#include "raster/front/feedback.h"
#include "raster/front/vertex_fetch.h"
#include "raster/front/vertex_scratch.h"

namespace vitrine::raster {

/// Runs the vertex shader for gathered vertices [base, base + count), at most a wave; `lanes` is working memory.
void shade_vertex_wave(const DrawRecord& draw, std::uint32_t base, std::uint32_t count, std::uint32_t view,
                       VertexLanes& lanes, VertexScratch& scratch);

/// Outputs of the last stage before rasterization to records and scratch arrays of vertices [base, base + lanes).
void store_wave(const PipelinePlan& plan, const WaveOutputs& outputs, std::uint32_t base, std::uint32_t lanes,
                VertexScratch& scratch);

/// Shades the vertices of a chunk into scratch (records in `arena`), one slot per distinct (index, instance).
void shade_chunk_vertices(const Chunk& chunk, Arena& arena, VertexScratch& scratch, CaptureScratch& capture);

}  // namespace vitrine::raster

// A chunk's way through the front end.
#include "raster/front/front.h"

#include "base/float_mode.h"
#include "raster/front/observed.h"
#include "raster/front/primitives.h"
#include "raster/front/stages/stages.h"
#include "raster/front/vertices.h"

namespace vitrine::raster {

namespace {

ChunkOutput work_on(const Chunk& chunk, const PassDesc& pass, const TileGrid& grid, Arena& arena,
                    FrontScratch& scratch) {
  const base::ScopedFloatMode mode(base::Denormals::kFlush);
  PrimitiveInstances* const instances = chunk.draw->instances;
  scratch.primitives.begin(arena, instances != nullptr);
  const PipelinePlan& plan = *chunk.draw->plan;
  ClippedEnds clipped;
  scratch.capture.active = is_captured(chunk.draw->call);
  if (plan.stages.any()) {
    clipped.first = clipped.last = process_stages(
        {chunk, pass, arena, scratch.vertices, scratch.primitives, scratch.stages, scratch.capture, plan});
  } else {
    shade_chunk_vertices(chunk, arena, scratch.vertices, scratch.capture);
    if (scratch.capture.active) capture_runs(chunk, scratch.vertices, scratch.capture);
    if (!plan.state->rasterizer_discard)
      clipped = process_primitives({chunk, pass, arena, scratch.vertices, scratch.primitives});
  }
  if (chunk.watch) finish_observed(chunk, pass, scratch.primitives);
  ChunkOutput output;
  if (!plan.state->rasterizer_discard) output = bin_chunk(scratch.primitives, grid, arena, scratch.bins);
  if (instances) instances->add(scratch.primitives.data(), scratch.primitives.size(), scratch.primitives.marks());
  if (scratch.capture.active) output.capture = finish_capture(arena, scratch.capture);
  output.begins_clipped = clipped.first;
  output.ends_clipped = clipped.last;
  return output;
}

}  // namespace

ChunkOutput process_chunk(const Chunk& chunk, const PassDesc& pass, const TileGrid& grid, Arena& arena,
                          FrontScratch& scratch) {
  const DrawCall& call = chunk.draw->call;
  const std::unique_ptr<DrawWatch> watch =
      call.observer ? call.observer->watch_chunk(call.vertex_resources.command) : nullptr;
  if (!call.observer) return work_on(chunk, pass, grid, arena, scratch);
  Chunk observed = chunk;
  DrawWatch nobody;
  observed.watch = watch ? watch.get() : &nobody;
  return work_on(observed, pass, grid, arena, scratch);
}

}  // namespace vitrine::raster

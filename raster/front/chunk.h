// A chunk: a part of a draw that the front end works on alone. Chunks share nothing, so any number of threads may work
// on them; their number is their order.
#pragma once

#include <cstdint>

#include "raster/front/assembly.h"
#include "raster/observe.h"
#include "raster/primitive.h"

namespace vitrine::raster {

class ClippedBatch;  // raster/front/rectangles.h
struct ViewLayer;    // raster/front/collected.h

/// The stipple pattern runs on along a strip: its lines stay in one chunk, up to this many positions. Chunks of longer
/// strips hand the counter on (Chunk::stipple_counter).
inline constexpr std::uint32_t kStippledChunkPositions = 32768;

struct Chunk {
  const DrawRecord* draw = nullptr;
  const Run* runs = nullptr;
  std::uint32_t run_count = 0;
  std::uint32_t view = 0;                    ///< multiview: index of the view, also the layer
  std::uint32_t* primitive_count = nullptr;  ///< PipelinePlan::counts_primitives: of the instance so far
  std::uint32_t* stipple_counter = nullptr;  ///< of strips cut into chunks: what the chunks before have used up
  ViewLayer* view_layer = nullptr;           ///< ReferenceWays::first_layer: chunks are worked on in order
  ClippedBatch* batch = nullptr;             ///< clipped triangles of the chunks before, which this one goes on with
  bool ends_batch = true;                    ///< no chunk follows that does
  DrawWatch* watch = nullptr;                ///< while an observed chunk is worked on
};

/// Positions (before de-duplication) that the chunk's runs need.
std::uint32_t positions_of(const Chunk& chunk);

/// Counts the chunk's vertices and primitives, and the `vertices` that are shaded for it, in an active pipeline
/// statistics query, and tells who observes; returns the number of primitives. Vertices that complete no primitive are
/// not counted ("Vertices corresponding to incomplete primitives may contribute to the count").
std::uint64_t count_assembly(const Chunk& chunk, std::uint32_t vertices);

/// Calls f(run, i, entry of position) for every primitive i of the chunk's runs: entry_of(p) is where position p of the
/// run stands among all positions of the chunk.
template <class F>
void for_each_primitive(const Chunk& chunk, F&& f) {
  std::uint32_t first_entry = 0;
  for (std::uint32_t r = 0; r < chunk.run_count; ++r) {
    const Run& run = chunk.runs[r];
    const RunSpan span = run_span(chunk.draw->plan->shape, run);
    const auto entry_of = [&](std::uint32_t position) { return first_entry + span.entry(position); };
    for (std::uint32_t i = run.begin; i < run.end; ++i) f(run, i, entry_of);
    first_entry += span.count();
  }
}

}  // namespace vitrine::raster

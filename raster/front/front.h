// The front end: one chunk of a draw from vertex fetch to per-tile lists of primitives (design.md section 3). Chunks
// share nothing, so any number of threads may work on them; their number is their order.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "raster/arena.h"
#include "raster/front/clip.h"
#include "raster/front/feedback.h"
#include "raster/front/setup.h"
#include "raster/front/stages/stages.h"
#include "raster/front/vertex_fetch.h"
#include "raster/front/viewport.h"
#include "raster/primitive.h"

namespace vitrine::raster {

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
};

/// Working memory of one thread, kept between chunks.
struct FrontScratch {
  StageRunner runner;
  Stage bound;
  TransformedWave transformed;
  // per position of the chunk
  std::vector<std::uint16_t> slot;
  // per vertex (slot) of the chunk
  std::vector<std::uint32_t> vertex, instance;
  std::vector<float> clip;                          ///< 4 each
  std::vector<float> clip_distance, cull_distance;  ///< kMaxClipDistances each
  std::vector<std::uint32_t> layer, viewport_index;
  std::vector<ClipCode> code;
  std::vector<std::int32_t> snapped;  ///< 2 each
  Vertex* records = nullptr;
  // index de-duplication
  std::vector<std::uint64_t> hash_key;
  std::vector<std::uint16_t> hash_slot;
  // results
  PrimitiveList primitives;
  std::vector<std::uint64_t> tile_pairs;  ///< tile << 32 | primitive
  std::vector<std::uint32_t> tile_count;
  std::vector<std::uint32_t> tiles;  ///< touched by the chunk
  StageScratch stages;
  CaptureScratch capture;

  /// The stages that were bound are gone.
  void forget_stages() {
    bound = {};
    stages.bound_control = stages.bound_evaluation = stages.bound_geometry = {};
  }
};

/// Outputs of a wave of vertices by register: of a stage, or words of vertices that were gathered.
struct WaveOutputs {
  const StageRunner* runner;
  const base::WaveRegister* words;
  const base::WaveRegister& at(std::uint32_t reg) const { return runner ? runner->output(reg) : words[reg]; }
};

/// Positions (before de-duplication) that the chunk's runs need.
std::uint32_t positions_of(const Chunk& chunk);

/// Counts the chunk's vertices and primitives, and the `vertices` that are shaded for it, in an active pipeline
/// statistics query; returns the number of primitives. Vertices that complete no primitive are not counted ("Vertices
/// corresponding to incomplete primitives may contribute to the count").
std::uint64_t count_assembly(const Chunk& chunk, std::uint32_t vertices);

/// Slots of all positions of a chunk, one per distinct (index, instance); returns the number of vertices to shade.
std::uint32_t gather_vertices(const Chunk& chunk, FrontScratch& scratch);

/// Room for `count` vertices in the scratch arrays that have one element per vertex.
void reserve_vertices(FrontScratch& scratch, std::uint32_t count);

/// Runs the vertex shader for gathered vertices [base, base + count), at most a wave; `lanes` is working memory.
void shade_vertex_wave(const DrawRecord& draw, std::uint32_t base, std::uint32_t count, std::uint32_t view,
                       VertexLanes& lanes, FrontScratch& scratch);

/// Outputs of the last stage before rasterization to records and scratch arrays of vertices [base, base + lanes).
void store_wave(const PipelinePlan& plan, const WaveOutputs& outputs, std::uint32_t base, std::uint32_t lanes,
                FrontScratch& scratch);

/// Shades the vertices of a chunk into scratch (records in `arena`), one slot per distinct (index, instance).
void shade_chunk_vertices(const Chunk& chunk, Arena& arena, FrontScratch& scratch);

/// Assembles, culls, clips and sets up the primitives of a chunk whose vertices are shaded.
void assemble_chunk(const Chunk& chunk, const PassDesc& pass, Arena& arena, FrontScratch& scratch);

/// The same for primitives of the last stage's vertices.
void assemble_listed(const Chunk& chunk, const PassDesc& pass, Arena& arena, FrontScratch& scratch,
                     std::span<const ListedPrimitive> primitives);

/// Sorts scratch.primitives into tiles; the lists lie in `arena`.
ChunkOutput bin_chunk(const PipelinePlan& plan, const TileGrid& grid, Arena& arena, FrontScratch& scratch);

/// All of the above. Flushes denormals while it works.
ChunkOutput process_chunk(const Chunk& chunk, const PassDesc& pass, const TileGrid& grid, Arena& arena,
                          FrontScratch& scratch);

}  // namespace vitrine::raster

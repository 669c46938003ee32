// The front end: one chunk of a draw from vertex fetch to per-tile lists of primitives (DESIGN.md section 3). Chunks
// share nothing, so any number of threads may work on them; their number is their order.
#pragma once

#include <cstdint>
#include <vector>

#include "raster/arena.h"
#include "raster/clip.h"
#include "raster/primitive.h"
#include "raster/setup.h"
#include "raster/vertex_fetch.h"
#include "raster/viewport.h"

namespace vitrine::raster {

/// Vertex or index positions of a chunk, about; runs are cut to this many.
inline constexpr std::uint32_t kChunkPositions = 1024;

/// The stipple pattern runs on along a strip: its lines stay in one chunk, up to this many positions.
inline constexpr std::uint32_t kStippledChunkPositions = 32768;

struct Chunk {
  const DrawRecord* draw = nullptr;
  const Run* runs = nullptr;
  std::uint32_t run_count = 0;
  std::uint32_t view = 0;  ///< multiview: index of the view, also the layer
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
  std::vector<Primitive> primitives;
  std::vector<std::uint64_t> tile_pairs;  ///< tile << 32 | primitive
  std::vector<std::uint32_t> tile_count;
  std::vector<std::uint32_t> tiles;  ///< touched by the chunk
};

/// Positions (before de-duplication) that the chunk's runs need.
std::uint32_t positions_of(const Chunk& chunk);

/// Shades the vertices of a chunk into scratch (records in `arena`), one slot per distinct (index, instance).
void shade_chunk_vertices(const Chunk& chunk, Arena& arena, FrontScratch& scratch);

/// Assembles, culls, clips and sets up the primitives of a chunk whose vertices are shaded.
void assemble_chunk(const Chunk& chunk, const PassDesc& pass, Arena& arena, FrontScratch& scratch);

/// Sorts scratch.primitives into tiles; the lists lie in `arena`.
ChunkOutput bin_chunk(const PipelinePlan& plan, const TileGrid& grid, Arena& arena, FrontScratch& scratch);

/// All of the above. Flushes denormals while it works.
ChunkOutput process_chunk(const Chunk& chunk, const PassDesc& pass, const TileGrid& grid, Arena& arena,
                          FrontScratch& scratch);

}  // namespace vitrine::raster

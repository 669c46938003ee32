// Binning: which tiles the primitives of a chunk may touch.
#pragma once

#include <cstdint>
#include <vector>

#include "raster/arena.h"
#include "raster/front/primitive_list.h"
#include "raster/primitive.h"

namespace vitrine::raster {

/// Working memory of one thread.
struct BinScratch {
  std::vector<std::uint64_t> tile_pairs;  ///< tile << 32 | primitive
  std::vector<std::uint32_t> tile_count;
  std::vector<std::uint32_t> tiles;  ///< touched by the chunk
};

/// Sorts the primitives into tiles, to which none is added any more; the lists lie in `arena`.
ChunkOutput bin_chunk(PrimitiveList& primitives, const TileGrid& grid, Arena& arena, BinScratch& scratch);

}  // namespace vitrine::raster

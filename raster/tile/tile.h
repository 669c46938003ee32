// The back end: one tile at a time, its primitives in API order (docs/design.md section 3). Covered quads are packed
// into waves across primitives of a draw, shaded, tested and written. The ways a primitive may take are told in
// rasterize.h.
#pragma once

#include <cstdint>
#include <vector>

#include "raster/pass_desc.h"
#include "raster/pixel_rect.h"
#include "raster/primitive.h"
#include "raster/tile/worker.h"
#include "texel/codec.h"

namespace vitrine::raster {

/// A clear in the order of the draws.
struct ClearCommand {
  const texel::ImageView* view;
  texel::StoredTexel value;
  PixelRect rect;
  std::uint32_t base_layer, layer_count;
};

/// What a tile has to do next: a clear, or primitives of one chunk.
struct TileItem {
  const ClearCommand* clear;
  const DrawRecord* draw;
  const Primitive* primitives;
  const std::uint32_t* index;
  std::uint32_t count;
};

/// Does `items` of one tile in order. Flushes denormals while it works.
void process_tile(TileWorker& worker, const PassDesc& pass, const TileGrid& grid, std::uint32_t tile,
                  const std::vector<TileItem>& items);

}  // namespace vitrine::raster

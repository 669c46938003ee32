// The back end: one tile at a time, its primitives in API order (DESIGN.md section 3). Covered quads are packed into
// waves across primitives of a draw, shaded, tested and written.
#pragma once

#include <cstdint>
#include <vector>

#include "raster/coverage.h"
#include "raster/depth_stencil.h"
#include "raster/interpolate.h"
#include "raster/primitive.h"
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

/// Quads waiting to be shaded, of one draw.
struct PackedWave {
  std::uint32_t quads = 0;
  std::uint32_t slots = 0;
  QuadPositions position;
  std::uint8_t slot[base::kQuadsPerWave];
  const Primitive* primitive[base::kQuadsPerWave];  ///< by slot
  base::LaneMask coverage[kMaxSamples];             ///< by sample of the attachments
  base::LaneMask rasterized[kMaxSamples];           ///< before early tests: gl_SampleMask as an input (8.5)
};

/// The tile being worked on.
struct TileTarget {
  int x = 0, y = 0;  ///< first pixel
  std::uint32_t layer = 0;
  DepthStencilTarget depth_stencil[kMaxSamples];
};

/// Working memory of one thread, kept between tiles.
struct TileWorker {
  const PassDesc* pass = nullptr;
  TileTarget target;
  const DrawRecord* draw = nullptr;  ///< of the packed wave
  PackedWave wave;                   ///< being packed
  PackedWave block;                  ///< one whole block, shaded at once
  StageRunner runner;
  Stage bound;
  PlaneSet planes[base::kQuadsPerWave];
  const Primitive* planes_of = nullptr;  ///< whose planes planes[0] are still those of the last wave
  WavePoints center, place;
  alignas(64) float reciprocal_w[base::kWaveWidth];
  alignas(64) float depth[base::kWaveWidth];
  base::WaveRegister color[4], second[4];
  std::uint64_t samples_passed = 0;        ///< not yet added to the draw's query
  std::uint64_t fragment_invocations = 0;  ///< likewise
};

/// Does `items` of one tile in order. Flushes denormals while it works.
void process_tile(TileWorker& worker, const PassDesc& pass, const TileGrid& grid, std::uint32_t tile,
                  const std::vector<TileItem>& items);

/// Covers, tests early and packs one primitive (tile.cpp).
void rasterize_primitive(TileWorker& worker, const Primitive& primitive);

/// Shades, tests and writes the quads of `wave`, one of the worker's; empties it (fragment.cpp).
void shade_wave(TileWorker& worker, PackedWave& wave);

}  // namespace vitrine::raster

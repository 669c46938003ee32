// Shading without packing of what one primitive nearly fills: blocks, and waves of spans. Attachments are read and
// written a row of pixels at a time, and colours that are the same all over a draw are encoded once. Same bits as
// packed waves (tests compare them).
#pragma once

#include "raster/pixel_order.h"
#include "raster/tile/worker.h"

namespace vitrine::raster {

/// Prepares worker.block_draw for the draw just bound, if its plan shades blocks.
void begin_blocks(TileWorker& worker);

/// Shades, tests late and writes a block inside all attachments whose first pixel is (x, y), in the framebuffer.
void shade_block(TileWorker& worker, const Primitive& primitive, int x, int y, const BlockCoverage& block);

/// The same for an observed draw, whose watch is told.
void shade_observed_block(TileWorker& worker, const Primitive& primitive, int x, int y, const BlockCoverage& block);

/// All pixels of blocks; what observes the draw is told of them by count_whole_blocks(). `hidden`: their colours need
/// not be written.
void shade_whole_blocks(TileWorker& worker, const Primitive& primitive, base::LaneMask places, bool hidden);

/// Shades and writes a wave, nothing of which is tested any more, and cuts its rows to what was written.
void shade_spans(TileWorker& worker, const Primitive& primitive, SpanWave& wave);

}  // namespace vitrine::raster

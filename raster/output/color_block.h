// Colours of whole blocks and of waves of spans to targets of four UNORM bytes, a row of pixels at a time. Same bits as
// the other colour functions (tests compare them).
#pragma once

#include <cstdint>

#include "base/lanes.h"
#include "raster/output/block_pixels.h"
#include "raster/output/color_writer.h"

namespace vitrine::raster {

/// Colours of a block as an attachment stores them, in an order that is the functions' own.
struct alignas(64) PackedBlock {
  std::uint32_t texel[base::kWaveWidth];
};

/// How blocks reach a colour attachment.
struct BlockColorFunctions {
  /// Four registers in quad order, converted: for colours that are written more than once.
  void (*pack)(const ColorWriter& writer, const ColorRegisters& color, PackedBlock& out);
  /// Stores or blends the pixels of `rows` (row order).
  void (*write_packed)(const ColorWriter& writer, const PackedBlock& colors, const BlockPixels& pixels,
                       base::LaneMask rows);
  /// Both at once.
  void (*write)(const ColorWriter& writer, const ColorRegisters& color, const BlockPixels& pixels, base::LaneMask rows);
  /// The last two for a wave of spans (raster/pixel_order.h); `pixels`: of the attachment, from (0, 0).
  void (*write_packed_spans)(const ColorWriter& writer, const PackedBlock& colors, const BlockPixels& pixels,
                             const SpanWave& wave);
  void (*write_spans)(const ColorWriter& writer, const ColorRegisters& color, const BlockPixels& pixels,
                      const SpanWave& wave);
};

/// The block functions for this writer, or null: `function` does blocks too.
const BlockColorFunctions* block_color_functions(const ColorWriter& writer);

}  // namespace vitrine::raster

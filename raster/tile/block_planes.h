// Planes over the pixels of one primitive in a wave: those of a whole block, or of quads in spans. Same bits as the
// evaluation over packed waves (raster/tile/interpolate.h).
#pragma once

#include <cstddef>
#include <cstdint>

#include "raster/pixel_order.h"
#include "raster/tile/interpolate.h"

namespace vitrine::raster {

/// A plane to be evaluated over a block.
struct BlockVarying {
  std::uint32_t plane;
  float* out;  ///< 64 lanes, quad order
};

/// fma(dady, y, fma(dadx, x, a0)) of `count` planes, the first pixel at (x, y), quad order; times `scale` per lane if
/// given.
void evaluate_block(const PlaneSet& planes, const BlockVarying* varying, std::size_t count, float x, float y,
                    const float* scale);

/// What evaluate_block() gives, at a wave's pixels moved by (center, center). Lanes of no quad are at the window's
/// first pixels.
void evaluate_spans(const PlaneSet& planes, const BlockVarying* varying, std::size_t count, const SpanWave& wave,
                    float center, const float* scale);

}  // namespace vitrine::raster

// Quads of fragments from those of a block's pixels.
#include "raster/tile/coarse_pack.h"

#include <algorithm>

#include "raster/tile/coarse.h"
#include "raster/tile/fragment.h"
#include "raster/tile/primitive_planes.h"

namespace vitrine::raster {
namespace {

/// The quad of a block that is quad `part` of the quad of fragments number (column, row), in the block's quad order.
std::uint32_t quad_in_block(FragmentRate rate, std::uint32_t column, std::uint32_t row, std::uint32_t part) {
  const std::uint32_t width = width_of(rate), height = height_of(rate);
  return (row * height + part / width) * 4 + column * width + part % width;
}

/// Makes room for a quad of `primitive` at (x, y). Returns its number.
std::uint32_t add_quad(TileWorker& worker, const Primitive& primitive, std::uint32_t x, std::uint32_t y) {
  PackedWave& wave = worker.wave;
  if (wave.quads == 0) {
    for (auto& samples : worker.coarse.coverage) std::fill(std::begin(samples), std::end(samples), 0);
    for (auto& samples : worker.coarse.rasterized) std::fill(std::begin(samples), std::end(samples), 0);
  }
  const PlaneSet& planes = current_planes(worker, primitive);
  if (wave.slots == 0 || wave.primitive[wave.slots - 1] != &primitive) {
    wave.planes.set[wave.slots] = &planes;
    wave.primitive[wave.slots++] = &primitive;
  }
  const std::uint32_t quad = wave.quads++;
  wave.position.x[quad] = static_cast<std::uint16_t>(x);
  wave.position.y[quad] = static_cast<std::uint16_t>(y);
  wave.slot[quad] = static_cast<std::uint8_t>(wave.slots - 1);
  wave.planes.end[wave.slots - 1] = static_cast<std::uint8_t>(wave.quads);
  return quad;
}

}  // namespace

void emit_coarse_block(TileWorker& worker, const Primitive& primitive, int x, int y, const BlockCoverage& rasterized,
                       const BlockCoverage& block) {
  CoarseWave& coarse = worker.coarse;
  const std::uint32_t samples = worker.draw->plan->samples;
  const FragmentRate rate = rate_in_block(worker, primitive, x, y);
  if (worker.wave.quads != 0 && coarse.rate != rate) shade_wave(worker, worker.wave);
  coarse.rate = rate;
  const std::uint32_t width = width_of(rate), height = height_of(rate), parts = pixels_of(rate);
  const base::LaneMask any = any_sample(block, samples);
  for (std::uint32_t row = 0; row < 4 / height; ++row)
    for (std::uint32_t column = 0; column < 4 / width; ++column) {
      base::LaneMask covered = 0;
      for (std::uint32_t part = 0; part < parts; ++part) covered |= any >> 4 * quad_in_block(rate, column, row, part);
      if ((covered & 15) == 0) continue;
      const std::uint32_t quad = add_quad(worker, primitive, static_cast<std::uint32_t>(x) + 2 * width * column,
                                          static_cast<std::uint32_t>(y) + 2 * height * row);
      for (std::uint32_t part = 0; part < parts; ++part)
        for (std::uint32_t s = 0; s < samples; ++s) {
          const std::uint32_t from = 4 * quad_in_block(rate, column, row, part);
          coarse.coverage[part][s] |= (block.lanes[s] >> from & 15) << 4 * quad;
          coarse.rasterized[part][s] |= (rasterized.lanes[s] >> from & 15) << 4 * quad;
        }
      if (worker.wave.quads == base::kQuadsPerWave) shade_wave(worker, worker.wave);
    }
}

}  // namespace vitrine::raster

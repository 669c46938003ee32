// Packed waves, and which blocks need none.
#include "raster/tile/pack.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "raster/tile/block_shade.h"
#include "raster/tile/coarse_pack.h"
#include "raster/tile/fragment.h"
#include "raster/tile/fragment_outputs.h"
#include "raster/tile/primitive_planes.h"

namespace vitrine::raster {
namespace {

/// Quads of a block from which on it is shaded on its own: fewer would waste more lanes than packing costs.
constexpr std::uint32_t kNearlyFull = 12, kNearlyFullIfShort = 2;

/// Whether quads of the block at (x, y) wait in the packed wave. `quads`: their lowest lanes.
bool waits_in_wave(const TileWorker& worker, int x, int y, base::LaneMask quads) {
  if (worker.wave.quads == 0) return false;
  const auto column = static_cast<std::uint32_t>(x - worker.target.x);
  const auto row = static_cast<std::uint32_t>(y - worker.target.y);
  // Bits 0, 4, 8 and 12 of 16 become neighbours.
  quads |= quads >> 3;
  quads |= quads >> 6;
  const auto wanted = [&](std::uint32_t r) { return static_cast<std::uint32_t>(quads >> (16 * r)) & 15; };
  const auto waiting = [&](std::uint32_t r) { return worker.packed.from(column, row + 2 * r) & wanted(r); };
  return (waiting(0) | waiting(1) | waiting(2) | waiting(3)) != 0;
}

/// A block none of whose quads is empty makes a wave of its own.
void append_full_block(TileWorker& worker, const Primitive& primitive, int x, int y, const BlockCoverage& rasterized,
                       const BlockCoverage& block) {
  PackedWave& wave = worker.block;
  wave.quads = base::kQuadsPerWave;
  wave.slots = 1;
  wave.primitive[0] = &primitive;
  wave.planes.set[0] = &current_planes(worker, primitive);
  wave.planes.end[0] = base::kQuadsPerWave;
  std::memset(wave.slot, 0, sizeof(wave.slot));
  place_block(x, y, wave.position);
  std::memcpy(wave.coverage, block.lanes, sizeof(wave.coverage));
  if (reads_rasterized(worker)) std::memcpy(wave.rasterized, rasterized.lanes, sizeof(wave.rasterized));
  shade_wave(worker, wave);
}

/// The quads of `quads` (lowest lanes) that fit the wave, at most `room`, into its places from `first` on. Returns how
/// many.
std::uint32_t fill_places(TileWorker& worker, int x, int y, base::LaneMask& quads, std::uint32_t first,
                          std::uint32_t room, base::LaneMask lanes, base::LaneMask& coverage) {
  PackedWave& wave = worker.wave;
  const auto column = static_cast<std::uint32_t>(x - worker.target.x),
             row = static_cast<std::uint32_t>(y - worker.target.y);
  std::uint32_t q = first;
  for (; quads != 0 && q != first + room; quads &= quads - 1, ++q) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(quads));
    wave.position.x[q] = static_cast<std::uint16_t>(x + lane_x(lane));
    wave.position.y[q] = static_cast<std::uint16_t>(y + lane_y(lane));
    worker.packed.add(column + static_cast<std::uint32_t>(lane_x(lane)),
                      row + static_cast<std::uint32_t>(lane_y(lane)));
    coverage |= (lanes >> lane & 15) << (4 * q);
  }
  return q - first;
}

/// Lanes of `quads` moved together, to the places from `first` on.
base::LaneMask compress_quads(base::LaneMask lanes, base::LaneMask quads, std::uint32_t first, std::uint32_t count) {
  base::LaneMask result = 0;
  for (std::uint32_t q = first; q != first + count; ++q, quads &= quads - 1)
    result |= (lanes >> std::countr_zero(quads) & 15) << (4 * q);
  return result;
}

/// Of a draw that shades nothing.
void count_block(TileWorker& worker, const BlockCoverage& block) {
  const PipelinePlan& plan = *worker.draw->plan;
  const std::uint32_t counted = plan.as_reference.one_sample_masks ? 1 : plan.samples;
  for (std::uint32_t s = 0; s < counted; ++s) count_samples(worker, block.lanes[s]);
}

}  // namespace

void append_quads(TileWorker& worker, const Primitive& primitive, int x, int y, const BlockCoverage& rasterized,
                  const BlockCoverage& block, base::LaneMask quads) {
  PackedWave& wave = worker.wave;
  const PlaneSet& planes = current_planes(worker, primitive);
  const std::uint32_t samples = worker.draw->plan->samples;
  while (quads != 0) {
    if (wave.quads == 0) {
      worker.packed = {};
      for (std::uint32_t s = 0; s < samples; ++s) wave.coverage[s] = wave.rasterized[s] = 0;
    }
    if (wave.slots == 0 || wave.primitive[wave.slots - 1] != &primitive) {
      wave.planes.set[wave.slots] = &planes;
      wave.primitive[wave.slots++] = &primitive;
    }
    const std::uint32_t first = wave.quads;
    const base::LaneMask before = quads;
    const std::uint32_t count =
        fill_places(worker, x, y, quads, first, base::kQuadsPerWave - first, block.lanes[0], wave.coverage[0]);
    for (std::uint32_t s = 1; s < samples; ++s)
      wave.coverage[s] |= compress_quads(block.lanes[s], before, first, count);
    for (std::uint32_t s = 0; reads_rasterized(worker) && s < samples; ++s)
      wave.rasterized[s] |= compress_quads(rasterized.lanes[s], before, first, count);
    wave.quads = first + count;
    std::fill(wave.slot + first, wave.slot + wave.quads, static_cast<std::uint8_t>(wave.slots - 1));
    wave.planes.end[wave.slots - 1] = static_cast<std::uint8_t>(wave.quads);
    if (wave.quads == base::kQuadsPerWave) shade_wave(worker, wave);
  }
}

void emit_block(TileWorker& worker, const Primitive& primitive, int x, int y, const BlockCoverage& rasterized,
                const BlockCoverage& block) {
  const PipelinePlan& plan = *worker.draw->plan;
  const base::LaneMask any = any_sample(block, plan.samples);
  if (!any) return;
  if (!plan.shades) return count_block(worker, block);
  if (plan.rates.any) return emit_coarse_block(worker, primitive, x, y, rasterized, block);
  const base::LaneMask quads = base::quads_of_lanes(any);
  const bool whole = quads == base::kFirstOfQuads;
  // The product's upper four bits are the sum of the 16 nibbles: the number of quads, modulo 16.
  const bool nearly =
      whole || (quads * base::kFirstOfQuads) >> 60 >= (worker.block_draw.is_short ? kNearlyFullIfShort : kNearlyFull);
  const bool alone = nearly && plan.shades_blocks && owns_square(worker, x, y, kBlockSize);
  if (!whole && !alone) {
    append_quads(worker, primitive, x, y, rasterized, block, quads);
    return;
  }
  // Quads on the same pixels come first.
  if (waits_in_wave(worker, x, y, quads)) shade_wave(worker, worker.wave);
  if (alone)
    shade_block(worker, primitive, x, y, block);
  else
    append_full_block(worker, primitive, x, y, rasterized, block);
}

void emit_observed_block(TileWorker& worker, const Primitive& primitive, int x, int y, const BlockCoverage& rasterized,
                         const BlockCoverage& block) {
  const PipelinePlan& plan = *worker.draw->plan;
  const base::LaneMask any = any_sample(block, plan.samples);
  if (!any) return;
  if (!plan.shades) return count_block(worker, block);
  if (plan.rates.any) return emit_coarse_block(worker, primitive, x, y, rasterized, block);
  const base::LaneMask quads = base::quads_of_lanes(any);
  if (quads != base::kFirstOfQuads) {
    // Who watches pixels sees what each fragment finds there and leaves.
    if (worker.draw->call.tile_observer && waits_in_wave(worker, x, y, quads)) shade_wave(worker, worker.wave);
    append_quads(worker, primitive, x, y, rasterized, block, quads);
    return;
  }
  if (waits_in_wave(worker, x, y, quads)) shade_wave(worker, worker.wave);
  if (plan.shades_blocks && owns_square(worker, x, y, kBlockSize))
    shade_observed_block(worker, primitive, x, y, block);
  else
    append_full_block(worker, primitive, x, y, rasterized, block);
}

}  // namespace vitrine::raster

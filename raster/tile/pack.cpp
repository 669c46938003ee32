// Planes of a worker's primitives, and their blocks on the way to the shader: quads are packed into waves across
// primitives, blocks with few empty quads are shaded on their own.
#include <algorithm>
#include <bit>
#include <cstring>

#include "raster/tile/tile.h"

namespace vitrine::raster {
namespace {

/// Positions of the quads of a block.
constexpr QuadPositions block_offsets() {
  QuadPositions offsets{};
  for (std::uint32_t q = 0; q < base::kQuadsPerWave; ++q) {
    offsets.x[q] = static_cast<std::uint16_t>(lane_x(4 * q));
    offsets.y[q] = static_cast<std::uint16_t>(lane_y(4 * q));
  }
  return offsets;
}
constexpr QuadPositions kBlockOffsets = block_offsets();

/// Whether quads of the block at (x, y) wait in the packed wave. `quads`: their lowest lanes.
bool waits_in_wave(const TileWorker& worker, int x, int y, base::LaneMask quads) {
  if (worker.wave.quads == 0) return false;
  const auto column = static_cast<std::uint32_t>(x - worker.target.x) / 2;
  const std::uint32_t* row = worker.packed.row + (y - worker.target.y) / 2;
  // Bits 0, 4, 8 and 12 of 16 become neighbours.
  quads |= quads >> 3;
  quads |= quads >> 6;
  const auto wanted = [&](std::uint32_t r) { return static_cast<std::uint32_t>(quads >> (16 * r)) & 15; };
  return (((row[0] >> column & wanted(0)) | (row[1] >> column & wanted(1)) | (row[2] >> column & wanted(2)) |
           (row[3] >> column & wanted(3)))) != 0;
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
    worker.packed.row[(row + static_cast<std::uint32_t>(lane_y(lane))) / 2] |=
        1u << ((column + static_cast<std::uint32_t>(lane_x(lane))) / 2);
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

}  // namespace

void set_current_planes(TileWorker& worker, const Primitive* primitive, PlaneSet* planes) {
  const PackedWave& wave = worker.wave;
  const bool used = wave.slots != 0 && wave.planes.set[wave.slots - 1] == worker.planes;
  if (worker.planes && !used) worker.pool.give_back(worker.planes);
  worker.planes = planes;
  worker.planes_of = primitive;
}

void release_planes(TileWorker& worker, const PackedWave& wave) {
  for (std::uint32_t slot = 0; slot < wave.slots; ++slot)
    if (wave.planes.set[slot] != worker.planes) worker.pool.give_back(wave.planes.set[slot]);
}

const PlaneSet& current_planes(TileWorker& worker, const Primitive& primitive) {
  if (worker.planes_of == &primitive) return *worker.planes;
  set_current_planes(worker, nullptr, nullptr);
  PlaneSet* planes = worker.pool.take();
  compute_planes(*worker.draw->plan, primitive, *planes);
  set_current_planes(worker, &primitive, planes);
  return *planes;
}

void place_block(int x, int y, QuadPositions& out) {
  for (std::uint32_t q = 0; q < base::kQuadsPerWave; ++q) {
    out.x[q] = static_cast<std::uint16_t>(x + kBlockOffsets.x[q]);
    out.y[q] = static_cast<std::uint16_t>(y + kBlockOffsets.y[q]);
  }
}

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

namespace {

/// Quads of a block from which on it is shaded on its own: fewer would waste more lanes than packing costs.
constexpr std::uint32_t kNearlyFull = 12, kNearlyFullIfShort = 2;

}  // namespace

void emit_block(TileWorker& worker, const Primitive& primitive, int x, int y, const BlockCoverage& rasterized,
                const BlockCoverage& block) {
  const PipelinePlan& plan = *worker.draw->plan;
  const base::LaneMask any = any_sample(block, plan.samples);
  if (!any) return;
  if (!plan.shades) {
    for (std::uint32_t s = 0; worker.counts && s < plan.samples; ++s)
      worker.samples_passed += static_cast<std::uint64_t>(std::popcount(block.lanes[s]));
    return;
  }
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

}  // namespace vitrine::raster

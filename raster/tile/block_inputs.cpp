// See block_inputs.h: a packed wave of one block that is never shaded.
#include "raster/tile/block_inputs.h"

#include <algorithm>

#include "raster/tile/coarse.h"
#include "raster/tile/packed_inputs.h"
#include "raster/tile/primitive_planes.h"

namespace vitrine::raster {
namespace {

void fill_wave(TileWorker& worker, const Primitive& primitive, int x, int y, const BlockCoverage& covered) {
  PackedWave& wave = worker.block;
  wave.quads = base::kQuadsPerWave;
  wave.slots = wave.planes.slots = 1;
  wave.primitive[0] = &primitive;
  wave.planes.set[0] = &current_planes(worker, primitive);
  wave.planes.end[0] = base::kQuadsPerWave;
  std::fill(std::begin(wave.slot), std::end(wave.slot), std::uint8_t{0});
  place_block(x, y, wave.position);
  std::copy(std::begin(covered.lanes), std::end(covered.lanes), wave.coverage);
}

/// Moves the quad that has a lane's pixel to where the quad of larger fragments lies that has it. Returns the lane of
/// that pixel's fragment.
std::size_t to_fragment(FragmentRate rate, std::size_t lane, QuadPositions& position) {
  const std::size_t quad = lane / 4;
  const std::uint32_t x = position.x[quad] + static_cast<std::uint32_t>(lane & 1);
  const std::uint32_t y = position.y[quad] + static_cast<std::uint32_t>(lane >> 1 & 1);
  position.x[quad] = static_cast<std::uint16_t>(x & ~(2 * width_of(rate) - 1));
  position.y[quad] = static_cast<std::uint16_t>(y & ~(2 * height_of(rate) - 1));
  return 4 * quad + (y >> log_height(rate) & 1) * 2 + (x >> log_width(rate) & 1);
}

}  // namespace

std::optional<std::uint32_t> BlockInputs::word(std::uint32_t reg, std::size_t lane) {
  const PipelinePlan& plan = *worker_.draw->plan;
  const auto end = plan.read.begin() + plan.read_count;
  const auto read = std::find_if(plan.read.begin(), end, [&](const VaryingRead& r) { return r.reg == reg; });
  if (read == end) return std::nullopt;
  fill_wave(worker_, primitive_, x_, y_, covered_);
  std::uint32_t sample = 0;
  while (sample + 1 < plan.samples && (covered_.lanes[sample] >> lane & 1) == 0) ++sample;
  ShadeRun run{worker_, worker_.block, plan, base::kAllLanes, 0, sample, sample + 1, {}, 0};
  if (plan.rates.any) {
    run.rate = rate_in_block(worker_, primitive_, x_, y_);
    lane = to_fragment(run.rate, lane, worker_.block.position);
  }
  begin_packed_inputs(run);
  base::WaveRegister out;
  read_varying(run, *read, out);
  worker_.block.quads = worker_.block.slots = 0;
  return out.lane[lane];
}

}  // namespace vitrine::raster

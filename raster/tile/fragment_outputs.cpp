// Collection of colour registers (lavapipe-rasterization.md 6.5 and 8.6 for alpha).
#include "raster/tile/fragment_outputs.h"

#include <algorithm>

#include "base/numeric.h"
#include "raster/tile/shade_run.h"

namespace vitrine::raster {

ColorRegisters collect_color(const TileWorker& worker, const std::array<std::uint32_t, 4>& registers, bool scaled,
                             base::WaveRegister scratch[4], const FragmentSpread* spread) {
  static constexpr base::WaveRegister kZero{};
  const PipelinePlan& plan = *worker.draw->plan;
  const base::WaveRegister* color[4];
  for (std::uint32_t c = 0; c < 4; ++c) {
    color[c] = registers[c] == kNoReg ? &kZero : &worker.runner.output(registers[c]);
    if (!spread || registers[c] == kNoReg) continue;
    spread_lanes(*spread, *color[c], scratch[c]);
    color[c] = &scratch[c];
  }
  if (plan.smooth_lines && scaled) {
    for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane)
      scratch[3].lane[lane] = base::bits_of(base::float_of(color[3]->lane[lane]) * worker.line_coverage[lane]);
    color[3] = &scratch[3];
  }
  if (plan.alpha_to_one) {
    std::fill_n(scratch[3].lane, base::kWaveWidth, base::bits_of(1.0f));
    color[3] = &scratch[3];
  }
  return {color[0], color[1], color[2], color[3]};
}

}  // namespace vitrine::raster

// Collection of colour registers (lavapipe-rasterization.md 6.5 and 8.6 for alpha).
#include "raster/tile/fragment_outputs.h"

#include <algorithm>

#include "base/numeric.h"
#include "raster/tile/shade_run.h"

namespace vitrine::raster {

const base::WaveRegister* collect_color(const TileWorker& worker, const std::array<std::uint32_t, 4>& registers,
                                        bool scaled, base::WaveRegister scratch[4], const FragmentSpread* spread) {
  const StageRunner& runner = worker.runner;
  const PipelinePlan& plan = *worker.draw->plan;
  const bool written = std::find(registers.begin(), registers.end(), kNoReg) == registers.end();
  if (written && !plan.alpha_to_one && !plan.smooth_lines && !spread) {
    const base::WaveRegister* first = &runner.output(registers[0]);
    if (&runner.output(registers[1]) == first + 1 && &runner.output(registers[2]) == first + 2 &&
        &runner.output(registers[3]) == first + 3)
      return first;
  }
  for (std::uint32_t c = 0; c < 4; ++c) {
    if (registers[c] == kNoReg)
      scratch[c] = {};
    else if (spread)
      spread_lanes(*spread, runner.output(registers[c]), scratch[c]);
    else
      scratch[c] = runner.output(registers[c]);
  }
  if (plan.smooth_lines && scaled)
    for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane)
      scratch[3].lane[lane] = base::bits_of(base::float_of(scratch[3].lane[lane]) * worker.line_coverage[lane]);
  if (plan.alpha_to_one) std::fill_n(scratch[3].lane, base::kWaveWidth, base::bits_of(1.0f));
  return scratch;
}

}  // namespace vitrine::raster

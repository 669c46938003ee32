// Colours of a wave as the shader left them, on the way to the attachments.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "base/lanes.h"
#include "raster/color_registers.h"
#include "raster/tile/worker.h"

namespace vitrine::raster {

struct FragmentSpread;  // raster/tile/shade_run.h

/// The four registers of a colour: the shader's own where nothing is changed, else copies in `scratch`. Components that
/// are not written are 0. `scaled`: of smooth lines, alpha is scaled by the coverage. `spread`: the colours are those
/// of larger fragments, and go to their pixels.
ColorRegisters collect_color(const TileWorker& worker, const std::array<std::uint32_t, 4>& registers, bool scaled,
                             base::WaveRegister scratch[4], const FragmentSpread* spread = nullptr);

/// Counts fragments that passed all tests in the draw's queries.
inline void count_samples(TileWorker& worker, base::LaneMask lanes) {
  if (worker.counts) worker.samples_passed += static_cast<std::uint64_t>(std::popcount(lanes));
}

}  // namespace vitrine::raster

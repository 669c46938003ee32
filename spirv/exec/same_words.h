// Whether lanes hold the same word: what is done for each of them can then be done once.
#pragma once

#include <bit>

#include "base/lanes.h"

namespace vitrine::spirv::exec {

/// The lowest of lanes that are not empty. The remainder tells the compiler that there is one.
inline std::size_t first_of(base::LaneMask lanes) {
  return static_cast<std::size_t>(std::countr_zero(lanes)) % base::kWaveWidth;
}

inline bool is_several(base::LaneMask lanes) { return (lanes & (lanes - 1)) != 0; }

/// For lanes that are not empty.
inline bool have_same_word(const base::WaveRegister& reg, base::LaneMask lanes) {
  const std::uint32_t first = reg.lane[first_of(lanes)];
  if (reg.lane[(63 - static_cast<std::size_t>(std::countl_zero(lanes))) % base::kWaveWidth] != first)
    return false;  // mostly they differ here
  if (!is_several(lanes)) return true;
  std::uint32_t differs = 0;
  for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane)
    differs |= (reg.lane[lane] ^ first) & (lanes >> lane & 1 ? ~0u : 0u);
  return differs == 0;
}

}  // namespace vitrine::spirv::exec

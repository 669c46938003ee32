// What one instruction of a wave does to memory: to all words of all its lanes at once.
#pragma once

#include <cstdint>

#include "base/lanes.h"
#include "glass/race/order.h"
#include "glass/race/shadow.h"

namespace vitrine::glass::race {

/// Who does what, when.
struct Doing {
  std::uint32_t site = 0;
  WaveNames wave = {};
  std::uint32_t time = 0;  ///< Order::time()
};

/// A number for each lane; without words, that of lane 0, and what each of the others has more than the one before.
struct Offsets {
  const std::uint32_t* words = nullptr;
  std::uint32_t lane_0 = 0, step = 0;
  std::uint32_t operator[](std::size_t lane) const {
    return words != nullptr ? words[lane] : lane_0 + static_cast<std::uint32_t>(lane) * step;
  }
};

/// The bytes are those of Site::touched behind an offset for each lane.
struct Span {
  Doing by;
  base::LaneMask lanes = 0;
  Offsets offsets;
  std::uint64_t base = 0, size = 0;     ///< of the memory: offsets lie in [0, size)
  const std::uint32_t* values[4] = {};  ///< that a store writes, by component; or null
};

}  // namespace vitrine::glass::race

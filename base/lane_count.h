// How many lanes a mask has, where that is asked for every wave: the code is for any x86-64, on which std::popcount is
// a call.
#pragma once

#include "base/lanes.h"

namespace vitrine::base {

constexpr std::uint64_t count_lanes(LaneMask lanes) {
  if (lanes == kAllLanes) return kWaveWidth;
  constexpr LaneMask kPairs = 0x5555555555555555, kNibbles = 0x3333333333333333, kBytes = 0x0f0f0f0f0f0f0f0f;
  lanes -= lanes >> 1 & kPairs;
  lanes = (lanes & kNibbles) + (lanes >> 2 & kNibbles);
  lanes = (lanes + (lanes >> 4)) & kBytes;
  return lanes * 0x0101010101010101 >> 56;
}

}  // namespace vitrine::base

// Widths every room agrees on: how many invocations run together, how they form quads, and the type of a lane mask.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace vitrine::base {

/// Invocations executed together. A compile-time constant, never the CPU's vector width, so that results do not depend
/// on the machine (design.md section 4; 64 is the measured knee of bars.md section 6).
inline constexpr std::size_t kWaveWidth = 64;

/// Fragments per quad. Lanes 4q..4q+3 of a wave are quad q in the order (x0,y0) (x1,y0) (x0,y1) (x1,y1).
inline constexpr std::size_t kQuadSize = 4;
inline constexpr std::size_t kQuadsPerWave = kWaveWidth / kQuadSize;

/// Bit i is lane i.
using LaneMask = std::uint64_t;
inline constexpr LaneMask kAllLanes = ~LaneMask{0};

/// Mask of the first `count` lanes; count in [0, 64].
constexpr LaneMask first_lanes(std::size_t count) {
  return count >= kWaveWidth ? kAllLanes : (LaneMask{1} << count) - 1;
}

/// The lowest lane of every quad.
inline constexpr LaneMask kFirstOfQuads = 0x1111111111111111;

/// The lowest lane of each quad that has a lane in `lanes`.
constexpr LaneMask quads_of_lanes(LaneMask lanes) {
  lanes |= lanes >> 1;
  return (lanes | lanes >> 2) & kFirstOfQuads;
}

/// Calls f(lane) for every set bit, in increasing lane order.
template <class F>
inline void for_each_lane(LaneMask mask, F&& f) {
  for (; mask != 0; mask &= mask - 1) f(static_cast<std::size_t>(std::countr_zero(mask)));
}

/// One 32-bit component of a whole wave, structure of arrays. Floats are kept as their bits.
struct alignas(64) WaveRegister {
  std::uint32_t lane[kWaveWidth];
};

}  // namespace vitrine::base

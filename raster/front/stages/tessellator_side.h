// One subdivided side of a domain in the tessellator's arithmetic: 16.16 fixed point, unsigned. Internal to the
// tessellator.
#pragma once

#include <cstdint>

namespace vitrine::raster {

using Fixed = std::uint32_t;  ///< 16.16

inline constexpr Fixed kFixedOne = 0x10000, kFixedHalf = 0x8000;

/// A side with its level. It is symmetric about its middle; while the level grows, new points split the segment that
/// the ruler sequence says, and move from there to their place.
struct Side {
  bool odd = false;         ///< number of segments, with the next greater integer level
  std::uint32_t count = 0;  ///< points, both ends included
  std::uint32_t half = 0;   ///< points in front of the middle (even: the middle itself is not counted)
  std::uint32_t split = 0;  ///< points behind this one have one more in front of them than at the smaller level
  Fixed fraction = 0;       ///< from the smaller level to the greater one
  Fixed inverse_low = 0, inverse_high = 0;  ///< 1 / segments at these levels

  /// Position of point i.
  Fixed place(std::uint32_t i) const;
};

Side make_side(Fixed level, bool odd);

/// Points of the first half of a side (`half`) in the order they appear when the level grows: point i of 0..32 is there
/// if its rank is below the number of points.
std::uint32_t ruler_rank(std::uint32_t i);

}  // namespace vitrine::raster

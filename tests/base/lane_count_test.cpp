// Lanes of a mask, counted.
#include "base/lane_count.h"

#include <gtest/gtest.h>

namespace vitrine::base {
namespace {

TEST(LaneCount, IsTheNumberOfBits) {
  for (std::size_t lane = 0; lane <= kWaveWidth; ++lane) EXPECT_EQ(count_lanes(first_lanes(lane)), lane);
  LaneMask mask = 0x9e3779b97f4a7c15;
  for (int i = 0; i < 1000; ++i, mask = mask * 0xd1342543de82ef95 + 1)
    EXPECT_EQ(count_lanes(mask), static_cast<std::uint64_t>(std::popcount(mask))) << mask;
}

}  // namespace
}  // namespace vitrine::base

// Orders of the pixels of a wave, there and back.
#include "raster/pixel_order.h"

#include <gtest/gtest.h>

namespace vitrine::raster {
namespace {

TEST(PixelOrder, OrdersOfLanesAreInverse) {
  for (std::uint32_t lane = 0; lane < 64; ++lane) {
    const base::LaneMask row = base::LaneMask{1} << (8 * lane_y(lane) + lane_x(lane));
    EXPECT_EQ(rows_of_quads(base::LaneMask{1} << lane), row);
    EXPECT_EQ(quads_of_rows(row), base::LaneMask{1} << lane);
  }
}

TEST(PixelOrder, RowsOfSpansAreTheirLanes) {
  for (std::uint32_t lane = 0; lane < 64; ++lane) {
    const std::uint64_t row = std::uint64_t{1} << (lane / 4 * 2 + (lane & 1) + 32 * (lane >> 1 & 1));
    EXPECT_EQ(lanes_of_spans(row), base::LaneMask{1} << lane);
    EXPECT_EQ(rows_of_spans(base::LaneMask{1} << lane), row);
  }
}

TEST(PixelOrder, SmallWindowsAreTheCornerOfABlock) {
  for (std::uint32_t lane = 0; lane < 64; ++lane) {
    const base::LaneMask bit = base::LaneMask{1} << lane;
    const bool inside = lane_x(lane) < 4 && lane_y(lane) < 4;
    EXPECT_EQ(inside, (bit & kSmallWindow) != 0);
    if (!inside) continue;
    const std::uint32_t quads = quads_of_small_window(bit);
    EXPECT_EQ(block_of_small_window(quads), bit);
    EXPECT_EQ(transpose_window(quads), 1u << (4 * lane_y(lane) + lane_x(lane)));
    EXPECT_EQ(transpose_window(transpose_window(quads)), quads);
  }
}

TEST(PixelOrder, RectLanesCutsColumnsAndRows) {
  for (int x0 = -1; x0 < 9; ++x0)
    for (int x1 = -1; x1 < 9; ++x1)
      for (std::uint32_t lane = 0; lane < 64; ++lane) {
        const bool in = lane_x(lane) >= x0 && lane_x(lane) <= x1;
        ASSERT_EQ(in, (rect_lanes(x0, -3, x1, 20) >> lane & 1) != 0);
        ASSERT_EQ(lane_y(lane) >= x0 && lane_y(lane) <= x1, (rect_lanes(0, x0, 7, x1) >> lane & 1) != 0);
      }
}

}  // namespace
}  // namespace vitrine::raster

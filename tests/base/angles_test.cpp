// base/angles.h against numbers that glibc 2.36's functions gave, which the reference calls.
#include "base/angles.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace vitrine::base {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

struct Row {
  float y, x;
  std::uint32_t angle, cos, sin;
};

std::uint32_t bits(float x) { return std::bit_cast<std::uint32_t>(x); }

TEST(Angles, AreThoseOfTheReference) {
  const Row rows[] = {
      {0.0f, 1.0f, 0x00000000, 0x3f800000, 0x00000000},
      {0.0f, -1.0f, 0x40490fdb, 0xbf800000, 0xb3bbbd2e},
      {1.0f, 0.0f, 0x3fc90fdb, 0xb33bbd2e, 0x3f800000},
      {-1.0f, 0.0f, 0xbfc90fdb, 0xb33bbd2e, 0xbf800000},
      {1.0f, 1.0f, 0x3f490fdb, 0x3f3504f3, 0x3f3504f3},
      {-3.5f, 2.0f, 0xbf869c79, 0x3efe05ee, 0xbf5e452e},
      {0.015625f, -700.0f, 0x40490f7d, 0xbf800000, 0x37bb4443},
      {123.4375f, 55.6875f, 0x3f92d0bf, 0x3ed28c7c, 0x3f695a31},
      {-20.0f, -33.3125f, 0xc026751a, 0xbf5b7b5a, 0xbf03c57e},
      {1500.0f, 9.99999975e-06f, 0x3fc90fdb, 0xb33bbd2e, 0x3f800000},
      {9.99999997e-07f, 900.0f, 0x3098b5bf, 0x3f800000, 0x3098b5bf},
      {-7.0625f, -0.00100000005f, 0xbfc9147e, 0xb9146bbc, 0xbf800000},
      {2.0f, 1.5f, 0x3f6d6338, 0x3f19999a, 0x3f4ccccd},
      {0.699999988f, 1.29999995f, 0x3efce5e3, 0x3f61668e, 0x3ef2bd37},
  };
  for (const Row& row : rows) {
    SCOPED_TRACE(testing::Message() << row.y << ", " << row.x);
    const float angle = atan2(row.y, row.x);
    EXPECT_EQ(bits(angle), row.angle);
    const Direction direction = direction_of(angle);
    EXPECT_EQ(bits(direction.cos), row.cos);
    EXPECT_EQ(bits(direction.sin), row.sin);
  }
}

/// A sum over many, as the functions of the C library had it.
TEST(Angles, OfManyLinesAreThoseOfTheReference) {
  std::uint32_t state = 1;
  const auto next = [&] {
    state = state * 1664525u + 1013904223u;
    return static_cast<float>(static_cast<std::int32_t>(state)) *
           (0x1p-20f / static_cast<float>(1u << (state >> 9 & 15)));
  };
  std::uint64_t sum = 0;
  for (int i = 0; i < 100000; ++i) {
    const float y = next(), angle = atan2(y, next());
    const Direction direction = direction_of(angle);
    for (const float value : {angle, direction.cos, direction.sin}) sum = (sum ^ bits(value)) * 0x100000001b3u;
  }
  EXPECT_EQ(sum, 0x46909f23f61aadfbu);
}

TEST(Angles, OfWhatIsNoLine) {
  EXPECT_TRUE(std::isnan(atan2(std::nanf(""), 1.0f)));
  EXPECT_EQ(bits(atan2(-0.0f, 1.0f)), bits(-0.0f));
  EXPECT_EQ(atan2(kInf, 1.0f), atan2(1.0f, 0.0f));
}

}  // namespace
}  // namespace vitrine::base

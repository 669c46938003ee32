// Scalar conversions against independent arithmetic: doubles for binary16, wide integers for the rest.
#include "base/numeric.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vitrine::base {
namespace {

/// The value of a finite binary16, by its definition.
double value_of_half(std::uint16_t half) {
  const int exponent = (half >> 10) & 31;
  const double mantissa = half & 0x3ff;
  const double magnitude = exponent == 0 ? std::ldexp(mantissa, -24) : std::ldexp(1024 + mantissa, exponent - 25);
  return half & 0x8000 ? -magnitude : magnitude;
}

TEST(Numeric, HalfToFloatIsExactForAllPatterns) {
  for (std::uint32_t bits = 0; bits < 0x10000; ++bits) {
    const auto half = static_cast<std::uint16_t>(bits);
    const float value = half_to_float(half);
    if (((half >> 10) & 31) == 31) {
      EXPECT_EQ(std::isinf(value), (half & 0x3ff) == 0) << bits;
      EXPECT_EQ(std::isnan(value), (half & 0x3ff) != 0) << bits;
    } else {
      EXPECT_EQ(value, value_of_half(half)) << bits;
      EXPECT_EQ(std::signbit(value), (half & 0x8000) != 0) << bits;
    }
  }
}

TEST(Numeric, FloatToHalfRoundsBetweenNeighbours) {
  for (std::uint32_t bits = 0; bits < 0x7bff; ++bits) {
    const auto low = static_cast<std::uint16_t>(bits), high = static_cast<std::uint16_t>(bits + 1);
    const auto a = static_cast<float>(value_of_half(low)), b = static_cast<float>(value_of_half(high));
    const float middle = a + (b - a) / 2;
    const std::uint16_t even = low & 1 ? high : low;
    EXPECT_EQ(float_to_half_nearest(middle), even) << bits;
    EXPECT_EQ(float_to_half_nearest(std::nextafter(middle, 1e9f)), high) << bits;
    EXPECT_EQ(float_to_half_nearest(std::nextafter(middle, -1e9f)), low) << bits;
    EXPECT_EQ(float_to_half_truncate(std::nextafter(b, 0.0f)), low) << bits;
    EXPECT_EQ(float_to_half_truncate(b), high) << bits;
    EXPECT_EQ(float_to_half_truncate(-std::nextafter(b, 0.0f)), low | 0x8000) << bits;
  }
}

TEST(Numeric, FloatToHalfAtTheEnds) {
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(float_to_half_nearest(65519.996f), 0x7bff);
  EXPECT_EQ(float_to_half_nearest(65520.0f), 0x7c00);
  EXPECT_EQ(float_to_half_nearest(infinity), 0x7c00);
  EXPECT_EQ(float_to_half_nearest(-std::nanf("")), 0xfe00);
  EXPECT_EQ(float_to_half_truncate(1e30f), 0x7bff);
  EXPECT_EQ(float_to_half_truncate(-infinity), 0xfc00);
  EXPECT_EQ(float_to_half_nearest(float_of(0x80000001)), 0x8000);
}

TEST(Numeric, IntegerConversionsSaturateAsTheInstructionsDo) {
  EXPECT_EQ(round_to_int(2.5f), 2);
  EXPECT_EQ(round_to_int(3.5f), 4);
  EXPECT_EQ(round_to_int(-2.5f), -2);
  EXPECT_EQ(round_to_int(3e9f), INT32_MIN);
  EXPECT_EQ(round_to_int(NAN), INT32_MIN);
  EXPECT_EQ(round_half_away(2.5f), 3);
  EXPECT_EQ(round_half_away(-2.5f), -3);
  EXPECT_EQ(truncate_to_int(-2.9f), -2);
  EXPECT_EQ(truncate_to_int(-2147483648.0f), INT32_MIN);
  EXPECT_EQ(truncate_to_uint(-0.5f), 0u);
  EXPECT_EQ(truncate_to_uint(-1.0f), UINT32_MAX);
  EXPECT_EQ(truncate_to_uint(4294967040.0f), 4294967040u);
  EXPECT_EQ(truncate_to_uint(NAN), UINT32_MAX);
}

TEST(Numeric, MinAndMaxTakeTheSecondOperandWhenUndecided) {
  EXPECT_EQ(bits_of(min_second(0.0f, -0.0f)), 0x80000000u);
  EXPECT_EQ(bits_of(max_second(-0.0f, 0.0f)), 0u);
  EXPECT_EQ(min_second(NAN, 1.0f), 1.0f);
  EXPECT_TRUE(std::isnan(max_second(1.0f, NAN)));
}

}  // namespace
}  // namespace vitrine::base

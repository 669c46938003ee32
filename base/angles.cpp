// See angles.h.
#include "base/angles.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace vitrine::base {
namespace {

constexpr float kPi = 0x1.921fb6p+1f, kHalfPi = 0x1.921fb6p+0f;
constexpr float kPiRest = -0x1.777a5cp-24f;  ///< pi - kPi

/// An angle around which the quotient is developed: the quotient t becomes that of the angle that is left over.
struct Near {
  float below;        ///< quotients less than that
  float angle, rest;  ///< the sum is the angle
};
constexpr Near kNear[] = {{0x1.6p-1f, 0x1.dac67p-2f, 0x1.586ed4p-28f},    // atan(1/2)
                          {0x1.3p+0f, 0x1.921fb4p-1f, 0x1.4442dp-25f},    // atan(1)
                          {0x1.38p+1f, 0x1.f730bcp-1f, 0x1.281f68p-25f},  // atan(3/2)
                          {std::numeric_limits<float>::infinity(), 0x1.921fb4p+0f, 0x1.4442dp-24f}};

float left_over(int near, float t) {
  switch (near) {
    case 0:
      return (2.0f * t - 1.0f) / (2.0f + t);
    case 1:
      return (t - 1.0f) / (t + 1.0f);
    case 2:
      return (t - 1.5f) / (1.0f + 1.5f * t);
    default:
      return -1.0f / t;
  }
}

/// x times it is x - atan(x), for small x.
float correction(float x) {
  const float z = x * x, w = z * z;
  const float odd_terms =
      z * (3.3333334327e-01f +
           w * (1.4285714924e-01f +
                w * (9.0908870101e-02f + w * (6.6610731184e-02f + w * (4.9768779427e-02f + w * 1.6285819933e-02f)))));
  const float even_terms =
      w * (-2.0000000298e-01f +
           w * (-1.1111110449e-01f + w * (-7.6918758452e-02f + w * (-5.8335702866e-02f + w * -3.6531571299e-02f))));
  return odd_terms + even_terms;
}

/// Of t >= 0.
float atan_of(float t) {
  if (t >= 0x1p25f) return kNear[3].angle + kNear[3].rest;
  if (t < 0.4375f) return t < 0x1p-29f ? t : t - t * correction(t);
  int near = 0;
  while (!(t < kNear[near].below)) ++near;
  const float x = left_over(near, t);
  return kNear[near].angle - ((x * correction(x) - kNear[near].rest) - x);
}

/// The exponents' difference of two finite numbers that are not 0, as their words' tops have it.
int exponents_apart(float a, float b) {
  const auto word = [](float x) { return static_cast<std::int32_t>(std::bit_cast<std::uint32_t>(x) & 0x7fffffff); };
  return (word(a) - word(b)) >> 23;
}

float first_quadrant(float y, float x, bool left) {
  const int apart = exponents_apart(y, x);
  if (apart > 60) return kHalfPi + 0.5f * kPiRest;
  if (left && apart < -60) return 0.0f;
  return atan_of(std::fabs(y / x));
}

}  // namespace

float atan2(float y, float x) {
  if (std::isnan(x) || std::isnan(y)) return x + y;
  const bool left = std::signbit(x);
  float angle;
  if (y == 0.0f) {
    angle = left ? kPi : 0.0f;
  } else if (x == 0.0f) {
    angle = kHalfPi;
  } else if (std::isinf(x)) {
    angle = std::isinf(y) ? (left ? 3.0f * (kHalfPi * 0.5f) : kHalfPi * 0.5f) : left ? kPi : 0.0f;
  } else if (std::isinf(y)) {
    angle = kHalfPi;
  } else {
    angle = first_quadrant(y, x, left);
    if (left) angle = kPi - (angle - kPiRest);
  }
  return std::copysign(angle, y);
}

Direction direction_of(float angle) {
  constexpr double kTurns = 0x1.45f306dc9c883p+23, kQuarter = 0x1.921fb54442d18p0;  // 2^24 * 2 / pi; pi / 2
  double x = angle;
  int quarter = 0;
  if (!(std::fabs(angle) < 0x1.921fb6p-1f)) {
    quarter = (static_cast<std::int32_t>(x * kTurns) + 0x800000) >> 24;
    x -= quarter * kQuarter;
  }
  const double x2 = x * x, x4 = x2 * x2;
  const double sine =
      (x + x * x2 * -0x1.555545995a603p-3) + x * x2 * x2 * (0x1.1107605230bc4p-7 + x2 * -0x1.994eb3774cf24p-13);
  const double cosine = (1.0 + x2 * -0x1.ffffffd0c621cp-2 + x4 * 0x1.55553e1068f19p-5) +
                        x4 * x2 * (-0x1.6c087e89a359dp-10 + x2 * 0x1.99343027bf8c3p-16);
  const double turned[] = {cosine, -sine, -cosine, sine};
  const float sin = std::fabs(angle) < 0x1p-12f ? angle : static_cast<float>(turned[(quarter + 3) & 3]);
  return {static_cast<float>(turned[quarter & 3]), sin};
}

}  // namespace vitrine::base

// Follows cube edges to the neighbouring face, by tables of lavapipe-texture-blend.md A5.
#include "texel/sampler/model/cube.h"

#include <algorithm>
#include <cmath>

#include "base/numeric.h"

namespace vitrine::texel {
namespace {

struct Crossing {
  std::uint8_t face;
  Along x;
  Along y;
};

// Per face, for leaving at x < 0, x > last, y < 0, y > last.
constexpr Crossing kCrossing[6][4] = {
    {{4, Along::kLast, Along::kSame},
     {5, Along::kZero, Along::kSame},
     {2, Along::kLast, Along::kFlipped},
     {3, Along::kLast, Along::kSame}},
    {{5, Along::kLast, Along::kSame},
     {4, Along::kZero, Along::kSame},
     {2, Along::kZero, Along::kSame},
     {3, Along::kZero, Along::kFlipped}},
    {{1, Along::kSame, Along::kZero},
     {0, Along::kFlipped, Along::kZero},
     {5, Along::kFlipped, Along::kZero},
     {4, Along::kSame, Along::kZero}},
    {{1, Along::kFlipped, Along::kLast},
     {0, Along::kSame, Along::kLast},
     {4, Along::kSame, Along::kLast},
     {5, Along::kFlipped, Along::kLast}},
    {{1, Along::kLast, Along::kSame},
     {0, Along::kZero, Along::kSame},
     {2, Along::kSame, Along::kLast},
     {3, Along::kSame, Along::kZero}},
    {{0, Along::kLast, Along::kSame},
     {1, Along::kZero, Along::kSame},
     {2, Along::kFlipped, Along::kZero},
     {3, Along::kFlipped, Along::kLast}},
};

std::int32_t follow(Along rule, std::int32_t along, std::int32_t last) {
  switch (rule) {
    case Along::kSame:
      return along;
    case Along::kFlipped:
      return last - along;
    case Along::kZero:
      return 0;
    default:
      return last;
  }
}

CubeTexel resolve(std::uint32_t face, std::int32_t x, std::int32_t y, std::int32_t last) {
  // Leaving in x takes precedence.
  const bool off_x = x < 0 || x > last;
  if (!off_x && y >= 0 && y <= last) return {face, x, y};
  const int edge = off_x ? (x < 0 ? 0 : 1) : (y < 0 ? 2 : 3);
  const Crossing& crossing = kCrossing[face][edge];
  const std::int32_t along = std::clamp(off_x ? y : x, 0, last);
  return {crossing.face, follow(crossing.x, along, last), follow(crossing.y, along, last)};
}

}  // namespace

constinit const std::array<std::int32_t, 24> kCubeCrossings = [] {
  std::array<std::int32_t, 24> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const Crossing& crossing = kCrossing[i / 4][i % 4];
    table[i] = crossing.face | static_cast<std::int32_t>(crossing.x) << 4 | static_cast<std::int32_t>(crossing.y) << 8;
  }
  return table;
}();

CubeTaps cube_taps(std::uint32_t face, float u, float v, std::int32_t size) {
  CubeTaps taps;
  const std::int32_t last = size - 1;
  const float a = base::max_second(u, 0.0f) * static_cast<float>(size) - 0.5f;
  const float b = base::max_second(v, 0.0f) * static_cast<float>(size) - 0.5f;
  taps.weight_x = a - std::floor(a);
  taps.weight_y = b - std::floor(b);
  const std::int32_t x0 = base::truncate_to_int(std::floor(a));
  const std::int32_t y0 = base::truncate_to_int(std::floor(b));
  for (std::uint32_t i = 0; i < 4; ++i) {
    const auto x = static_cast<std::int32_t>(static_cast<std::uint32_t>(x0) + (i & 1));
    const auto y = static_cast<std::int32_t>(static_cast<std::uint32_t>(y0) + (i >> 1));
    taps.texel[i] = resolve(face, x, y, last);
    if ((x < 0 || x > last) && (y < 0 || y > last)) taps.corner = i;
  }
  return taps;
}

void corner_weights(const CubeTaps& taps, float weight[4]) {
  const float x1 = taps.weight_x, y1 = taps.weight_y;
  const float x0 = 1.0f - x1, y0 = 1.0f - y1;
  weight[0] = x0 * y0;
  weight[1] = x1 * y0;
  weight[2] = x0 * y1;
  weight[3] = x1 * y1;
  const float share = weight[taps.corner] * (1.0f / 3.0f);
  for (std::uint32_t i = 0; i < 4; ++i) weight[i] = i == taps.corner ? 0.0f : weight[i] + share;
}

}  // namespace vitrine::texel

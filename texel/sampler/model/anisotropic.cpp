// EWA as the reference does it: the footprint of a pixel is an ellipse, its texels are weighted by a table of a
// Gaussian (lavapipe-texture-blend.md A8). Its steps are numbered as there.
#include "texel/sampler/model/anisotropic.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/numeric.h"
#include "texel/sampler/model/address.h"

namespace vitrine::texel {
namespace {

using base::float_of;

/// A box of more texels is only met with derivatives that mean nothing; it is sampled like an empty one.
constexpr std::int64_t kMaxTexels = std::int64_t{1} << 24;

constexpr double exponential(double x) {
  double term = 1, sum = 1;
  for (int i = 1; i < 40; ++i) {
    term = term * x / i;
    sum += term;
  }
  return sum;
}

/// v >= 0, half up; std::lround() is no constant expression.
constexpr std::int64_t nearest(double v) {
  return static_cast<std::int64_t>(v + 0.5);  // NOLINT(bugprone-incorrect-roundings): v >= 0
}

constexpr std::array<float, 1024> make_weights() {
  std::array<float, 1024> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double value = exponential(-2.0 * static_cast<double>(i) / 1023.0);
    table[i] = static_cast<float>(static_cast<double>(nearest(value * 1e6)) / 1e6);
  }
  table[44] = 0.917575f;
  table[388] = 0.468343f;
  table[493] = 0.381429f;
  table[538] = 0.349306f;
  table[580] = 0.321770f;
  table[864] = 0.184676f;
  table[909] = 0.169124f;
  table[911] = 0.168463f;
  table[939] = 0.159489f;
  return table;
}

float weight_of(float q) {
  const std::int32_t i = base::truncate_to_int(q);
  return i <= 1023 ? kEwaWeights[static_cast<std::size_t>(std::max(i, 0))] : 0.0f;
}

/// An ellipse in texels of the level: centre, bounds, and the quadratic form A, B, C scaled for the table.
struct Ellipse {
  float tu = 0, tv = 0;
  float a = 0, b = 0, c = 0;
  std::int32_t u0 = 0, u1 = 0, v0 = 0, v1 = 0;
};

Ellipse make_ellipse(const LanePoint& point, const Extent& size, std::uint32_t image_level) {
  Ellipse e;
  const float scaling = 1.0f / static_cast<float>(1u << image_level);
  const float width = static_cast<float>(size.width), height = static_cast<float>(size.height);
  const float ux = point.ddx[0] * width * scaling, uy = point.ddy[0] * width * scaling;
  const float vx = point.ddx[1] * height * scaling, vy = point.ddy[1] * height * scaling;
  e.a = (vx * vx + vy * vy) + 1.0f;
  e.b = (ux * vx + uy * vy) * -2.0f;
  e.c = (ux * ux + uy * uy) + 1.0f;
  const float f = e.a * e.c - (e.b * e.b) / 4.0f;
  const float d = (0.0f - e.b * e.b) + (e.a * e.c) * 4.0f;
  const float box_u = (2.0f / d) * std::sqrt((d * e.c) * f);
  const float box_v = (2.0f / d) * std::sqrt((e.a * d) * f);
  const float g = 1023.0f / f;
  e.a = e.a * g;
  e.b = e.b * g;
  e.c = e.c * g;
  e.tu = point.coord[0] * (width * scaling) + -0.5f;
  e.tv = point.coord[1] * (height * scaling) + -0.5f;
  e.u0 = floor_to_int(e.tu - box_u);
  e.u1 = base::truncate_to_int(std::ceil(e.tu + box_u));
  e.v0 = floor_to_int(e.tv - box_v);
  e.v1 = base::truncate_to_int(std::ceil(e.tv + box_v));
  return e;
}

Texel nearest_at(LaneSample lane, std::uint32_t level, float u, float v) {
  const Extent& extent = lane.plan->view->level[level].extent;
  lane.coord[0] = u / static_cast<float>(extent.width);
  lane.coord[1] = v / static_cast<float>(extent.height);
  return sample_level(lane, level, false);
}

bool reasonable(const Ellipse& e) {
  const std::int64_t width = std::int64_t{e.u1} - e.u0 + 1, height = std::int64_t{e.v1} - e.v0 + 1;
  return width < kMaxTexels && height < kMaxTexels && width * height <= kMaxTexels;
}

}  // namespace

constinit const std::array<float, 1024> kEwaWeights = make_weights();

constinit const EwaFactors kEwaFactors = [] {
  EwaFactors f{};
  const std::array<float, 1024> weights = make_weights();
  const auto millionths = [&](std::size_t i) { return static_cast<double>(weights[i]) * 1e6; };
  for (std::size_t k = 0; k < 32; ++k) {
    // 4e-8: what the reference's roundings of entries 909 and 911 take.
    const double moved = k == 13 ? 4e-8 : k == 15 ? -4e-8 : 0;
    f.less[k] = static_cast<float>(exponential(-2.0 * static_cast<double>(k) / 1023.0) - 1 + moved);
  }
  for (std::size_t i = 0; i < 32; ++i) {
    f.whole[i] = static_cast<float>(nearest(millionths(32 * i)));
    double low = -1, high = 1;
    for (std::size_t k = 0; k < 32; ++k) {
      const auto rounded = static_cast<double>(nearest(millionths(32 * i + k)));
      const double missing = rounded - static_cast<double>(f.whole[i]) * (1 + static_cast<double>(f.less[k]));
      low = std::max(low, missing - 0.5);
      high = std::min(high, missing + 0.5);
    }
    f.rest[i] = static_cast<float>((low + high) / 2);
  }
  return f;
}();

Texel sample_anisotropic(const LaneSample& lane, const LanePoint& point, std::uint32_t level) {
  const ImageView& view = *lane.plan->view;
  const Ellipse e = make_ellipse(point, view.level0_extent, view.base_level + level);
  float color[4] = {};
  float total = 0;
  const float u_start = static_cast<float>(e.u0) - e.tu;
  const float dq_start = (u_start * 2.0f + 1.0f) * e.a;
  const float q_start = (u_start * u_start) * e.a;
  const float ddq = e.a * 2.0f;
  const bool finite = reasonable(e);
  for (std::int64_t v = e.v0; finite && v <= e.v1; ++v) {
    const float offset = static_cast<float>(v) - e.tv;
    float dq = offset * e.b + dq_start;
    float q = (e.c * offset + e.b * u_start) * offset + q_start;
    for (std::int64_t u = e.u0; u <= e.u1; ++u) {
      if (const float weight = weight_of(q); weight != 0.0f) {
        const Texel texel = nearest_at(lane, level, static_cast<float>(u), static_cast<float>(v));
        for (std::size_t c = 0; c < 4; ++c) color[c] = color[c] + float_of(texel[c]) * weight;
        total = total + weight;
      }
      q = q + dq;
      dq = dq + ddq;
    }
  }
  if (total == 0.0f) return sample_level(lane, level, true);
  Texel result;
  for (std::size_t c = 0; c < 4; ++c) result[c] = base::bits_of(color[c] / total);
  return result;
}

}  // namespace vitrine::texel

// Levels, points and rings of the three domains.
#include "raster/front/stages/tessellator.h"

#include <algorithm>
#include <cmath>

namespace vitrine::raster {
namespace {

using spirv::TessDomain;
using spirv::TessSpacing;

/// Levels above this one are more than 1 in fixed point.
constexpr float kMoreThanOne = 1.0f + 0x1p-17f, kNextAfterOne = 1.0f + 0x1p-16f;

/// Nearest even.
Fixed to_fixed(float level) {
  const double scaled = static_cast<double>(level) * 65536.0;
  const auto whole = static_cast<Fixed>(scaled);
  const double rest = scaled - whole;
  return rest > 0.5 || (rest == 0.5 && (whole & 1) != 0) ? whole + 1 : whole;
}

float to_float(Fixed value) { return static_cast<float>(value >> 16) + static_cast<float>(value & 0xffffu) / 65536.0f; }

bool is_even(float level) { return (static_cast<int>(level) & 1) == 0; }

}  // namespace

void Tessellator::add_point(Fixed u, Fixed v) { points_.push_back({to_float(u), to_float(v)}); }

void Tessellator::list_points() {
  for (std::uint32_t i = 0; i < points_.size(); ++i) triangles_.indices.push_back(i);
}

/// To the range of the spacing; NaN becomes its lower end. `picture_frame`: more than 1, so that there is a ring.
float Tessellator::clamp_level(float level, bool picture_frame) const {
  float low = modes_.spacing == TessSpacing::kFractionalEven ? 2.0f : 1.0f;
  const float high = modes_.spacing == TessSpacing::kFractionalOdd ? 63.0f : 64.0f;
  if (picture_frame) low = kNextAfterOne;
  level = level > low ? std::min(level, high) : low;
  return modes_.spacing == TessSpacing::kEqual ? std::ceil(level) : level;
}

Side Tessellator::outside_side(float level) const {
  const bool odd =
      modes_.spacing == TessSpacing::kEqual ? !is_even(level) : modes_.spacing == TessSpacing::kFractionalOdd;
  return make_side(to_fixed(level), odd);
}

Side Tessellator::inside_side(float level) const {
  const bool odd = modes_.spacing == TessSpacing::kEqual ? !is_even(level) && level != 1.0f
                                                         : modes_.spacing == TessSpacing::kFractionalOdd;
  return make_side(to_fixed(level), odd);
}

void Tessellator::run(const TessModes& modes, const TessLevels& levels) {
  modes_ = modes;
  points_.clear();
  triangles_.indices.clear();
  triangles_.clockwise = modes.clockwise;
  const int used = modes.domain == TessDomain::kIsolines ? 2 : modes.domain == TessDomain::kTriangles ? 3 : 4;
  for (int i = 0; i < used; ++i)
    if (!(levels.outer[i] > 0)) return;
  if (modes.domain == TessDomain::kIsolines)
    isolines(levels);
  else if (modes.domain == TessDomain::kTriangles)
    triangles(levels);
  else
    quads(levels);
}

void Tessellator::triangles(const TessLevels& levels) {
  Side outer[3];
  bool more = false, all_one = modes_.spacing != TessSpacing::kFractionalEven;
  for (int e = 0; e < 3; ++e) {
    const float level = clamp_level(levels.outer[e], false);
    more |= level > kMoreThanOne;
    all_one &= to_fixed(level) == kFixedOne;
    outer[e] = outside_side(level);
  }
  const float level = clamp_level(levels.inner[0], more && modes_.spacing == TessSpacing::kFractionalOdd);
  if (all_one && to_fixed(level) == kFixedOne) {
    add_point(0, kFixedOne);
    add_point(0, 0);
    add_point(kFixedOne, 0);
    if (modes_.point_mode) return list_points();
    return triangles_.add(0, 1, 2);
  }
  const Side inner = inside_side(level);
  const std::uint32_t count = std::max(inner.count, inner.odd ? 4u : 3u);
  triangle_points(outer, inner, count);
  if (modes_.point_mode) return list_points();
  triangle_rings(outer, inner, count);
}

/// Edge 0 is u = 0 with v falling, edge 1 v = 0 with u rising, edge 2 w = 0 with u falling.
void Tessellator::triangle_points(const Side outer[3], const Side& inner, std::uint32_t count) {
  for (int e = 0; e < 3; ++e) {
    const std::uint32_t end = outer[e].count - 1;
    for (std::uint32_t p = 0; p < end; ++p) {
      const Fixed at = outer[e].place(e == 1 ? p : end - p);
      add_point(e == 0 ? 0 : at, e == 0 ? at : e == 1 ? 0 : kFixedOne - at);
    }
  }
  constexpr Fixed kTwoThirds = 0xaaaa, kOneThird = 0x5555;
  for (std::uint32_t ring = 1; ring < count / 2; ++ring) {
    const std::uint32_t end = count - 1 - ring;
    const Fixed across = (inner.place(ring) * kTwoThirds + kFixedHalf) >> 16;
    for (int e = 0; e < 3; ++e) {
      for (std::uint32_t p = ring; p < end; ++p) {
        const Fixed along = inner.place(e == 1 ? p : end - (p - ring)) - (across + 1) / 2;
        if (e == 0)
          add_point(across, along);
        else
          add_point(along, e == 1 ? across : kFixedOne - along - across);
      }
    }
  }
  if (!inner.odd) add_point(kOneThird, kOneThird);
}

void Tessellator::triangle_rings(const Side outer[3], const Side& inner, std::uint32_t count) {
  Ring outside{0, outer[0].count + outer[1].count + outer[2].count - 3, false, false};
  std::uint32_t outside_count[3] = {outer[0].count, outer[1].count, outer[2].count};
  for (std::uint32_t ring = 1; ring < (count + 1) / 2; ++ring) {
    const std::uint32_t n = count - 2 * ring;
    const Ring inside{outside.base + outside.total, 3 * (n - 1), false, false};
    Seam seam{outside, inside, 0, 0};
    for (int e = 0; e < 3; ++e) {
      if (ring == 1)
        triangles_.join_sides(seam, outer[e], inner);
      else
        triangles_.join_rows(seam, n);
      seam.outside_start += outside_count[e] - 1;
      seam.inside_start += n - 1;
      outside_count[e] = n;
    }
    outside = inside;
  }
  if (inner.odd) triangles_.add(outside.base, outside.base + 1, outside.base + 2);
}

void Tessellator::quads(const TessLevels& levels) {
  Side outer[4];
  bool more = false, all_one = modes_.spacing != TessSpacing::kFractionalEven;
  for (int e = 0; e < 4; ++e) {
    const float level = clamp_level(levels.outer[e], false);
    more |= level > kMoreThanOne;
    all_one &= to_fixed(level) == kFixedOne;
    outer[e] = outside_side(level);
  }
  for (const float level : levels.inner) more |= level > kMoreThanOne;
  Side inner[2];
  std::uint32_t count[2];
  for (int axis = 0; axis < 2; ++axis) {
    const float level = clamp_level(levels.inner[axis], more && modes_.spacing == TessSpacing::kFractionalOdd);
    all_one &= to_fixed(level) == kFixedOne;
    inner[axis] = inside_side(level);
    count[axis] = std::max(inner[axis].count, inner[axis].odd ? 4u : 3u);
  }
  if (all_one) {
    add_point(0, 0);
    add_point(kFixedOne, 0);
    add_point(kFixedOne, kFixedOne);
    add_point(0, kFixedOne);
    if (modes_.point_mode) return list_points();
    triangles_.add(0, 1, 3);
    return triangles_.add(1, 2, 3);
  }
  quad_points(outer, inner, count);
  if (modes_.point_mode) return list_points();
  quad_rings(outer, inner, count);
}

/// Edge 0 is u = 0 with v falling, edge 1 v = 0 with u rising, edge 2 u = 1 with v rising, edge 3 v = 1 with u falling.
void Tessellator::quad_points(const Side outer[4], const Side inner[2], const std::uint32_t count[2]) {
  const auto rises = [](int edge) { return edge == 1 || edge == 2; };
  for (int e = 0; e < 4; ++e) {
    const std::uint32_t end = outer[e].count - 1;
    for (std::uint32_t p = 0; p < end; ++p) {
      const Fixed at = outer[e].place(rises(e) ? p : end - p);
      if (e % 2 == 1)
        add_point(at, e == 3 ? kFixedOne : 0);
      else
        add_point(e == 2 ? kFixedOne : 0, at);
    }
  }
  const std::uint32_t rings = std::min(count[0], count[1]) / 2;
  for (std::uint32_t ring = 1; ring < rings; ++ring) {
    for (int e = 0; e < 4; ++e) {
      const int across = e % 2, along = 1 - across;
      const std::uint32_t end = count[along] - 1 - ring;
      const Fixed fixed = inner[across].place(e < 2 ? ring : count[across] - 1 - ring);
      for (std::uint32_t p = ring; p < end; ++p) {
        const Fixed at = inner[along].place(rises(e) ? p : end - (p - ring));
        add_point(along == 0 ? at : fixed, along == 0 ? fixed : at);
      }
    }
  }
  // An even side has a row of points in its middle, along the longer side.
  if (count[0] > count[1]) {
    if (inner[1].odd) return;
    for (std::uint32_t p = rings; p <= count[0] - 1 - rings; ++p) add_point(inner[0].place(p), kFixedHalf);
  } else if (!inner[0].odd) {
    for (std::uint32_t p = count[1] - rings; p-- > rings;) add_point(kFixedHalf, inner[1].place(p));
  }
}

void Tessellator::quad_rings(const Side outer[4], const Side inner[2], const std::uint32_t count[2]) {
  Ring outside{0, outer[0].count + outer[1].count + outer[2].count + outer[3].count - 4, false, false};
  std::uint32_t outside_count[4] = {outer[0].count, outer[1].count, outer[2].count, outer[3].count};
  const std::uint32_t rings = (std::min(count[0], count[1]) + 1) / 2;
  for (std::uint32_t ring = 1; ring < rings; ++ring) {
    const std::uint32_t n[2] = {count[0] - 2 * ring, count[1] - 2 * ring};
    const Ring inside{outside.base + outside.total, 2 * (n[0] - 1) + 2 * (n[1] - 1), n[0] == 1 || n[1] == 1, false};
    Seam seam{outside, inside, 0, 0};
    for (int e = 0; e < 4; ++e) {
      const int along = (e + 1) % 2;
      if (ring == 1)
        triangles_.join_sides(seam, outer[e], inner[along]);
      else
        triangles_.join_rows(seam, n[along]);
      seam.outside_start += outside_count[e] - 1;
      seam.inside_start += n[along] - 1;
      outside_count[e] = n[along];
    }
    outside = inside;
  }
  quad_center(outside, inner, count);
}

/// The row of quads inside the last ring, if the shorter side is odd: its two rows are halves of the ring, one of them
/// walked backwards.
void Tessellator::quad_center(const Ring& ring, const Side inner[2], const std::uint32_t count[2]) {
  const bool wide = count[0] > count[1];
  if (!inner[wide ? 1 : 0].odd) return;
  Ring back = ring;
  back.backwards = true;
  const std::uint32_t points = (wide ? count[0] - count[1] : count[1] - count[0]) + 2;
  triangles_.join_strip({ring, back, wide ? 1u : 0u, wide ? 0u : 1u}, points, !wide && inner[1].odd);
}

void Tessellator::isolines(const TessLevels& levels) {
  const float lines = std::ceil(std::min(std::max(levels.outer[0], 1.0f), 64.0f));
  const Side density = make_side(to_fixed(lines), !is_even(lines));
  const Side detail = outside_side(clamp_level(levels.outer[1], false));
  for (std::uint32_t line = 0; line + 1 < density.count; ++line) {
    for (std::uint32_t p = 0; p < detail.count; ++p) {
      const auto number = static_cast<std::uint32_t>(points_.size());
      add_point(detail.place(p), density.place(line));
      if (p != 0 && !modes_.point_mode) triangles_.indices.insert(triangles_.indices.end(), {number - 1, number});
    }
  }
  if (modes_.point_mode) list_points();
}

}  // namespace vitrine::raster

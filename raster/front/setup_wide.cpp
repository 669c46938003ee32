// Polygons of lines and points: Bresenham, rectangular and smooth lines, square points (lavapipe-rasterization.md 6 and
// 7).
#include "raster/front/setup_wide.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/angles.h"
#include "base/numeric.h"

namespace vitrine::raster {
namespace {

std::int32_t snap(float v) { return base::round_half_away(256.0f * v); }

float fraction(float v) { return v - std::floor(v); }
bool sign(float v) { return v >= 0; }  // -0 counts as positive

/// One end of a Bresenham line relative to the centre of its pixel.
struct DiamondEnd {
  float x, y;
  bool near_center() const { return static_cast<double>(std::fabs(x) + std::fabs(y)) < 0.5; }
};
DiamondEnd diamond_end(const Vertex* v) { return {v[0] - std::floor(v[0]) - 0.5f, v[1] - std::floor(v[1]) - 0.5f}; }

struct Offset {
  float x = 0, y = 0;
};

/// Where the polygon of a Bresenham line starts and ends (6.2): ends A (first corners 0, 3) and B (1, 2).
struct Ends {
  const Vertex *a, *b;
  Offset a_offset, b_offset;
};

Ends bresenham_x_major(const Vertex* v1, const Vertex* v2, float dx, float dy) {
  const DiamondEnd d1 = diamond_end(v1);
  DiamondEnd d2 = diamond_end(v2);
  const float m = dy / dx;
  if (d2.y == -0.5f && dy < 0) d2.y = 0.5f;
  const auto crosses = [](float y) { return y > 0 && y < 1; };
  bool draw_start, draw_end;
  if (d1.near_center())
    draw_start = true;
  else if (sign(d1.x) == sign(-dx))
    draw_start = false;
  else if (sign(-d1.y) != sign(dy))
    draw_start = true;
  else
    draw_start = crosses(fraction(v1[1]) + d1.x * m);
  if (d2.near_center())
    draw_end = false;
  else if (sign(d2.x) != sign(-dx))
    draw_end = false;
  else if (sign(-d2.y) == sign(dy))
    draw_end = true;
  else
    draw_end = crosses(fraction(v2[1]) + d2.x * m);
  const bool will_start = sign(-d1.x) != sign(dx);
  const bool will_end = sign(d2.x) == sign(-dx) || d2.x == 0;
  Ends ends{v1, v2, {}, {}};
  const bool swapped = dx < 0;
  if (swapped) std::swap(ends.a, ends.b);
  Offset& start = swapped ? ends.b_offset : ends.a_offset;
  Offset& end = swapped ? ends.a_offset : ends.b_offset;
  const float half = swapped ? -0.5f : 0.5f;
  if (will_start != draw_start) {
    start.x = -d1.x + half;
    start.y = start.x * m;
  }
  if (will_end != draw_end) {
    end.x = -d2.x + half;
    end.y = end.x * m;
  }
  return ends;
}

Ends bresenham_y_major(const Vertex* v1, const Vertex* v2, float dx, float dy) {
  const DiamondEnd d1 = diamond_end(v1);
  DiamondEnd d2 = diamond_end(v2);
  const float m = dx / dy;
  if (d2.x == -0.5f && dx < 0) d2.x = 0.5f;
  bool draw_start, draw_end;
  if (d1.near_center()) {
    draw_start = true;
  } else if (sign(-d1.y) == sign(dy)) {
    draw_start = false;
  } else if (sign(d1.x) != sign(-dx)) {
    draw_start = true;
  } else {
    const float x = fraction(v1[0]) + d1.y * m;
    draw_start = x > 0 && x < 1;
  }
  if (d2.near_center()) {
    draw_end = false;
  } else if (sign(-d2.y) != sign(dy)) {
    draw_end = false;
  } else if (sign(d2.x) == sign(-dx)) {
    draw_end = true;
  } else {
    const float x = fraction(v2[0]) + d2.y * m;
    draw_end = x >= 0 && x < 1;
  }
  const bool will_start = sign(d1.y) == sign(dy);
  const bool will_end = sign(-d2.y) == sign(dy) || d2.y == 0;
  Ends ends{v1, v2, {}, {}};
  const bool swapped = dy > 0;
  if (swapped) std::swap(ends.a, ends.b);
  Offset& start = swapped ? ends.b_offset : ends.a_offset;
  Offset& end = swapped ? ends.a_offset : ends.b_offset;
  const float half = swapped ? 0.5f : -0.5f;
  if (will_start != draw_start) {
    start.y = -d1.y + half;
    start.x = start.y * m;
  }
  if (will_end != draw_end) {
    end.y = -d2.y + half;
    end.x = end.y * m;
  }
  return ends;
}

void bresenham_polygon(const State& state, const Vertex* v1, const Vertex* v2, float po, Primitive& p) {
  const float dx = v1[0] - v2[0], dy = v1[1] - v2[1];
  const std::int32_t half = base::round_half_away(std::max(1.0f, state.line_width)) * 256 / 2;
  const bool x_major = std::fabs(dx) >= std::fabs(dy);
  const Ends e = x_major ? bresenham_x_major(v1, v2, dx, dy) : bresenham_y_major(v1, v2, dx, dy);
  const std::int32_t ax = snap(e.a[0] + e.a_offset.x - po), ay = snap(e.a[1] + e.a_offset.y - po);
  const std::int32_t bx = snap(e.b[0] + e.b_offset.x - po), by = snap(e.b[1] + e.b_offset.y - po);
  const std::int32_t sx = x_major ? 0 : half, sy = x_major ? half : 0;
  const std::int32_t x[4] = {ax - sx, bx - sx, bx + sx, ax + sx}, y[4] = {ay - sy, by - sy, by + sy, ay + sy};
  std::copy_n(x, 4, p.x);
  std::copy_n(y, 4, p.y);
}

void rectangular_polygon(const State& state, const Vertex* v1, const Vertex* v2, float area, float po, Primitive& p) {
  const float dx = v1[0] - v2[0], dy = v1[1] - v2[1];
  const float s = (state.line_width * 0.5f) / std::sqrt(area);
  const std::int32_t tx = snap(-dy * s), ty = snap(dx * s);
  const std::int32_t x1 = snap(v1[0] - po), y1 = snap(v1[1] - po), x2 = snap(v2[0] - po), y2 = snap(v2[1] - po);
  const std::int32_t x[4] = {x1 - tx, x2 - tx, x2 + tx, x1 + tx}, y[4] = {y1 - ty, y2 - ty, y2 + ty, y1 + ty};
  std::copy_n(x, 4, p.x);
  std::copy_n(y, 4, p.y);
}

/// Viewport 0 cuts lines and points, the others do not: the specification leaves that open, and this is the
/// reference's.
bool set_bounds(const SetupContext& context, const PixelRect& bounds, Primitive& p) {
  const PipelinePlan& plan = *context.plan;
  const PixelRect visible = intersect(bounds, context.viewport == 0 ? plan.wide_region : plan.region[context.viewport]);
  if (visible.empty()) {
    context.tell(bounds.empty() ? PrimitiveFate::kNoSample : PrimitiveFate::kScissor);
    return false;
  }
  p.x0 = static_cast<std::uint16_t>(visible.x0);
  p.y0 = static_cast<std::uint16_t>(visible.y0);
  p.x1 = static_cast<std::uint16_t>(visible.x1);
  p.y1 = static_cast<std::uint16_t>(visible.y1);
  return true;
}

void fill_common(const SetupContext& context, PrimitiveKind kind, bool front, Primitive& p) {
  p.depth_offset = 0;
  p.id = context.id;
  p.layer = context.layer;
  p.viewport = context.viewport;
  p.rate = context.rate;
  p.kind = kind;
  p.front = front;
}

}  // namespace

void setup_line(const SetupContext& context, const Vertex* v1, const Vertex* v2, bool front) {
  const PipelinePlan& plan = *context.plan;
  const float dx = v1[0] - v2[0], dy = v1[1] - v2[1];
  const float area = dx * dx + dy * dy;
  if (!(area > 0 && area < 1e12f)) return context.tell(area == 0 ? PrimitiveFate::kZeroArea : PrimitiveFate::kTooFar);
  const float limit = 32768;
  for (const Vertex* v : {v1, v2})
    if (!(std::fabs(v[0]) < limit && std::fabs(v[1]) < limit)) return context.tell(PrimitiveFate::kTooFar);
  Primitive p{};
  if (plan.state->line_mode == VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT)
    bresenham_polygon(*plan.state, v1, v2, plan.pixel_offset, p);
  else
    rectangular_polygon(*plan.state, v1, v2, area, plan.pixel_offset, p);
  const auto [left, right] = std::minmax({p.x[0], p.x[1], p.x[2], p.x[3]});
  const auto [top, bottom] = std::minmax({p.y[0], p.y[1], p.y[2], p.y[3]});
  // (The reference looks for pixels whose upper left corner lies inside: deviations.md, multisample-short-lines.)
  const PixelRect corners{(left + 255) >> 8, (top + 255) >> 8, (right - 1) >> 8, (bottom - 1) >> 8};
  if (plan.as_reference.needs_corner && intersect(corners, plan.region[context.viewport]).empty())
    return context.tell(PrimitiveFate::kNoSample);
  const int first = plan.raster_samples > 1 ? 0 : 255;
  if (!set_bounds(context, {(left + first) >> 8, (top + first) >> 8, right >> 8, bottom >> 8}, p)) return;
  fill_common(context, PrimitiveKind::kLine, front, p);
  p.v[0] = v1;
  p.v[1] = p.v[2] = v2;
  p.provoking = plan.state->provoking_vertex_last ? 1 : 0;
  context.out->append() = p;
}

void setup_smooth_line(SetupContext context, Arena& arena, const Vertex* v0, const Vertex* v1, bool front) {
  const PipelinePlan& plan = *context.plan;
  const float dx = v1[0] - v0[0], dy = v1[1] - v0[1];
  const auto [c, s] = base::direction_of(base::atan2(dy, dx));
  const float line_width = plan.state->line_width;
  const float half_width = line_width <= 1.0f ? 1.0f : 0.5f * line_width + 0.5f;
  const float half = 0.5f * std::sqrt(dx * dx + dy * dy);
  const float half_length = half < 0.5f ? 2.0f * half : half + 0.5f;
  SetupVertex corner[4];
  for (int i = 0; i < 4; ++i) {
    Vertex* v = arena.take<Vertex>(plan.vertex_stride);
    std::memcpy(v, i < 2 ? v0 : v1, plan.vertex_stride * sizeof(Vertex));
    const float along = i < 2 ? -0.5f : 0.5f, side = (i & 1) != 0 ? -half_width : half_width;
    v[0] += along * c - side * s;
    v[1] += along * s + side * c;
    Vertex* coverage = v + 4 + plan.perspective_count - 4;
    coverage[0] = -side;
    coverage[1] = half_width;
    coverage[2] = i < 2 ? -half_length : half_length;
    coverage[3] = half_length;
    corner[i] = {v, snap_coordinate(v[0], plan.pixel_offset), snap_coordinate(v[1], plan.pixel_offset)};
  }
  context.of_line = true;
  context.line_front = front;
  setup_triangle(context, corner[2], corner[1], corner[0]);
  setup_triangle(context, corner[3], corner[1], corner[2]);
}

void setup_point(const SetupContext& context, const Vertex* v, bool front) {
  const PipelinePlan& plan = *context.plan;
  const float limit = 32768;
  if (!(std::fabs(v[0]) < limit && std::fabs(v[1]) < limit)) return context.tell(PrimitiveFate::kTooFar);
  const float size =
      std::min(plan.point_size_word == kNoReg ? 1.0f : v[plan.point_size_word], plan.as_reference.largest_point);
  const std::int32_t width = std::max(256, base::round_half_away(256 * size));
  Primitive p{};
  p.x[0] = snap(v[0] - plan.pixel_offset) - width / 2;
  p.y[0] = snap(v[1] - plan.pixel_offset) - width / 2;
  p.x[1] = p.x[0] + width;
  p.y[1] = p.y[0] + width;
  const int first = plan.raster_samples > 1 ? 0 : 255;
  const PixelRect bounds{(p.x[0] + first) >> 8, (p.y[0] + first) >> 8, (p.x[1] - 1) >> 8, (p.y[1] - 1) >> 8};
  if (!set_bounds(context, bounds, p)) return;
  fill_common(context, PrimitiveKind::kPoint, front, p);
  p.v[0] = p.v[1] = p.v[2] = v;
  p.provoking = 0;
  context.out->append() = p;
}

}  // namespace vitrine::raster

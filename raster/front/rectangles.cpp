// Rectangles: from pairs of triangles to primitives (lavapipe-rasterization.md 9.2, 9.3).
#include "raster/front/rectangles.h"

#include <algorithm>
#include <cmath>

#include "base/numeric.h"
#include "raster/pixel_order.h"

namespace vitrine::raster {
namespace {

enum class Winding : std::uint8_t { kNone, kCounterClockwise, kClockwise };

Winding winding_of(const Vertex* const* v) {
  const float determinant = window_determinant(v[0], v[1], v[2]);
  return determinant < 0 ? Winding::kCounterClockwise : determinant > 0 ? Winding::kClockwise : Winding::kNone;
}

bool same_place(const Vertex* a, const Vertex* b) {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2] && a[3] == b[3];
}

/// A way in which two counter-clockwise triangles share an edge: the corner at which both meet, the other end of the
/// edge in both, and the corners of the rectangle in order. The first row whose first two are the same corner decides,
/// with the row behind it if that has the same.
struct Join {
  std::uint8_t a, b, c, d;
  std::uint8_t corner[4];
};
constexpr Join kJoins[] = {
    {0, 3, 2, 4, {5, 0, 1, 2}}, {0, 3, 1, 5, {4, 1, 2, 0}}, {0, 5, 2, 3, {4, 0, 1, 2}},
    {0, 5, 1, 4, {3, 1, 2, 0}}, {0, 4, 2, 5, {3, 0, 1, 2}}, {0, 4, 1, 3, {5, 1, 2, 0}},
    {2, 3, 1, 4, {5, 2, 0, 1}}, {2, 5, 1, 3, {4, 2, 0, 1}}, {2, 4, 1, 5, {3, 2, 0, 1}},
};

/// The four corners of the quadrilateral that two counter-clockwise triangles form; false if they do not.
bool join(const PairCorners& v, const Vertex* (&corner)[4]) {
  for (std::size_t i = 0; i < std::size(kJoins); ++i) {
    const Join& first = kJoins[i];
    if (!same_place(v[first.a], v[first.b])) continue;
    for (std::size_t k = i; k < std::size(kJoins) && kJoins[k].a == first.a && kJoins[k].b == first.b; ++k) {
      if (!same_place(v[kJoins[k].c], v[kJoins[k].d])) continue;
      for (int c = 0; c < 4; ++c) corner[c] = v[kJoins[k].corner[c]];
      return true;
    }
    return false;
  }
  return false;
}

bool is_axis_aligned(const Vertex* const (&r)[4]) {
  return r[0][0] == r[1][0] && r[2][0] == r[3][0] && r[0][1] == r[3][1] && r[1][1] == r[2][1];
}

bool is_plane(const Vertex* const (&r)[4], std::uint32_t word) {
  return r[0][word] - r[3][word] == r[1][word] - r[2][word] && r[0][word] - r[1][word] == r[3][word] - r[2][word];
}

/// Whether inputs that are interpolated from three corners are right at the fourth.
bool inputs_are_planes(const PipelinePlan& plan, const Vertex* const (&r)[4]) {
  if (r[1][3] != r[0][3] || r[2][3] != r[0][3] || r[3][3] != r[0][3]) return false;
  if (plan.frag.frag_coord[2] != kNoReg && !is_plane(r, 2)) return false;
  for (std::uint32_t k = 4; k < 4 + plan.perspective_count + plan.linear_count; ++k)
    if (!is_plane(r, k)) return false;
  return true;
}

/// Two triangles that face the same way, counter-clockwise.
TrianglePair pair_counter_clockwise(const PipelinePlan& plan, const PairCorners& v, bool front) {
  const Vertex* r[4];
  if (!join(v, r)) return {};
  if (r[0][1] == r[1][1]) std::rotate(std::begin(r), std::begin(r) + 1, std::end(r));
  if (!is_axis_aligned(r) || !inputs_are_planes(plan, r)) return {};
  for (const Vertex* corner : r)
    if (!(std::fabs(corner[0]) < 32768 && std::fabs(corner[1]) < 32768)) return {};
  return {TrianglePair::Kind::kRectangle, {r[0], r[2], r[1]}, front};
}

}  // namespace

TrianglePair pair_triangles(const PipelinePlan& plan, const PairCorners& v) {
  using Kind = TrianglePair::Kind;
  const State& state = *plan.state;
  const bool ccw_front = state.front_face == VK_FRONT_FACE_COUNTER_CLOCKWISE;
  const Winding first = winding_of(v.data()), second = winding_of(v.data() + 3);
  const auto together = [&] {
    if (first == Winding::kCounterClockwise) return pair_counter_clockwise(plan, v, ccw_front);
    return pair_counter_clockwise(plan, {v[0], v[2], v[1], v[3], v[5], v[4]}, !ccw_front);
  };
  if (state.cull_mode == VK_CULL_MODE_NONE) {
    if (first != second) return {};
    return first == Winding::kNone ? TrianglePair{Kind::kNothing, {}, false} : together();
  }
  const bool ccw_visible = (state.cull_mode == VK_CULL_MODE_BACK_BIT) == ccw_front;
  const Winding visible = ccw_visible ? Winding::kCounterClockwise : Winding::kClockwise;
  if (first == visible && second == visible) return together();
  if (first == visible) return {Kind::kFirst, {}, false};
  if (second == visible) return {ccw_visible ? Kind::kApart : Kind::kSecond, {}, false};
  return {Kind::kNothing, {}, false};
}

void setup_rectangle(const SetupContext& context, const TrianglePair& pair) {
  const PipelinePlan& plan = *context.plan;
  std::int32_t x[3], y[3];
  for (std::size_t i = 0; i < 3; ++i) {
    x[i] = base::round_half_away(256.0f * (pair.corner[i][0] - plan.pixel_offset));
    y[i] = base::round_half_away(256.0f * (pair.corner[i][1] - plan.pixel_offset));
  }
  const auto tell = [&](PrimitiveFate fate) {
    for (int triangle = 0; triangle < 2; ++triangle) context.tell(fate);
  };
  if ((x[2] < x[1]) != (y[0] < y[2])) return tell(PrimitiveFate::kZeroArea);
  const auto [left, right] = std::minmax({x[0], x[1], x[2]});
  const auto [top, bottom] = std::minmax({y[0], y[1], y[2]});
  const PixelRect bounds{(left + 255) >> 8, (top + 255) >> 8, ((right + 255) >> 8) - 1, ((bottom + 255) >> 8) - 1};
  if (bounds.empty()) return tell(PrimitiveFate::kNoSample);
  const PixelRect visible = intersect(bounds, plan.region[context.viewport]);
  if (visible.empty()) return tell(PrimitiveFate::kScissor);
  const int wx = visible.x0 & ~1, wy = visible.y0 & ~1;
  base::LaneMask window = 0;
  if (plan.windows && visible.x1 - wx < 8 && visible.y1 - wy < 8)
    window = rect_lanes(visible.x0 - wx, visible.y0 - wy, visible.x1 - wx, visible.y1 - wy);
  Primitive& p = context.out->append();
  std::copy_n(pair.corner.data(), 3, p.v);
  const std::int32_t box_x[4] = {left, right, 0, 0}, box_y[4] = {top, bottom, 0, 0};
  std::copy_n(box_x, 4, p.x);
  std::copy_n(box_y, 4, p.y);
  complete_triangle(context, {pair.front, visible, window}, p);
  p.kind = PrimitiveKind::kRectangle;
}

void ClippedBatch::begin(const PipelinePlan& plan) {
  plan_ = &plan;
  clear(false);
}

void ClippedBatch::clear(bool another) {
  alone_ = another && !alone_;
  triangles_.clear();
  collected_.clear();
}

void ClippedBatch::add(const ClippedTriangle& triangle) {
  triangles_.push_back(triangle);
  collected_.add(triangle.v);
}

}  // namespace vitrine::raster

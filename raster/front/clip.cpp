// Sutherland-Hodgman clipping of triangles, parametric clipping of lines.
#include "raster/front/clip.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "base/x86_arithmetic.h"
#include "raster/front/made_vertices.h"

namespace vitrine::raster {
namespace {

using base::x86_add;
using base::x86_div;
using base::x86_mul;
using base::x86_sub;

/// Coefficients of planes 0..5 for (x, y, z, w).
struct Plane {
  float x, y, z, w;
};

Plane plane_of(const ClipContext& context, std::uint32_t index) {
  const float k = context.guard_band ? 0.5f : 1.0f;
  switch (index) {
    case 0:
      return {-k, 0, 0, 1};
    case 1:
      return {k, 0, 0, 1};
    case 2:
      return {0, -k, 0, 1};
    case 3:
      return {0, k, 0, 1};
    case 4:
      return {0, 0, 1, context.plan->state->negative_one_to_one ? 1.0f : 0.0f};
    default:
      return {0, 0, -1, 1};
  }
}

/// All four products are computed, so that an infinite coordinate gives NaN (lavapipe-rasterization.md 1.5).
float distance_to(const ClipContext& context, std::uint32_t plane, const ClipVertex& v) {
  if (plane >= kFirstUserPlane) return v.distance[plane - kFirstUserPlane];
  const Plane p = plane_of(context, plane);
  return ((p.x * v.clip[0] + p.y * v.clip[1]) + p.z * v.clip[2]) + p.w * v.clip[3];
}

float mix(float base, float other, float t) { return x86_add(x86_mul(x86_sub(other, base), t), base); }

/// 1.5, noperspective: the parameter in window space, along the first axis on which the parents differ.
float linear_parameter(const ClipVertex& base, const ClipVertex& other, const ClipVertex& made, float t) {
  for (int k = 0; k < 2; ++k) {
    if (base.clip[k] == other.clip[k]) continue;
    const float in = x86_div(other.clip[k], other.clip[3]);
    const float out = x86_div(base.clip[k], base.clip[3]);
    const float at = x86_div(made.clip[k], made.clip[3]);
    return x86_div(x86_sub(at, out), x86_sub(in, out));
  }
  return t;
}

/// A new vertex between `base` (t = 0) and `other` (t = 1). Flat values are those of `base` until fixed up.
ClipVertex interpolate(const ClipContext& context, const ClipVertex& base, const ClipVertex& other, float t) {
  const PipelinePlan& plan = *context.plan;
  ClipVertex made = base;
  for (int i = 0; i < 4; ++i) made.clip[i] = mix(base.clip[i], other.clip[i], t);
  for (std::uint32_t i = 0; i < plan.out.clip_count; ++i)
    made.distance[i] = mix(base.distance[i], other.distance[i], t);
  Vertex* record = context.arena->take<Vertex>(plan.vertex_stride);
  transform_vertex(made.clip, *context.viewport, record);
  std::uint32_t k = 4;
  for (const std::uint32_t end = k + plan.perspective_count; k < end; ++k)
    record[k] = mix(base.record[k], other.record[k], t);
  const float linear = plan.linear_count ? linear_parameter(base, other, made, t) : t;
  for (const std::uint32_t end = k + plan.linear_count; k < end; ++k)
    record[k] = mix(base.record[k], other.record[k], linear);
  std::memcpy(record + k, base.record + k, (plan.vertex_stride - k) * sizeof(Vertex));
  made.record = record;
  made.code = 0;
  return made;
}

/// The vertex on the plane between previous (distance dp) and current (d): measured from the nearer one.
ClipVertex crossing(const ClipContext& context, const ClipVertex& previous, const ClipVertex& current, float dp,
                    float d) {
  const float den = d - dp;
  const bool leaving = d < 0;
  const bool from_current = leaving ? -d < dp : !(-dp < d);
  if (from_current) return interpolate(context, current, previous, d / den);
  return interpolate(context, previous, current, -dp / den);
}

/// One plane; false if a distance is not finite.
bool clip_by_plane(const ClipContext& context, std::uint32_t plane, const ClipPolygon& in, ClipPolygon& out) {
  out.count = 0;
  const ClipVertex* previous = &in.corner[0];
  float dp = distance_to(context, plane, *previous);
  if (!std::isfinite(dp)) return false;
  for (std::uint32_t i = 1; i <= in.count; ++i) {
    const ClipVertex& current = in.corner[i == in.count ? 0 : i];
    const float d = distance_to(context, plane, current);
    if (!std::isfinite(d)) return false;
    const bool inside = dp >= 0;
    if (inside) out.corner[out.count++] = *previous;
    if (inside ? d < 0 : !(d < 0)) {
      ClipVertex& made = out.corner[out.count++];
      made = crossing(context, *previous, current, dp, d);
      // 10.2: edges along planes of the frustum are not drawn, those along user planes are.
      made.edge = inside ? plane >= kFirstUserPlane : previous->edge;
    }
    previous = &current;
    dp = d;
  }
  return out.count >= 3;
}

}  // namespace

bool clip_triangle(const ClipContext& context, std::uint32_t provoking, ClipPolygon& polygon) {
  const ClipCode planes = polygon.corner[0].code | polygon.corner[1].code | polygon.corner[2].code;
  const Vertex* provoking_record = polygon.corner[provoking].record;
  ClipPolygon other;
  ClipPolygon *in = &polygon, *out = &other;
  for (ClipCode left = planes; left != 0; left &= left - 1) {
    if (!clip_by_plane(context, static_cast<std::uint32_t>(std::countr_zero(left)), *in, *out)) return false;
    std::swap(in, out);
  }
  if (in != &polygon) polygon = *in;
  const Vertex*& first = polygon.corner[0].record;
  first = with_flat_values(*context.plan, *context.arena, first, provoking_record);
  return true;
}

bool clip_line(const ClipContext& context, std::uint32_t provoking, ClipVertex line[2]) {
  float t0 = 0, t1 = 0;
  for (ClipCode left = line[0].code | line[1].code; left != 0; left &= left - 1) {
    const auto plane = static_cast<std::uint32_t>(std::countr_zero(left));
    const float d0 = distance_to(context, plane, line[0]);
    const float d1 = distance_to(context, plane, line[1]);
    if (!std::isfinite(d0) || !std::isfinite(d1)) return false;
    if (d1 < 0) t1 = std::max(t1, d1 / (d1 - d0));
    if (d0 < 0) t0 = std::max(t0, d0 / (d0 - d1));
    if (t0 + t1 >= 1) return false;
  }
  const ClipVertex v0 = line[0], v1 = line[1];
  if (v0.code) line[0] = interpolate(context, v0, v1, t0);
  if (v1.code) line[1] = interpolate(context, v1, v0, t1);
  const ClipVertex& source = provoking == 0 ? v0 : v1;
  for (int i = 0; i < 2; ++i)
    line[i].record = with_flat_values(*context.plan, *context.arena, line[i].record, source.record);
  return true;
}

}  // namespace vitrine::raster

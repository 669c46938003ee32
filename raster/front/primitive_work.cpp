// Cull distances, clipping, culling, polygon modes, hand-over to setup (lavapipe-rasterization.md 1.4 to 1.7, 2.2, 7.1,
// 10.2).
#include "raster/front/primitive_work.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/numeric.h"
#include "raster/front/made_vertices.h"
#include "raster/front/setup_wide.h"

namespace vitrine::raster {

void count_behind_clipper(const PrimitiveWork& w, std::uint64_t input) {
  if (!w.plan.draws_points)
    w.chunk.draw->call.queries.count(Statistic::kClippingPrimitives, input + w.parts - w.discarded);
}

void choose_view_layer(PrimitiveWork& w, bool clips) {
  if (!w.chunk.view_layer) return;
  ViewLayer& waiting = *w.chunk.view_layer;
  const State& state = *w.plan.state;
  clips |= w.plan.bias_in_vertices || w.plan.smooth_lines || w.plan.out.cull_count != 0 ||
           (w.plan.draws_lines && state.line_stipple);
  if (!waiting.any || !clips) {
    waiting.layer = w.chunk.view;
    waiting.alone = false;
    waiting.collected.clear();
  }
  waiting.any = clips;
  waiting.collected.begin_segment();
  if (clips) w.waiting = &waiting;
  w.batches &= !clips;
  w.base_layer = waiting.layer;
  w.setup.layer = static_cast<std::uint16_t>(w.base_layer);
}

namespace {

/// Before a primitive is set up whose corners, and no others, the reference collects. (With several views no shader
/// writes a layer.)
void collect(PrimitiveWork& w, std::initializer_list<const Vertex*> corners) {
  if (!w.waiting) return;
  w.waiting->add(w.chunk.view, corners, w.plan.rectangles.batch_vertices);
  w.base_layer = w.waiting->layer;
  w.setup.layer = static_cast<std::uint16_t>(w.base_layer);
}

}  // namespace

void number_corners(PrimitiveWork& w, const std::uint32_t* slot, std::uint32_t corners) {
  const PipelinePlan& plan = w.plan;
  if (!plan.numbers_corners) return;
  const auto shared = [&](std::uint32_t c) { return w.vertices.records + std::size_t{slot[c]} * plan.vertex_stride; };
  const std::uint32_t smooth = plan.perspective_count + plan.linear_count;
  for (std::uint32_t c = 0; c < corners; ++c) {
    Vertex* const own = copy_record(plan, w.arena, shared(c));
    for (std::uint32_t i = 0; i < plan.varying_count(); ++i) {
      const std::uint32_t corner = plan.varying[i].corner;
      if (corner == Varying::kAnyCorner) continue;
      own[4 + i] = i >= smooth ? shared(std::min(corner, corners - 1))[4 + i] : c == corner ? 1.0f : 0.0f;
    }
    w.own[c] = own;
  }
}

ClipVertex clip_vertex(const PrimitiveWork& w, std::uint32_t slot, std::uint32_t corner) {
  ClipVertex v;
  std::memcpy(v.clip, &w.vertices.clip[slot * 4], sizeof(v.clip));
  std::memcpy(v.distance, &w.vertices.clip_distance[slot * kMaxClipDistances], sizeof(v.distance));
  v.record = record_of(w, slot, corner);
  v.code = w.vertices.code[slot];
  return v;
}

bool culled_by_distance(const PrimitiveWork& w, const std::uint32_t* slot, std::uint32_t corners) {
  for (std::uint32_t d = 0; d < w.plan.out.cull_count; ++d) {
    bool all = true;
    for (std::uint32_t c = 0; c < corners; ++c) {
      const float value = w.vertices.cull_distance[slot[c] * kMaxClipDistances + d];
      all &= !(value >= 0) || !std::isfinite(value);
    }
    if (all) return true;
  }
  return false;
}

void choose_layer_and_viewport(PrimitiveWork& w, std::uint32_t provoking_slot) {
  w.setup.layer = static_cast<std::uint16_t>(w.base_layer);
  if (w.plan.out.layer != kNoReg) {
    const std::uint32_t layer = w.vertices.layer[provoking_slot] + w.base_layer;
    w.setup.layer = static_cast<std::uint16_t>(std::min(layer, std::max<std::uint32_t>(w.pass.layers, 1) - 1));
  }
  if (w.plan.rates.any && w.plan.out.shading_rate != kNoReg)
    w.setup.rate = w.plan.rates.with_primitive(w.vertices.shading_rate[provoking_slot]);
  if (!w.plan.per_vertex_viewport) return;
  const std::uint32_t index = w.vertices.viewport_index[provoking_slot];
  w.setup.viewport = index < kMaxViewports ? static_cast<std::uint8_t>(index) : std::uint8_t{0};
  w.viewport = w.plan.viewport[w.setup.viewport];
}

const Vertex* window_record(const PrimitiveWork& w, const ClipVertex& v) {
  if (!w.plan.per_vertex_viewport || v.code != 0) return v.record;
  Vertex* copy = copy_record(w.plan, w.arena, v.record);
  transform_vertex(v.clip, w.viewport, copy);
  return copy;
}

namespace {

SetupVertex setup_vertex(const PrimitiveWork& w, const Vertex* record) {
  return {record, snap_coordinate(record[0], w.plan.pixel_offset), snap_coordinate(record[1], w.plan.pixel_offset)};
}

/// The corner of an outline, or the end of a line with pieces, that is not the provoking one: the reference collects a
/// copy.
const Vertex* flat_copy(const PrimitiveWork& w, const Vertex* record, const Vertex* provoking) {
  if (w.waiting) record = copy_record(w.plan, w.arena, record);
  return with_flat_values(w.plan, w.arena, record, provoking);
}

/// Length in units of the pattern (6.4): Euclidean, of Bresenham lines along the major axis.
float stipple_length(const State& state, const Vertex* v0, const Vertex* v1) {
  const float dx = v1[0] - v0[0], dy = v1[1] - v0[1];
  if (state.line_mode != VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT) return std::sqrt(dx * dx + dy * dy);
  return base::max_second(std::fabs(dx), std::fabs(dy));
}

void emit_segment(PrimitiveWork& w, const Vertex* v0, const Vertex* v1, bool front) {
  collect(w, {v0, v1});
  if (w.plan.smooth_lines)
    setup_smooth_line(w.setup, w.arena, v0, v1, front || w.plan.as_reference.smooth_outlines_face_front);
  else
    setup_line(w.setup, v0, v1, front);
}

/// A line in window space: as a whole, or the stretches where the stipple pattern has ones.
void emit_line(PrimitiveWork& w, const Vertex* v0, const Vertex* v1, bool front) {
  const State& state = *w.plan.state;
  if (!state.line_stipple && !w.plan.smooth_lines) return emit_segment(w, v0, v1, front);
  if (w.plan.corners == 2) {  // an outline's corners are flat already
    if (state.provoking_vertex_last)
      v0 = flat_copy(w, v0, v1);
    else
      v1 = flat_copy(w, v1, v0);
  }
  if (!state.line_stipple) return emit_segment(w, v0, v1, front);
  const float length = stipple_length(state, v0, v1);
  if (!std::isfinite(length)) return;
  const auto pixels = static_cast<std::uint32_t>(std::ceil(length));
  const auto segment = [&](float t0, float t1) {
    emit_segment(w, t0 > 0 ? between(w.plan, w.arena, v0, v1, t0) : v0,
                 t1 < 1 ? between(w.plan, w.arena, v0, v1, t1) : v1, front);
  };
  const std::uint32_t factor = std::max<std::uint32_t>(state.line_stipple_factor, 1);
  bool drawing = false;
  float start = 0;
  for (std::uint32_t i = 0; i < pixels; ++i) {
    const std::uint32_t bit = (w.stipple_counter + i) / factor & 15;
    const bool on = (state.line_stipple_pattern >> bit & 1) != 0;
    if (on == drawing) continue;
    if (drawing)
      segment(start / length, static_cast<float>(i) / length);
    else
      start = static_cast<float>(i);
    drawing = on;
  }
  if (drawing && start < length) segment(start / length, 1.0f);
  w.stipple_counter += pixels;
}

void emit_point(PrimitiveWork& w, const Vertex* v, bool front) {
  collect(w, {v});
  setup_point(w.setup, v, front);
}

}  // namespace

void emit_filled(PrimitiveWork& w, const Vertex* const v[3]) {
  collect(w, {v[0], v[1], v[2]});
  setup_triangle(w.setup, setup_vertex(w, v[0]), setup_vertex(w, v[1]), setup_vertex(w, v[2]));
}

namespace {

/// 10.2: the outline or the corners of one triangle after clipping. edge[i]: of the edge that starts at corner i.
void emit_unfilled(PrimitiveWork& w, const Vertex* const in[3], const bool edge[3], float determinant) {
  const State& state = *w.plan.state;
  const Vertex* v[3] = {in[0], in[1], in[2]};
  if (w.plan.depth_bias) {
    const float offset = vertex_depth_bias(w.plan, w.pass, v[0], v[1], v[2]);
    for (const Vertex*& corner : v) corner = biased_copy(w.plan, w.arena, corner, offset);
  }
  if (state.polygon_mode == VK_POLYGON_MODE_FILL) return emit_filled(w, v);
  const std::uint32_t provoking = provoking_corner(3, state.provoking_vertex_last);
  for (std::uint32_t i = 0; i < 3; ++i)
    if (i != provoking) v[i] = flat_copy(w, v[i], v[provoking]);
  const bool ccw = state.front_face == VK_FRONT_FACE_COUNTER_CLOCKWISE;
  const bool front = w.plan.as_reference.outlines_face_front || (ccw ? determinant < 0 : determinant > 0);
  if (state.polygon_mode == VK_POLYGON_MODE_POINT) {
    for (int i = 0; i < 3; ++i)
      if (edge[i]) emit_point(w, v[i], front);
    return;
  }
  if (edge[2]) emit_line(w, v[2], v[0], front);
  if (edge[0]) emit_line(w, v[0], v[1], front);
  if (edge[1]) emit_line(w, v[1], v[2], front);
}

}  // namespace

bool emit_pair(PrimitiveWork& w, const PairCorners& v) {
  using Kind = TrianglePair::Kind;
  const TrianglePair pair = pair_triangles(w.plan, v);
  if (pair.kind == Kind::kApart) return false;
  if (pair.kind == Kind::kFirst) emit_filled(w, v.data());
  if (pair.kind == Kind::kSecond) emit_filled(w, v.data() + 3);
  if (pair.kind != Kind::kRectangle) {
    for (int culled = pair.kind == Kind::kNothing ? 2 : 1; culled > 0; --culled) w.setup.tell(PrimitiveFate::kFacing);
    return true;
  }
  setup_rectangle(w.setup, pair);
  return true;
}

void flush_clipped(PrimitiveWork& w, bool another) {
  const std::span<const ClippedTriangle> triangles = w.clipped.triangles();
  const bool even = triangles.size() % 2 == 0;
  const std::uint32_t id = w.setup.id;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const TriangleCorners& v = triangles[i].v;
    w.setup.id = triangles[i].id;
    w.setup.instance = index_of_instance(w, triangles[i].instance);
    w.primitives.mark(triangles[i].instance);
    if (even && i % 2 == 0) {
      const TriangleCorners& next = triangles[i + 1].v;
      if (emit_pair(w, {v[0], v[1], v[2], next[0], next[1], next[2]})) {
        ++i;
        continue;
      }
    }
    emit_filled(w, v.data());
  }
  w.setup.id = id;
  w.setup.instance = index_of_instance(w, w.instance);
  w.primitives.mark(w.instance);
  if (!triangles.empty()) w.clipped.clear(another);
}

void emit_slow(PrimitiveWork& w, const Vertex* const v[3], const bool edge[3]) {
  const float determinant = window_determinant(v[0], v[1], v[2]);
  if (culled_by_determinant(*w.plan.state, determinant))
    return w.setup.tell(determinant == 0 ? PrimitiveFate::kZeroArea : PrimitiveFate::kFacing);
  if (w.plan.bias_in_vertices) {
    emit_unfilled(w, v, edge, determinant);
    return;
  }
  if (!w.clips_segment) return emit_filled(w, v);
  if (w.clipped.is_complete()) flush_clipped(w, true);
  w.clipped.add({{v[0], v[1], v[2]}, w.setup.id, w.instance});
}

void emit_clipped(PrimitiveWork& w, std::uint32_t provoking, ClipPolygon& polygon) {
  const bool guard_band = w.plan.guard_band || w.plan.state->polygon_mode == VK_POLYGON_MODE_POINT;
  const ClipContext context{&w.plan, &w.viewport, &w.arena, guard_band};
  if (!clip_triangle(context, provoking, polygon)) return discard(w, PrimitiveFate::kOutside);
  w.parts += polygon.count - 3;
  w.setup.tell(PrimitiveFate::kClipped);
  const Vertex* record[kMaxPolygon];
  for (std::uint32_t i = 0; i < polygon.count; ++i) record[i] = window_record(w, polygon.corner[i]);
  const bool last_mode = w.plan.state->provoking_vertex_last;
  for (std::uint32_t i = 2; i < polygon.count; ++i) {
    // Fan (p0, p[i-1], p[i]); edges inside the polygon are not part of the outline.
    const bool from_p0 = i == 2 && polygon.corner[0].edge;
    const bool between = polygon.corner[i - 1].edge;
    const bool to_p0 = i == polygon.count - 1 && polygon.corner[i].edge;
    if (last_mode) {
      const Vertex* v[3] = {record[i - 1], record[i], record[0]};
      const bool edge[3] = {between, to_p0, from_p0};
      emit_slow(w, v, edge);
    } else {
      const Vertex* v[3] = {record[0], record[i - 1], record[i]};
      const bool edge[3] = {from_p0, between, to_p0};
      emit_slow(w, v, edge);
    }
  }
}

void process_line(PrimitiveWork& w, const std::uint32_t slot[2]) {
  const ClipCode c0 = w.vertices.code[slot[0]], c1 = w.vertices.code[slot[1]];
  if ((c0 & c1) != 0) return discard(w, PrimitiveFate::kOutside);
  if (w.plan.out.cull_count && culled_by_distance(w, slot, 2)) return discard(w, PrimitiveFate::kCulledByDistance);
  const std::uint32_t provoking = provoking_corner(2, w.plan.state->provoking_vertex_last);
  choose_layer_and_viewport(w, slot[provoking]);
  number_corners(w, slot, 2);
  ClipVertex line[2] = {clip_vertex(w, slot[0], 0), clip_vertex(w, slot[1], 1)};
  const ClipContext context{&w.plan, &w.viewport, &w.arena, w.plan.guard_band};
  if ((c0 | c1) != 0) {
    if (!clip_line(context, provoking, line)) return discard(w, PrimitiveFate::kOutside);
    w.setup.tell(PrimitiveFate::kClipped);
  }
  emit_line(w, window_record(w, line[0]), window_record(w, line[1]), true);
}

namespace {

/// A point that the reference keeps (deviations.md, point-clipping).
void process_outside_point(PrimitiveWork& w, const ClipVertex& v) {
  if (v.clip[3] <= 0 || !std::isfinite(v.clip[0]) || !std::isfinite(v.clip[1]))
    return w.setup.tell(PrimitiveFate::kOutside);
  if (w.plan.fused_transform && !w.plan.per_vertex_viewport) return emit_point(w, v.record, true);
  Vertex* copy = copy_record(w.plan, w.arena, v.record);
  std::copy_n(v.clip, 4, copy);
  emit_point(w, copy, true);
}

}  // namespace

void process_point(PrimitiveWork& w, std::uint32_t slot) {
  const ClipCode code = w.vertices.code[slot];
  if ((code & ~kClipXY) != 0) return w.setup.tell(PrimitiveFate::kOutside);
  number_corners(w, &slot, 1);
  const ClipVertex v = clip_vertex(w, slot, 0);
  if (w.plan.out.cull_count && culled_by_distance(w, &slot, 1)) return w.setup.tell(PrimitiveFate::kCulledByDistance);
  // Clipping primitives: the reference's count, and any is allowed for what is outside.
  w.chunk.draw->call.queries.count(Statistic::kClippingPrimitives, 1);
  if (code != 0 && !w.plan.as_reference.keeps_outside_points) return w.setup.tell(PrimitiveFate::kOutside);
  choose_layer_and_viewport(w, slot);
  if (code != 0) return process_outside_point(w, v);
  emit_point(w, window_record(w, v), true);
}

}  // namespace vitrine::raster

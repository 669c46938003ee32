// The front end's second half: cull distances, clipping, culling, polygon modes, hand-over to setup
// (lavapipe-rasterization.md 1.4 to 1.7, 2.2, 7.1, 10.2).
#include "raster/front/primitives.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/numeric.h"
#include "raster/front/assembly.h"
#include "raster/front/clip.h"
#include "raster/front/collected.h"
#include "raster/front/made_vertices.h"
#include "raster/front/rectangles.h"
#include "raster/front/setup_batch.h"
#include "raster/front/setup_wide.h"

namespace vitrine::raster {
namespace {

struct PrimitiveWork : PrimitiveContext {
  const PipelinePlan& plan;
  SetupContext setup;
  ViewportTransform viewport;
  bool batches;                       ///< triangles inside the view volume need nothing but setup
  std::uint32_t stipple_counter = 0;  ///< pixels of the pattern used up by earlier lines of the strip
  TriangleBatch batch;
  bool clips_segment = false;  ///< triangles go to `clipped`, not to setup
  ClippedBatch own_batch;
  ClippedBatch& clipped;         ///< the chunk's own, or one that several chunks share
  std::uint32_t base_layer;      ///< of the view
  ViewLayer* waiting = nullptr;  ///< primitives go through the reference's clipper, and wait with those of other views
  std::uint32_t discarded = 0;   ///< lines and triangles that the clipper leaves nothing of
  std::uint32_t parts = 0;       ///< triangles that it makes beyond the first of a polygon

  explicit PrimitiveWork(const PrimitiveContext& context)
      : PrimitiveContext(context),
        plan(*chunk.draw->plan),
        setup{&plan, &pass, &primitives},
        viewport(plan.viewport[0]),
        batches(plan.windows && plan.out.layer == kNoReg && !plan.per_vertex_viewport && !plan.bias_in_vertices &&
                plan.out.cull_count == 0),
        clipped(chunk.batch ? *chunk.batch : own_batch),
        base_layer(chunk.view) {
    setup.layer = static_cast<std::uint16_t>(base_layer);
    if (plan.rectangles.any && !chunk.batch) own_batch.begin(plan);
    setup.watch = chunk.watch;
  }
};

/// The clipper's end of a line or triangle.
void discard(PrimitiveWork& w, PrimitiveFate fate) {
  ++w.discarded;
  w.setup.tell(fate);
}

/// Vulkan 1.3.239, VkQueryPipelineStatisticFlagBits: "If at least one vertex of the input primitive lies inside the
/// clipping volume, the counter is incremented by one or more", whatever its area and the culling by its face.
/// (The reference leaves out those that its clipper culls, and rectangles.)
void count_behind_clipper(const PrimitiveWork& w, std::uint64_t input) {
  if (!w.plan.draws_points)
    w.chunk.draw->call.queries.count(Statistic::kClippingPrimitives, input + w.parts - w.discarded);
}

/// deviations.md, multiview-layers: what goes through the reference's clipper waits, and goes to the layer of the view
/// that the first of it is of; what does not sends that off.
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

/// Before a primitive is set up whose corners, and no others, the reference collects. (With several views no shader
/// writes a layer.)
void collect(PrimitiveWork& w, std::initializer_list<const Vertex*> corners) {
  if (!w.waiting) return;
  w.waiting->add(w.chunk.view, corners, w.plan.rectangles.batch_vertices);
  w.base_layer = w.waiting->layer;
  w.setup.layer = static_cast<std::uint16_t>(w.base_layer);
}

ClipVertex clip_vertex(const PrimitiveWork& w, std::uint32_t slot) {
  ClipVertex v;
  std::memcpy(v.clip, &w.vertices.clip[slot * 4], sizeof(v.clip));
  std::memcpy(v.distance, &w.vertices.clip_distance[slot * kMaxClipDistances], sizeof(v.distance));
  v.record = w.vertices.records + std::size_t{slot} * w.plan.vertex_stride;
  v.code = w.vertices.code[slot];
  return v;
}

/// 1.7: dropped if all corners are outside of one cull distance.
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

/// 3.4: layer and viewport from the provoking vertex.
void choose_layer_and_viewport(PrimitiveWork& w, std::uint32_t provoking_slot) {
  w.setup.layer = static_cast<std::uint16_t>(w.base_layer);
  if (w.plan.out.layer != kNoReg) {
    const std::uint32_t layer = w.vertices.layer[provoking_slot] + w.base_layer;
    w.setup.layer = static_cast<std::uint16_t>(std::min(layer, std::max<std::uint32_t>(w.pass.layers, 1) - 1));
  }
  if (!w.plan.per_vertex_viewport) return;
  const std::uint32_t index = w.vertices.viewport_index[provoking_slot];
  w.setup.viewport = index < kMaxViewports ? static_cast<std::uint8_t>(index) : std::uint8_t{0};
  w.viewport = w.plan.viewport[w.setup.viewport];
}

/// A record transformed by the primitive's own viewport (1.2 form B), when the viewport is chosen per primitive.
const Vertex* window_record(const PrimitiveWork& w, const ClipVertex& v) {
  if (!w.plan.per_vertex_viewport || v.code != 0) return v.record;
  Vertex* copy = copy_record(w.plan, w.arena, v.record);
  transform_vertex(v.clip, w.viewport, copy);
  return copy;
}

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

void emit_filled(PrimitiveWork& w, const Vertex* const v[3]) {
  collect(w, {v[0], v[1], v[2]});
  setup_triangle(w.setup, setup_vertex(w, v[0]), setup_vertex(w, v[1]), setup_vertex(w, v[2]));
}

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

/// Two triangles that may be a rectangle. False: they are not; nothing has been set up.
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

/// Sets up what has gone through the clipper: by pairs if it comes out even. `another`: a triangle that does not fit
/// comes next.
void flush_clipped(PrimitiveWork& w, bool another) {
  const std::span<const ClippedTriangle> triangles = w.clipped.triangles();
  const bool even = triangles.size() % 2 == 0;
  const std::uint32_t id = w.setup.id;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const TriangleCorners& v = triangles[i].v;
    w.setup.id = triangles[i].id;
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
  if (!triangles.empty()) w.clipped.clear(another);
}

/// One triangle that went through the clipper or needs the slow path anyway.
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
  w.clipped.add({{v[0], v[1], v[2]}, w.setup.id});
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

/// Sets up the triangles that wait: before any other primitive, which comes behind them.
void flush_batch(PrimitiveWork& w) {
  if (w.batch.count != 0) setup_triangles(w.setup, w.batch);
}

void add_to_batch(PrimitiveWork& w, const std::uint32_t slot[3]) {
  const VertexScratch& s = w.vertices;
  TriangleBatch& batch = w.batch;
  const std::uint32_t at = batch.count++;
  for (int c = 0; c < 3; ++c) {
    batch.x[c][at] = s.snapped[slot[c] * 2];
    batch.y[c][at] = s.snapped[slot[c] * 2 + 1];
    batch.record[c][at] = s.records + std::size_t{slot[c]} * w.plan.vertex_stride;
  }
  batch.id[at] = w.setup.id;
  if (batch.count == TriangleBatch::kSize) setup_triangles(w.setup, batch);
}

void process_triangle(PrimitiveWork& w, const std::uint32_t slot[3]) {
  const VertexScratch& s = w.vertices;
  const ClipCode c0 = s.code[slot[0]], c1 = s.code[slot[1]], c2 = s.code[slot[2]];
  if ((c0 & c1 & c2) != 0) return discard(w, PrimitiveFate::kOutside);
  if (w.batches && !w.clips_segment && (c0 | c1 | c2) == 0) return add_to_batch(w, slot);
  flush_batch(w);
  if (w.plan.out.cull_count && culled_by_distance(w, slot, 3)) return discard(w, PrimitiveFate::kCulledByDistance);
  const std::uint32_t provoking = provoking_corner(3, w.plan.state->provoking_vertex_last);
  choose_layer_and_viewport(w, slot[provoking]);
  const bool simple = !w.waiting && (c0 | c1 | c2) == 0 && !w.plan.per_vertex_viewport && !w.plan.bias_in_vertices &&
                      w.plan.out.cull_count == 0 && !w.clips_segment;
  if (simple) {
    const auto corner = [&](std::uint32_t i) {
      return SetupVertex{s.records + std::size_t{i} * w.plan.vertex_stride, s.snapped[i * 2], s.snapped[i * 2 + 1]};
    };
    setup_triangle(w.setup, corner(slot[0]), corner(slot[1]), corner(slot[2]));
    return;
  }
  w.stipple_counter = 0;
  if ((c0 | c1 | c2) == 0) {
    const Vertex* v[3];
    for (int i = 0; i < 3; ++i) v[i] = window_record(w, clip_vertex(w, slot[i]));
    const bool outline[3] = {true, true, true};
    emit_slow(w, v, outline);
    return;
  }
  ClipPolygon polygon;
  polygon.count = 3;
  for (int i = 0; i < 3; ++i) polygon.corner[i] = clip_vertex(w, slot[i]);
  emit_clipped(w, provoking, polygon);
}

void process_line(PrimitiveWork& w, const std::uint32_t slot[2]) {
  const ClipCode c0 = w.vertices.code[slot[0]], c1 = w.vertices.code[slot[1]];
  if ((c0 & c1) != 0) return discard(w, PrimitiveFate::kOutside);
  if (w.plan.out.cull_count && culled_by_distance(w, slot, 2)) return discard(w, PrimitiveFate::kCulledByDistance);
  const std::uint32_t provoking = provoking_corner(2, w.plan.state->provoking_vertex_last);
  choose_layer_and_viewport(w, slot[provoking]);
  ClipVertex line[2] = {clip_vertex(w, slot[0]), clip_vertex(w, slot[1])};
  const ClipContext context{&w.plan, &w.viewport, &w.arena, w.plan.guard_band};
  if ((c0 | c1) != 0) {
    if (!clip_line(context, provoking, line)) return discard(w, PrimitiveFate::kOutside);
    w.setup.tell(PrimitiveFate::kClipped);
  }
  emit_line(w, window_record(w, line[0]), window_record(w, line[1]), true);
}

/// A point that the reference keeps (deviations.md, point-clipping).
void process_outside_point(PrimitiveWork& w, const ClipVertex& v) {
  if (v.clip[3] <= 0 || !std::isfinite(v.clip[0]) || !std::isfinite(v.clip[1]))
    return w.setup.tell(PrimitiveFate::kOutside);
  if (w.plan.fused_transform && !w.plan.per_vertex_viewport) return emit_point(w, v.record, true);
  Vertex* copy = copy_record(w.plan, w.arena, v.record);
  std::copy_n(v.clip, 4, copy);
  emit_point(w, copy, true);
}

/// Vulkan 1.3.239, Primitive Clipping: "If the primitive under consideration is a point, then clipping passes it
/// unchanged if it lies within the clip volume; otherwise, it is discarded." (The reference keeps those outside in x
/// and y: deviation point-clipping. Behind a tessellation or geometry shader it forgets to transform them.)
void process_point(PrimitiveWork& w, std::uint32_t slot) {
  const ClipCode code = w.vertices.code[slot];
  if ((code & ~kClipXY) != 0) return w.setup.tell(PrimitiveFate::kOutside);
  const ClipVertex v = clip_vertex(w, slot);
  if (w.plan.out.cull_count && culled_by_distance(w, &slot, 1)) return w.setup.tell(PrimitiveFate::kCulledByDistance);
  // Clipping primitives: the reference's count, and any is allowed for what is outside.
  w.chunk.draw->call.queries.count(Statistic::kClippingPrimitives, 1);
  if (code != 0 && !w.plan.as_reference.keeps_outside_points) return w.setup.tell(PrimitiveFate::kOutside);
  choose_layer_and_viewport(w, slot);
  if (code != 0) return process_outside_point(w, v);
  emit_point(w, window_record(w, v), true);
}

/// 10.1: a fan of four vertices that lies inside the view volume and has no flat values is set up from its centre on,
/// whatever vertex is the provoking one; that tells only in the last bits of what is interpolated.
bool starts_at_center(const PrimitiveWork& w, const Run& run, const std::uint16_t* slot) {
  const PipelinePlan& plan = w.plan;
  if (plan.state->topology != VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN || run.end - run.begin != 2 || !run.ends) return false;
  if (run.begin != 0 || w.chunk.draw->call.index_data || plan.flat_count != 0) return false;
  if (plan.bias_in_vertices || plan.out.cull_count != 0 || plan.per_vertex_viewport) return false;
  for (int i = 0; i < 4; ++i) {
    if (w.vertices.code[slot[i]] != 0) return false;
    if (plan.out.layer != kNoReg && w.vertices.layer[slot[i]] != w.vertices.layer[slot[0]]) return false;
  }
  return true;
}

void process_primitive(PrimitiveWork& w, std::uint32_t corners, const std::uint32_t* slot) {
  if (corners == 3)
    process_triangle(w, slot);
  else if (corners == 2)
    process_line(w, slot);
  else
    process_point(w, slot[0]);
}

/// deviations.md, nine-vertices: of three triangles, the last of which lies in a row, nothing is drawn unless the
/// others are this rectangle.
bool vanishes(const PrimitiveWork& w, const Run& run, const std::uint16_t* slots) {
  if (run.begin != 0 || run.end != 3 || !run.ends || w.chunk.draw->call.index_data) return false;
  const Vertex* v[9];
  for (int i = 0; i < 9; ++i) {
    if (w.vertices.code[slots[i]] != 0) return false;
    v[i] = w.vertices.records + std::size_t{slots[i]} * w.plan.vertex_stride;
  }
  if (v[6][1] != v[7][1] || v[6][1] != v[8][1]) return false;
  const auto same = [&](int word, int a, int b, int c) { return v[a][word] == v[b][word] && v[a][word] == v[c][word]; };
  return !(same(0, 0, 1, 5) && same(0, 2, 3, 4) && same(1, 0, 3, 5) && same(1, 1, 2, 4));
}

/// The most frequent topology, without tables.
void process_triangle_list(PrimitiveWork& w, const Run& run, std::uint32_t first_entry) {
  const std::uint16_t* corner = w.vertices.slot.data() + first_entry;
  for (std::uint32_t i = run.begin; i < run.end; ++i, corner += 3) {
    const std::uint32_t slot[3] = {corner[0], corner[1], corner[2]};
    w.setup.id = run.first_id + i;
    process_triangle(w, slot);
  }
}

void process_run(PrimitiveWork& w, const Run& run, const RunSpan& span, std::uint32_t first_entry) {
  const State& state = *w.plan.state;
  const TopologyShape& shape = w.plan.shape;
  const std::uint16_t* slots = w.vertices.slot.data() + first_entry;
  const bool last = state.provoking_vertex_last || starts_at_center(w, run, slots);
  for (std::uint32_t i = run.begin; i < run.end; ++i) {
    const Corners corners = corners_of(state.topology, last, i);
    std::uint32_t slot[3];
    for (std::uint32_t c = 0; c < shape.corners; ++c) slot[c] = slots[span.entry(corners.at[c])];
    w.setup.id = run.first_id + i;
    // Strips go on with the pattern.
    if (i == 0 || shape.step > 1 || w.plan.as_reference.stipples_lines) w.stipple_counter = 0;
    process_primitive(w, shape.corners, slot);
  }
}

void process_any_run(PrimitiveWork& w, const Run& run, const RunSpan& span, std::uint32_t first_entry) {
  if (w.plan.as_reference.nine_vertices && vanishes(w, run, w.vertices.slot.data() + first_entry)) return;
  if (w.plan.state->topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST)
    process_triangle_list(w, run, first_entry);
  else
    process_run(w, run, span, first_entry);
}

/// How many triangles of a run that needs no clipping are looked at two by two, and how many the next pair is on.
struct Pairing {
  bool any = false;
  std::uint32_t missed = 2;  ///< triangles by which the next pair is on if one was none
};

Pairing pairing_of(const PrimitiveWork& w, const Run& run) {
  const std::uint32_t count = run.end - run.begin;
  const bool indexed = w.chunk.draw->call.index_data != nullptr;
  switch (w.plan.state->topology) {
    case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST:
      return {count % 2 == 0, 2};
    case VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP:
      return {!indexed && !w.plan.state->provoking_vertex_last, 1};
    default:
      return {!indexed && count == 2 && run.begin == 0 && run.ends, 2};
  }
}

/// A run of a draw whose triangles may form rectangles.
void process_segment(PrimitiveWork& w, const Run& run, const RunSpan& span, std::uint32_t first_entry) {
  const std::uint16_t* slots = w.vertices.slot.data() + first_entry;
  w.clips_segment = w.plan.out.cull_count != 0 || std::any_of(slots, slots + span.count(), [&](std::uint16_t slot) {
                      return w.vertices.code[slot] != 0;
                    });
  if (w.clips_segment) {
    w.clipped.begin_segment();
    return process_any_run(w, run, span, first_entry);
  }
  flush_clipped(w, false);
  const Pairing pairing = pairing_of(w, run);
  if (!pairing.any) return process_any_run(w, run, span, first_entry);
  flush_batch(w);
  const bool last = w.plan.state->provoking_vertex_last || starts_at_center(w, run, slots);
  const auto corner = [&](std::uint32_t i, std::uint32_t c) -> const Vertex* {
    const std::uint32_t position = corners_of(w.plan.state->topology, last, i).at[c];
    return w.vertices.records + std::size_t{slots[span.entry(position)]} * w.plan.vertex_stride;
  };
  for (std::uint32_t i = run.begin; i < run.end;) {
    const TriangleCorners first = {corner(i, 0), corner(i, 1), corner(i, 2)};
    w.setup.id = run.first_id + i;
    if (i + 1 == run.end) return emit_filled(w, first.data());
    const PairCorners v = {first[0], first[1], first[2], corner(i + 1, 0), corner(i + 1, 1), corner(i + 1, 2)};
    const bool paired = emit_pair(w, v);
    if (!paired) emit_filled(w, first.data());
    if (!paired && pairing.missed == 2) emit_filled(w, v.data() + 3);
    i += paired ? 2 : pairing.missed;
  }
}

/// Both faces are culled.
void tell_invisible(PrimitiveWork& w) {
  if (!w.setup.watch) return;
  for (std::uint32_t r = 0; r < w.chunk.run_count; ++r) {
    const Run& run = w.chunk.runs[r];
    for (std::uint32_t i = run.begin; i < run.end; ++i)
      w.setup.watch->primitive(run.first_id + i, PrimitiveFate::kFacing);
  }
}

}  // namespace

ClippedEnds process_primitives(const PrimitiveContext& context) {
  PrimitiveWork w(context);
  ClippedEnds ends;
  const Chunk& chunk = w.chunk;
  const TopologyShape& shape = w.plan.shape;
  std::uint32_t first_entry = 0, expected = 0;
  for (std::uint32_t r = 0; r < chunk.run_count; ++r) expected += chunk.runs[r].end - chunk.runs[r].begin;
  if (w.plan.state->cull_mode == VK_CULL_MODE_FRONT_AND_BACK && shape.corners == 3) {
    tell_invisible(w);
    count_behind_clipper(w, expected);
    return ends;
  }
  if (chunk.stipple_counter) w.stipple_counter = *chunk.stipple_counter;
  const auto slots = w.vertices.slot.begin();
  choose_view_layer(w, std::any_of(slots, slots + positions_of(chunk),
                                   [&](std::uint16_t slot) { return w.vertices.code[slot] != 0; }));
  w.primitives.reserve(expected);
  for (std::uint32_t r = 0; r < chunk.run_count; ++r) {
    const RunSpan span = run_span(shape, chunk.runs[r]);
    if (w.plan.rectangles.any)
      process_segment(w, chunk.runs[r], span, first_entry);
    else
      process_any_run(w, chunk.runs[r], span, first_entry);
    first_entry += span.count();
    ends.last = w.clips_segment;
    if (r == 0) ends.first = ends.last;
  }
  flush_batch(w);
  if (chunk.ends_batch) flush_clipped(w, false);
  if (chunk.stipple_counter) *chunk.stipple_counter = w.stipple_counter;
  count_behind_clipper(w, expected);
  return ends;
}

void process_listed(const PrimitiveContext& context, std::span<const ListedPrimitive> listed) {
  PrimitiveWork w(context);
  if (w.setup.watch) w.setup.watch->emitted(listed.size());
  const bool invisible = w.plan.state->cull_mode == VK_CULL_MODE_FRONT_AND_BACK && w.plan.corners == 3;
  choose_view_layer(w, std::any_of(listed.begin(), listed.end(), [&](const ListedPrimitive& primitive) {
                      return (w.vertices.code[primitive.slot[0]] | w.vertices.code[primitive.slot[1]] |
                              w.vertices.code[primitive.slot[2]]) != 0;
                    }));
  for (const ListedPrimitive& primitive : listed) {
    w.setup.id = primitive.id;
    if (invisible) {
      w.setup.tell(PrimitiveFate::kFacing);
      continue;
    }
    if (!primitive.continues) w.stipple_counter = 0;
    process_primitive(w, w.plan.corners, primitive.slot);
  }
  flush_batch(w);
  w.chunk.draw->call.queries.count(Statistic::kClippingInvocations, listed.size());
  count_behind_clipper(w, listed.size());
}

}  // namespace vitrine::raster

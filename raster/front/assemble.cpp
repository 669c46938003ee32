// The front end's primitive half: cull distances, clipping, culling, polygon modes, hand-over to setup
// (lavapipe-rasterization.md 1.4 to 1.7, 2.2, 7.1, 10.2).
#include "raster/front/assemble.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/numeric.h"
#include "raster/front/assembly.h"
#include "raster/front/clip.h"
#include "raster/front/setup_batch.h"
#include "raster/front/setup_wide.h"

namespace vitrine::raster {
namespace {

struct Assembler : AssembleContext {
  const PipelinePlan& plan;
  SetupContext setup;
  ViewportTransform viewport;
  bool batches;                       ///< triangles inside the view volume need nothing but setup
  std::uint32_t stipple_counter = 0;  ///< pixels of the pattern used up by earlier lines of the strip
  TriangleBatch batch;

  explicit Assembler(const AssembleContext& context)
      : AssembleContext(context),
        plan(*chunk.draw->plan),
        setup{&plan, &pass, &primitives, !chunk.draw->call.queries.statistics},
        viewport(plan.viewport[0]),
        batches(plan.windows && plan.out.layer == kNoReg && !plan.per_vertex_viewport && !plan.bias_in_vertices &&
                plan.out.cull_count == 0) {
    setup.layer = static_cast<std::uint16_t>(chunk.view);
  }
};

ClipVertex clip_vertex(const Assembler& a, std::uint32_t slot) {
  ClipVertex v;
  std::memcpy(v.clip, &a.vertices.clip[slot * 4], sizeof(v.clip));
  std::memcpy(v.distance, &a.vertices.clip_distance[slot * kMaxClipDistances], sizeof(v.distance));
  v.record = a.vertices.records + std::size_t{slot} * a.plan.vertex_stride;
  v.code = a.vertices.code[slot];
  return v;
}

/// 1.7: dropped if all corners are outside of one cull distance.
bool culled_by_distance(const Assembler& a, const std::uint32_t* slot, std::uint32_t corners) {
  for (std::uint32_t d = 0; d < a.plan.out.cull_count; ++d) {
    bool all = true;
    for (std::uint32_t c = 0; c < corners; ++c) {
      const float value = a.vertices.cull_distance[slot[c] * kMaxClipDistances + d];
      all &= !(value >= 0) || !std::isfinite(value);
    }
    if (all) return true;
  }
  return false;
}

/// 3.4: layer and viewport from the provoking vertex.
void choose_layer_and_viewport(Assembler& a, std::uint32_t provoking_slot) {
  a.setup.layer = static_cast<std::uint16_t>(a.chunk.view);
  if (a.plan.out.layer != kNoReg) {
    const std::uint32_t layer = a.vertices.layer[provoking_slot] + a.chunk.view;
    a.setup.layer = static_cast<std::uint16_t>(std::min(layer, std::max<std::uint32_t>(a.pass.layers, 1) - 1));
  }
  if (!a.plan.per_vertex_viewport) return;
  const std::uint32_t index = a.vertices.viewport_index[provoking_slot];
  a.setup.viewport = index < kMaxViewports ? static_cast<std::uint8_t>(index) : std::uint8_t{0};
  a.viewport = a.plan.viewport[a.setup.viewport];
}

/// A record transformed by the primitive's own viewport (1.2 form B), when the viewport is chosen per primitive.
const Vertex* window_record(const Assembler& a, const ClipVertex& v) {
  if (!a.plan.per_vertex_viewport || v.code != 0) return v.record;
  Vertex* copy = a.arena.take<Vertex>(a.plan.vertex_stride);
  std::memcpy(copy, v.record, a.plan.vertex_stride * sizeof(Vertex));
  transform_vertex(v.clip, a.viewport, copy);
  return copy;
}

SetupVertex setup_vertex(const Assembler& a, const Vertex* record) {
  return {record, snap_coordinate(record[0], a.plan.pixel_offset), snap_coordinate(record[1], a.plan.pixel_offset)};
}

Vertex* biased_copy(const Assembler& a, const Vertex* record, float offset) {
  Vertex* copy = a.arena.take<Vertex>(a.plan.vertex_stride);
  std::memcpy(copy, record, a.plan.vertex_stride * sizeof(Vertex));
  const float z = copy[2] + offset;
  copy[2] = z > 0 ? (z > 1 ? 1 : z) : 0;  // NaN: 0
  return copy;
}

/// A vertex on the way from one to the other, in window space and without perspective; flat values as in the first.
const Vertex* between(const Assembler& a, const Vertex* from, const Vertex* to, float t) {
  Vertex* made = a.arena.take<Vertex>(a.plan.vertex_stride);
  const std::uint32_t smooth = 4 + a.plan.perspective_count + a.plan.linear_count;
  for (std::uint32_t i = 0; i < smooth; ++i) made[i] = from[i] + t * (to[i] - from[i]);
  std::memcpy(made + smooth, from + smooth, (a.plan.vertex_stride - smooth) * sizeof(Vertex));
  return made;
}

/// Length in units of the pattern (6.4): Euclidean, of Bresenham lines along the major axis.
float stipple_length(const State& state, const Vertex* v0, const Vertex* v1) {
  const float dx = v1[0] - v0[0], dy = v1[1] - v0[1];
  if (state.line_mode != VK_LINE_RASTERIZATION_MODE_BRESENHAM_EXT) return std::sqrt(dx * dx + dy * dy);
  return base::max_second(std::fabs(dx), std::fabs(dy));
}

void emit_segment(const Assembler& a, const Vertex* v0, const Vertex* v1, bool front) {
  if (a.plan.smooth_lines)
    setup_smooth_line(a.setup, a.arena, v0, v1, front);
  else
    setup_line(a.setup, v0, v1, front);
}

/// A line in window space: as a whole, or the stretches where the stipple pattern has ones.
void emit_line(Assembler& a, const Vertex* v0, const Vertex* v1, bool front) {
  const State& state = *a.plan.state;
  if (!state.line_stipple && !a.plan.smooth_lines) return setup_line(a.setup, v0, v1, front);
  const Vertex* provoking = state.provoking_vertex_last ? v1 : v0;
  v0 = with_flat_values(a.plan, a.arena, v0, provoking);
  v1 = with_flat_values(a.plan, a.arena, v1, provoking);
  if (!state.line_stipple) return emit_segment(a, v0, v1, front);
  const float length = stipple_length(state, v0, v1);
  if (!std::isfinite(length)) return;
  const auto pixels = static_cast<std::uint32_t>(std::ceil(length));
  const auto segment = [&](float t0, float t1) {
    emit_segment(a, t0 > 0 ? between(a, v0, v1, t0) : v0, t1 < 1 ? between(a, v0, v1, t1) : v1, front);
  };
  const std::uint32_t factor = std::max<std::uint32_t>(state.line_stipple_factor, 1);
  bool drawing = false;
  float start = 0;
  for (std::uint32_t i = 0; i < pixels; ++i) {
    const std::uint32_t bit = (a.stipple_counter + i) / factor & 15;
    const bool on = (state.line_stipple_pattern >> bit & 1) != 0;
    if (on == drawing) continue;
    if (drawing)
      segment(start / length, static_cast<float>(i) / length);
    else
      start = static_cast<float>(i);
    drawing = on;
  }
  if (drawing && start < length) segment(start / length, 1.0f);
  a.stipple_counter += pixels;
}

/// 10.2: the outline or the corners of one triangle after clipping. edge[i]: of the edge that starts at corner i.
void emit_unfilled(Assembler& a, const Vertex* const in[3], const bool edge[3], float determinant) {
  const State& state = *a.plan.state;
  const Vertex* v[3] = {in[0], in[1], in[2]};
  if (a.plan.depth_bias) {
    const float offset = vertex_depth_bias(a.plan, a.pass, v[0], v[1], v[2]);
    for (const Vertex*& corner : v) corner = biased_copy(a, corner, offset);
  }
  const Vertex* provoking = v[provoking_corner(3, state.provoking_vertex_last)];
  for (const Vertex*& corner : v) corner = with_flat_values(a.plan, a.arena, corner, provoking);
  const bool ccw = state.front_face == VK_FRONT_FACE_COUNTER_CLOCKWISE;
  const bool front = ccw ? determinant < 0 : determinant > 0;
  if (state.polygon_mode == VK_POLYGON_MODE_POINT) {
    for (int i = 0; i < 3; ++i)
      if (edge[i]) setup_point(a.setup, v[i], front);
    return;
  }
  if (edge[2]) emit_line(a, v[2], v[0], front);
  if (edge[0]) emit_line(a, v[0], v[1], front);
  if (edge[1]) emit_line(a, v[1], v[2], front);
}

/// One triangle that went through the clipper or needs the slow path anyway.
void emit_slow(Assembler& a, const Vertex* const v[3], const bool edge[3]) {
  const float determinant = window_determinant(v[0], v[1], v[2]);
  if (culled_by_determinant(*a.plan.state, determinant)) return;
  if (a.plan.bias_in_vertices) {
    emit_unfilled(a, v, edge, determinant);
    return;
  }
  setup_triangle(a.setup, setup_vertex(a, v[0]), setup_vertex(a, v[1]), setup_vertex(a, v[2]));
}

void emit_clipped(Assembler& a, std::uint32_t provoking, ClipPolygon& polygon) {
  const ClipContext context{&a.plan, &a.viewport, &a.arena, a.plan.state->polygon_mode == VK_POLYGON_MODE_POINT};
  if (!clip_triangle(context, provoking, polygon)) return;
  const Vertex* record[kMaxPolygon];
  for (std::uint32_t i = 0; i < polygon.count; ++i) record[i] = window_record(a, polygon.corner[i]);
  const bool last_mode = a.plan.state->provoking_vertex_last;
  for (std::uint32_t i = 2; i < polygon.count; ++i) {
    // Fan (p0, p[i-1], p[i]); edges inside the polygon are not part of the outline.
    const bool from_p0 = i == 2 && polygon.corner[0].edge;
    const bool between = polygon.corner[i - 1].edge;
    const bool to_p0 = i == polygon.count - 1 && polygon.corner[i].edge;
    if (last_mode) {
      const Vertex* v[3] = {record[i - 1], record[i], record[0]};
      const bool edge[3] = {between, to_p0, from_p0};
      emit_slow(a, v, edge);
    } else {
      const Vertex* v[3] = {record[0], record[i - 1], record[i]};
      const bool edge[3] = {from_p0, between, to_p0};
      emit_slow(a, v, edge);
    }
  }
}

/// Sets up the triangles that wait: before any other primitive, which comes behind them.
void flush_batch(Assembler& a) {
  if (a.batch.count != 0) setup_triangles(a.setup, a.batch);
}

void add_to_batch(Assembler& a, const std::uint32_t slot[3]) {
  const VertexScratch& s = a.vertices;
  TriangleBatch& batch = a.batch;
  const std::uint32_t at = batch.count++;
  for (int c = 0; c < 3; ++c) {
    batch.x[c][at] = s.snapped[slot[c] * 2];
    batch.y[c][at] = s.snapped[slot[c] * 2 + 1];
    batch.record[c][at] = s.records + std::size_t{slot[c]} * a.plan.vertex_stride;
  }
  batch.id[at] = a.setup.id;
  if (batch.count == TriangleBatch::kSize) setup_triangles(a.setup, batch);
}

void assemble_triangle(Assembler& a, const std::uint32_t slot[3]) {
  const VertexScratch& s = a.vertices;
  const ClipCode c0 = s.code[slot[0]], c1 = s.code[slot[1]], c2 = s.code[slot[2]];
  if ((c0 & c1 & c2) != 0) return;
  if (a.batches && (c0 | c1 | c2) == 0) return add_to_batch(a, slot);
  flush_batch(a);
  if (a.plan.out.cull_count && culled_by_distance(a, slot, 3)) return;
  const std::uint32_t provoking = provoking_corner(3, a.plan.state->provoking_vertex_last);
  choose_layer_and_viewport(a, slot[provoking]);
  const bool simple =
      (c0 | c1 | c2) == 0 && !a.plan.per_vertex_viewport && !a.plan.bias_in_vertices && a.plan.out.cull_count == 0;
  if (simple) {
    const auto corner = [&](std::uint32_t i) {
      return SetupVertex{s.records + std::size_t{i} * a.plan.vertex_stride, s.snapped[i * 2], s.snapped[i * 2 + 1]};
    };
    setup_triangle(a.setup, corner(slot[0]), corner(slot[1]), corner(slot[2]));
    return;
  }
  a.stipple_counter = 0;
  if ((c0 | c1 | c2) == 0) {
    const Vertex* v[3];
    for (int i = 0; i < 3; ++i) v[i] = window_record(a, clip_vertex(a, slot[i]));
    const bool outline[3] = {true, true, true};
    emit_slow(a, v, outline);
    return;
  }
  ClipPolygon polygon;
  polygon.count = 3;
  for (int i = 0; i < 3; ++i) polygon.corner[i] = clip_vertex(a, slot[i]);
  emit_clipped(a, provoking, polygon);
}

void assemble_line(Assembler& a, const std::uint32_t slot[2]) {
  const ClipCode c0 = a.vertices.code[slot[0]], c1 = a.vertices.code[slot[1]];
  if ((c0 & c1) != 0) return;
  if (a.plan.out.cull_count && culled_by_distance(a, slot, 2)) return;
  const std::uint32_t provoking = provoking_corner(2, a.plan.state->provoking_vertex_last);
  choose_layer_and_viewport(a, slot[provoking]);
  ClipVertex line[2] = {clip_vertex(a, slot[0]), clip_vertex(a, slot[1])};
  const ClipContext context{&a.plan, &a.viewport, &a.arena, false};
  if ((c0 | c1) != 0 && !clip_line(context, provoking, line)) return;
  emit_line(a, window_record(a, line[0]), window_record(a, line[1]), true);
}

/// Vulkan 1.3.239, Primitive Clipping: "If the primitive under consideration is a point, then clipping passes it
/// unchanged if it lies within the clip volume; otherwise, it is discarded." (The reference keeps those outside in x
/// and y: deviation point-clipping.)
void assemble_point(Assembler& a, std::uint32_t slot) {
  const ClipCode code = a.vertices.code[slot];
  if ((code & ~kClipXY) != 0) return;
  const ClipVertex v = clip_vertex(a, slot);
  if (a.plan.out.cull_count && culled_by_distance(a, &slot, 1)) return;
  // Clipping primitives: the reference's count, and any is allowed for what is outside.
  a.chunk.draw->call.queries.count(Statistic::kClippingPrimitives, 1);
  if (code != 0) return;
  choose_layer_and_viewport(a, slot);
  setup_point(a.setup, window_record(a, v), true);
}

/// 10.1: a fan of four vertices that lies inside the view volume and has no flat values is set up from its centre on,
/// whatever vertex is the provoking one; that tells only in the last bits of what is interpolated.
bool starts_at_center(const Assembler& a, const Run& run, const std::uint16_t* slot) {
  const PipelinePlan& plan = a.plan;
  if (plan.state->topology != VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN || run.end - run.begin != 2 || !run.ends) return false;
  if (run.begin != 0 || a.chunk.draw->call.index_data || plan.flat_count != 0) return false;
  if (plan.bias_in_vertices || plan.out.cull_count != 0 || plan.per_vertex_viewport) return false;
  for (int i = 0; i < 4; ++i) {
    if (a.vertices.code[slot[i]] != 0) return false;
    if (plan.out.layer != kNoReg && a.vertices.layer[slot[i]] != a.vertices.layer[slot[0]]) return false;
  }
  return true;
}

void assemble_primitive(Assembler& a, std::uint32_t corners, const std::uint32_t* slot) {
  if (corners == 3)
    assemble_triangle(a, slot);
  else if (corners == 2)
    assemble_line(a, slot);
  else
    assemble_point(a, slot[0]);
}

/// The most frequent topology, without tables.
void assemble_triangle_list(Assembler& a, const Run& run, std::uint32_t first_entry) {
  const std::uint16_t* corner = a.vertices.slot.data() + first_entry;
  for (std::uint32_t i = run.begin; i < run.end; ++i, corner += 3) {
    const std::uint32_t slot[3] = {corner[0], corner[1], corner[2]};
    a.setup.id = run.first_id + i;
    assemble_triangle(a, slot);
  }
}

void assemble_run(Assembler& a, const Run& run, const RunSpan& span, std::uint32_t first_entry) {
  const State& state = *a.plan.state;
  const TopologyShape& shape = a.plan.shape;
  const std::uint16_t* slots = a.vertices.slot.data() + first_entry;
  const bool last = state.provoking_vertex_last || starts_at_center(a, run, slots);
  for (std::uint32_t i = run.begin; i < run.end; ++i) {
    const Corners corners = corners_of(state.topology, last, i);
    std::uint32_t slot[3];
    for (std::uint32_t c = 0; c < shape.corners; ++c) slot[c] = slots[span.entry(corners.at[c])];
    a.setup.id = run.first_id + i;
    if (i == 0 || shape.step > 1) a.stipple_counter = 0;  // strips go on with the pattern
    assemble_primitive(a, shape.corners, slot);
  }
}

}  // namespace

void assemble_chunk(const AssembleContext& context) {
  Assembler a(context);
  const Chunk& chunk = a.chunk;
  const TopologyShape& shape = a.plan.shape;
  if (a.plan.state->cull_mode == VK_CULL_MODE_FRONT_AND_BACK && shape.corners == 3) return;
  if (chunk.stipple_counter) a.stipple_counter = *chunk.stipple_counter;
  std::uint32_t first_entry = 0, expected = 0;
  for (std::uint32_t r = 0; r < chunk.run_count; ++r) expected += chunk.runs[r].end - chunk.runs[r].begin;
  a.primitives.reserve(expected);
  for (std::uint32_t r = 0; r < chunk.run_count; ++r) {
    const RunSpan span = run_span(shape, chunk.runs[r]);
    if (a.plan.state->topology == VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST)
      assemble_triangle_list(a, chunk.runs[r], first_entry);
    else
      assemble_run(a, chunk.runs[r], span, first_entry);
    first_entry += span.count();
  }
  flush_batch(a);
  if (chunk.stipple_counter) *chunk.stipple_counter = a.stipple_counter;
  if (!a.plan.draws_points) chunk.draw->call.queries.count(Statistic::kClippingPrimitives, a.primitives.size());
}

void assemble_listed(const AssembleContext& context, std::span<const ListedPrimitive> listed) {
  Assembler a(context);
  const std::uint32_t before = a.primitives.size();
  const bool invisible = a.plan.state->cull_mode == VK_CULL_MODE_FRONT_AND_BACK && a.plan.corners == 3;
  for (const ListedPrimitive& primitive : listed) {
    if (invisible) break;
    a.setup.id = primitive.id;
    if (!primitive.continues) a.stipple_counter = 0;
    assemble_primitive(a, a.plan.corners, primitive.slot);
  }
  flush_batch(a);
  const QueryCounters& queries = a.chunk.draw->call.queries;
  queries.count(Statistic::kClippingInvocations, listed.size());
  if (!a.plan.draws_points) queries.count(Statistic::kClippingPrimitives, a.primitives.size() - before);
}

}  // namespace vitrine::raster

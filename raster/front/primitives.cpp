// The front end's second half: the primitives of a chunk in their order.
#include "raster/front/primitives.h"

#include <algorithm>

#include "raster/front/assembly.h"
#include "raster/front/primitive_work.h"

namespace vitrine::raster {
namespace {

/// Sets up the triangles that wait: before any other primitive, which comes behind them.
void flush_batch(PrimitiveWork& w) {
  if (w.batch.count != 0) setup_triangles(w.setup, w.batch);
}

/// What comes from here on is of an instance. What waits is set up before, if it is told apart.
void begin_instance(PrimitiveWork& w, std::uint32_t instance) {
  w.instance = instance;
  if (!w.primitives.has_marks()) return;
  flush_batch(w);
  w.primitives.mark(instance);
  w.setup.instance = index_of_instance(w, instance);
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
  number_corners(w, slot, 3);
  const bool simple = !w.waiting && (c0 | c1 | c2) == 0 && !w.plan.per_vertex_viewport && !w.plan.bias_in_vertices &&
                      w.plan.out.cull_count == 0 && !w.clips_segment;
  if (simple) {
    const auto corner = [&](std::uint32_t c) {
      return SetupVertex{record_of(w, slot[c], c), s.snapped[slot[c] * 2], s.snapped[slot[c] * 2 + 1]};
    };
    setup_triangle(w.setup, corner(0), corner(1), corner(2));
    return;
  }
  w.stipple_counter = 0;
  if ((c0 | c1 | c2) == 0) {
    const Vertex* v[3];
    for (int i = 0; i < 3; ++i) v[i] = window_record(w, clip_vertex(w, slot[i], static_cast<std::uint32_t>(i)));
    const bool outline[3] = {true, true, true};
    emit_slow(w, v, outline);
    return;
  }
  ClipPolygon polygon;
  polygon.count = 3;
  for (int i = 0; i < 3; ++i) polygon.corner[i] = clip_vertex(w, slot[i], static_cast<std::uint32_t>(i));
  emit_clipped(w, provoking, polygon);
}

void process_primitive(PrimitiveWork& w, std::uint32_t corners, const std::uint32_t* slot) {
  if (corners == 3)
    process_triangle(w, slot);
  else if (corners == 2)
    process_line(w, slot);
  else
    process_point(w, slot[0]);
}

/// 10.1: a fan of four vertices that lies inside the view volume and has no flat values is set up from its centre on,
/// whatever vertex is the provoking one; that tells only in the last bits of what is interpolated.
bool starts_at_center(const PrimitiveWork& w, const Run& run, const std::uint16_t* slot) {
  const PipelinePlan& plan = w.plan;
  if (plan.state->topology != VK_PRIMITIVE_TOPOLOGY_TRIANGLE_FAN || run.end - run.begin != 2 || !run.ends) return false;
  if (run.begin != 0 || w.chunk.draw->call.index_data || plan.flat_count != 0 || plan.numbers_corners) return false;
  if (plan.bias_in_vertices || plan.out.cull_count != 0 || plan.per_vertex_viewport) return false;
  if (plan.out.shading_rate != kNoReg) return false;
  for (int i = 0; i < 4; ++i) {
    if (w.vertices.code[slot[i]] != 0) return false;
    if (plan.out.layer != kNoReg && w.vertices.layer[slot[i]] != w.vertices.layer[slot[0]]) return false;
  }
  return true;
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

/// Triangles [first, first + count) of a list, of which nothing is to be clipped; `slot`: three a triangle.
void add_list_to_batch(PrimitiveWork& w, std::uint32_t first, std::uint32_t count, const std::uint16_t* slot) {
  TriangleBatch& batch = w.batch;
  const std::int32_t* const snapped = w.vertices.snapped.data();
  const Vertex* const records = w.vertices.records;
  const std::size_t stride = w.plan.vertex_stride;
  while (count != 0) {
    const std::uint32_t at = batch.count, some = std::min(TriangleBatch::kSize - at, count);
    for (std::uint32_t c = 0; c < 3; ++c)
      for (std::uint32_t t = 0; t < some; ++t) {
        const std::size_t vertex = slot[3 * t + c];
        batch.x[c][at + t] = snapped[2 * vertex];
        batch.y[c][at + t] = snapped[2 * vertex + 1];
        batch.record[c][at + t] = records + vertex * stride;
      }
    for (std::uint32_t t = 0; t < some; ++t) batch.id[at + t] = first + t;
    batch.count += some;
    if (batch.count == TriangleBatch::kSize) setup_triangles(w.setup, batch);
    first += some;
    count -= some;
    slot += std::size_t{3} * some;
  }
}

/// The most frequent topology, without tables.
void process_triangle_list(PrimitiveWork& w, const Run& run, std::uint32_t first_entry) {
  const std::uint16_t* corner = w.vertices.slot.data() + first_entry;
  if (w.batches && w.inside && !w.clips_segment)
    return add_list_to_batch(w, run.first_id + run.begin, run.end - run.begin, corner);
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

TriangleCorners corners_at(const PrimitiveWork& w, const ListedPrimitive& primitive) {
  const auto at = [&](std::uint32_t slot) { return w.vertices.records + std::size_t{slot} * w.plan.vertex_stride; };
  return {at(primitive.slot[0]), at(primitive.slot[1]), at(primitive.slot[2])};
}

/// Both faces are culled.
void tell_invisible(PrimitiveWork& w) {
  if (!w.setup.watch) return;
  for (std::uint32_t r = 0; r < w.chunk.run_count; ++r) {
    const Run& run = w.chunk.runs[r];
    for (std::uint32_t i = run.begin; i < run.end; ++i)
      w.setup.watch->primitive(run.first_id + i, index_of_instance(w, run.instance), PrimitiveFate::kFacing);
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
  w.inside =
      std::none_of(slots, slots + positions_of(chunk), [&](std::uint16_t slot) { return w.vertices.code[slot] != 0; });
  choose_view_layer(w, !w.inside);
  w.primitives.reserve(expected);
  for (std::uint32_t r = 0; r < chunk.run_count; ++r) {
    const RunSpan span = run_span(shape, chunk.runs[r]);
    begin_instance(w, chunk.runs[r].instance);
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

void process_strips(const PrimitiveContext& context, std::span<const ListedPrimitive> listed, bool clips) {
  PrimitiveWork w(context);
  if (w.setup.watch) w.setup.watch->emitted(listed.size());
  choose_view_layer(w, clips);
  w.clips_segment = clips;
  if (clips)
    w.clipped.begin_segment();
  else
    flush_clipped(w, false);
  const bool invisible = w.plan.state->cull_mode == VK_CULL_MODE_FRONT_AND_BACK;
  const bool pairs = !clips && !invisible && !w.plan.state->provoking_vertex_last;
  if (!listed.empty()) begin_instance(w, listed[0].instance);
  for (std::size_t i = 0; i < listed.size(); ++i) {
    w.setup.id = listed[i].id;
    if (listed[i].instance != w.instance) begin_instance(w, listed[i].instance);
    if (invisible) {
      w.setup.tell(PrimitiveFate::kFacing);
    } else if (!pairs) {
      process_triangle(w, listed[i].slot);
    } else {
      const TriangleCorners v = corners_at(w, listed[i]);
      const bool two = i + 1 < listed.size() && listed[i + 1].continues;
      const TriangleCorners next = corners_at(w, listed[two ? i + 1 : i]);
      if (two && emit_pair(w, {v[0], v[1], v[2], next[0], next[1], next[2]}))
        ++i;
      else
        emit_filled(w, v.data());
    }
  }
  flush_batch(w);
  if (w.chunk.ends_batch) flush_clipped(w, false);
  w.chunk.draw->call.queries.count(Statistic::kClippingInvocations, listed.size());
  count_behind_clipper(w, listed.size());
}

void process_listed(const PrimitiveContext& context, std::span<const ListedPrimitive> listed) {
  PrimitiveWork w(context);
  if (w.setup.watch) w.setup.watch->emitted(listed.size());
  const bool invisible = w.plan.state->cull_mode == VK_CULL_MODE_FRONT_AND_BACK && w.plan.corners == 3;
  choose_view_layer(w, std::any_of(listed.begin(), listed.end(), [&](const ListedPrimitive& primitive) {
                      return (w.vertices.code[primitive.slot[0]] | w.vertices.code[primitive.slot[1]] |
                              w.vertices.code[primitive.slot[2]]) != 0;
                    }));
  if (!listed.empty()) begin_instance(w, listed[0].instance);
  for (const ListedPrimitive& primitive : listed) {
    w.setup.id = primitive.id;
    if (primitive.instance != w.instance) begin_instance(w, primitive.instance);
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

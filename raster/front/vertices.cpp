// From vertex shader outputs to records in window coordinates.
#include "raster/front/vertices.h"

#include <algorithm>
#include <cstring>

#include "raster/front/gather.h"
#include "raster/front/records.h"
#include "raster/front/setup.h"

namespace vitrine::raster {

namespace {

const float* as_floats(const base::WaveRegister& reg) { return reinterpret_cast<const float*>(reg.lane); }

/// One output register into element `component` of an array of `stride` words per vertex; 0 where not written.
template <class T>
void scatter(const WaveOutputs& outputs, std::uint32_t reg, std::uint32_t lanes, T* out, std::uint32_t stride,
             T missing = T{}) {
  static_assert(sizeof(T) == 4);
  if (reg == kNoReg) {
    for (std::uint32_t i = 0; i < lanes; ++i) out[std::size_t{i} * stride] = missing;
    return;
  }
  const std::uint32_t* lane = outputs.at(reg).lane;
  for (std::uint32_t i = 0; i < lanes; ++i) std::memcpy(&out[std::size_t{i} * stride], &lane[i], 4);
}

void scatter_distances(const PipelinePlan& plan, const WaveOutputs& outputs, std::uint32_t base, std::uint32_t lanes,
                       VertexScratch& s) {
  const VertexOutputs& out = plan.out;
  for (std::uint32_t d = 0; d < out.cull_count; ++d)
    scatter(outputs, out.cull_distance[d], lanes, s.cull_distance.data() + base * kMaxClipDistances + d,
            kMaxClipDistances);
  for (std::uint32_t d = 0; d < out.clip_count; ++d) {
    float* distance = s.clip_distance.data() + base * kMaxClipDistances + d;
    scatter(outputs, out.clip_distance[d], lanes, distance, kMaxClipDistances);
    for (std::uint32_t i = 0; i < lanes; ++i) {
      const float value = distance[i * kMaxClipDistances];
      if (!(value >= 0 && value <= 3.402823466e38f)) s.code[base + i] |= 1u << (kFirstUserPlane + d);
    }
  }
}

/// deviations.md, identity-viewport.
void keep_clip_coordinates(const float* const clip[4], std::uint32_t lanes, float pixel_offset, TransformedWave& out) {
  float* const window[4] = {out.x, out.y, out.z, out.w};
  for (int c = 0; c < 4; ++c) std::copy_n(clip[c], lanes, window[c]);
  for (std::uint32_t i = 0; i < lanes; ++i) {
    out.snapped_x[i] = snap_coordinate(out.x[i], pixel_offset);
    out.snapped_y[i] = snap_coordinate(out.y[i], pixel_offset);
  }
}

}  // namespace

void shade_vertex_wave(const DrawRecord& draw, std::uint32_t base, std::uint32_t count, std::uint32_t view,
                       VertexLanes& lanes, VertexScratch& s) {
  if (!(s.bound == draw.vertex)) s.runner.bind(draw.vertex);
  s.bound = draw.vertex;
  lanes.count = count;
  std::copy_n(s.vertex.data() + base, count, lanes.vertex);
  std::copy_n(s.instance.data() + base, count, lanes.instance);
  fetch_vertices(draw, lanes, view, s.runner);
  s.runner.run(base::first_lanes(count), 0);
}

void store_wave(const PipelinePlan& plan, const WaveOutputs& outputs, std::uint32_t base, std::uint32_t lanes,
                VertexScratch& s) {
  static const base::WaveRegister zero{};
  const VertexOutputs& out = plan.out;
  const float* clip[4];
  for (int c = 0; c < 4; ++c) clip[c] = as_floats(out.position[c] == kNoReg ? zero : outputs.at(out.position[c]));
  const State& state = *plan.state;
  transform_wave(clip,
                 {plan.viewport[0], plan.pixel_offset, state.depth_clip, state.negative_one_to_one,
                  plan.fused_transform, plan.guard_band},
                 s.transformed);
  if (!plan.as_reference.divides) keep_clip_coordinates(clip, lanes, plan.pixel_offset, s.transformed);
  const TransformedWave& t = s.transformed;
  const std::uint32_t stride = plan.vertex_stride;
  const auto words = [](auto* memory) { return reinterpret_cast<std::uint32_t*>(memory); };
  const auto lanes_of = [](const float* reg) { return reinterpret_cast<const std::uint32_t*>(reg); };
  std::uint32_t* records = words(s.records + std::size_t{base} * stride);
  const std::uint32_t* from[4] = {lanes_of(clip[0]), lanes_of(clip[1]), lanes_of(clip[2]), lanes_of(clip[3])};
  store_records(from, lanes, words(s.clip.data() + std::size_t{base} * 4), 4);
  const std::uint32_t* window[4] = {lanes_of(t.x), lanes_of(t.y), lanes_of(t.z), lanes_of(t.w)};
  store_records(window, lanes, records, stride);
  // Records are a multiple of four words: the last ones may be nobody's.
  for (std::uint32_t k = 0; k < plan.varying_count(); k += 4) {
    for (std::uint32_t c = 0; c < 4; ++c) {
      const std::uint32_t reg = k + c < plan.varying_count() ? plan.varying[k + c].vertex_reg : kNoReg;
      from[c] = reg == kNoReg ? zero.lane : outputs.at(reg).lane;
    }
    store_records(from, lanes, records + 4 + k, stride);
  }
  std::copy_n(t.code, lanes, s.code.data() + base);
  for (std::uint32_t i = 0; i < lanes; ++i) {
    s.snapped[(base + i) * 2] = t.snapped_x[i];
    s.snapped[(base + i) * 2 + 1] = t.snapped_y[i];
  }
  if (out.clip_count + out.cull_count) scatter_distances(plan, outputs, base, lanes, s);
  if (out.layer != kNoReg) scatter(outputs, out.layer, lanes, s.layer.data() + base, 1);
  if (out.shading_rate != kNoReg) scatter(outputs, out.shading_rate, lanes, s.shading_rate.data() + base, 1);
  if (out.viewport_index != kNoReg) scatter(outputs, out.viewport_index, lanes, s.viewport_index.data() + base, 1);
}

void shade_chunk_vertices(const Chunk& chunk, Arena& arena, VertexScratch& s, CaptureScratch& capture) {
  const DrawRecord& draw = *chunk.draw;
  const PipelinePlan& plan = *draw.plan;
  const std::uint32_t count = gather_vertices(chunk, s);
  s.records = arena.take<Vertex>(std::size_t{count} * plan.vertex_stride);
  VertexLanes lanes;
  for (std::uint32_t base = 0; base < count; base += base::kWaveWidth) {
    shade_vertex_wave(draw, base, std::min<std::uint32_t>(count - base, base::kWaveWidth), chunk.view, lanes, s);
    if (!plan.state->rasterizer_discard) store_wave(plan, {&s.runner, nullptr}, base, lanes.count, s);
    if (capture.active) capture_wave(plan, {&s.runner, nullptr}, base, lanes.count, capture);
  }
  draw.call.queries.count(Statistic::kClippingInvocations, count_assembly(chunk, count));
}

}  // namespace vitrine::raster

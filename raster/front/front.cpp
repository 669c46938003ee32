// The front end's vertex half: index de-duplication, vertex waves, transform, records.
#include "raster/front/front.h"

#include <algorithm>
#include <atomic>
#include <cstring>

#include "base/float_mode.h"
#include "raster/front/assembly.h"
#include "raster/front/records.h"

namespace vitrine::raster {
namespace {

constexpr std::uint32_t kHashSize = 4096;
constexpr std::uint64_t kEmptyKey = ~std::uint64_t{0};
constexpr std::uint16_t kNoSlot = 0xffff;

/// The slot of (index, instance), a new one if it was not seen in this chunk. The table is at most half full: chunks
/// that are larger skip it.
std::uint32_t find_slot(FrontScratch& s, std::uint32_t index, std::uint32_t instance, std::uint32_t& count) {
  const std::uint64_t key = std::uint64_t{instance} << 32 | index;
  std::uint32_t at = (index * 0x9e3779b1u + instance * 0x85ebca6bu) >> 20;
  for (;; at = (at + 1) & (kHashSize - 1)) {
    if (s.hash_key[at] == key) return s.hash_slot[at];
    if (s.hash_key[at] == kEmptyKey) break;
  }
  s.hash_key[at] = key;
  s.hash_slot[at] = static_cast<std::uint16_t>(count);
  s.vertex[count] = index;
  s.instance[count] = instance;
  return count++;
}

/// The index buffer of a draw; positions beyond its end read 0.
template <class T>
struct Indices {
  const std::byte* data;
  std::uint64_t count;
  std::uint32_t offset;

  std::uint32_t operator[](std::uint64_t position) const {
    T value = 0;
    if (position < count) std::memcpy(&value, data + position * sizeof(T), sizeof(T));
    return value + offset;
  }
};

struct Gather {
  const Chunk& chunk;
  FrontScratch& scratch;
  std::uint32_t entry = 0, count = 0;

  /// One slot per position.
  void add_linear() {
    const DrawCall& call = chunk.draw->call;
    for_each_position([&](const Run& run, std::uint32_t position) { add_new(call.first + run.start + position, run); });
  }

  /// One slot per distinct (index, instance), unless the chunk is too large for the tables.
  template <class T>
  void add_indexed(std::uint32_t positions) {
    const DrawCall& call = chunk.draw->call;
    const Indices<T> indices{call.index_data, call.index_bytes / sizeof(T),
                             static_cast<std::uint32_t>(call.vertex_offset)};
    const auto each = [&](auto&& add) {
      for_each_position([&](const Run& run, std::uint32_t position) {
        add(indices[std::uint64_t{call.first} + run.start + position], run);
      });
    };
    if (positions > kHashSize / 2) return each([&](std::uint32_t index, const Run& run) { add_new(index, run); });
    std::uint32_t lowest = ~0u, highest = 0;
    each([&](std::uint32_t index, const Run&) {
      lowest = std::min(lowest, index);
      highest = std::max(highest, index);
    });
    const bool one_instance = chunk.runs[0].instance == chunk.runs[chunk.run_count - 1].instance;
    scratch.hash_slot.resize(kHashSize);
    if (one_instance && highest - lowest < kHashSize) {
      std::fill_n(scratch.hash_slot.begin(), highest - lowest + 1, kNoSlot);
      return each([&](std::uint32_t index, const Run& run) { add_in_range(index - lowest, index, run); });
    }
    scratch.hash_key.assign(kHashSize, kEmptyKey);
    each([&](std::uint32_t index, const Run& run) {
      scratch.slot[entry++] = static_cast<std::uint16_t>(find_slot(scratch, index, run.instance, count));
    });
  }

 private:
  template <class F>
  void for_each_position(F&& add) {
    const TopologyShape& shape = chunk.draw->plan->shape;
    for (std::uint32_t r = 0; r < chunk.run_count; ++r) {
      const RunSpan span = run_span(shape, chunk.runs[r]);
      if (span.center) add(chunk.runs[r], 0);
      for (std::uint32_t p = span.low; p < span.high; ++p) add(chunk.runs[r], p);
    }
  }

  /// hash_slot is a table of the slots of all indices of the chunk, by distance from the lowest.
  void add_in_range(std::uint32_t distance, std::uint32_t index, const Run& run) {
    const std::uint16_t known = scratch.hash_slot[distance];
    if (known == kNoSlot) {
      scratch.hash_slot[distance] = static_cast<std::uint16_t>(count);
      add_new(index, run);
    } else {
      scratch.slot[entry++] = known;
    }
  }

  void add_new(std::uint32_t index, const Run& run) {
    scratch.vertex[count] = index;
    scratch.instance[count] = run.instance;
    scratch.slot[entry++] = static_cast<std::uint16_t>(count++);
  }
};

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
                       FrontScratch& s) {
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

void count_statistics(const Chunk& chunk, std::uint32_t vertices) {
  std::atomic<std::uint64_t>* statistics = chunk.draw->call.queries.statistics;
  if (!statistics) return;
  const std::uint64_t primitives = count_assembly(chunk, vertices);
  statistics[5].fetch_add(primitives, std::memory_order_relaxed);  // clipping invocations
}

}  // namespace

std::uint32_t positions_of(const Chunk& chunk) {
  const TopologyShape& shape = chunk.draw->plan->shape;
  std::uint32_t count = 0;
  for (std::uint32_t r = 0; r < chunk.run_count; ++r) count += run_span(shape, chunk.runs[r]).count();
  return count;
}

std::uint64_t count_assembly(const Chunk& chunk, std::uint32_t vertices) {
  const TopologyShape& shape = chunk.draw->plan->shape;
  std::uint64_t primitives = 0, assembled = 0;
  for (std::uint32_t r = 0; r < chunk.run_count; ++r) {
    const Run& run = chunk.runs[r];
    primitives += run.end - run.begin;
    assembled += std::uint64_t{run.end - run.begin} * shape.step + (run.begin == 0 ? shape.first - shape.step : 0);
  }
  if (std::atomic<std::uint64_t>* statistics = chunk.draw->call.queries.statistics) {
    statistics[0].fetch_add(assembled, std::memory_order_relaxed);   // input assembly vertices
    statistics[1].fetch_add(primitives, std::memory_order_relaxed);  // input assembly primitives
    statistics[2].fetch_add(vertices, std::memory_order_relaxed);    // vertex shader invocations
  }
  return primitives;
}

void reserve_vertices(FrontScratch& s, std::uint32_t count) {
  const std::size_t vertices = (count + base::kWaveWidth - 1) / base::kWaveWidth * base::kWaveWidth;
  if (s.vertex.size() >= vertices) return;
  s.vertex.resize(vertices);
  s.instance.resize(vertices);
  s.clip.resize(vertices * 4);
  s.clip_distance.resize(vertices * kMaxClipDistances);
  s.cull_distance.resize(vertices * kMaxClipDistances);
  s.layer.resize(vertices);
  s.viewport_index.resize(vertices);
  s.code.resize(vertices);
  s.snapped.resize(vertices * 2);
}

std::uint32_t gather_vertices(const Chunk& chunk, FrontScratch& s) {
  const DrawCall& call = chunk.draw->call;
  const std::uint32_t positions = positions_of(chunk);
  if (s.slot.size() < positions) s.slot.resize(positions);
  reserve_vertices(s, positions);
  Gather gather{chunk, s};
  if (!call.index_data) {
    gather.add_linear();
    return gather.count;
  }
  if (call.index_type == VK_INDEX_TYPE_UINT32)
    gather.add_indexed<std::uint32_t>(positions);
  else if (call.index_type == VK_INDEX_TYPE_UINT16)
    gather.add_indexed<std::uint16_t>(positions);
  else
    gather.add_indexed<std::uint8_t>(positions);
  return gather.count;
}

void store_wave(const PipelinePlan& plan, const WaveOutputs& outputs, std::uint32_t base, std::uint32_t lanes,
                FrontScratch& s) {
  static const base::WaveRegister zero{};
  const VertexOutputs& out = plan.out;
  const float* clip[4];
  for (int c = 0; c < 4; ++c) clip[c] = as_floats(out.position[c] == kNoReg ? zero : outputs.at(out.position[c]));
  const State& state = *plan.state;
  transform_wave(
      clip, {plan.viewport[0], plan.pixel_offset, state.depth_clip, state.negative_one_to_one, plan.fused_transform},
      s.transformed);
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
  if (out.viewport_index != kNoReg) scatter(outputs, out.viewport_index, lanes, s.viewport_index.data() + base, 1);
}

void shade_vertex_wave(const DrawRecord& draw, std::uint32_t base, std::uint32_t count, std::uint32_t view,
                       VertexLanes& lanes, FrontScratch& s) {
  if (!(s.bound == draw.vertex)) s.runner.bind(draw.vertex);
  s.bound = draw.vertex;
  lanes.count = count;
  std::copy_n(s.vertex.data() + base, count, lanes.vertex);
  std::copy_n(s.instance.data() + base, count, lanes.instance);
  fetch_vertices(draw, lanes, view, s.runner);
  s.runner.run(base::first_lanes(count), 0);
}

void shade_chunk_vertices(const Chunk& chunk, Arena& arena, FrontScratch& s) {
  const DrawRecord& draw = *chunk.draw;
  const PipelinePlan& plan = *draw.plan;
  const std::uint32_t count = gather_vertices(chunk, s);
  s.records = arena.take<Vertex>(std::size_t{count} * plan.vertex_stride);
  VertexLanes lanes;
  for (std::uint32_t base = 0; base < count; base += base::kWaveWidth) {
    shade_vertex_wave(draw, base, std::min<std::uint32_t>(count - base, base::kWaveWidth), chunk.view, lanes, s);
    store_wave(plan, {&s.runner, nullptr}, base, lanes.count, s);
    if (s.capture.active) capture_wave(plan, {&s.runner, nullptr}, base, lanes.count, s.capture);
  }
  count_statistics(chunk, count);
}

ChunkOutput process_chunk(const Chunk& chunk, const PassDesc& pass, const TileGrid& grid, Arena& arena,
                          FrontScratch& scratch) {
  const base::ScopedFloatMode mode(base::Denormals::kFlush);
  scratch.primitives.begin(arena);
  const PipelinePlan& plan = *chunk.draw->plan;
  scratch.capture.active = is_captured(chunk.draw->call);
  if (plan.stages.any()) {
    process_stages(chunk, pass, arena, scratch);
  } else {
    shade_chunk_vertices(chunk, arena, scratch);
    if (scratch.capture.active) capture_runs(chunk, scratch);
    if (!plan.state->rasterizer_discard) assemble_chunk(chunk, pass, arena, scratch);
  }
  ChunkOutput output;
  if (!plan.state->rasterizer_discard) output = bin_chunk(plan, grid, arena, scratch);
  if (scratch.capture.active) output.capture = finish_capture(plan, arena, scratch.capture);
  return output;
}

}  // namespace vitrine::raster

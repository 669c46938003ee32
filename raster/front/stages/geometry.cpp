// Geometry shading (Vulkan 1.3.239, Geometry Shading): waves of (primitive, invocation), emitted vertices in order.
#include "raster/front/stages/geometry.h"

#include <algorithm>
#include <optional>

#include "raster/front/gather.h"
#include "raster/front/rectangles.h"
#include "raster/front/vertices.h"
#include "spirv/stage_memory.h"

namespace vitrine::raster {
namespace {

using spirv::BuiltIn;
using spirv::InterfaceSlot;

constexpr std::uint32_t kTableWords = 8;  ///< of one primitive

/// One wave: lane i runs invocation (first + i) % invocations of primitive (first + i) / invocations.
struct GeometryWave {
  std::uint64_t first = 0;
  std::uint32_t lanes = 0;
  std::size_t table = 0, emit = 0;  ///< words in stage memory
};

/// As spirv/exec/invocation.h.
std::uint32_t identity_of(const GeometryInput& input, std::uint32_t component, std::uint32_t invocation,
                          std::uint32_t invocations) {
  const std::uint32_t numbers[] = {input.number * invocations + invocation, input.source, input.instance};
  return numbers[component];
}

void fill_inputs(const StageContext& c, std::span<const GeometryInput> inputs, const GeometryWave& wave) {
  StageScratch& s = c.stages;
  const spirv::ShaderInterface& shader = *c.plan.stages.geometry;
  const std::uint32_t invocations = shader.modes.invocations;
  const auto table = static_cast<std::uint32_t>(wave.table * 4), emit = static_cast<std::uint32_t>(wave.emit * 4);
  const std::uint32_t lane_bytes = shader.modes.max_vertices * shader.modes.vertex_words * 4;
  const auto input_of = [&](std::uint32_t i) -> const GeometryInput& { return inputs[(wave.first + i) / invocations]; };
  for (std::uint32_t i = 0; i < wave.lanes; ++i)
    std::copy_n(input_of(i).vertex, 6, s.memory.data() + wave.table + i * kTableWords);
  for (const InterfaceSlot& slot : shader.inputs) {
    std::uint32_t* lane = s.geometry.input(slot.reg).lane;
    for (std::uint32_t i = 0; i < wave.lanes; ++i) {
      switch (slot.built_in) {
        case BuiltIn::kPrimitiveId:
          lane[i] = input_of(i).id;
          break;
        case BuiltIn::kInvocationId:
          lane[i] = static_cast<std::uint32_t>((wave.first + i) % invocations);
          break;
        case BuiltIn::kVertexTable:
          lane[i] = table + i * kTableWords * 4;
          break;
        case BuiltIn::kEmitOffset:
          lane[i] = emit + i * lane_bytes;
          break;
        case BuiltIn::kIdentity:
          lane[i] = identity_of(input_of(i), slot.component, static_cast<std::uint32_t>((wave.first + i) % invocations),
                                invocations);
          break;
        case BuiltIn::kViewIndex:
          lane[i] = c.chunk.view;
          break;
        default:
          lane[i] = 0;
          break;
      }
    }
  }
}

/// Primitives of the strip of emitted vertices [begin, end).
void list_strip(const StageContext& c, std::uint32_t begin, std::uint32_t end, const GeometryInput& input) {
  const std::uint32_t corners = c.plan.corners;
  const VkPrimitiveTopology output = c.plan.stages.geometry->modes.output;
  for (std::uint32_t i = 0; begin + i + corners <= end; ++i) {
    const Corners at = corners_of(output, c.plan.state->provoking_vertex_last, i);
    c.stages.listed.push_back(
        {{begin + at.at[0], begin + at.at[1], begin + at.at[2]}, input.id, i != 0, input.instance});
  }
}

/// Vertices of a stream and their primitives, invocation after invocation.
void collect(const StageContext& c, std::span<const GeometryInput> inputs, const GeometryWave& wave,
             std::uint32_t stream) {
  StageScratch& s = c.stages;
  const spirv::ShaderInterface& shader = *c.plan.stages.geometry;
  const spirv::StageModes& modes = shader.modes;
  s.emitted.clear();
  s.listed.clear();
  const InterfaceSlot* count = nullptr;
  for (const InterfaceSlot& slot : shader.outputs)
    if (slot.built_in == BuiltIn::kEmittedVertices) count = &slot;
  if (!count) return;
  for (std::uint32_t i = 0; i < wave.lanes; ++i) {
    const GeometryInput& input = inputs[(wave.first + i) / modes.invocations];
    const std::uint32_t vertices = std::min(s.geometry.output(count->reg).lane[i], modes.max_vertices);
    auto begin = static_cast<std::uint32_t>(s.emitted.size());
    std::size_t word = wave.emit + std::size_t{i} * modes.max_vertices * modes.vertex_words;
    for (std::uint32_t v = 0; v < vertices; ++v, word += modes.vertex_words) {
      const std::uint32_t flags = s.memory[word];
      if ((flags & spirv::kEmitStream) != stream) continue;
      const auto end = static_cast<std::uint32_t>(s.emitted.size());
      if ((flags & spirv::kEmitStarts) != 0) {
        list_strip(c, begin, end, input);
        begin = end;
      }
      s.emitted.push_back(static_cast<std::uint32_t>(word));
    }
    list_strip(c, begin, static_cast<std::uint32_t>(s.emitted.size()), input);
  }
}

void capture_streams(const StageContext& c, std::span<const GeometryInput> inputs, const GeometryWave& wave) {
  StageScratch& s = c.stages;
  for (std::uint32_t stream = 0; stream < kMaxStreams; ++stream) {
    collect(c, inputs, wave, stream);
    capture_emitted(c.plan, stream, s.listed, s.emitted, s.memory.data(), c.capture);
  }
}

/// Emitted vertices to records of the vertices from `first` on, wave by wave. Those before stay where they are.
void transform_emitted(const StageContext& c, std::uint32_t first) {
  VertexScratch& vertices = c.vertices;
  StageScratch& s = c.stages;
  const auto count = static_cast<std::uint32_t>(s.emitted.size());
  const std::uint32_t words = c.plan.stages.geometry->modes.vertex_words;
  reserve_vertices(vertices, first + count);
  if (s.staging.size() < words) s.staging.resize(words);
  for (std::uint32_t base = 0; base < count; base += base::kWaveWidth) {
    const std::uint32_t lanes = std::min<std::uint32_t>(count - base, base::kWaveWidth);
    for (std::uint32_t i = 0; i < lanes; ++i) {
      const std::uint32_t* vertex = s.memory.data() + s.emitted[base + i];
      for (std::uint32_t w = 0; w < words; ++w) s.staging[w].lane[i] = vertex[w];
    }
    store_wave(c.plan, {nullptr, s.staging.data()}, first + base, lanes, vertices);
  }
  if (c.plan.out.primitive_id == kNoReg) return;
  const std::uint32_t provoking = provoking_corner(c.plan.corners, c.plan.state->provoking_vertex_last);
  for (ListedPrimitive& primitive : s.listed)
    primitive.id = s.memory[s.emitted[primitive.slot[provoking]] + c.plan.out.primitive_id];
}

/// Triangles that may form rectangles wait for all of their segment: they do not where one of its vertices is clipped,
/// or where there are more than 65,535 of them (lavapipe-rasterization.md 9.2).
class WaitingStrips {
 public:
  explicit WaitingStrips(const StageContext& context) : c_(context), chunk_(context.chunk) {
    c_.stages.segment.clear();
    clips_ = c_.plan.out.cull_count != 0;
  }
  /// The primitives of a wave.
  void add() {
    StageScratch& s = c_.stages;
    const auto count = static_cast<std::uint32_t>(s.emitted.size());
    reserve_records(count);
    transform_emitted(c_, vertices_);
    for (ListedPrimitive primitive : s.listed) {
      for (std::uint32_t& slot : primitive.slot) slot += vertices_;
      s.segment.push_back(primitive);
    }
    vertices_ += count;
    if (vertices_ <= kMostVertices) return;
    clips_ = true;
    if (!chunk_.batch) {
      batch_.begin(c_.plan);
      chunk_.batch = &batch_;
    }
    chunk_.ends_batch = false;
    work_off();
  }
  /// Returns whether they went through the clipper.
  bool finish() {
    const std::vector<ClipCode>& codes = c_.vertices.code;
    clips_ = clips_ || std::any_of(codes.begin(), codes.begin() + vertices_, [](ClipCode code) { return code != 0; });
    chunk_.ends_batch = c_.chunk.ends_batch;
    work_off();
    return clips_;
  }

 private:
  static constexpr std::uint32_t kMostVertices = 65535;

  void reserve_records(std::uint32_t count) {
    if (vertices_ != 0 && vertices_ + count <= capacity_) return;
    capacity_ = std::max(vertices_ + count, 2 * vertices_);
    auto* const records = c_.arena.take<Vertex>(std::size_t{capacity_} * c_.plan.vertex_stride);
    std::copy_n(c_.vertices.records, std::size_t{vertices_} * c_.plan.vertex_stride, records);
    c_.vertices.records = records;
  }
  void work_off() {
    process_strips({chunk_, c_.pass, c_.arena, c_.vertices, c_.primitives}, c_.stages.segment, clips_);
    c_.stages.segment.clear();
    vertices_ = 0;
  }

  const StageContext& c_;
  Chunk chunk_;
  ClippedBatch batch_;
  std::uint32_t vertices_ = 0, capacity_ = 0;
  bool clips_ = false;
};

}  // namespace

bool run_geometry(const StageContext& c, std::span<const GeometryInput> inputs) {
  StageScratch& s = c.stages;
  const spirv::StageModes& modes = c.plan.stages.geometry->modes;
  const std::size_t mark = s.used;
  bind_stage(s.geometry, s.bound_geometry, c.chunk.draw->geometry);
  GeometryWave wave;
  wave.table = s.take(base::kWaveWidth * kTableWords);
  wave.emit = s.take(std::size_t{base::kWaveWidth} * modes.max_vertices * modes.vertex_words);
  s.geometry.set_stage_memory(s.memory.data(), s.used);
  std::optional<WaitingStrips> strips;
  if (c.plan.rectangles.any && !c.plan.state->rasterizer_discard) strips.emplace(c);
  const std::uint64_t total = std::uint64_t{inputs.size()} * modes.invocations;
  for (; wave.first < total; wave.first += base::kWaveWidth) {
    wave.lanes = static_cast<std::uint32_t>(std::min<std::uint64_t>(total - wave.first, base::kWaveWidth));
    fill_inputs(c, inputs, wave);
    s.geometry.run(base::first_lanes(wave.lanes), 0);
    if (c.capture.active) capture_streams(c, inputs, wave);
    collect(c, inputs, wave, rasterized_stream(c.plan));
    c.queries().count(Statistic::kGeometryInvocations, wave.lanes);
    c.queries().count(Statistic::kGeometryPrimitives, s.listed.size());
    if (c.plan.state->rasterizer_discard || s.listed.empty()) continue;
    if (strips) {
      strips->add();
      continue;
    }
    c.vertices.records = c.arena.take<Vertex>(s.emitted.size() * c.plan.vertex_stride);
    transform_emitted(c, 0);
    process_listed(c.primitive_context(), s.listed);
  }
  s.used = mark;
  return strips && strips->finish();
}

}  // namespace vitrine::raster

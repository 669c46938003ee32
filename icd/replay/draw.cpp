// Replay of draws and dispatches: resolves what is bound into a raster::DrawCall or a BoundShader.
#include <algorithm>
#include <cstring>

#include "base/as_reference.h"
#include "glass/profile.h"
#include "glass/session.h"
#include "icd/object/memory.h"
#include "icd/replay/observed_replay.h"

namespace vitrine::icd {
namespace {

// Beyond this, values of recorded draws are given up by flushing the pass.
constexpr std::size_t kArenaBudget = std::size_t{32} << 20;

void resolve_vertex_buffers(ReplayState& state) {
  const Pipeline& pipeline = *state.graphics.pipeline;
  const bool dynamic_input = pipeline.dynamic.test(DynamicState::kVertexInput);
  const bool dynamic_stride = dynamic_input || pipeline.dynamic.test(DynamicState::kVertexStride);
  const VertexStreams& streams = dynamic_input ? state.dynamic.streams : pipeline.streams;
  for (std::uint32_t i = 0; i < raster::kMaxVertexBindings; ++i) {
    const VertexStream& stream = streams[i];
    if (!stream.used) continue;
    const BoundBuffer& buffer = state.vertex_buffers[i];
    const std::uint32_t stride = dynamic_stride ? state.dynamic.streams[i].stride : stream.stride;
    state.draw.vertex_binding[i] = {buffer.data, buffer.size, stride, stream.per_instance, stream.divisor};
  }
}

const std::byte* copy_push_constants(ReplayState& state) {
  auto* copy = state.arena.take<std::byte>(spirv::kMaxPushConstantBytes);
  std::memcpy(copy, state.push_constants.data(), spirv::kMaxPushConstantBytes);
  return copy;
}

/// In a performance query the shader whose blocks are counted.
const spirv::Shader& running_shader(const ReplayState& state, const CompiledShader& compiled) {
  return state.profiled ? counted_shader(compiled, *state.profiled->profile) : *compiled.shader;
}

/// Who is told of draws; null: nobody.
raster::DrawObserver* observer_of(const ReplayState& state) {
  if (state.profiled) return state.profiled->profile->draws();
  return state.observed ? glass::session().draws() : nullptr;
}

/// Nobody is told, but the draw is one that is observed: its fragments outside of the scissor, too.
struct Nobody final : raster::DrawObserver {
  std::unique_ptr<raster::DrawWatch> watch_chunk(const spirv::ObservedCommand*) override { return nullptr; }
  std::unique_ptr<raster::DrawWatch> watch_tile(const spirv::ObservedCommand*, std::uint32_t) override {
    return nullptr;
  }
};
Nobody kNobody;

/// Whether a scissor of the draw leaves out pixels that are watched.
bool cuts_watched_pixels(const ReplayState& state) {
  const raster::State& fixed = *state.draw.state;
  for (std::uint32_t i = 0; i < std::min(fixed.viewport_count, raster::kMaxViewports); ++i)
    if (!state.observed->pixel_pass->inside(fixed.scissor[i])) return true;
  return false;
}

/// Brings `state.draw` up to date. False if there is nothing to draw with or to.
bool prepare_draw(ReplayState& state) {
  if (state.shaders.any) link_shaders(state);
  const Pipeline* pipeline = state.graphics.pipeline;
  if (!pipeline || !state.pass || state.suppressed) return false;
  if (state.arena.used() > kArenaBudget) flush_pass(state);
  if (state.dirty & kDirtyDescriptors) read_descriptor_buffers(state, state.graphics);
  follow_locations(state, pipeline->locations);
  raster::DrawCall& draw = state.draw;
  if (state.dirty & kDirtyState) {
    draw.state = resolve_state(state);
    const auto shader_of = [&](const std::shared_ptr<const CompiledShader>& stage) {
      return stage ? &running_shader(state, *stage) : nullptr;
    };
    draw.vertex = shader_of(pipeline->vertex);
    draw.control = shader_of(pipeline->control);
    draw.evaluation = shader_of(pipeline->evaluation);
    draw.geometry = shader_of(pipeline->geometry);
    draw.fragment = shader_of(pipeline->fragment);
  }
  if (state.dirty & kDirtyDescriptors) fill_resources(state, state.graphics, draw.vertex_resources);
  if (state.dirty & kDirtyPushConstants) draw.vertex_resources.push_constants = copy_push_constants(state);
  if (state.dirty & (kDirtyDescriptors | kDirtyPushConstants)) draw.fragment_resources = draw.vertex_resources;
  if (state.dirty & kDirtyVertexBuffers) resolve_vertex_buffers(state);
  state.dirty = 0;
  if (state.observed) {
    draw.vertex_resources.command = observe_command(state, *pipeline, draw.vertex_resources);
    const bool told = state.observed->every_fragment || (draw.fragment && draw.fragment->interface().writes_memory);
    draw.fragment_resources.command = told ? draw.vertex_resources.command : nullptr;
    draw.tile_observer = state.observed->pixel_pass.get();
  }
  draw.observer = observer_of(state);
  if (draw.tile_observer && !draw.observer && state.observed->primitives)
    draw.observer = state.observed->primitives.get();
  if (draw.tile_observer && !draw.observer && cuts_watched_pixels(state)) draw.observer = &kNobody;
  draw.queries = state.counters;
  return true;
}

/// Hands the draw to the pass; observers see it first.
void submit_draw(ReplayState& state) {
  if (state.observed) glass::session().draw(state.draw);
  state.pass->draw(state.draw);
  if (state.draw.queries.statistics && state.draw.state->rasterizer_discard &&
      base::as_reference(base::Deviation::kDiscardedClippingInvocations)) {
    state.pass->flush();  // the draws before count, too
    state.draw.queries.statistics[static_cast<std::size_t>(raster::Statistic::kClippingInvocations)] = 0;
  }
}

/// The instances of a draw that are drawn: all, or one.
struct Instances {
  std::uint32_t first = 0, end = UINT32_MAX;
};

void choose_instances(raster::DrawCall& draw, std::uint32_t count, const Instances& chosen) {
  draw.instance_count = std::min(count, chosen.end);
  draw.skipped_instances = chosen.first;
}

void draw_direct(ReplayState& state, const CmdDraw& command, std::uint32_t draw_index, const Instances& chosen = {}) {
  raster::DrawCall& draw = state.draw;
  draw.index_data = nullptr;
  draw.index_bytes = 0;
  draw.first = command.first_vertex;
  draw.count = command.vertex_count;
  draw.vertex_offset = 0;
  draw.first_instance = command.first_instance;
  choose_instances(draw, command.instance_count, chosen);
  draw.draw_index = draw_index;
  submit_draw(state);
}

void draw_indexed(ReplayState& state, const CmdDrawIndexed& command, std::uint32_t draw_index,
                  const Instances& chosen = {}) {
  // An indexed draw without indices: every index is out of bounds, so it reads 0.
  static constexpr std::byte kNoIndices{};
  raster::DrawCall& draw = state.draw;
  draw.index_data = state.indices.data ? state.indices.data : &kNoIndices;
  draw.index_bytes = state.indices.size;
  draw.first = command.first_index;
  draw.count = command.index_count;
  draw.vertex_offset = command.vertex_offset;
  draw.first_instance = command.first_instance;
  choose_instances(draw, command.instance_count, chosen);
  draw.draw_index = draw_index;
  submit_draw(state);
}

/// Calls f(number of the draw, instances) for the draws of a vkCmdDrawMulti*EXT, one after the other. (The reference:
/// all draws of an instance, then those of the next; deviations.md, multi-draw-order.)
template <class Command, class F>
void for_each_draw(ReplayState& state, const Command& command, F&& f) {
  const bool by_instance = base::as_reference(base::Deviation::kMultiDrawOrder);
  const std::uint32_t rounds = by_instance ? command.instance_count : 1;
  for (std::uint32_t round = 0; round < rounds; ++round)
    for (std::uint32_t i = 0; i < command.draws.size() && prepare_draw(state); ++i)
      f(i, by_instance ? Instances{round, round + 1} : Instances{});
}

/// Reads a T at `offset` of a buffer. False if it is not all inside.
template <class T>
bool read_value(const Buffer& buffer, VkDeviceSize offset, T& out) {
  if (!buffer.data || buffer.resolve_range(offset, sizeof(T)) != sizeof(T)) return false;
  std::memcpy(&out, buffer.data + offset, sizeof(T));
  return true;
}

/// The same for what a draw or dispatch needs: observers are told of what is missing.
template <class T>
bool read_arguments(ReplayState& state, const BindPoint& point, const char* what, const Buffer& buffer,
                    VkDeviceSize offset, T& out) {
  const bool there = read_value(buffer, offset, out);
  if (!there && state.observed) report_arguments(state, point, buffer, offset, sizeof(T), what);
  return there;
}

void dispatch(ReplayState& state, const std::uint32_t base[3], const std::uint32_t groups[3]) {
  const Pipeline* pipeline = state.compute.pipeline;
  if (!pipeline || state.suppressed || groups[0] == 0 || groups[1] == 0 || groups[2] == 0) return;
  read_descriptor_buffers(state, state.compute);
  spirv::ResourceTable resources;
  fill_resources(state, state.compute, resources);
  resources.push_constants = state.push_constants.data();
  if (state.observed) resources.command = observe_command(state, *pipeline, resources);
  const spirv::Shader& shader = running_shader(state, *pipeline->compute);
  const spirv::BoundShader bound(shader, resources, state.fault);
  spirv::dispatch(bound, base, groups);
  const std::uint32_t* local = shader.interface().local_size;
  state.counters.count(raster::Statistic::kComputeInvocations,
                       std::uint64_t{local[0]} * local[1] * local[2] * groups[0] * groups[1] * groups[2]);
  if (!state.pass) reset_arena(state);
}

}  // namespace

void execute(ReplayState& state, const CmdDraw& command) {
  if (prepare_draw(state)) draw_direct(state, command, 0);
}

void execute(ReplayState& state, const CmdDrawIndexed& command) {
  if (prepare_draw(state)) draw_indexed(state, command, 0);
}

void execute(ReplayState& state, const CmdDrawMulti& command) {
  for_each_draw(state, command, [&](std::uint32_t i, const Instances& instances) {
    const VkMultiDrawInfoEXT& d = command.draws[i];
    draw_direct(state, {d.vertexCount, command.instance_count, d.firstVertex, command.first_instance}, i, instances);
  });
}

void execute(ReplayState& state, const CmdDrawMultiIndexed& command) {
  for_each_draw(state, command, [&](std::uint32_t i, const Instances& instances) {
    const VkMultiDrawIndexedInfoEXT& d = command.draws[i];
    draw_indexed(state, {d.indexCount, command.instance_count, d.firstIndex, d.vertexOffset, command.first_instance}, i,
                 instances);
  });
}

void execute(ReplayState& state, const CmdBeginConditionalRendering& command) {
  std::uint32_t value = 0;
  read_value(*command.buffer, command.offset, value);
  state.suppressed = (value == 0) != command.inverted;
}

void execute(ReplayState& state, const CmdEndConditionalRendering&) { state.suppressed = false; }

void execute(ReplayState& state, const CmdDrawIndirect& command) {
  const auto read = [&](const char* what, const Buffer& buffer, VkDeviceSize offset, auto& out) {
    return read_arguments(state, state.graphics, what, buffer, offset, out);
  };
  std::uint32_t count = command.draw_count;
  link_shaders(state);
  if (command.count_buffer) {
    std::uint32_t stored = 0;
    if (!read("number of draws", *command.count_buffer, command.count_offset, stored)) return;
    count = std::min(count, stored);
  }
  for (std::uint32_t i = 0; i < count && prepare_draw(state); ++i) {
    const VkDeviceSize offset = command.offset + VkDeviceSize{i} * command.stride;
    if (command.indexed) {
      VkDrawIndexedIndirectCommand a;
      if (!read("arguments of a draw", *command.buffer, offset, a)) return;
      draw_indexed(state, {a.indexCount, a.instanceCount, a.firstIndex, a.vertexOffset, a.firstInstance}, i);
    } else {
      VkDrawIndirectCommand a;
      if (!read("arguments of a draw", *command.buffer, offset, a)) return;
      draw_direct(state, {a.vertexCount, a.instanceCount, a.firstVertex, a.firstInstance}, i);
    }
  }
}

void execute(ReplayState& state, const CmdDrawByteCount& command) {
  std::uint32_t bytes = 0;
  if (!read_counter(command.counter, bytes) || command.stride == 0 || !prepare_draw(state)) return;
  const std::uint32_t vertices = bytes > command.subtracted ? (bytes - command.subtracted) / command.stride : 0;
  draw_direct(state, {vertices, command.instance_count, 0, command.first_instance}, 0);
}

void execute(ReplayState& state, const CmdDispatch& command) { dispatch(state, command.base, command.groups); }

void execute(ReplayState& state, const CmdDispatchIndirect& command) {
  constexpr std::uint32_t kBase[3] = {0, 0, 0};
  VkDispatchIndirectCommand a;
  if (!read_arguments(state, state.compute, "arguments of a dispatch", *command.buffer, command.offset, a)) return;
  const std::uint32_t groups[3] = {a.x, a.y, a.z};
  dispatch(state, kBase, groups);
}

}  // namespace vitrine::icd

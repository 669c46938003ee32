// Replay of dynamic state.
#include <algorithm>

#include "icd/replay/replay.h"

namespace vitrine::icd {
namespace {

template <class T, std::size_t N>
void set_range(std::array<T, N>& out, std::uint32_t first, std::span<const T> values) {
  if (first >= N) return;
  std::copy_n(values.begin(), std::min<std::size_t>(values.size(), N - first), out.begin() + first);
}

/// The values, about to be changed.
DynamicValues& change(ReplayState& state) {
  state.dirty |= kDirtyState;
  return state.dynamic;
}

template <class F>
void for_each_face(raster::State& state, VkStencilFaceFlags faces, F f) {
  if (faces & VK_STENCIL_FACE_FRONT_BIT) f(state.front);
  if (faces & VK_STENCIL_FACE_BACK_BIT) f(state.back);
}

}  // namespace

const raster::State* resolve_state(ReplayState& state) {
  const Pipeline& pipeline = *state.graphics.pipeline;
  const DynamicStates& dynamic = pipeline.dynamic;
  const bool located = pipeline.locations != ColorLocations{};
  if (dynamic.none() && !located && pipeline.state.rasterized_stream == 0) return &pipeline.state;
  const DynamicValues& values = state.dynamic;
  const bool all_dynamic = pipeline.shader_objects[0].handle != 0;
  auto* out = ::new (state.arena.take<raster::State>(1)) raster::State(all_dynamic ? values.state : pipeline.state);
  if (all_dynamic) out->unrestricted_depth = pipeline.state.unrestricted_depth;
  for (std::uint8_t i = 0; i < static_cast<std::uint8_t>(DynamicState::kCount) && !all_dynamic; ++i) {
    const auto which = static_cast<DynamicState>(i);
    if (dynamic.test(which)) copy_state(values.state, which, *out);
  }
  // Without a geometry shader all primitives are of stream 0.
  out->rasterizer_discard |= out->rasterized_stream != 0 && !pipeline.geometry;
  out->discard_count = std::min(out->discard_count, pipeline.state.discard_count);
  if (pipeline.clip_follows_clamp) out->depth_clip = !out->depth_clamp;
  const bool writes = dynamic.test(DynamicState::kColorWriteEnable);
  leave_unnamed(pipeline, writes ? values.color_writes : pipeline.color_writes, *out);
  if (located) locate_blending(pipeline.locations, *out);
  return out;
}

void execute(ReplayState& state, const CmdSetViewport& command) {
  raster::State& out = change(state).state;
  set_range(out.viewport, command.first, command.viewports);
  if (command.sets_count) {
    out.viewport_count =
        static_cast<std::uint32_t>(std::min<std::size_t>(command.viewports.size(), out.viewport.size()));
  }
}

void execute(ReplayState& state, const CmdSetScissor& command) {
  set_range(change(state).state.scissor, command.first, command.scissors);
}

void execute(ReplayState& state, const CmdSetDiscardRectangle& command) {
  set_range(change(state).state.discard, command.first, command.rectangles);
}

void execute(ReplayState& state, const CmdSetDepthBias& command) {
  raster::State& out = change(state).state;
  out.depth_bias_constant = command.constant;
  out.depth_bias_clamp = command.clamp;
  out.depth_bias_slope = command.slope;
  out.depth_bias_unit = command.unit;
}

void execute(ReplayState& state, const CmdSetFragmentShadingRate& command) {
  raster::State& out = change(state).state;
  out.fragment_size = command.size;
  out.rate_combiners = command.combiners;
}

void execute(ReplayState& state, const CmdSetBlendConstants& command) {
  change(state).state.blend_constants = command.constants;
}

void execute(ReplayState& state, const CmdSetDepthBounds& command) {
  raster::State& out = change(state).state;
  out.min_depth_bounds = command.min;
  out.max_depth_bounds = command.max;
}

void execute(ReplayState& state, const CmdSetStencil& command) {
  for_each_face(change(state).state, command.faces,
                [&](raster::StencilFace& face) { face.*command.which = static_cast<std::uint8_t>(command.value); });
}

void execute(ReplayState& state, const CmdSetStencilOp& command) {
  for_each_face(change(state).state, command.faces, [&](raster::StencilFace& face) {
    face.fail = command.fail;
    face.pass = command.pass;
    face.depth_fail = command.depth_fail;
    face.compare = command.compare;
  });
}

void execute(ReplayState& state, const CmdSetValue& command) {
  set_value(change(state).state, command.which, command.value);
}

void execute(ReplayState& state, const CmdSetLineStipple& command) {
  raster::State& out = change(state).state;
  out.line_stipple_factor = command.factor;
  out.line_stipple_pattern = command.pattern;
}

void execute(ReplayState& state, const CmdSetSampleLocations& command) {
  change(state).state.locations = command.locations;
}

void execute(ReplayState& state, const CmdSetColorWriteEnable& command) { change(state).color_writes = command.writes; }

void execute(ReplayState& state, const CmdSetBlend& command) {
  raster::State& out = change(state).state;
  raster::State source = out;
  set_range(source.blend, command.first, command.attachments);
  copy_state(source, command.which, out);
}

void execute(ReplayState& state, const CmdSetVertexInput& command) {
  DynamicValues& values = change(state);
  state.dirty |= kDirtyVertexBuffers;
  values.streams = {};
  for (const VkVertexInputBindingDescription2EXT& b : command.bindings) {
    if (b.binding >= values.streams.size()) continue;
    values.streams[b.binding] = {b.stride, b.divisor, b.inputRate == VK_VERTEX_INPUT_RATE_INSTANCE, true};
  }
  raster::State& out = values.state;
  out.attribute_count =
      static_cast<std::uint32_t>(std::min<std::size_t>(command.attributes.size(), out.attribute.size()));
  for (std::uint32_t i = 0; i < out.attribute_count; ++i) {
    const VkVertexInputAttributeDescription2EXT& a = command.attributes[i];
    out.attribute[i] = {a.location, a.binding, a.format, a.offset};
  }
}

}  // namespace vitrine::icd

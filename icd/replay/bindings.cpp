// Replay of what sets state: bindings, push constants, buffers; and how it reaches a draw or dispatch.
#include <algorithm>

#include "icd/object/memory.h"
#include "icd/replay/observed_replay.h"
#include "icd/replay/replay.h"

namespace vitrine::icd {
namespace {

/// Applies the dynamic offsets of one set; returns how many it took.
std::uint32_t bind_dynamic_buffers(BindPoint& point, const DescriptorSet& set, std::uint32_t first_slot,
                                   std::span<const std::uint32_t> offsets) {
  const std::uint32_t count = set.shape->dynamic_count;
  for (std::uint32_t i = 0; i < count && first_slot + i < point.dynamic.size(); ++i) {
    point.dynamic[first_slot + i] = apply_offset(set.dynamic[i], i < offsets.size() ? offsets[i] : 0);
  }
  return count;
}

}  // namespace

void fill_resources(ReplayState& state, const BindPoint& point, spirv::ResourceTable& table) {
  const PipelineLayoutShape& layout = *point.pipeline->layout;
  for (std::size_t i = 0; i < layout.sets.size() && i < spirv::kMaxSets; ++i) {
    const DescriptorSet* set = point.sets[i];
    table.set[i] = set ? set->slots : nullptr;
    table.set_size[i] = set ? set->slot_count : 0;
  }
  const std::size_t dynamic_count = std::min<std::size_t>(layout.dynamic_count, point.dynamic.size());
  spirv::Descriptor* dynamic = nullptr;
  if (dynamic_count) {
    dynamic = state.arena.take<spirv::Descriptor>(dynamic_count);
    std::uninitialized_copy_n(point.dynamic.begin(), dynamic_count, dynamic);
  }
  table.set[spirv::kDynamicSet] = dynamic;
  table.set_size[spirv::kDynamicSet] = static_cast<std::uint32_t>(dynamic_count);
  if (state.observed) hide_departed(state, point, table);
}

void execute(ReplayState& state, const CmdBindPipeline& command) {
  if (command.pipeline->bind_point == VK_PIPELINE_BIND_POINT_COMPUTE) {
    state.compute.pipeline = command.pipeline;
  } else if (state.graphics.pipeline != command.pipeline) {
    state.shaders.any = false;
    state.shaders.stages.fill(nullptr);
    state.graphics.pipeline = command.pipeline;
    state.dirty |= kDirtyState | kDirtyDescriptors | kDirtyVertexBuffers;
  }
}

void execute(ReplayState& state, const CmdBindDescriptorSets& command) {
  BindPoint& point = bind_point(state, command.bind_point);
  std::span<const std::uint32_t> offsets = command.offsets;
  for (std::size_t i = 0; i < command.sets.size(); ++i) {
    const DescriptorSet* set = command.sets[i];
    point.sets[command.first_set + i] = set;
    point.addresses[command.first_set + i] = 0;
    if (!set) continue;
    const std::uint32_t taken = bind_dynamic_buffers(point, *set, command.first_dynamic[i], offsets);
    offsets = offsets.subspan(std::min<std::size_t>(taken, offsets.size()));
  }
  if (&point == &state.graphics) state.dirty |= kDirtyDescriptors;
}

void execute(ReplayState& state, const CmdPushConstants& command) {
  std::copy(command.bytes.begin(), command.bytes.end(), state.push_constants.begin() + command.offset);
  state.dirty |= kDirtyPushConstants;
  if (state.observed) note_push_constants(state, command);
}

void execute(ReplayState& state, const CmdBindVertexBuffers& command) {
  for (std::size_t i = 0; i < command.buffers.size(); ++i) {
    BoundBuffer& out = state.vertex_buffers[command.first + i];
    out = {};
    const Buffer* buffer = command.buffers[i];
    if (!buffer || !buffer->data) continue;
    out.size = buffer->resolve_range(command.offsets[i], command.sizes.empty() ? VK_WHOLE_SIZE : command.sizes[i]);
    if (out.size) out.data = buffer->data + command.offsets[i];
  }
  for (std::size_t i = 0; i < command.strides.size(); ++i) {
    state.dynamic.streams[command.first + i].stride = static_cast<std::uint32_t>(command.strides[i]);
  }
  state.dirty |= kDirtyVertexBuffers;
}

void execute(ReplayState& state, const CmdBindIndexBuffer& command) {
  const Buffer* buffer = command.buffer;
  const std::uint64_t size = buffer && buffer->data ? buffer->resolve_range(command.offset, command.size) : 0;
  state.indices = {size ? buffer->data + command.offset : nullptr, size};
  state.draw.index_type = command.type;
}

}  // namespace vitrine::icd

// See descriptor_buffers.h (Vulkan 1.3.239, Resource Descriptors: Descriptor Buffers).
#include "icd/replay/descriptor_buffers.h"

#include <algorithm>
#include <cstring>

#include "icd/object/descriptor_bytes.h"
#include "icd/replay/observed_replay.h"
#include "icd/replay/replay.h"
#include "spirv/addresses.h"

namespace vitrine::icd {
namespace {

constexpr std::uint32_t kLargeSet = 1024;               ///< slots, from which on a set is kept
constexpr std::size_t kMostKept = 2 * spirv::kMaxSets;  ///< no fewer than can be bound at once
constexpr std::uint32_t kChunk = 256;                   ///< elements that are compared and read at once

DescriptorBytes bytes_at(VkDeviceAddress address, const SetShape& shape) {
  const spirv::AddressRange memory = spirv::find_addresses(address);
  if (address < memory.begin || address >= memory.end) return {};
  return {reinterpret_cast<const std::byte*>(address),
          std::min<std::uint64_t>(shape.buffer_bytes, memory.end - address)};
}

/// Elements of the binding with a variable count: buffers say nothing of it, so all that there can be.
std::uint32_t variable_count_of(const SetShape& shape) {
  const SetBinding* variable = shape.variable_binding();
  return variable ? variable->count : 0;
}

/// An empty set of null descriptors. The shape has to outlive it.
DescriptorSet& make_set(ReplayState& state, void* storage, const SetShape& shape) {
  const std::shared_ptr<const SetShape> borrowed(std::shared_ptr<const SetShape>(), &shape);
  DescriptorSet& set = *construct_set(storage, state.device.memory, borrowed, variable_count_of(shape));
  set.written = nullptr;  // nobody knows when bytes were written
  if (state.observed) state.observed->alive.erase(&set);
  return set;
}

std::size_t bytes_of_set(const SetShape& shape) { return set_bytes(shape, variable_count_of(shape)); }

const DescriptorSet& read_small_set(ReplayState& state, DescriptorBytes bytes, const SetShape& shape) {
  DescriptorSet& set = make_set(state, state.arena.take_bytes(bytes_of_set(shape)), shape);
  auto* texels = may_have_texel_buffers(shape) ? state.arena.take<texel::BufferTexelView>(set.slot_count) : nullptr;
  read_descriptor_bytes(*state.device.described, bytes, set, texels, 0, set.slot_count);
  return set;
}

/// Brings a kept set up to date.
class KeptReader {
 public:
  KeptReader(ReplayState& state, KeptSet& kept) : state_(state), kept_(kept) {}

  void read(DescriptorBytes bytes) {
    const std::uint64_t forgotten = state_.device.described->forgotten();
    const bool whole = kept_.forgotten != forgotten || kept_.bytes.size() != bytes.size;
    if (whole) {
      begin();
      kept_.bytes.assign(bytes.first, bytes.first + bytes.size);
      kept_.forgotten = forgotten;
      return read_slots(0, kept_.set->slot_count);
    }
    for (const SetBinding& binding : kept_.shape->bindings) read_binding(binding, bytes);
  }

 private:
  void read_binding(const SetBinding& binding, DescriptorBytes bytes) {
    const bool block = is_inline_block(binding.type);
    const std::uint64_t stride = block ? 1 : binding.stride;
    for (std::uint32_t i = 0; i < binding.count; i += kChunk) {
      const std::uint32_t count = std::min(kChunk, binding.count - i);
      const std::uint64_t first = binding.buffer_offset + i * stride;
      if (first >= bytes.size) return;
      const std::size_t size = std::min<std::uint64_t>(count * stride, bytes.size - first);
      if (std::memcmp(kept_.bytes.data() + first, bytes.first + first, size) == 0) continue;
      begin();
      std::memcpy(kept_.bytes.data() + first, bytes.first + first, size);
      if (!block) read_slots(binding.first_slot + i, binding.first_slot + i + count);
    }
  }

  /// Draws that are put off see the set as it was.
  void begin() {
    if (state_.pass && !flushed_) flush_pass(state_);
    flushed_ = true;
    if (state_.observed) state_.observed->alive.erase(kept_.set);
  }

  void read_slots(std::uint32_t first, std::uint32_t end) {
    read_descriptor_bytes(*state_.device.described, {kept_.bytes.data(), kept_.bytes.size()}, *kept_.set,
                          kept_.texels.empty() ? nullptr : kept_.texels.data(), first, end);
  }

  ReplayState& state_;
  KeptSet& kept_;
  bool flushed_ = false;
};

/// The kept set of that place, made unless it is there.
KeptSet& kept_set_of(ReplayState& state, VkDeviceAddress address, const std::shared_ptr<const SetShape>& shape) {
  KeptSets& all = state.kept_sets;
  const auto found =
      std::ranges::find_if(all, [&](const KeptSet& k) { return k.address == address && k.shape == shape; });
  if (found != all.end()) {
    all.splice(all.begin(), all, found);
    return all.front();
  }
  if (all.size() >= kMostKept) {
    if (state.pass) flush_pass(state);
    all.pop_back();
  }
  KeptSet& kept = all.emplace_front(state.device.memory);
  kept.address = address;
  kept.storage.resize((bytes_of_set(*shape) + sizeof(std::uint64_t) - 1) / sizeof(std::uint64_t));
  kept.set = &make_set(state, kept.storage.data(), *shape);
  if (may_have_texel_buffers(*shape)) kept.texels.resize(kept.set->slot_count);
  kept.shape = shape;  // last: what threw before is not found again
  return kept;
}

const DescriptorSet* read_set(ReplayState& state, VkDeviceAddress address,
                              const std::shared_ptr<const SetShape>& shape) {
  const DescriptorBytes bytes = bytes_at(address, *shape);
  if (shape->slot_count < kLargeSet) return &read_small_set(state, bytes, *shape);
  KeptSet& kept = kept_set_of(state, address, shape);
  KeptReader(state, kept).read(bytes);
  return kept.set;
}

}  // namespace

void read_descriptor_buffers(ReplayState& state, BindPoint& point) {
  if (!point.in_buffers || !state.device.described) return;
  const PipelineLayoutShape& layout = *point.pipeline->layout;
  const auto read_all = [&](bool large) {
    for (std::size_t i = 0; i < layout.sets.size() && i < spirv::kMaxSets; ++i) {
      const std::shared_ptr<const SetShape>& shape = layout.sets[i];
      if (point.addresses[i] && shape && (shape->slot_count >= kLargeSet) == large)
        point.sets[i] = read_set(state, point.addresses[i], shape);
    }
  };
  read_all(true);  // may flush, and what is in the arena is gone then
  read_all(false);
}

void execute(ReplayState& state, const CmdBindDescriptorBuffers& command) {
  std::ranges::copy(command.addresses, state.descriptor_buffers.begin());
}

void execute(ReplayState& state, const CmdSetDescriptorBufferOffsets& command) {
  BindPoint& point = bind_point(state, command.bind_point);
  for (std::size_t i = 0; i < command.buffers.size(); ++i) {
    const std::uint32_t buffer = command.buffers[i];
    const VkDeviceAddress first = buffer < state.descriptor_buffers.size() ? state.descriptor_buffers[buffer] : 0;
    point.sets[command.first_set + i] = nullptr;
    point.addresses[command.first_set + i] = first ? first + command.offsets[i] : 0;
  }
  point.in_buffers = true;
  if (&point == &state.graphics) state.dirty |= kDirtyDescriptors;
}

}  // namespace vitrine::icd

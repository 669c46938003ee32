// Replay of transform feedback: bound ranges, and counters that are read when it begins and written when it ends.
#include <algorithm>
#include <cstring>

#include "icd/object/memory.h"
#include "icd/replay/replay.h"

namespace vitrine::icd {
namespace {

/// The 32-bit counter, or null if it is not all inside its buffer.
std::byte* counter_of(const CounterBuffer& counter) {
  if (!counter.buffer || !counter.buffer->data) return nullptr;
  if (counter.buffer->resolve_range(counter.offset, sizeof(std::uint32_t)) != sizeof(std::uint32_t)) return nullptr;
  return counter.buffer->data + counter.offset;
}

}  // namespace

bool read_counter(const CounterBuffer& counter, std::uint32_t& value) {
  const std::byte* bytes = counter_of(counter);
  if (bytes) std::memcpy(&value, bytes, sizeof(value));
  return bytes != nullptr;
}

void execute(ReplayState& state, const CmdBindTransformFeedbackBuffers& command) {
  // Draws of a feedback that has ended have been flushed, and ranges must not change while it is active.
  for (std::size_t i = 0; i < command.bindings.size(); ++i) {
    const FeedbackBinding& binding = command.bindings[i];
    raster::XfbBuffer& out = state.feedback.buffer[command.first + i];
    out = {};
    if (!binding.buffer || !binding.buffer->data) continue;
    out.size = binding.buffer->resolve_range(binding.offset, binding.size);
    if (out.size) out.data = binding.buffer->data + binding.offset;
  }
}

void execute(ReplayState& state, const CmdBeginTransformFeedback& command) {
  for (raster::XfbBuffer& buffer : state.feedback.buffer) buffer.offset = 0;
  for (std::size_t i = 0; i < command.counters.size(); ++i) {
    std::uint32_t value = 0;
    if (read_counter(command.counters[i], value)) state.feedback.buffer[command.first + i].offset = value;
  }
  state.draw.feedback = &state.feedback;
}

void execute(ReplayState& state, const CmdEndTransformFeedback& command) {
  flush_pass(state);
  state.draw.feedback = nullptr;
  for (std::size_t i = 0; i < command.counters.size(); ++i) {
    const auto value = static_cast<std::uint32_t>(state.feedback.buffer[command.first + i].offset);
    if (std::byte* bytes = counter_of(command.counters[i])) std::memcpy(bytes, &value, sizeof(value));
  }
}

}  // namespace vitrine::icd

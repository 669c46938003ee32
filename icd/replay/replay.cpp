// The loop over recorded commands.
#include "icd/replay/replay.h"

#include "icd/object/sync.h"
#include "icd/record/command_buffer.h"

namespace vitrine::icd {
namespace {

using Executor = void (*)(ReplayState&, const void*);

template <class T>
void execute_erased(ReplayState& state, const void* command) {
  execute(state, *static_cast<const T*>(command));
}

constexpr Executor kExecutors[] = {
#define VITRINE_COMMAND(name) execute_erased<Cmd##name>,
#include "icd/record/commands.def"
};

/// A command buffer starts with nothing bound, and nothing that an earlier one bound may be touched again.
void forget_bindings(ReplayState& state) {
  state.graphics.pipeline = state.compute.pipeline = nullptr;
  state.graphics.sets.fill(nullptr);
  state.compute.sets.fill(nullptr);
  state.vertex_buffers.fill({});
  state.indices = {};
  state.draw = {};
  state.draw.fault = &state.fault;
  state.counters = {};
  state.suppressed = false;
  state.feedback = {};
  state.dirty = kDirtyAll;
}

}  // namespace

void replay_commands(ReplayState& state, const CommandBuffer& buffer) {
  for (const CommandHeader* header = buffer.arena.first(); header; header = header->next) {
    kExecutors[header->type](state, header->command());
    if (state.fault.raised.load(std::memory_order_relaxed)) return;
  }
}

VkResult replay(Device& device, const CommandBuffer& buffer) noexcept {
  ReplayState& state = *device.replay;
  const char* reason = nullptr;
  try {
    forget_bindings(state);
    replay_commands(state, buffer);
    flush_pass(state);
  } catch (const std::bad_alloc&) {
    reason = "out of host memory while commands ran";
  } catch (...) {
    reason = "internal failure while commands ran";
  }
  state.pass.reset();
  state.instance = nullptr;
  if (state.fault.raised.load()) reason = state.fault.message.c_str();
  if (!reason) return VK_SUCCESS;
  lose_device(device, reason);
  return VK_ERROR_DEVICE_LOST;
}

void prepare_replay(Device& device) {
  const std::lock_guard lock(device.sync_mutex);
  if (!device.replay)
    device.replay = std::allocate_shared<ReplayState>(HostAllocator<ReplayState>(device.memory), device);
}

void execute(ReplayState& state, const CmdExecuteCommands& command) {
  for (const CommandBuffer* buffer : command.buffers) replay_commands(state, *buffer);
}

}  // namespace vitrine::icd

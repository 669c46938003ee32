// The loop over recorded commands.
#include "icd/replay/replay.h"

#include "glass/bug/capture.h"
#include "glass/debug/command_watch.h"
#include "glass/digest.h"
#include "glass/place.h"
#include "glass/session.h"
#include "glass/timeline.h"
#include "icd/edge/diagnostics.h"
#include "icd/object/sync.h"
#include "icd/record/command_buffer.h"
#include "icd/replay/captured_replay.h"
#include "icd/replay/debug_writes.h"
#include "icd/replay/digested_replay.h"
#include "icd/replay/sync_notes.h"
#include "icd/replay/texel_events.h"
#include "icd/replay/timed_replay.h"
#include "icd/replay/written.h"

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

/// What the shadow of device memory is told of a command; most write nothing.
template <class T>
void note_erased(ReplayState& state, const void* command) {
  if constexpr (requires(const T& typed) { note_written(state, typed); })
    note_written(state, *static_cast<const T*>(command));
}

constexpr Executor kNotes[] = {
#define VITRINE_COMMAND(name) note_erased<Cmd##name>,
#include "icd/record/commands.def"
};

/// What watched texels are told of a command.
template <class T>
void note_texels_erased(ReplayState& state, const void* command) {
  if constexpr (requires(const T& typed) { note_texels(state, typed); })
    note_texels(state, *static_cast<const T*>(command));
}

constexpr Executor kTexelNotes[] = {
#define VITRINE_COMMAND(name) note_texels_erased<Cmd##name>,
#include "icd/record/commands.def"
};

/// What the tool sync is told of a command.
template <class T>
void note_sync_erased(ReplayState& state, const void* command) {
  if constexpr (requires(const T& typed) { note_sync(state, typed); })
    note_sync(state, *static_cast<const T*>(command));
}

constexpr Executor kSyncNotes[] = {
#define VITRINE_COMMAND(name) note_sync_erased<Cmd##name>,
#include "icd/record/commands.def"
};

/// What the debugger is told of a command.
template <class T>
void note_debug_erased(ReplayState& state, const void* command) {
  if constexpr (requires(const T& typed) { note_debug(state, typed); })
    note_debug(state, *static_cast<const T*>(command));
}

constexpr Executor kDebugNotes[] = {
#define VITRINE_COMMAND(name) note_debug_erased<Cmd##name>,
#include "icd/record/commands.def"
};

/// One command of a timeline, or of digests.
void run_command(ReplayState& state, const CommandHeader& header) {
  kExecutors[header.type](state, header.command());
  if (shadows_memory(state)) kNotes[header.type](state, header.command());
  if (watches_texels(state)) kTexelNotes[header.type](state, header.command());
  if (follows_hazards(state)) kSyncNotes[header.type](state, header.command());
  if (tells_debugger(state)) kDebugNotes[header.type](state, header.command());
}

void forget_descriptor_buffers(ReplayState& state) {
  for (BindPoint* const point : {&state.graphics, &state.compute}) {
    point->addresses.fill(0);
    point->in_buffers = false;
  }
  state.descriptor_buffers.fill(0);
}

#ifdef VK_EXT_shader_object
/// Draws by shader objects need no state that has no effect on them, and see none of earlier command buffers; those by
/// pipelines have all that is dynamic set in their own.
void forget_shaders(ReplayState& state) {
  state.shaders = {};
  state.dynamic = {};
}
#endif

/// A command buffer starts with nothing bound, and nothing that an earlier one bound may be touched again.
void forget_bindings(ReplayState& state) {
  state.graphics.pipeline = state.compute.pipeline = nullptr;
  state.graphics.sets.fill(nullptr);
  state.compute.sets.fill(nullptr);
  if (state.device.described) forget_descriptor_buffers(state);
#ifdef VK_EXT_shader_object
  if (state.device.features.test(Feature::shaderObject)) forget_shaders(state);
#endif
  state.vertex_buffers.fill({});
  state.indices = {};
  state.draw = {};
  state.draw.fault = &state.fault;
  state.counters = {};
  state.profiled = nullptr;
  state.suppressed = false;
  state.feedback = {};
  state.dirty = kDirtyAll;
}

/// The calls that lead to a place in a shader, innermost first.
std::vector<DeviceLoss::Call> calls_to(const spirv::SourceInfo* sources, std::uint32_t place) {
  std::vector<DeviceLoss::Call> calls;
  for (const glass::Frame& frame : glass::frames_of(sources, place)) {
    std::string text = calls.empty() ? "in" : "called from";
    if (!frame.function.empty()) text.append(" function ").append(frame.function);
    if (const std::string where = glass::to_text(frame); !where.empty()) text.append(" at ").append(where);
    calls.push_back({std::move(text), frame.line});
  }
  return calls;
}

/// What the application is told: of a shader that did not end, or the other reason.
DeviceLoss loss_of(const spirv::Fault& fault, const char* reason) noexcept {
  try {
    if (!fault.raised.load()) return {reason, 0, {}};
    return {fault.message, fault.spirv_id, calls_to(fault.sources.get(), fault.place), true};
  } catch (const std::bad_alloc&) {
    return {};
  }
}

}  // namespace

void replay_commands(ReplayState& state, const CommandBuffer& buffer) {
  if (state.observed && glass::has_timeline()) return replay_timed(state, buffer, run_command);
  if (state.observed && glass::has_digest()) return replay_digested(state, buffer, run_command);
  if (state.observed && glass::bug::captures()) return replay_captured(state, buffer, run_command);
  const bool shadows = shadows_memory(state), watches = watches_texels(state), follows = follows_hazards(state);
  const bool debugs = tells_debugger(state);
  for (const CommandHeader* header = buffer.arena.first(); header; header = header->next) {
    kExecutors[header->type](state, header->command());
    if (shadows) kNotes[header->type](state, header->command());
    if (watches) kTexelNotes[header->type](state, header->command());
    if (follows) kSyncNotes[header->type](state, header->command());
    if (debugs) kDebugNotes[header->type](state, header->command());
    if (state.fault.raised.load(std::memory_order_relaxed)) return;
  }
}

VkResult replay(Device& device, const CommandBuffer& buffer) noexcept {
  ReplayState& state = *device.replay;
  const char* reason = nullptr;
  glass::Span span("commands", "command buffer");
  try {
    if (span.on()) span.describe(name_of(device.physical_device.instance, ref(buffer)));
    forget_bindings(state);
    if (state.observed) state.observed->command_buffer = ref(buffer);
    forget_push_constants(state);
    replay_commands(state, buffer);
    flush_pass(state);
  } catch (const std::bad_alloc&) {
    reason = "out of host memory while commands ran";
  } catch (...) {
    reason = "internal failure while commands ran";
  }
  state.pass.reset();
  state.instance = nullptr;
  state.rendering = nullptr;
  if (!reason && !state.fault.raised.load()) return VK_SUCCESS;
  DeviceLoss loss = loss_of(state.fault, reason);
  glass::bug::Captures* const captures = glass::bug::captures();
  if (captures && loss.of_shader) captures->lost(&device, loss.reason);
  lose_device(device, std::move(loss));
  return VK_ERROR_DEVICE_LOST;
}

void prepare_replay(Device& device) {
  const std::lock_guard lock(device.sync_mutex);
  if (device.replay) return;
  device.replay = std::allocate_shared<ReplayState>(HostAllocator<ReplayState>(device.memory), device);
  if (glass::session().idle()) return;
  device.replay->observed = std::make_shared<ObservedReplay>();
  device.replay->observed->shadows_memory = glass::session().shadows_memory();
  device.replay->observed->hazards = glass::sync::hazards_of(&device);
  device.replay->observed->debugger = glass::debug::command_watch();
  device.replay->observed->every_fragment = glass::session().needs_every_fragment();
  glass::pixel::Pixels* const pixels = device.replay->observed->pixels = glass::pixel::pixels();
  if (pixels && pixels->primitive())
    device.replay->observed->primitives = std::make_unique<glass::pixel::PrimitiveObserver>(*pixels);
}

void execute(ReplayState& state, const CmdExecuteCommands& command) {
  // "the secondary command buffer inherits no state", and that of the primary one "is undefined after" it (Vulkan
  // 1.3.239, Command Buffers).
  for (const CommandBuffer* buffer : command.buffers) {
    forget_push_constants(state);
    replay_commands(state, *buffer);
  }
  forget_push_constants(state);
}

}  // namespace vitrine::icd

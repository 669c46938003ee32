// See captured_replay.h. Passes are flushed around such a command, so that attachments hold what the commands before
// have drawn, and what this one has.
#include "icd/replay/captured_replay.h"

#include "glass/bug/capture.h"
#include "icd/record/command_buffer.h"
#include "icd/replay/captured_command.h"
#include "icd/replay/observed_replay.h"

namespace vitrine::icd {
namespace {

using glass::bug::Bug;

void capture(ReplayState& state, const CommandHeader& header, void (*run)(ReplayState&, const CommandHeader&)) {
  glass::bug::Captures& captures = *glass::bug::captures();
  const ObservedReplay& observed = *state.observed;
  if (state.pass) flush_pass(state);
  link_shaders(state);
  for (BindPoint* const point : {&state.graphics, &state.compute})
    if (point->pipeline) read_descriptor_buffers(state, *point);
  auto bug = std::make_unique<Bug>();
  bug->device = state.device.physical_device.properties.deviceName;
  bug->command_name = observed.name;
  bug->submission = observed.submission;
  bug->command_number = observed.command;
  bug->labels = open_labels(observed);
  CapturedObjects objects(state.device, observed.shadows_memory, *bug);
  const std::string problem = describe_captured(state, header, objects, *bug);
  if (!problem.empty()) {
    captures.refuse(observed.submission, observed.command, problem);
    return run(state, header);
  }
  objects.take_before(state.observed->snapshots);
  captures.begin(&state.device, std::move(bug));
  run(state, header);
  if (state.pass) flush_pass(state);
  if (state.fault.raised.load(std::memory_order_relaxed)) return;  // it is lost, and stays the one that is running
  objects.take_after();
  captures.done(&state.device);
}

}  // namespace

void replay_captured(ReplayState& state, const CommandBuffer& buffer, void (*run)(ReplayState&, const CommandHeader&)) {
  const glass::bug::Captures& captures = *glass::bug::captures();
  ObservedReplay& observed = *state.observed;
  for (const CommandHeader* header = buffer.arena.first(); header; header = header->next) {
    const auto type = static_cast<CommandType>(header->type);
    if (type == CommandType::kBeginRendering)
      observed.captured_rendering = static_cast<const CmdBeginRendering*>(header->command());
    if (is_captured(type) && !state.suppressed && captures.wants(observed.submission, observed.command))
      capture(state, *header, run);
    else
      run(state, *header);
    if (state.fault.raised.load(std::memory_order_relaxed)) return;
  }
}

}  // namespace vitrine::icd

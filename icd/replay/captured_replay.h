// Replay for bug files (glass/bug/capture.h): each draw or dispatch that may become one is captured before it runs, and
// done before the next one begins.
#pragma once

#include "icd/record/command_arena.h"
#include "icd/replay/replay.h"

namespace vitrine::icd {

/// Runs the commands of a buffer. `run`: does one.
void replay_captured(ReplayState& state, const CommandBuffer& buffer, void (*run)(ReplayState&, const CommandHeader&));

}  // namespace vitrine::icd

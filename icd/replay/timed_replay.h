// Replay for a timeline (glass/timeline.h): each command is done before the next one begins.
#pragma once

#include "icd/record/command_arena.h"
#include "icd/replay/replay.h"

namespace vitrine::icd {

/// Runs the commands of a buffer and notes when each ran. `run`: does one.
void replay_timed(ReplayState& state, const CommandBuffer& buffer, void (*run)(ReplayState&, const CommandHeader&));

}  // namespace vitrine::icd

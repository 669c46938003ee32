// Replay for a timeline (glass/timeline.h): each command is done before the next one begins.
#pragma once

#include <string_view>

#include "icd/record/command_arena.h"
#include "icd/replay/replay.h"

namespace vitrine::icd {

/// Runs the commands of a buffer and notes when each ran. `run`: does one.
void replay_timed(ReplayState& state, const CommandBuffer& buffer, void (*run)(ReplayState&, const CommandHeader&));

/// Whether a command only tells observers where they are.
bool is_for_observers(CommandType type);
/// Whether a command of this name does something that takes time: what binds and sets does not.
bool is_work(std::string_view name);

}  // namespace vitrine::icd

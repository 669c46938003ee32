// What transfers write to buffers, told to the debugger (glass/debug/command_watch.h). Nothing of it is called where
// nobody debugs.
#pragma once

#include "icd/replay/observed_replay.h"

namespace vitrine::icd {

inline bool tells_debugger(const ReplayState& state) { return state.observed && state.observed->debugger; }

// After a command of that kind has been replayed.
void note_debug(ReplayState& state, const CmdCopyBuffer& command);
void note_debug(ReplayState& state, const CmdUpdateBuffer& command);
void note_debug(ReplayState& state, const CmdFillBuffer& command);

}  // namespace vitrine::icd

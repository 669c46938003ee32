// Replay for digests of memory (glass/digest.h): each command is done before the next one begins.
#pragma once

#include "icd/record/command_arena.h"
#include "icd/replay/replay.h"

namespace vitrine::icd {

/// Runs the commands of a buffer and tells what memory holds after each. `run`: does one.
void replay_digested(ReplayState& state, const CommandBuffer& buffer, void (*run)(ReplayState&, const CommandHeader&));
/// What it holds when a submission begins.
void digest_submission(ReplayState& state) noexcept;

}  // namespace vitrine::icd

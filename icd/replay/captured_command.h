// What a draw or dispatch that is about to run has bound, as a Bug (glass/bug/bug.h).
#pragma once

#include <string>

#include "icd/record/command_arena.h"
#include "icd/replay/captured_objects.h"

namespace vitrine::icd {

/// Fills all but the contents of memory. Why it cannot be captured; empty: it can.
std::string describe_captured(ReplayState& state, const CommandHeader& header, CapturedObjects& objects,
                              glass::bug::Bug& bug);

/// Whether a command is a draw or a dispatch.
bool is_captured(CommandType type);

}  // namespace vitrine::icd

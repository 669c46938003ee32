// The debugger as a tool.
#pragma once

#include <memory>

#include "glass/debug/engine.h"
#include "glass/tool.h"

namespace vitrine::glass::debug {

/// Which program is shown: one that has been rewritten only as far as it must be, in front of each wave, or the one
/// that always runs.
enum class Shown : std::uint8_t { kRehearsal, kExact };

/// Of an engine that outlives it.
std::unique_ptr<Tool> make_tool(Engine& engine, Shown shown = Shown::kRehearsal);

}  // namespace vitrine::glass::debug

// The debugger as a tool.
#pragma once

#include <memory>

#include "glass/debug/engine.h"
#include "glass/tool.h"

namespace vitrine::glass::debug {

/// Of an engine that outlives it.
std::unique_ptr<Tool> make_tool(Engine& engine);

}  // namespace vitrine::glass::debug

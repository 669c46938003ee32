// The debugger's prompt: a line of text in, text out. docs/glass/debug.md has the commands.
#pragma once

#include <string>
#include <string_view>

#include "glass/debug/engine.h"

namespace vitrine::glass::debug {

/// Does what a line says, of a stopped engine or, as far as that needs none, of a running one.
std::string command(Engine& engine, std::string_view line);

/// What a person is told at a stop.
std::string stop_text(Engine& engine, const Stop& stop);

}  // namespace vitrine::glass::debug

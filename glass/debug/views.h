// What the prompt shows of a stopped engine.
#pragma once

#include <string>
#include <vector>

#include "glass/debug/engine.h"

namespace vitrine::glass::debug {

/// Of the invocation in focus; empty: there is none.
std::vector<CodeFrame> focus_frames(Engine& engine);
/// An expression in a lane and frame.
base::Result<Value> evaluate_in(Engine& engine, const std::string& text, std::size_t lane, std::size_t frame);

std::string where_text(Engine& engine);
std::string value_text(Engine& engine, const std::string& expression);
std::string table_of(Engine& engine, const std::string& expression);
std::string lanes_text(Engine& engine);
std::string locals_text(Engine& engine);
std::string globals_text(Engine& engine);
std::string breakpoints_text(Engine& engine);
std::string backtrace_text(Engine& engine);
/// Around a line; 0: around the one in focus.
std::string list_text(Engine& engine, std::uint32_t line);
std::string disassembly_text(Engine& engine);
std::string who_wrote_text(Engine& engine, const std::string& expression);
/// Watches it from now on; the number of the watch.
base::Result<int> watch_in(Engine& engine, const std::string& expression, std::size_t lane, std::size_t frame,
                           std::string owner);
std::string watch_text(Engine& engine, const std::string& expression);
/// Gives what `target` names the value of an expression; that value.
base::Result<Value> set_in(Engine& engine, const std::string& target, const std::string& expression, std::size_t lane,
                           std::size_t frame);
/// "x = 3".
std::string set_text(Engine& engine, const std::string& assignment);

}  // namespace vitrine::glass::debug

// The options of the subcommands for bug files, through CLI11.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "glass/cli/bug_commands.h"

namespace vitrine::glass::cli {

struct BugOptions {
  ReplayOptions replay;
  ReduceOptions reduce;
  ExportOptions exported;
};

/// Runs a command line of `vitrine`, without the program's name.
using Main = int (*)(const std::vector<std::string>& words);

/// Adds replay, reduce and export. What outlives the call: `options`, `code`.
void add_bug_commands(CLI::App& app, BugOptions& options, Main main, int& code);

}  // namespace vitrine::glass::cli

// Bug files for the subcommands: read and written, replayed under tools, without names.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "glass/bug/bug.h"
#include "glass/cli/process.h"
#include "glass/finding.h"

namespace vitrine::glass::cli {

/// The program that replays, beside the command.
std::filesystem::path replayer();

/// The bug in the file; says what is wrong with it if it is none.
std::optional<bug::Bug> read_bug(const std::string& file);
/// Says why it cannot be written (and gives false).
bool write_bug(const std::string& file, const bug::Bug& bug);

/// Runs a program on this driver without a word, unlike run_application().
Ending run_quietly(const std::vector<std::string>& command, Environment environment);

/// Takes names, labels and the debug information of shaders out of it. False, after saying so: spirv-opt of
/// spirv-tools is needed for that, and is not there.
bool remove_names(bug::Bug& bug);

}  // namespace vitrine::glass::cli

// An application on this driver, with tools.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "glass/cli/commands.h"
#include "glass/cli/process.h"

namespace vitrine::glass::cli {

/// The manifest of the driver that lies beside the command: in the build tree, in the install tree or in the same
/// folder. Empty: there is none.
std::filesystem::path driver_manifest(const std::filesystem::path& command);

/// Runs it on this driver. Says whatever is not as usual: that it could not be started, failed, was ended by a signal.
/// Ending::error: it did not run.
Ending run_application(const CommandLine& application, Environment environment = {},
                       const Interrupted& interrupted = {});

/// The tool is in tools.def.
bool is_tool(std::string_view name);
/// As is_tool(), and says so if it is not.
bool demand_tool(const std::string& name);

}  // namespace vitrine::glass::cli

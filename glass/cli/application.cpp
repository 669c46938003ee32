// Finds the driver beside the command and runs an application on it.
#include "glass/cli/application.h"

#include <string.h>

#include <algorithm>
#include <cstdlib>

#include "glass/cli/install.h"
#include "glass/cli/say.h"

namespace vitrine::glass::cli {
namespace fs = std::filesystem;
namespace {

constexpr const char* kTools[] = {
#define VITRINE_TOOL(name, make, effect) #name,
#include "glass/tools.def"
#undef VITRINE_TOOL
};

#ifdef __aarch64__
constexpr const char* kManifest = "vitrine_icd.aarch64.json";
#else
constexpr const char* kManifest = "vitrine_icd.x86_64.json";
#endif

}  // namespace

fs::path driver_manifest(const fs::path& command) {
  std::error_code error;
  const fs::path folder = command.parent_path();
  for (const char* const place : {"../icd", kDriverFolder, "."}) {
    const fs::path manifest = (folder / place / kManifest).lexically_normal();
    if (fs::exists(manifest, error)) return manifest;
  }
  return {};
}

Ending run_application(const CommandLine& application, Environment environment, const Interrupted& interrupted) {
  std::error_code error;
  const fs::path command = fs::read_symlink("/proc/self/exe", error), manifest = driver_manifest(command);
  if (manifest.empty()) {
    say("no driver lies beside " + command.string());
    return {"no driver", kCouldNotRun, 0};
  }
  environment["VK_DRIVER_FILES"] = manifest;
  environment["VK_ICD_FILENAMES"] = manifest;  // what loaders before 1.3.207 read
  Ending ending = run_to_end(application, environment, interrupted);
  if (!ending.error.empty()) {
    say(application[0] + " cannot be started: " + ending.error);
    ending.code = kCouldNotRun;
  } else if (ending.signal) {
    say(application[0] + " was ended by signal " + std::to_string(ending.signal) + " (" + ::strsignal(ending.signal) +
        ")");
  } else if (ending.code) {
    say(application[0] + " ended with exit code " + std::to_string(ending.code));
  }
  return ending;
}

bool is_tool(std::string_view name) {
  return std::find(std::begin(kTools), std::end(kTools), name) != std::end(kTools);
}

bool demand_tool(const std::string& name) {
  if (is_tool(name)) return true;
  std::string known;
  for (const char* const tool : kTools) known += std::string(known.empty() ? "" : ", ") + tool;
  say("the tool '" + name + "' is not there (yet); there are: " + known);
  return false;
}

}  // namespace vitrine::glass::cli

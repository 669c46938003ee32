// vitrine check: runs an application with tools that find faults, gathers what all of its processes found, and fails if
// there is anything.
#include <algorithm>
#include <cstdio>

#include "glass/cli/annotations.h"
#include "glass/cli/application.h"
#include "glass/cli/commands.h"
#include "glass/cli/files.h"
#include "glass/cli/findings.h"
#include "glass/cli/places.h"
#include "glass/cli/say.h"
#include "glass/report/report.h"

namespace vitrine::glass::cli {
namespace {

constexpr const char* kNothingChecked =
    "nothing was checked: no process of the application used this driver (the loader, libvulkan.so.1, finds it by "
    "VK_DRIVER_FILES, which the application has to leave as it is)";
constexpr const char* kDisassembly =
    "lines of .spvasm are those of shaders without debug information; compiled with it (glslangValidator -g, glslc -g, "
    "dxc -fspv-debug=vulkan-with-source), findings lie at lines of their sources";

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ",") + word;
  return text;
}

/// "1 error", "2 processes".
std::string amount(std::size_t number, const std::string& what) {
  return std::to_string(number) + " " + what + (number == 1 ? "" : what.ends_with('s') ? "es" : "s");
}

/// The findings of all reports in the folder. False: one of them could not be read.
bool gather(const std::vector<std::filesystem::path>& reports, std::vector<Finding>& findings) {
  bool good = true;
  for (const std::filesystem::path& path : reports) {
    std::string error = "it cannot be opened";
    const std::optional<std::string> text = read_file(path);
    if (text && read_findings(*text, findings, error)) continue;
    say("the report of process " + path.stem().string() + " cannot be read: " + error);
    good = false;
  }
  findings = folded(std::move(findings));
  quote_files(findings);
  return good;
}

std::size_t count_of(const std::vector<Finding>& findings, Severity severity) {
  return static_cast<std::size_t>(std::count_if(
      findings.begin(), findings.end(), [&](const Finding& finding) { return finding.rule->severity == severity; }));
}

/// Asks for files of the commands in which something is found.
void ask_for_bugs(const std::string& name, Environment& environment) {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::absolute(name, error);
  std::filesystem::create_directories(folder, error);
  environment["VITRINE_CAPTURE"] = "finding,lost";
  environment["VITRINE_CAPTURE_FILE"] = folder / "bug-%s-%c.vitrine";
}

/// Errors and warnings; notes are what shaders say.
std::size_t summarize(const std::vector<Finding>& findings, std::size_t processes) {
  const std::size_t errors = count_of(findings, Severity::kError), warnings = count_of(findings, Severity::kWarning);
  std::string text = errors + warnings == 0 ? "no findings" : "";
  if (errors) text += amount(errors, "error");
  if (warnings) text += (errors ? ", " : "") + amount(warnings, "warning");
  say(text + " in " + amount(processes, "process"));
  return errors + warnings;
}

}  // namespace

int check(const CheckOptions& options) {
  if (options.tools.empty()) {
    say("no tool that finds faults is there (yet)");
    return kCouldNotRun;
  }
  for (const std::string& tool : options.tools) {
    if (!demand_tool(tool)) return kCouldNotRun;
  }
  const TemporaryFolder folder;
  if (folder.path().empty()) return kCouldNotRun;
  Environment environment{{"VITRINE_TOOLS", joined(options.tools)}, {"VITRINE_REPORT", folder.path() / "%p.json"}};
  if (!options.invocations.empty()) environment["VITRINE_PRINTF_FILTER"] = options.invocations;
  if (!options.bugs.empty()) ask_for_bugs(options.bugs, environment);
  const Ending ending = run_application(options.application, environment);
  if (!ending.error.empty()) return kCouldNotRun;
  const auto reports = folder.files(".json");
  if (reports.empty()) say(kNothingChecked);
  std::vector<Finding> findings;
  const bool good = gather(reports, findings);
  if (!options.quiet) std::fputs(to_report(ReportFormat::kText, findings).c_str(), stderr);
  if (options.annotations) std::fputs(annotations(in_repository(findings)).c_str(), stderr);
  const bool written = write_reports({options.sarif, options.json, options.code_quality}, findings);
  if (any_in_disassembly(findings)) say(kDisassembly);
  const bool found = !reports.empty() && summarize(findings, reports.size()) != 0;
  if (ending.code) return ending.code;
  if (found) return kFound;
  return good && written && !reports.empty() ? 0 : kCouldNotRun;
}

}  // namespace vitrine::glass::cli

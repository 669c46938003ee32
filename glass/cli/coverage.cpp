// vitrine coverage: runs an application with the tool that covers, adds up what its processes covered, and fails if
// that is too little.
#include <cstdio>

#include "glass/cli/application.h"
#include "glass/cli/commands.h"
#include "glass/cli/files.h"
#include "glass/cli/say.h"
#include "glass/cli/tracefiles.h"

namespace vitrine::glass::cli {
namespace {

/// Adds a tracefile, or says why it cannot.
bool add_file(const std::filesystem::path& path, const std::string& name, Coverage& sum) {
  std::string error = "it cannot be opened";
  const std::optional<std::string> text = read_file(path);
  if (text && add_tracefile(*text, sum, error)) return true;
  say(name + " cannot be read: " + error);
  return false;
}

std::string part_text(const char* what, const CoverageSummary::Part& part) {
  char percent[16];
  std::snprintf(percent, sizeof percent, "%.1f", part.percent());
  return std::to_string(part.hit) + " of " + std::to_string(part.found) + " " + what + " (" + percent + " %)";
}

/// False: less than what was demanded.
bool enough(const Coverage& sum, const CoverageOptions& options) {
  const CoverageSummary summary = summary_of(sum);
  say("ran " + part_text("lines", summary.lines) + ", " + part_text("functions", summary.functions) + ", " +
      part_text("branches", summary.branches));
  if (!options.least_lines || summary.lines.percent() >= *options.least_lines) return true;
  say("fewer lines ran than --min-lines demands");
  return false;
}

}  // namespace

int coverage(const CoverageOptions& options) {
  const TemporaryFolder folder;
  if (!demand_tool("coverage") || folder.path().empty()) return kCouldNotRun;
  Environment environment{{"VITRINE_TOOLS", "coverage"}, {"VITRINE_COVERAGE", folder.path() / "%p.info"}};
  if (!options.sources.empty()) environment["VITRINE_SOURCES"] = options.sources;
  const Ending ending = run_application(options.application, environment);
  if (!ending.error.empty()) return kCouldNotRun;
  const auto files = folder.files(".info");
  if (files.empty()) say("nothing was covered: no process of the application ran a shader on this driver");
  Coverage sum;
  bool good = !files.empty();
  if (options.append && std::filesystem::exists(options.output)) good &= add_file(options.output, options.output, sum);
  for (const auto& path : files) good &= add_file(path, "the coverage of process " + path.stem().string(), sum);
  const bool written = good && write_file(options.output, to_lcov(sum));
  const bool covered = enough(sum, options);
  if (ending.code) return ending.code;
  if (!written) return kCouldNotRun;
  return covered ? 0 : kFound;
}

}  // namespace vitrine::glass::cli

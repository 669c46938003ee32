// vitrine count: runs an application with the tool that counts and adds up what its processes counted. vitrine diff:
// compares two such files.
#include <cstdio>

#include "glass/cli/application.h"
#include "glass/cli/commands.h"
#include "glass/cli/counters.h"
#include "glass/cli/files.h"
#include "glass/cli/say.h"

namespace vitrine::glass::cli {
namespace {

/// The counters of all files, added up. Nothing: one cannot be read.
std::optional<std::string> sum_of(const std::vector<std::filesystem::path>& files) {
  std::string sum = "{}";
  for (const std::filesystem::path& path : files) {
    const std::optional<std::string> text = read_file(path);
    std::optional<std::string> next = text ? sum_of_counters(sum, *text) : std::nullopt;
    if (!next) {
      say("the counters of process " + path.stem().string() + " cannot be read");
      return std::nullopt;
    }
    sum = std::move(*next);
  }
  return sum;
}

double value_of(const Counters& counters, const std::string& name) {
  const auto entry = counters.find(name);
  return entry == counters.end() ? 0 : entry->second;
}

/// What pipelines drew, and how often fragments lie on each other.
void print_draws(const Counters& counters) {
  const std::vector<std::string> pipelines = names_in_group(counters, "pipelines");
  if (pipelines.empty()) return;
  std::fprintf(stdout, "\n%12s %12s %12s %12s  pipeline\n", "rasterized", "fragments", "shaded", "passed");
  for (const std::string& name : pipelines) {
    const auto value = [&](const char* counter) { return value_of(counters, "pipelines/" + name + "/" + counter); };
    std::fprintf(stdout, "%12.0f %12.0f %12.0f %12.0f  %s\n", value("primitives/rasterized"),
                 value("fragments/generated"), value("shading/invocations"), value("fragments/passed"), name.c_str());
  }
  const double pixels = value_of(counters, "total/shading/pixels");
  if (pixels == 0) return;
  std::fprintf(stdout, "\noverdraw: %.2f fragments shaded per pixel of a pass that has any, %.0f at most\n",
               value_of(counters, "total/shading/invocations") / pixels,
               value_of(counters, "total/shading/mostOverdraw"));
}

/// A table of the totals and of the dearest shaders.
void print_table(const Counters& counters) {
  std::fprintf(stdout, "%18s  counter\n", "total");
  for (const auto& [name, value] : counters)
    if (name.starts_with("total/")) std::fprintf(stdout, "%18.0f  %s\n", value, name.c_str() + 6);
  constexpr std::size_t kShown = 10;
  const auto dearest = dearest_shaders(counters);
  std::fprintf(stdout, "\n%18s  shader\n", "instructions");
  for (std::size_t i = 0; i < std::min(dearest.size(), kShown); ++i)
    std::fprintf(stdout, "%18.0f  %s\n", dearest[i].second, dearest[i].first.c_str());
  if (dearest.size() > kShown) std::fprintf(stdout, "%18s  %zu more\n", "", dearest.size() - kShown);
}

std::optional<Counters> counters_of(const std::string& file) {
  const std::optional<std::string> text = read_file(file);
  std::optional<Counters> counters = text ? read_counters(*text) : std::nullopt;
  if (!counters) say(file + (text ? " is no file of counters" : " cannot be read"));
  return counters;
}

void print(const CounterChange& change) {
  std::fprintf(stdout, "%14.0f %14.0f %+9.2f %%  %s\n", change.before, change.after, change.growth(),
               change.name.c_str());
}

Environment environment_of(const CountOptions& options, const std::filesystem::path& folder) {
  Environment environment{{"VITRINE_TOOLS", "count"}, {"VITRINE_COUNTS", folder / "%p.json"}};
  if (options.lines) environment.emplace("VITRINE_COUNT_LINES", "1");
  if (options.draws) environment.emplace("VITRINE_COUNT_DRAWS", "1");
  return environment;
}

}  // namespace

int count(const CountOptions& options) {
  const TemporaryFolder folder;
  if (!demand_tool("count") || folder.path().empty()) return kCouldNotRun;
  const Ending ending = run_application(options.application, environment_of(options, folder.path()));
  if (!ending.error.empty()) return kCouldNotRun;
  const auto files = folder.files(".json");
  if (files.empty()) say("nothing was counted: no process of the application used this driver");
  const std::optional<std::string> sum = sum_of(files);
  if (files.empty() || !sum) return ending.code ? ending.code : kCouldNotRun;
  if (const auto counters = read_counters(*sum)) {
    print_table(*counters);
    print_draws(*counters);
  }
  if (options.lines) std::fputs(annotated_sources(*sum).c_str(), stdout);
  const bool written = options.output.empty() || write_file(options.output, *sum);
  if (ending.code) return ending.code;
  return written ? 0 : kCouldNotRun;
}

int diff(const DiffOptions& options) {
  const std::optional<Counters> before = counters_of(options.before), after = counters_of(options.after);
  if (!before || !after) return kCouldNotRun;
  std::size_t too_many = 0;
  const std::vector<CounterChange> changed = changes(*before, *after, options.pattern);
  if (!changed.empty()) std::fprintf(stdout, "%14s %14s %11s  counter\n", "before", "after", "growth");
  for (const CounterChange& change : changed) {
    print(change);
    too_many += options.most_growth && change.growth() > *options.most_growth;
  }
  if (changed.empty()) say("no counter differs");
  if (too_many == 0) return 0;
  say(std::to_string(too_many) + (too_many == 1 ? " counter has" : " counters have") + " grown by more than the limit");
  return kFound;
}

}  // namespace vitrine::glass::cli

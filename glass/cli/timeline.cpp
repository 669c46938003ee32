// vitrine timeline: runs an application with the tool that notes when what ran, and makes one file of what its
// processes noted.
#include <nlohmann/json.hpp>

#include "glass/cli/application.h"
#include "glass/cli/commands.h"
#include "glass/cli/files.h"
#include "glass/cli/say.h"

namespace vitrine::glass::cli {
namespace {

using Json = nlohmann::ordered_json;

/// Adds the events of a file. False: it has none.
bool add_events(const std::filesystem::path& path, Json& events) {
  const std::optional<std::string> text = read_file(path);
  Json document = text ? Json::parse(*text, nullptr, false) : Json();
  if (!document.is_object() || !document["traceEvents"].is_array()) {
    say("the timeline of process " + path.stem().string() + " cannot be read");
    return false;
  }
  for (Json& event : document["traceEvents"]) events.push_back(std::move(event));
  return true;
}

}  // namespace

int timeline(const TimelineOptions& options) {
  const TemporaryFolder folder;
  if (!demand_tool("timeline") || folder.path().empty()) return kCouldNotRun;
  const Ending ending = run_application(
      options.application, {{"VITRINE_TOOLS", "timeline"}, {"VITRINE_TIMELINE", folder.path() / "%p.json"}});
  if (!ending.error.empty()) return kCouldNotRun;
  const auto files = folder.files(".json");
  if (files.empty()) say("nothing was noted: no process of the application used this driver");
  Json events = Json::array();
  bool good = !files.empty();
  for (const auto& path : files) good &= add_events(path, events);
  const std::size_t count = events.size();
  const Json document{{"displayTimeUnit", "ms"}, {"traceEvents", std::move(events)}};
  good = good && write_file(options.output, document.dump(0, ' ', false, Json::error_handler_t::replace) + '\n');
  if (good) say(std::to_string(count) + " events in " + options.output + ": https://ui.perfetto.dev opens it");
  if (ending.code) return ending.code;
  return good ? 0 : kCouldNotRun;
}

}  // namespace vitrine::glass::cli

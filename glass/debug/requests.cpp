// See requests.h.
#include "glass/debug/requests.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "glass/debug/commands.h"
#include "glass/debug/views.h"
#include "glass/json_members.h"

namespace vitrine::glass::debug {
namespace {

using nlohmann::json;

json json_of(const Tree& tree) {
  json children = json::array();
  for (const Tree& child : tree.children) children.push_back(json_of(child));
  return {{"name", tree.name}, {"type", tree.type}, {"value", tree.value}, {"children", std::move(children)}};
}

std::string dump(const json& object) { return object.dump(-1, ' ', false, json::error_handler_t::replace); }

json error(const std::string& text) { return {{"error", text}}; }

json run_command(Engine& engine, const json& request) { return {{"text", command(engine, text_of(request, "text"))}}; }

/// Line that a breakpoint is really at; 0: no shader has any so far.
std::uint32_t line_of(const Engine& engine, const Breakpoint& breakpoint) {
  for (const auto& subject : engine.subjects()) {
    const std::vector<std::uint32_t> steps = steps_of(breakpoint, *subject);
    if (!steps.empty()) return subject->place(steps[0]).line;
  }
  return 0;
}

/// Replaces those of the same owner.
json replace(Engine& engine, const json& request, const std::string& owner, Breakpoint::Kind kind) {
  for (auto at = engine.breakpoints().begin(); at != engine.breakpoints().end();) {
    const auto& [number, breakpoint] = *at++;
    if (breakpoint.owner == owner) engine.remove(number);
  }
  json list = json::array();
  const auto rows = request.find("list");
  if (rows == request.end() || !rows->is_array()) return {{"list", list}};
  for (const json& row : *rows) {
    if (!row.is_object()) continue;
    Breakpoint breakpoint;
    breakpoint.kind = kind;
    breakpoint.owner = owner;
    breakpoint.file = text_of(request, "file");
    breakpoint.line = number_of<std::uint32_t>(row, "line");
    breakpoint.function = text_of(row, "name");
    breakpoint.condition = text_of(row, "condition");
    breakpoint.hits_wanted = text_of(row, "hits");
    breakpoint.message = text_of(row, "message");
    const std::uint32_t line = line_of(engine, breakpoint), wanted = breakpoint.line;
    const int number = engine.add(std::move(breakpoint));
    list.push_back({{"number", number}, {"verified", line != 0}, {"line", line != 0 ? line : wanted}});
  }
  return {{"list", std::move(list)}};
}

json set_lines(Engine& engine, const json& request) {
  return replace(engine, request, "lines of " + text_of(request, "file"), Breakpoint::Kind::kLine);
}
json set_functions(Engine& engine, const json& request) {
  return replace(engine, request, "functions", Breakpoint::Kind::kFunction);
}

json placed(Engine& engine, const json&) {
  json list = json::array();
  for (const auto& [number, breakpoint] : engine.breakpoints())
    if (const std::uint32_t line = line_of(engine, breakpoint); line != 0)
      list.push_back({{"number", number}, {"line", line}});
  return {{"list", std::move(list)}};
}

json set_catches(Engine& engine, const json& request) {
  unsigned catches = 0;
  const auto rows = request.find("list");
  if (rows != request.end() && rows->is_array())
    for (const json& row : *rows)
      if (row.is_string()) catches |= catch_of(row.get<std::string>());
  engine.set_catches(catches);
  return json::object();
}

json lanes(Engine& engine, const json&) {
  json list = json::array();
  const Run* run = engine.focus().run.get();
  if (run != nullptr) {
    base::for_each_lane(run->launched, [&](std::size_t lane) {
      list.push_back({{"lane", lane}, {"name", invocation_text(*run, lane)}});
    });
  }
  return {{"list", std::move(list)}};
}

/// The lane that a request names, if it is one.
std::size_t lane_of(Engine& engine, const json& request) {
  const std::uint32_t lane = number_of<std::uint32_t>(request, "lane", static_cast<std::uint32_t>(engine.focus().lane));
  return lane < base::kWaveWidth ? lane : engine.focus().lane;
}

json frames(Engine& engine, const json& request) {
  json list = json::array();
  if (engine.focus().run)
    for (const CodeFrame& frame : frames_at(*engine.focus().run, lane_of(engine, request)))
      list.push_back(
          {{"name", frame.function}, {"file", frame.file}, {"line", frame.place.line}, {"column", frame.place.column}});
  return {{"list", std::move(list)}};
}

json variables(Engine& engine, const json& request) {
  if (!engine.focus().run) return error("nothing has run yet");
  const Run& run = *engine.focus().run;
  const std::size_t lane = lane_of(engine, request), frame = number_of<std::uint32_t>(request, "frame");
  const std::vector<CodeFrame> frames = frames_at(run, lane);
  const FrameNames names(run, frame < frames.size() ? &frames[frame] : nullptr);
  json list = json::array();
  for (const spirv::SourceVariable* variable :
       text_of(request, "which") == "globals" ? names.globals() : names.locals())
    list.push_back(json_of(tree_of(engine.view(run, lane), variable->name, {place_of(*variable), {}})));
  return {{"list", std::move(list)}};
}

json evaluate_text(Engine& engine, const json& request) {
  const std::string text = text_of(request, "text");
  const std::size_t lane = lane_of(engine, request);
  const auto value = evaluate_in(engine, text, lane, number_of<std::uint32_t>(request, "frame"));
  if (!value) return error(value.message());
  return json_of(tree_of(engine.view(*engine.focus().run, lane), text, value.value()));
}

json set_value(Engine& engine, const json& request) {
  const std::string text = text_of(request, "text");
  const std::size_t lane = lane_of(engine, request);
  const auto value = set_in(engine, text, text_of(request, "value"), lane, number_of<std::uint32_t>(request, "frame"));
  if (!value) return error(value.message());
  return json_of(tree_of(engine.view(*engine.focus().run, lane), text, value.value()));
}

/// Replaces those of requests: they are kept where nothing has changed.
json set_watches(Engine& engine, const json& request) {
  const std::string owner = "watches";
  std::vector<int> old;
  for (const auto& [number, watchpoint] : engine.watchpoints())
    if (watchpoint.owner.starts_with(owner)) old.push_back(number);
  json list = json::array();
  const auto rows = request.find("list");
  if (rows != request.end() && rows->is_array()) {
    for (const json& row : *rows) {
      if (!row.is_object()) continue;
      const std::string name = owner + " " + dump(row);
      const auto known =
          std::ranges::find_if(engine.watchpoints(), [&](const auto& one) { return one.second.owner == name; });
      if (known != engine.watchpoints().end()) {
        std::erase(old, known->first);
        list.push_back({{"number", known->first}, {"verified", true}});
        continue;
      }
      const auto number =
          watch_in(engine, text_of(row, "text"), lane_of(engine, row), number_of<std::uint32_t>(row, "frame"), name);
      if (number)
        list.push_back({{"number", number.value()}, {"verified", true}});
      else
        list.push_back({{"verified", false}, {"message", number.message()}});
    }
  }
  for (const int number : old) engine.remove(number);
  return {{"list", std::move(list)}};
}

json source(Engine& engine, const json& request) {
  const std::string name = text_of(request, "file");
  for (const auto& subject : engine.subjects())
    for (const spirv::SourceFile& file : subject->context.sources->files)
      if (file.name == name && !file.text.empty()) return {{"text", file.text}};
  return error("the source is not in a module");
}

json go(Engine& engine, const json& request) {
  const std::string how = text_of(request, "how");
  Motion motion;
  motion.backward = request.value("backward", json()) == json(true);
  if (how == "step")
    motion.kind = Motion::Kind::kStep;
  else if (how == "next")
    motion.kind = Motion::Kind::kNext;
  else if (how == "finish")
    motion.kind = Motion::Kind::kFinish;
  else if (how == "detach")
    motion.kind = Motion::Kind::kDetach;
  else if (how != "continue")
    return error("continue, step, next, finish or detach");
  const std::size_t lane = lane_of(engine, request);
  if (engine.focus().run && (engine.focus().run->launched >> lane & 1) != 0) engine.focus().lane = lane;
  if (!engine.focus().run && motion.kind != Motion::Kind::kDetach) motion = {};
  engine.go(motion);
  return json::object();
}

json pause(Engine& engine, const json&) {
  engine.pause();
  return json::object();
}

struct Row {
  const char* name;
  bool anytime;  ///< needs no shader that waits
  json (*run)(Engine&, const json&);
};
constexpr Row kRows[] = {{"command", false, run_command},
                         {"breakpoints", true, set_lines},
                         {"functions", true, set_functions},
                         {"placed", true, placed},
                         {"catch", true, set_catches},
                         {"lanes", false, lanes},
                         {"frames", false, frames},
                         {"variables", false, variables},
                         {"evaluate", false, evaluate_text},
                         {"set", false, set_value},
                         {"watches", false, set_watches},
                         {"source", true, source},
                         {"go", false, go},
                         {"pause", true, pause}};

json answer(Engine& engine, const json& request, bool stopped) {
  const std::string name = text_of(request, "request");
  for (const Row& row : kRows) {
    if (name != row.name) continue;
    const bool detaches = name == "go" && text_of(request, "how") == "detach";
    return stopped || row.anytime || detaches ? row.run(engine, request) : error("the shader runs");
  }
  return error("there is no request '" + name + "'");
}

constexpr const char* kReasons[] = {"start", "step",    "breakpoint", "break",    "watch",
                                    "end",   "history", "pause",      "exception"};

}  // namespace

std::string answer_to(Engine& engine, const std::string& line, bool stopped) {
  const json request = json::parse(line, nullptr, false);
  json result = request.is_object() ? answer(engine, request, stopped) : error("that is no object of JSON");
  if (request.is_object() && request.contains("id")) result["id"] = request["id"];
  result["going"] = engine.going();
  return dump(result);
}

std::string describe(Engine& engine, const Stop& stop) {
  return dump({{"event", "stopped"},
               {"reason", kReasons[static_cast<std::size_t>(stop.reason)]},
               {"number", stop.number},
               {"lane", engine.focus().lane},
               {"message", stop.text},
               {"text", stop_text(engine, stop)}});
}

}  // namespace vitrine::glass::debug

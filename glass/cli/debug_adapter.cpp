// See debug_adapter.h. https://microsoft.github.io/debug-adapter-protocol/specification
#include "glass/cli/debug_adapter.h"

#include <filesystem>
#include <utility>

#include "glass/json_members.h"

namespace vitrine::glass::cli {
namespace fs = std::filesystem;
namespace {

using nlohmann::json;

/// Frames of an invocation: frameId = lane * kFrames + number + 1.
constexpr std::size_t kFrames = 1024;
/// The editor's numbers of watches: those of the process behind this one, so that they are no breakpoints'.
constexpr std::size_t kWatches = std::size_t{1} << 20;

json failure(const std::string& text) { return {{"error", text}}; }

/// Rows of setBreakpoints as the driver wants them.
json rows_of(const json& breakpoints) {
  json rows = json::array();
  for (const json& row : breakpoints)
    if (row.is_object())
      rows.push_back({{"line", number_of(row, "line")},
                      {"name", text_of(row, "name")},
                      {"condition", text_of(row, "condition")},
                      {"hits", text_of(row, "hitCondition")},
                      {"message", text_of(row, "logMessage")}});
  return rows;
}

json filters() {
  return json::array({{{"filter", "printf"}, {"label", "Messages (printf)"}},
                      {{"filter", "nan"}, {"label", "Operations that make a NaN"}},
                      {{"filter", "findings"}, {"label", "What sanitize and race find"}}});
}

const char* reason_of(const std::string& reason) {
  if (reason == "breakpoint" || reason == "pause") return reason == "pause" ? "pause" : "breakpoint";
  if (reason == "watch") return "data breakpoint";
  return reason == "break" || reason == "exception" ? "exception" : "step";
}

}  // namespace

void DebugAdapter::event(const char* name, json body) {
  wire_.send({{"type", "event"}, {"event", name}, {"body", std::move(body)}});
}

bool DebugAdapter::take(const json& request) {
  const std::string command = text_of(request, "command");
  const auto arguments = request.find("arguments");
  json body = answer(command, arguments != request.end() && arguments->is_object() ? *arguments : json::object());
  json response = {{"type", "response"}, {"command", command}, {"request_seq", number_of(request, "seq")}};
  const bool failed = body.is_object() && body.contains("error");
  response["success"] = !failed;
  if (failed)
    response["message"] = body["error"];
  else
    response["body"] = std::move(body);
  wire_.send(std::move(response));
  if (command == "initialize" && !failed) event("initialized", json::object());
  return !leaving_;
}

json DebugAdapter::answer(const std::string& command, const json& arguments) {
  if (command == "initialize") return initialize(arguments);
  if (command == "launch" || command == "attach") {
    stops_on_entry_ = arguments.value("stopOnEntry", json()) == json(true);
    launched_ = true;
    return json::object();
  }
  if (command == "configurationDone") return configured_ = true, json::object();
  if (command == "setBreakpoints") return set_breakpoints(arguments);
  if (command == "setFunctionBreakpoints") return set_functions(arguments);
  if (command == "setExceptionBreakpoints") return set_exceptions(arguments);
  if (command == "threads") return threads(arguments);
  if (command == "stackTrace") return stack(arguments);
  if (command == "scopes") return scopes(arguments);
  if (command == "variables") return variables(arguments);
  if (command == "evaluate") return evaluate(arguments);
  if (command == "setVariable") return set_variable(arguments);
  if (command == "setExpression") return set_expression(arguments);
  if (command == "dataBreakpointInfo") return data_breakpoint_info(arguments);
  if (command == "setDataBreakpoints") return set_data_breakpoints(arguments);
  if (command == "source") return source(arguments);
  if (command == "exceptionInfo") return exception(arguments);
  if (command == "continue") return move("continue", false, arguments);
  if (command == "next") return move("next", false, arguments);
  if (command == "stepIn") return move("step", false, arguments);
  if (command == "stepOut") return move("finish", false, arguments);
  if (command == "stepBack") return move("next", true, arguments);
  if (command == "reverseContinue") return move("continue", true, arguments);
  if (command == "pause") return ask({{"request", "pause"}}), json::object();
  if (command == "disconnect" || command == "terminate") return leaving_ = true, json::object();
  return failure("'" + command + "' is not supported");
}

json DebugAdapter::initialize(const json&) {
  return {{"supportsConfigurationDoneRequest", true},
          {"supportsFunctionBreakpoints", true},
          {"supportsConditionalBreakpoints", true},
          {"supportsHitConditionalBreakpoints", true},
          {"supportsLogPoints", true},
          {"supportsStepBack", true},
          {"supportsEvaluateForHovers", true},
          {"supportsExceptionInfoRequest", true},
          {"supportsSetVariable", true},
          {"supportsSetExpression", true},
          {"supportsDataBreakpoints", true},
          {"exceptionBreakpointFilters", filters()}};
}

json DebugAdapter::ask(json request) {
  if (link_ == nullptr) return failure("no shader has run yet");
  auto answer = link_->ask(std::move(request), [this](const json& event) { told(event); });
  return answer ? std::move(*answer) : failure("the application has ended");
}

json DebugAdapter::set_owned(const std::string& owner, json request) {
  breakpoints_.replace(owner, request);
  if (link_ != nullptr) breakpoints_.learn(owner, ask(std::move(request)));
  return breakpoints_.answer(owner);
}

json DebugAdapter::set_breakpoints(const json& arguments) {
  const json source = arguments.value("source", json::object());
  std::string file = source.is_object() ? text_of(source, "path") : std::string();
  if (file.empty() && source.is_object()) file = text_of(source, "name");
  return set_owned(file,
                   {{"request", "breakpoints"}, {"file", file}, {"list", rows_of(list_of(arguments, "breakpoints"))}});
}

json DebugAdapter::set_functions(const json& arguments) {
  return set_owned("", {{"request", "functions"}, {"list", rows_of(list_of(arguments, "breakpoints"))}});
}

json DebugAdapter::set_exceptions(const json& arguments) {
  json list = list_of(arguments, "filters"), answers = json::array();
  for (std::size_t i = 0; i < list.size(); ++i) answers.push_back({{"verified", true}});
  exceptions_ = {{"request", "catch"}, {"list", std::move(list)}};
  if (link_ != nullptr) ask(exceptions_);
  return {{"breakpoints", std::move(answers)}};
}

void DebugAdapter::send_breakpoints() {
  if (!exceptions_.is_null()) ask(exceptions_);
  for (const auto& [owner, request] : breakpoints_.requests()) breakpoints_.learn(owner, ask(request));
}

void DebugAdapter::tell_placed() {
  if (breakpoints_.are_all_verified()) return;
  for (json& news : breakpoints_.learn_placed(ask({{"request", "placed"}}))) event("breakpoint", std::move(news));
}

void DebugAdapter::told(const json& message) {
  const std::string name = text_of(message, "event"), reason = text_of(message, "reason");
  if (name == "output") event("output", {{"category", "console"}, {"output", text_of(message, "text") + "\n"}});
  if (name == "running") stopped_ = false;
  if (name != "stopped") return;
  if (reason == "start") {
    send_breakpoints();
    if (stops_on_entry_) ask({{"request", "pause"}});
    ask({{"request", "go"}, {"how", "continue"}});
    return;
  }
  tell_placed();
  stopped_ = true;
  lane_ = number_of(message, "lane");
  last_stop_ = message;
  references_.clear();
  json body = {{"reason", reason_of(reason)},
               {"threadId", lane_ + 1},
               {"allThreadsStopped", true},
               {"description", text_of(message, "message")},
               {"text", text_of(message, "text")}};
  if (reason == "breakpoint")
    if (const json id = breakpoints_.id_of(number_of(message, "number")); !id.is_null())
      body["hitBreakpointIds"] = json::array({id});
  event("stopped", std::move(body));
}

void DebugAdapter::ended(int code) {
  link_ = nullptr;
  event("exited", {{"exitCode", code}});
  event("terminated", json::object());
}

json DebugAdapter::threads(const json&) {
  json list = json::array();
  if (stopped_)
    for (const json& row : list_of(ask({{"request", "lanes"}}), "list"))
      list.push_back({{"id", number_of(row, "lane") + 1}, {"name", text_of(row, "name")}});
  if (list.empty()) list.push_back({{"id", 1}, {"name", "shaders"}});
  return {{"threads", std::move(list)}};
}

json DebugAdapter::source_of(const std::string& file) {
  std::error_code error;
  json result = {{"name", fs::path(file).filename().string()}};
  if (fs::exists(file, error)) {
    result["path"] = fs::absolute(file, error).string();
    return result;
  }
  // The person who has set breakpoints in it has it.
  for (const auto& [path, request] : breakpoints_.requests())
    if (fs::path(path).filename() == fs::path(file).filename() && fs::exists(path, error)) {
      result["path"] = path;
      return result;
    }
  std::size_t number = 0;
  while (number < files_.size() && files_[number] != file) ++number;
  if (number == files_.size()) files_.push_back(file);
  result["sourceReference"] = number + 1;
  return result;
}

json DebugAdapter::stack(const json& arguments) {
  const std::size_t lane = number_of(arguments, "threadId", 1) - 1;
  const json answer = ask({{"request", "frames"}, {"lane", lane}});
  if (answer.contains("error")) return answer;
  json list = json::array();
  std::size_t number = 0;
  for (const json& row : list_of(answer, "list"))
    list.push_back({{"id", lane * kFrames + ++number},
                    {"name", text_of(row, "name")},
                    {"source", source_of(text_of(row, "file"))},
                    {"line", number_of(row, "line")},
                    {"column", std::max<std::size_t>(number_of(row, "column"), 1)}});
  return {{"stackFrames", list}, {"totalFrames", list.size()}};
}

int DebugAdapter::refer(json children, Owner owner) {
  references_.push_back({std::move(children), std::move(owner)});
  return static_cast<int>(references_.size());
}

json DebugAdapter::scopes(const json& arguments) {
  const std::size_t id = number_of(arguments, "frameId", 1) - 1;
  json list = json::array();
  for (const auto& [which, name] : {std::pair{"locals", "Locals"}, std::pair{"globals", "Globals"}}) {
    json answer = ask({{"request", "variables"}, {"lane", id / kFrames}, {"frame", id % kFrames}, {"which", which}});
    if (answer.contains("error")) return answer;
    list.push_back({{"name", name},
                    {"variablesReference", refer(list_of(answer, "list"), {id / kFrames, id % kFrames, ""})},
                    {"expensive", false}});
  }
  return {{"scopes", std::move(list)}};
}

json DebugAdapter::variable_of(const json& tree, Owner itself) {
  json children = list_of(tree, "children");
  json variable = {{"name", text_of(tree, "name")},
                   {"type", text_of(tree, "type")},
                   {"value", text_of(tree, "value")},
                   {"evaluateName", itself.expression}};
  variable["variablesReference"] = children.empty() ? 0 : refer(std::move(children), std::move(itself));
  return variable;
}

/// Blocks without a name have one that begins with '%': their members are visible as variables. Names with a space are
/// those of rows of texels, which have names of their own.
DebugAdapter::Owner DebugAdapter::child_of(const Owner& owner, const std::string& name) {
  Owner child = owner;
  if (name.starts_with("row ") || name.starts_with("layer ")) return child;
  if (owner.expression.empty() || owner.expression.starts_with('%'))
    child.expression = name;
  else
    child.expression += name.starts_with('[') ? name : "." + name;
  return child;
}

json DebugAdapter::variables(const json& arguments) {
  const std::size_t reference = number_of(arguments, "variablesReference");
  if (reference == 0 || reference > references_.size()) return failure("that is gone");
  json list = json::array();
  const Reference of = references_[reference - 1];
  for (const json& child : of.children) list.push_back(variable_of(child, child_of(of.owner, text_of(child, "name"))));
  return {{"variables", std::move(list)}};
}

/// What a request names: a variable of a reference, or an expression in a frame.
DebugAdapter::Owner DebugAdapter::named_by(const json& arguments, const char* expression) {
  const std::size_t reference = number_of(arguments, "variablesReference");
  if (reference != 0 && reference <= references_.size())
    return child_of(references_[reference - 1].owner, text_of(arguments, "name"));
  const std::size_t id = number_of(arguments, "frameId", lane_ * kFrames + 1) - 1;
  return {id / kFrames, id % kFrames, text_of(arguments, expression)};
}

json DebugAdapter::set_variable(const json& arguments) { return set(named_by(arguments, "name"), arguments); }
json DebugAdapter::set_expression(const json& arguments) {
  return set(named_by({{"frameId", number_of(arguments, "frameId", lane_ * kFrames + 1)},
                       {"expression", text_of(arguments, "expression")}},
                      "expression"),
             arguments);
}

json DebugAdapter::set(const Owner& owner, const json& arguments) {
  const json answer = ask({{"request", "set"},
                           {"lane", owner.lane},
                           {"frame", owner.frame},
                           {"text", owner.expression},
                           {"value", text_of(arguments, "value")}});
  return answer.contains("error") ? answer : variable_of(answer, owner);
}

json DebugAdapter::data_breakpoint_info(const json& arguments) {
  const Owner owner = named_by(arguments, "name");
  const json known =
      ask({{"request", "evaluate"}, {"lane", owner.lane}, {"frame", owner.frame}, {"text", owner.expression}});
  if (known.contains("error")) return {{"dataId", nullptr}, {"description", text_of(known, "error")}};
  return {{"dataId", json{{"lane", owner.lane}, {"frame", owner.frame}, {"text", owner.expression}}.dump()},
          {"description", owner.expression},
          {"accessTypes", json::array({"write"})}};
}

json DebugAdapter::set_data_breakpoints(const json& arguments) {
  const json rows = list_of(arguments, "breakpoints");
  json list = json::array(), answers = json::array();
  for (const json& row : rows) {
    const json id = row.is_object() ? json::parse(text_of(row, "dataId"), nullptr, false) : json();
    list.push_back(id.is_object() ? id : json::object());
  }
  const json answer = ask({{"request", "watches"}, {"list", std::move(list)}});
  if (answer.contains("error")) return rows.empty() ? json{{"breakpoints", answers}} : answer;
  for (const json& row : list_of(answer, "list"))
    answers.push_back({{"id", kWatches + number_of(row, "number")},
                       {"verified", row.value("verified", json(false))},
                       {"message", text_of(row, "message")}});
  return {{"breakpoints", std::move(answers)}};
}

json DebugAdapter::evaluate(const json& arguments) {
  const std::size_t id = number_of(arguments, "frameId", lane_ * kFrames + 1) - 1;
  const Owner owner{id / kFrames, id % kFrames, text_of(arguments, "expression")};
  const json answer =
      ask({{"request", "evaluate"}, {"lane", owner.lane}, {"frame", owner.frame}, {"text", owner.expression}});
  if (answer.contains("error")) return answer;
  json variable = variable_of(answer, owner);
  return {{"result", variable["value"]},
          {"type", variable["type"]},
          {"variablesReference", variable["variablesReference"]}};
}

json DebugAdapter::source(const json& arguments) {
  std::size_t reference = number_of(arguments, "sourceReference");
  if (reference == 0 && arguments.value("source", json()).is_object())
    reference = number_of(arguments["source"], "sourceReference");
  if (reference == 0 || reference > files_.size()) return failure("there is no such source");
  const json answer = ask({{"request", "source"}, {"file", files_[reference - 1]}});
  return answer.contains("error") ? answer : json{{"content", text_of(answer, "text")}};
}

json DebugAdapter::exception(const json&) {
  const std::string reason = text_of(last_stop_, "reason"), message = text_of(last_stop_, "message");
  return {{"exceptionId", reason == "exception" ? message.substr(0, message.find(':')) : reason},
          {"description", text_of(last_stop_, "text")},
          {"breakMode", "always"}};
}

json DebugAdapter::move(const char* how, bool backward, const json& arguments) {
  const std::size_t lane = number_of(arguments, "threadId", lane_ + 1) - 1;
  const json answer = ask({{"request", "go"}, {"how", how}, {"backward", backward}, {"lane", lane}});
  if (answer.contains("error")) return answer;
  return {{"allThreadsContinued", true}};
}

}  // namespace vitrine::glass::cli

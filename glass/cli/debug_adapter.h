// Between an editor (Debug Adapter Protocol) and a process whose shaders stop (debug_link.h). Threads are the
// invocations of the wave that has stopped: number = lane + 1.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "glass/cli/debug_breakpoints.h"
#include "glass/cli/debug_link.h"
#include "glass/cli/debug_wire.h"

namespace vitrine::glass::cli {

class DebugAdapter {
 public:
  using json = nlohmann::json;

  explicit DebugAdapter(DapWire& wire) : wire_(wire) {}

  /// A request of the editor. False: it wants to leave.
  bool take(const json& request);
  /// The editor has set its breakpoints and wants the application to run.
  bool wants_start() const { return launched_ && configured_; }
  /// The process; null: there is none (any more).
  void connect(DebugLink* link) { link_ = link; }
  /// Something that the process says.
  void told(const json& event);
  /// The application has ended.
  void ended(int code);

 private:
  /// What an expression names in a frame of an invocation.
  struct Owner {
    std::size_t lane = 0, frame = 0;
    std::string expression;  ///< empty: a scope
  };
  struct Reference {
    json children;  ///< list of {name, type, value, children}
    Owner owner;
  };

  json answer(const std::string& command, const json& arguments);
  json initialize(const json& arguments);
  json set_breakpoints(const json& arguments);
  json set_functions(const json& arguments);
  json threads(const json& arguments);
  json stack(const json& arguments);
  json scopes(const json& arguments);
  json variables(const json& arguments);
  json evaluate(const json& arguments);
  json set_variable(const json& arguments);
  json set_expression(const json& arguments);
  json set(const Owner& owner, const json& arguments);
  json data_breakpoint_info(const json& arguments);
  json set_data_breakpoints(const json& arguments);
  json source(const json& arguments);
  json move(const char* how, bool backward, const json& arguments);
  json set_exceptions(const json& arguments);
  json exception(const json& arguments);

  json ask(json request);
  /// Breakpoints of a file, or of functions.
  json set_owned(const std::string& owner, json request);
  /// Tells the editor of breakpoints that shaders have by now.
  void tell_placed();
  void send_breakpoints();
  json source_of(const std::string& file);
  int refer(json children, Owner owner);
  json variable_of(const json& tree, Owner itself);
  static Owner child_of(const Owner& owner, const std::string& name);
  Owner named_by(const json& arguments, const char* expression);
  void event(const char* name, json body);

  DapWire& wire_;
  DebugLink* link_ = nullptr;
  bool launched_ = false, configured_ = false, stops_on_entry_ = false, leaving_ = false;
  bool stopped_ = false;
  std::size_t lane_ = 0;  ///< that has stopped
  json last_stop_ = json::object();
  Breakpoints breakpoints_;
  json exceptions_;                    ///< the request of the driver; null: none
  std::vector<std::string> files_;     ///< that are in modules alone, by sourceReference - 1
  std::vector<Reference> references_;  ///< since the stop, by variablesReference - 1
};

}  // namespace vitrine::glass::cli

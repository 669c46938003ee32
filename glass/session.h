// The tools that this process asked for (VITRINE_TOOLS), and where what they find goes (VITRINE_REPORT, messengers).
// Nothing of it exists in a process that asked for none.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "glass/draw_observers.h"
#include "glass/report/report_file.h"
#include "glass/tool.h"

namespace vitrine::glass {

class Session {
 public:
  Session();
  ~Session();  ///< write()s: the library is unloaded, or the process ends

  /// No tool is on: nothing is observed.
  bool idle() const { return tools_.empty(); }
  /// Turns on one more tool, for shaders and devices that are made from now on.
  void add(std::unique_ptr<Tool> tool);
  /// Who observes a shader that is about to be compiled; null: nobody. One for each program.
  /// `more`: who observes it besides the tools; null: nobody.
  std::shared_ptr<const spirv::exec::Observer> observe(const ShaderIdentity& shader, Tool* more = nullptr);
  /// As ProgramTool::draw() and Tool::broken().
  void draw(const raster::DrawCall& call);
  void broken(const spirv::ObservedCommand& command, std::string_view rule, const std::string& message);
  /// Whether any tool wants a shadow of device memory.
  bool shadows_memory() const { return shadows_memory_; }
  /// Whether any tool must see every fragment.
  bool needs_every_fragment() const { return needs_every_fragment_; }
  /// As Tool::commands_done().
  void commands_done(const void* owner);
  /// Who is told of draws; null: nobody.
  raster::DrawObserver* draws() { return draws_.observer(); }
  /// A submission is done: what the tools have found goes to the report and to `deliver`, in a fixed order.
  void end_submission(const std::function<void(const Finding&)>& deliver);
  /// The tools write what they write at the end.
  void write() noexcept;

 private:
  std::vector<std::unique_ptr<Tool>> tools_;
  bool shadows_memory_ = false;
  bool needs_every_fragment_ = false;
  DrawObservers draws_;
  std::unique_ptr<ReportFile> report_;  ///< null: VITRINE_REPORT names none
};

/// The session of this process.
Session& session();

}  // namespace vitrine::glass

// What shaders do that the specification does not allow, and where their numbers end. Each place in a shader is one
// finding, with a count and the first invocation in order.
#include <algorithm>
#include <mutex>
#include <tuple>

#include "glass/sanitize/broken_commands.h"
#include "glass/sanitize/checks.h"
#include "glass/sanitize/shared.h"
#include "glass/sanitize/variables.h"
#include "glass/sanitize/written.h"
#include "glass/tools.h"
#include "spirv/exec/observe.h"

namespace vitrine::glass {
namespace {

using spirv::Instruction;
using spirv::InstructionNote;
using spirv::Wave;

/// A program all of whose waves a watch of this kind looks at.
template <class WatchType, class PlacesType>
class WatchedProgram : public ProgramTool, public PlacesType {
 public:
  using PlacesType::PlacesType;
  std::unique_ptr<spirv::exec::Watch> watch(const Wave& wave, const Instruction* start) override {
    return std::make_unique<WatchType>(*this, wave, start);
  }
};

/// A tool that finds faults at places of programs.
template <class Watched>
class PlacesTool : public Tool {
 public:
  explicit PlacesTool(const spirv::exec::Interest& interest) : interest_(interest) {}
  spirv::exec::Interest interest() const override { return interest_; }

  std::shared_ptr<ProgramTool> attach(const ShaderIdentity& shader, const spirv::Program& program) override {
    auto made = std::make_shared<Watched>(shader, program);
    const std::lock_guard lock(mutex_);
    programs_.push_back(made);
    return made;
  }

  std::vector<Finding> take_findings() override {
    std::vector<Finding> findings;
    const std::lock_guard lock(mutex_);
    for (const auto& program : programs_) program->places.take(findings);
    sort(findings);
    return findings;
  }

 protected:
  static void sort(std::vector<Finding>& findings) {
    const auto key = [](const Finding& f) {
      return std::tuple(f.address.submission, f.address.command, f.address.stage);
    };
    std::stable_sort(findings.begin(), findings.end(),
                     [&](const Finding& a, const Finding& b) { return key(a) < key(b); });
  }

 private:
  const spirv::exec::Interest interest_;
  std::mutex mutex_;
  std::vector<std::shared_ptr<Watched>> programs_;  ///< in the order in which they were made
};

struct SanitizedPlaces : sanitize::ProgramPlaces {
  SanitizedPlaces(const ShaderIdentity& shader, const spirv::Program& program)
      : ProgramPlaces(shader, program), variables(program) {}
  sanitize::SharedShadows shared;
  sanitize::VariableShadows variables;
  sanitize::UnwrittenReads* reads = nullptr;  ///< the tool's; null: it does not ask what has been written
};

class SanitizeWatch : public spirv::exec::Watch {
 public:
  SanitizeWatch(SanitizedPlaces& program, const Wave& wave, const Instruction* start)
      : reporter_(program, wave),
        written_(reporter_, program.reads),
        shared_(program.reads != nullptr ? program.shared.of(wave, start) : nullptr),
        variables_(program.variables.of(wave, start)) {}

  void access(const Wave& wave, const Instruction* i, const InstructionNote& note) override {
    written_.access(wave, i, note);
    if (note.access == spirv::Access::kImage) return sanitize::check_image(reporter_, wave, i, note);
    sanitize::check_memory(reporter_, wave, i, note);
    if (note.space == spirv::MemorySpace::kPush) sanitize::check_push_constants(reporter_, wave, i, note);
    if (shared_ != nullptr && note.space == spirv::MemorySpace::kShared)
      sanitize::check_shared(reporter_, wave, i, note, *shared_);
  }

  void probe(const Wave& wave, const spirv::ProbeOp& op) override {
    const spirv::Probe& probe = wave.program->probes[op.probe];
    switch (probe.kind) {
      case spirv::Probe::Kind::kOperation:
        return sanitize::check_operation(reporter_, wave, op, probe);
      case spirv::Probe::Kind::kQuad:
      case spirv::Probe::Kind::kBarrier:
      case spirv::Probe::Kind::kUnreachable:
        return sanitize::check_control(reporter_, wave, op, probe);
      case spirv::Probe::Kind::kAligned:
        return sanitize::check_alignment(reporter_, wave, op, probe);
      case spirv::Probe::Kind::kDescriptor:
        return sanitize::check_uniformity(reporter_, wave, op, probe);
      case spirv::Probe::Kind::kWrite:
      case spirv::Probe::Kind::kRead:
      case spirv::Probe::Kind::kChoose:
      case spirv::Probe::Kind::kUse:
        if (variables_ != nullptr) sanitize::check_variable(reporter_, wave, op, probe, *variables_);
        return;
      default:
        return;
    }
  }

 private:
  sanitize::Reporter reporter_;
  sanitize::WrittenCheck written_;
  sanitize::SharedShadow* const shared_;       ///< null: the workgroup has none
  sanitize::VariableShadow* const variables_;  ///< null: nothing is to be known of variables
};

class SanitizedProgram final : public WatchedProgram<SanitizeWatch, SanitizedPlaces> {
 public:
  using WatchedProgram::WatchedProgram;
  void apart(const Wave& wave) override {
    sanitize::Reporter reporter(*this, wave);
    sanitize::check_apart(reporter, wave);
  }
  void draw(const raster::DrawCall& call) override { sanitize::check_draw(*this, call); }
};

/// The tools `sanitize` and `sanitize_quick`. `follows`: what nobody has written, too.
class SanitizeTool : public PlacesTool<SanitizedProgram> {
 public:
  explicit SanitizeTool(bool follows)
      : PlacesTool({.accesses = true, .arithmetic = true, .initialization = follows, .control = true}),
        follows_(follows) {}
  bool shadows_memory() const override { return follows_; }

  std::shared_ptr<ProgramTool> attach(const ShaderIdentity& shader, const spirv::Program& program) override {
    auto made = PlacesTool::attach(shader, program);
    if (follows_) static_cast<SanitizedProgram&>(*made).reads = &reads_;
    return made;
  }
  void commands_done(const void* owner) override { reads_.settle(owner); }
  void broken(const spirv::ObservedCommand& command, std::string_view id, const std::string& message) override {
    commands_.add(command, rule(id), message);
  }
  std::vector<Finding> take_findings() override {
    reads_.settle(nullptr);  // of programs that no device runs
    std::vector<Finding> findings = PlacesTool::take_findings();
    commands_.take(findings);
    sort(findings);
    return findings;
  }

 private:
  const bool follows_;
  sanitize::UnwrittenReads reads_;
  sanitize::BrokenCommands commands_;
};

/// The tool `numbers`.
class NumbersWatch : public spirv::exec::Watch {
 public:
  NumbersWatch(sanitize::ProgramPlaces& program, const Wave& wave, const Instruction*) : reporter_(program, wave) {}

  void probe(const Wave& wave, const spirv::ProbeOp& op) override {
    const spirv::Probe& probe = wave.program->probes[op.probe];
    if (probe.has_result) sanitize::check_number(reporter_, wave, op, probe);
  }

 private:
  sanitize::Reporter reporter_;
};

}  // namespace

std::unique_ptr<Tool> make_sanitize() { return std::make_unique<SanitizeTool>(true); }

std::unique_ptr<Tool> make_sanitize_quick() { return std::make_unique<SanitizeTool>(false); }

std::unique_ptr<Tool> make_numbers() {
  return std::make_unique<PlacesTool<WatchedProgram<NumbersWatch, sanitize::ProgramPlaces>>>(
      spirv::exec::Interest{.numbers = true});
}

}  // namespace vitrine::glass

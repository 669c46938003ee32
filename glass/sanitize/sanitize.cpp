// What shaders do that the specification does not allow, and where their numbers end. Each place in a shader is one
// finding, with a count and the first invocation in order.
#include <algorithm>
#include <mutex>
#include <tuple>

#include "glass/sanitize/checks.h"
#include "glass/tools.h"
#include "spirv/exec/observe.h"

namespace vitrine::glass {
namespace {

using spirv::Instruction;
using spirv::InstructionNote;
using spirv::Wave;

/// A program all of whose waves a watch of this kind looks at.
template <class WatchType>
class WatchedProgram : public ProgramTool, public sanitize::ProgramPlaces {
 public:
  using ProgramPlaces::ProgramPlaces;
  std::unique_ptr<spirv::exec::Watch> watch(const Wave& wave, const Instruction*) override {
    return std::make_unique<WatchType>(*this, wave);
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
    const auto key = [](const Finding& f) {
      return std::tuple(f.address.submission, f.address.command, f.address.stage);
    };
    std::stable_sort(findings.begin(), findings.end(),
                     [&](const Finding& a, const Finding& b) { return key(a) < key(b); });
    return findings;
  }

 private:
  const spirv::exec::Interest interest_;
  std::mutex mutex_;
  std::vector<std::shared_ptr<Watched>> programs_;  ///< in the order in which they were made
};

class SanitizeWatch : public spirv::exec::Watch {
 public:
  SanitizeWatch(sanitize::ProgramPlaces& program, const Wave& wave) : reporter_(program, wave) {}

  void access(const Wave& wave, const Instruction* i, const InstructionNote& note) override {
    if (note.access != spirv::Access::kImage) sanitize::check_memory(reporter_, wave, i, note);
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
      default:
        return;
    }
  }

 private:
  sanitize::Reporter reporter_;
};

class SanitizedProgram : public WatchedProgram<SanitizeWatch> {
 public:
  using WatchedProgram::WatchedProgram;
  void apart(const Wave& wave) override {
    sanitize::Reporter reporter(*this, wave);
    sanitize::check_apart(reporter, wave);
  }
};

/// The tool `numbers`.
class NumbersWatch : public spirv::exec::Watch {
 public:
  NumbersWatch(sanitize::ProgramPlaces& program, const Wave& wave) : reporter_(program, wave) {}

  void probe(const Wave& wave, const spirv::ProbeOp& op) override {
    const spirv::Probe& probe = wave.program->probes[op.probe];
    if (probe.has_result) sanitize::check_number(reporter_, wave, op, probe);
  }

 private:
  sanitize::Reporter reporter_;
};

}  // namespace

std::unique_ptr<Tool> make_sanitize() {
  return std::make_unique<PlacesTool<SanitizedProgram>>(
      spirv::exec::Interest{.accesses = true, .arithmetic = true, .control = true});
}

std::unique_ptr<Tool> make_numbers() {
  return std::make_unique<PlacesTool<WatchedProgram<NumbersWatch>>>(spirv::exec::Interest{.numbers = true});
}

}  // namespace vitrine::glass

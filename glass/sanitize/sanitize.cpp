// What shaders do that the specification does not allow. Each place in a shader is one finding, with a count and the
// first invocation in order.
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

class SanitizeWatch : public spirv::exec::Watch {
 public:
  SanitizeWatch(sanitize::ProgramPlaces& program, const Wave& wave) : reporter_(program, wave) {}

  void access(const Wave& wave, const Instruction* i, const InstructionNote& note) override {
    if (note.access != spirv::Access::kImage) sanitize::check_memory(reporter_, wave, i, note);
  }

 private:
  sanitize::Reporter reporter_;
};

class SanitizedProgram : public ProgramTool, public sanitize::ProgramPlaces {
 public:
  using ProgramPlaces::ProgramPlaces;
  std::unique_ptr<spirv::exec::Watch> watch(const Wave& wave, const Instruction*) override {
    return std::make_unique<SanitizeWatch>(*this, wave);
  }
};

class Sanitize : public Tool {
 public:
  spirv::exec::Interest interest() const override { return {.accesses = true}; }

  std::shared_ptr<ProgramTool> attach(const ShaderIdentity& shader, const spirv::Program& program) override {
    auto made = std::make_shared<SanitizedProgram>(shader, program);
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
  std::mutex mutex_;
  std::vector<std::shared_ptr<SanitizedProgram>> programs_;  ///< in the order in which they were made
};

}  // namespace

std::unique_ptr<Tool> make_sanitize() { return std::make_unique<Sanitize>(); }

}  // namespace vitrine::glass

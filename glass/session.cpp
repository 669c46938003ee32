// Which tools are on, one observer for all of them, and the way of findings.
#include "glass/session.h"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <new>
#include <string_view>

#include "base/lasting.h"
#include "base/words.h"
#include "glass/output.h"
#include "glass/tools.h"
#include "raster/draw.h"

namespace vitrine::glass {
namespace {

using spirv::exec::Interest;
using spirv::exec::Watch;

void add_to(Interest& interest, const Interest& wanted) {
  interest.instructions |= wanted.instructions;
  interest.accesses |= wanted.accesses;
  interest.images |= wanted.images;
  interest.discards |= wanted.discards;
  interest.arithmetic |= wanted.arithmetic;
  interest.numbers |= wanted.numbers;
  interest.control |= wanted.control;
  interest.initialization |= wanted.initialization;
  interest.blocks |= wanted.blocks;
  interest.printf |= wanted.printf;
  interest.debug |= wanted.debug;
  interest.order |= wanted.order;
  interest.rehearsal |= wanted.rehearsal;
}

/// The watches of several tools.
class Watches : public Watch {
 public:
  explicit Watches(std::vector<std::unique_ptr<Watch>> watches) : watches_(std::move(watches)) {}
  void before(const spirv::Wave& wave, const spirv::Instruction* instruction) override {
    for (const auto& watch : watches_) watch->before(wave, instruction);
  }
  void after(const spirv::Wave& wave, const spirv::Instruction* instruction, const spirv::Instruction* next) override {
    for (const auto& watch : watches_) watch->after(wave, instruction, next);
  }
  void access(const spirv::Wave& wave, const spirv::Instruction* instruction,
              const spirv::InstructionNote& note) override {
    for (const auto& watch : watches_) watch->access(wave, instruction, note);
  }
  void discard(const spirv::Wave& wave, const spirv::Instruction* instruction,
               const spirv::InstructionNote& note) override {
    for (const auto& watch : watches_) watch->discard(wave, instruction, note);
  }
  void probe(const spirv::Wave& wave, const spirv::ProbeOp& op) override {
    for (const auto& watch : watches_) watch->probe(wave, op);
  }
  void probes(const spirv::Wave& wave, const spirv::ProbeOp& op, std::uint64_t times) override {
    for (const auto& watch : watches_) watch->probes(wave, op, times);
  }

 private:
  std::vector<std::unique_ptr<Watch>> watches_;
};

/// All tools that are on, for one program.
class ProgramObserver : public spirv::exec::Observer {
 public:
  ProgramObserver(std::vector<Tool*> tools, const ShaderIdentity& shader) : tools_(std::move(tools)), shader_(shader) {
    for (const Tool* tool : tools_) {
      add_to(interest_, tool->interest());
      add_to(rehearsed_, tool->rehearsed());
    }
  }

  Interest interest() const override { return interest_; }
  Interest rehearsed() const override { return rehearsed_; }

  /// Before compile() returns: the words are still there.
  void made(const spirv::Program& program) const override {
    for (Tool* tool : tools_)
      if (auto attached = tool->attach(shader_, program)) programs_.push_back(std::move(attached));
  }

  void apart(const spirv::Wave& wave) const override {
    for (const auto& program : programs_) program->apart(wave);
  }

  bool in_order() const override {
    return std::ranges::any_of(programs_, [](const auto& program) { return program->in_order(); });
  }

  void draw(const raster::DrawCall& call) const {
    for (const auto& program : programs_) program->draw(call);
  }

  Watch* lasting_watch() const override { return programs_.size() == 1 ? programs_[0]->lasting_watch() : nullptr; }

  std::unique_ptr<Watch> watch(const spirv::Wave& wave, const spirv::Instruction* start) const override {
    if (programs_.size() == 1) return programs_[0]->watch(wave, start);
    std::vector<std::unique_ptr<Watch>> watches;
    for (const auto& program : programs_)
      if (auto one = program->watch(wave, start)) watches.push_back(std::move(one));
    if (watches.size() == 1) return std::move(watches[0]);
    return watches.empty() ? nullptr : std::make_unique<Watches>(std::move(watches));
  }

 private:
  std::vector<Tool*> tools_;
  ShaderIdentity shader_;  ///< valid until made() has been called
  Interest interest_, rehearsed_;
  mutable std::vector<std::shared_ptr<ProgramTool>> programs_;  ///< constant behind made()
};

struct Row {
  std::string_view name;
  std::unique_ptr<Tool> (*make)();
};

constexpr Row kTools[] = {
#define VITRINE_TOOL(name, make, effect) {#name, make},
#include "glass/tools.def"
#undef VITRINE_TOOL
};

std::unique_ptr<Tool> make_tool(std::string_view name) {
  for (const Row& row : kTools)
    if (row.name == name) return row.make();
  std::string known;
  for (const Row& row : kTools) known.append(known.empty() ? "" : ", ").append(row.name);
  complain("VITRINE_TOOLS: there is no tool '" + std::string(name) + "'; there are " + known);
  return nullptr;
}

/// The loader unloads the driver with its last instance, and applications make several, one after the other: what the
/// tools know of the process must last until it ends, and what is wrong with their names is said once.
void stay_loaded() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&session), &info) != 0 && info.dli_fname != nullptr) {
    dlopen(info.dli_fname, RTLD_NOW | RTLD_NOLOAD | RTLD_NODELETE);
  }
}

}  // namespace

Session::Session() {
  const char* wanted = std::getenv("VITRINE_TOOLS");
  base::for_each_word(wanted ? wanted : "", [&](std::string_view name) {
    if (auto tool = make_tool(name)) add(std::move(tool));
  });
  // Whoever says where messages go wants them.
  const char* messages = std::getenv("VITRINE_PRINTF");
  const bool named = wanted != nullptr && base::has_word(wanted, "printf");
  if (messages != nullptr && *messages != 0 && !named) add(make_printf());
  // And who names commands wants files of them.
  const char* commands = std::getenv("VITRINE_CAPTURE");
  if (commands != nullptr && *commands != 0 && !base::has_word(wanted ? wanted : "", "capture")) add(make_capture());
  if (!idle() || (wanted != nullptr && *wanted != 0)) stay_loaded();
  if (idle()) return;
  const char* report = std::getenv("VITRINE_REPORT");
  if (report != nullptr && *report != 0) report_ = std::make_unique<ReportFile>(report);
}

Session::~Session() { write(); }

void Session::add(std::unique_ptr<Tool> tool) {
  shadows_memory_ |= tool->shadows_memory();
  needs_every_fragment_ |= tool->needs_every_fragment();
  if (raster::DrawObserver* draws = tool->draws()) draws_.add(*draws);
  tools_.push_back(std::move(tool));
}

std::shared_ptr<const spirv::exec::Observer> Session::observe(const ShaderIdentity& shader, Tool* more) {
  std::vector<Tool*> tools;
  for (const auto& tool : tools_)
    if (tool->interest() != Interest{}) tools.push_back(tool.get());
  if (more) tools.push_back(more);
  return tools.empty() ? nullptr : std::make_shared<ProgramObserver>(std::move(tools), shader);
}

void Session::draw(const raster::DrawCall& call) {
  const auto& observation = call.vertex->program().observation;
  if (!observation) return;
  if (const auto* observer = dynamic_cast<const ProgramObserver*>(observation->observer.get())) observer->draw(call);
}

void Session::broken(const spirv::ObservedCommand& command, std::string_view rule, const std::string& message) {
  for (const auto& tool : tools_) tool->broken(command, rule, message);
}

void Session::commands_done(const void* owner) {
  for (const auto& tool : tools_) tool->commands_done(owner);
}

void Session::end_submission(const std::function<void(const Finding&)>& deliver) {
  std::vector<Finding> findings;
  for (const auto& tool : tools_) std::ranges::move(tool->take_findings(), std::back_inserter(findings));
  if (report_) report_->append(findings);
  for (const Finding& finding : findings) deliver(finding);
}

void Session::write() noexcept {
  for (const auto& tool : tools_) {
    try {
      tool->write();
    } catch (const std::bad_alloc&) {
      complain("there is no memory left to write what a tool has seen");
    }
  }
}

Session& session() {
  static const std::unique_ptr<Session>& session = base::lasting([] { return std::make_unique<Session>(); });
  return *session;
}

}  // namespace vitrine::glass

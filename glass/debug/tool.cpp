// The tool `debug`: stops shaders where somebody wants them to stop, who is at the other end of the socket that
// VITRINE_DEBUG names.
#include "glass/debug/tool.h"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <iterator>
#include <map>
#include <utility>

#include "glass/debug/rehearsal.h"
#include "glass/debug/socket_face.h"
#include "glass/output.h"
#include "glass/tools.h"

namespace vitrine::glass {
namespace debug {
namespace {

/// Of the tool that is connected.
std::atomic<CommandWatch*> watch_of_commands = nullptr;

/// The program as it always runs, with probes.
class DebugWatch : public spirv::exec::Watch {
 public:
  DebugWatch(Engine& engine, std::shared_ptr<Run> run, const spirv::Wave& wave)
      : engine_(engine), run_(std::move(run)), wave_(wave) {}
  ~DebugWatch() override {
    engine_.ended(run_, wave_, wave_.status == spirv::Wave::Status::kAtBarrier);
    engine_.leave(run_);
  }
  DebugWatch(const DebugWatch&) = delete;
  DebugWatch& operator=(const DebugWatch&) = delete;

  void probe(const spirv::Wave& wave, const spirv::ProbeOp& op) override { engine_.came_by(*run_, wave, op); }

 private:
  Engine& engine_;
  std::shared_ptr<Run> run_;
  const spirv::Wave& wave_;
};

using Watches = std::vector<std::unique_ptr<spirv::exec::Watch>>;

/// A rehearsal of a wave. `others`: of tools whose findings are caught.
class RehearsalWatch : public spirv::exec::Watch {
 public:
  RehearsalWatch(Engine& engine, Run& run, StoreLog& stores, Watches others)
      : engine_(engine), run_(run), stores_(stores), others_(std::move(others)) {}

  void probe(const spirv::Wave& wave, const spirv::ProbeOp& op) override {
    for (const auto& other : others_) other->probe(wave, op);
    engine_.came_by(run_, wave, op);
  }
  void access(const spirv::Wave& wave, const spirv::Instruction* i, const spirv::InstructionNote& note) override {
    for (const auto& other : others_) other->access(wave, i, note);
    engine_.writes(run_, wave, i, note, stores_);
  }

 private:
  Engine& engine_;
  Run& run_;
  StoreLog& stores_;
  Watches others_;
};

/// The wave itself, which runs behind its rehearsal.
class ResultWatch : public spirv::exec::Watch {
 public:
  ResultWatch(Engine& engine, std::shared_ptr<Run> run, const Rehearsal& rehearsal, const spirv::Wave& wave)
      : engine_(engine), run_(std::move(run)), rehearsal_(rehearsal), wave_(wave) {}
  ~ResultWatch() override {
    if (const auto difference = rehearsal_.compare(wave_)) engine_.differs(*run_, *difference);
    engine_.leave(run_);
  }
  ResultWatch(const ResultWatch&) = delete;
  ResultWatch& operator=(const ResultWatch&) = delete;

 private:
  Engine& engine_;
  std::shared_ptr<Run> run_;
  const Rehearsal& rehearsal_;
  const spirv::Wave& wave_;
};

/// The wave itself, behind a rehearsal that somebody has changed: it does nothing but come to its barriers, as helpers
/// do, and gets the rehearsal's results.
class ReplacedWatch : public spirv::exec::Watch {
 public:
  ReplacedWatch(Engine& engine, std::shared_ptr<Run> run, const Rehearsal& rehearsal, spirv::Wave& wave)
      : engine_(engine), run_(std::move(run)), rehearsal_(rehearsal), wave_(wave) {
    wave_.live = 0;
  }
  ~ReplacedWatch() override {
    wave_.live = rehearsal_.wave().live;
    if (wave_.status == spirv::Wave::Status::kDone) rehearsal_.hand_over(wave_);
    engine_.leave(run_);
  }
  ReplacedWatch(const ReplacedWatch&) = delete;
  ReplacedWatch& operator=(const ReplacedWatch&) = delete;

 private:
  Engine& engine_;
  std::shared_ptr<Run> run_;
  const Rehearsal& rehearsal_;
  spirv::Wave& wave_;
};

/// Tools whose findings stop shaders: they watch the rehearsals.
struct Finders {
  std::vector<std::unique_ptr<Tool>> tools;

  std::vector<Finding> take() {
    std::vector<Finding> findings;
    for (const auto& tool : tools) std::ranges::move(tool->take_findings(), std::back_inserter(findings));
    return findings;
  }
};

class DebugProgram : public ProgramTool {
 public:
  /// `rehearsal`: null where the program as it always runs is looked at. `found_by`: what `finders` have of it.
  DebugProgram(Engine& engine, std::shared_ptr<const Subject> subject, std::shared_ptr<const spirv::Shader> rehearsal,
               Finders& finders, std::vector<std::shared_ptr<ProgramTool>> found_by)
      : engine_(engine),
        subject_(std::move(subject)),
        rehearsal_(std::move(rehearsal)),
        finders_(finders),
        found_by_(std::move(found_by)) {}

  std::unique_ptr<spirv::exec::Watch> watch(const spirv::Wave& wave, const spirv::Instruction* start) override {
    const bool begins = start == wave.program->code.data();
    std::shared_ptr<Run> run = engine_.enter(subject_, wave, begins);
    if (!run) return nullptr;
    if (!rehearsal_) return std::make_unique<DebugWatch>(engine_, std::move(run), wave);
    return rehearse(std::move(run), wave, begins);
  }
  bool in_order() const override { return true; }
  void draw(const raster::DrawCall& call) override {
    for (const auto& program : found_by_) program->draw(call);
  }

 private:
  /// One wave at a time: between Engine::enter() and leave().
  std::unique_ptr<spirv::exec::Watch> rehearse(std::shared_ptr<Run> run, const spirv::Wave& wave, bool begins) {
    std::unique_ptr<Rehearsal>& rehearsal = rehearsals_[&wave];
    if (!rehearsal) rehearsal = std::make_unique<Rehearsal>(rehearsal_);
    if (begins) rehearsal->begin(wave);
    // The loop that runs a wave gives it to its observers as something that they do not change.
    auto& itself = const_cast<spirv::Wave&>(wave);
    if (!rehearsal->goes_on()) {
      if (run->changed) return std::make_unique<ReplacedWatch>(engine_, std::move(run), *rehearsal, itself);
      return engine_.leave(run), nullptr;
    }
    rehearse_now(*rehearsal, run, wave);
    if (run->changed) return std::make_unique<ReplacedWatch>(engine_, std::move(run), *rehearsal, itself);
    rehearsal->stores.take_back();
    return std::make_unique<ResultWatch>(engine_, std::move(run), *rehearsal, wave);
  }

  void rehearse_now(Rehearsal& rehearsal, const std::shared_ptr<Run>& run, const spirv::Wave& wave) {
    Watches others;
    for (const auto& program : found_by_)
      if (auto watch = program->watch(rehearsal.wave(), rehearsal.wave().resume)) others.push_back(std::move(watch));
    engine_.rehearses(&rehearsal.stores);
    {
      RehearsalWatch watch(engine_, *run, rehearsal.stores, std::move(others));
      rehearsal.run(wave, watch);
    }
    engine_.ended(run, wave, rehearsal.waits());
    if (!found_by_.empty()) engine_.found(run, finders_.take());
    engine_.rehearses(nullptr);
  }

  Engine& engine_;
  std::shared_ptr<const Subject> subject_;
  std::shared_ptr<const spirv::Shader> rehearsal_;
  Finders& finders_;
  std::vector<std::shared_ptr<ProgramTool>> found_by_;
  std::map<const spirv::Wave*, std::unique_ptr<Rehearsal>> rehearsals_;
};

class DebugTool : public Tool {
 public:
  DebugTool(Engine& engine, Shown shown) : engine_(engine), exact_(shown == Shown::kExact) { make_finders(); }

  spirv::exec::Interest interest() const override {
    return exact_ ? probes() : spirv::exec::Interest{.rehearsal = true};
  }
  spirv::exec::Interest rehearsed() const override {
    make_finders();
    spirv::exec::Interest interest = probes();
    interest.accesses = true;
    for (const auto& tool : finders_.tools) add(interest, tool->interest());
    return interest;
  }
  std::shared_ptr<ProgramTool> attach(const ShaderIdentity& shader, const spirv::Program& program) override {
    const std::shared_ptr<const spirv::Shader>& rehearsal = program.observation->rehearsal;
    const spirv::Program& shown = rehearsal ? rehearsal->program() : program;
    if (!shown.sources || !shown.sources->variables || shown.sources->variables->inputs_alone) return nullptr;
    if (!exact_ && !rehearsal)
      engine_.say("note: " + std::string(shader.entry_point) +
                  " is shown as it always runs: line by line it keeps more values than there is room for");
    auto subject = std::make_shared<const Subject>(shader, shown);
    engine_.know(subject);
    std::vector<std::shared_ptr<ProgramTool>> found_by;
    if (rehearsal)
      for (const auto& tool : finders_.tools)
        if (auto program_tool = tool->attach(shader, shown)) found_by.push_back(std::move(program_tool));
    return std::make_shared<DebugProgram>(engine_, std::move(subject), rehearsal, finders_, std::move(found_by));
  }
  bool shadows_memory() const override { return !finders_.tools.empty(); }
  void broken(const spirv::ObservedCommand& command, std::string_view rule, const std::string& message) override {
    for (const auto& tool : finders_.tools) tool->broken(command, rule, message);
  }
  void commands_done(const void* owner) override {
    for (const auto& tool : finders_.tools) tool->commands_done(owner);
    if (!finders_.tools.empty()) engine_.found(nullptr, finders_.take());
    engine_.commands_done();
  }

 private:
  spirv::exec::Interest probes() const {
    return {.numbers = (engine_.catches() & kCatchNan) != 0, .printf = true, .debug = true};
  }

  /// What sanitize and race want to be told of a rehearsal.
  static void add(spirv::exec::Interest& interest, const spirv::exec::Interest& wanted) {
    interest.arithmetic |= wanted.arithmetic;
    interest.initialization |= wanted.initialization;
    interest.control |= wanted.control;
    interest.order |= wanted.order;
  }

  void make_finders() const {
    if (exact_ || !finders_.tools.empty() || (engine_.catches() & kCatchFinding) == 0) return;
    finders_.tools.push_back(make_sanitize());
    finders_.tools.push_back(make_race());
  }

  Engine& engine_;
  const bool exact_;
  mutable Finders finders_;  ///< made when somebody wants them first
};

/// With the socket that it listens to.
class ConnectedTool : public Tool {
 public:
  ConnectedTool(int socket, Shown shown) : face_(socket) {
    face_.listen(engine_);
    engine_.start();
    tool_ = std::make_unique<DebugTool>(engine_, shown);
    watch_of_commands = &engine_;
  }
  ~ConnectedTool() override { watch_of_commands = nullptr; }
  ConnectedTool(const ConnectedTool&) = delete;
  ConnectedTool& operator=(const ConnectedTool&) = delete;

  spirv::exec::Interest interest() const override { return tool_->interest(); }
  spirv::exec::Interest rehearsed() const override { return tool_->rehearsed(); }
  std::shared_ptr<ProgramTool> attach(const ShaderIdentity& shader, const spirv::Program& program) override {
    return tool_->attach(shader, program);
  }
  bool shadows_memory() const override { return tool_->shadows_memory(); }
  void broken(const spirv::ObservedCommand& command, std::string_view rule, const std::string& message) override {
    tool_->broken(command, rule, message);
  }
  void commands_done(const void* owner) override { tool_->commands_done(owner); }

 private:
  Engine engine_{face_};
  SocketFace face_;                  ///< its thread uses the engine to its end
  std::unique_ptr<DebugTool> tool_;  ///< made when it is known what is caught
};

/// Nobody debugs.
class NoTool : public Tool {
 public:
  spirv::exec::Interest interest() const override { return {}; }
  std::shared_ptr<ProgramTool> attach(const ShaderIdentity&, const spirv::Program&) override { return nullptr; }
};

}  // namespace

CommandWatch* command_watch() { return watch_of_commands; }

std::unique_ptr<Tool> make_tool(Engine& engine, Shown shown) { return std::make_unique<DebugTool>(engine, shown); }

}  // namespace debug

std::unique_ptr<Tool> make_debug() {
  const char* path = std::getenv("VITRINE_DEBUG");
  const int socket = path == nullptr ? -1 : debug::connect_to(path);
  const bool exact = std::getenv("VITRINE_DEBUG_EXACT") != nullptr;
  if (socket >= 0)
    return std::make_unique<debug::ConnectedTool>(socket, exact ? debug::Shown::kExact : debug::Shown::kRehearsal);
  complain("debug: nobody listens at VITRINE_DEBUG; `vitrine debug` sets it");
  return std::make_unique<debug::NoTool>();
}

}  // namespace vitrine::glass

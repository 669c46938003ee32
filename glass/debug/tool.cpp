// The tool `debug`: stops shaders where somebody wants them to stop, who is at the other end of the socket that
// VITRINE_DEBUG names.
#include "glass/debug/tool.h"

#include <cstdlib>
#include <map>
#include <utility>

#include "glass/debug/rehearsal.h"
#include "glass/debug/socket_face.h"
#include "glass/output.h"
#include "glass/tools.h"

namespace vitrine::glass {
namespace debug {
namespace {

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

/// A rehearsal of a wave.
class RehearsalWatch : public spirv::exec::Watch {
 public:
  RehearsalWatch(Engine& engine, Run& run, StoreLog& stores) : engine_(engine), run_(run), stores_(stores) {}

  void probe(const spirv::Wave& wave, const spirv::ProbeOp& op) override { engine_.came_by(run_, wave, op); }
  void access(const spirv::Wave& wave, const spirv::Instruction* i, const spirv::InstructionNote& note) override {
    engine_.writes(run_, wave, i, note, stores_);
  }

 private:
  Engine& engine_;
  Run& run_;
  StoreLog& stores_;
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

class DebugProgram : public ProgramTool {
 public:
  /// `rehearsal`: null where the program as it always runs is looked at.
  DebugProgram(Engine& engine, std::shared_ptr<const Subject> subject, std::shared_ptr<const spirv::Shader> rehearsal)
      : engine_(engine), subject_(std::move(subject)), rehearsal_(std::move(rehearsal)) {}

  std::unique_ptr<spirv::exec::Watch> watch(const spirv::Wave& wave, const spirv::Instruction* start) override {
    const bool begins = start == wave.program->code.data();
    std::shared_ptr<Run> run = engine_.enter(subject_, wave, begins);
    if (!run) return nullptr;
    if (!rehearsal_) return std::make_unique<DebugWatch>(engine_, std::move(run), wave);
    return rehearse(std::move(run), wave, begins);
  }
  bool in_order() const override { return true; }

 private:
  /// One wave at a time: between Engine::enter() and leave().
  std::unique_ptr<spirv::exec::Watch> rehearse(std::shared_ptr<Run> run, const spirv::Wave& wave, bool begins) {
    std::unique_ptr<Rehearsal>& rehearsal = rehearsals_[&wave];
    if (!rehearsal) rehearsal = std::make_unique<Rehearsal>(rehearsal_);
    if (begins) rehearsal->begin(wave);
    if (!rehearsal->goes_on()) return engine_.leave(run), nullptr;
    RehearsalWatch watch(engine_, *run, rehearsal->stores);
    rehearsal->run(wave, watch);
    engine_.ended(run, wave, rehearsal->waits());
    rehearsal->stores.take_back();
    return std::make_unique<ResultWatch>(engine_, std::move(run), *rehearsal, wave);
  }

  Engine& engine_;
  std::shared_ptr<const Subject> subject_;
  std::shared_ptr<const spirv::Shader> rehearsal_;
  std::map<const spirv::Wave*, std::unique_ptr<Rehearsal>> rehearsals_;
};

class DebugTool : public Tool {
 public:
  DebugTool(Engine& engine, Shown shown) : engine_(engine), exact_(shown == Shown::kExact) {}

  spirv::exec::Interest interest() const override {
    return exact_ ? probes() : spirv::exec::Interest{.rehearsal = true};
  }
  spirv::exec::Interest rehearsed() const override {
    spirv::exec::Interest interest = probes();
    interest.accesses = true;
    return interest;
  }
  std::shared_ptr<ProgramTool> attach(const ShaderIdentity& shader, const spirv::Program& program) override {
    const std::shared_ptr<const spirv::Shader>& rehearsal = program.observation->rehearsal;
    if (!exact_ && !rehearsal) return nullptr;
    const spirv::Program& shown = exact_ ? program : rehearsal->program();
    if (!shown.sources || !shown.sources->variables) return nullptr;
    auto subject = std::make_shared<const Subject>(shader, shown);
    engine_.know(subject);
    return std::make_shared<DebugProgram>(engine_, std::move(subject), exact_ ? nullptr : rehearsal);
  }

 private:
  spirv::exec::Interest probes() const {
    return {.numbers = (engine_.catches() & kCatchNan) != 0, .printf = true, .debug = true};
  }

  Engine& engine_;
  const bool exact_;
};

/// With the socket that it listens to.
class ConnectedTool : public Tool {
 public:
  ConnectedTool(int socket, Shown shown) : face_(socket), tool_(engine_, shown) {
    face_.listen(engine_);
    engine_.start();
  }

  spirv::exec::Interest interest() const override { return tool_.interest(); }
  spirv::exec::Interest rehearsed() const override { return tool_.rehearsed(); }
  std::shared_ptr<ProgramTool> attach(const ShaderIdentity& shader, const spirv::Program& program) override {
    return tool_.attach(shader, program);
  }

 private:
  Engine engine_{face_};
  SocketFace face_;  ///< its thread uses the engine to its end
  DebugTool tool_;
};

/// Nobody debugs.
class NoTool : public Tool {
 public:
  spirv::exec::Interest interest() const override { return {}; }
  std::shared_ptr<ProgramTool> attach(const ShaderIdentity&, const spirv::Program&) override { return nullptr; }
};

}  // namespace

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

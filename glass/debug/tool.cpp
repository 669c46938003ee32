// The tool `debug`: stops shaders where somebody wants them to stop, who is at the other end of the socket that
// VITRINE_DEBUG names.
#include "glass/debug/tool.h"

#include <cstdlib>

#include "glass/debug/socket_face.h"
#include "glass/output.h"
#include "glass/tools.h"

namespace vitrine::glass {
namespace debug {
namespace {

class DebugWatch : public spirv::exec::Watch {
 public:
  DebugWatch(Engine& engine, std::shared_ptr<Run> run, const spirv::Wave& wave)
      : engine_(engine), run_(std::move(run)), wave_(wave) {}
  ~DebugWatch() override { engine_.leave(run_, wave_); }
  DebugWatch(const DebugWatch&) = delete;
  DebugWatch& operator=(const DebugWatch&) = delete;

  void probe(const spirv::Wave& wave, const spirv::ProbeOp& op) override { engine_.came_by(*run_, wave, op); }

 private:
  Engine& engine_;
  std::shared_ptr<Run> run_;
  const spirv::Wave& wave_;
};

class DebugProgram : public ProgramTool {
 public:
  DebugProgram(Engine& engine, std::shared_ptr<const Subject> subject)
      : engine_(engine), subject_(std::move(subject)) {}

  std::unique_ptr<spirv::exec::Watch> watch(const spirv::Wave& wave, const spirv::Instruction* start) override {
    std::shared_ptr<Run> run = engine_.enter(subject_, wave, start == wave.program->code.data());
    return run ? std::make_unique<DebugWatch>(engine_, std::move(run), wave) : nullptr;
  }
  bool in_order() const override { return true; }

 private:
  Engine& engine_;
  std::shared_ptr<const Subject> subject_;
};

class DebugTool : public Tool {
 public:
  explicit DebugTool(Engine& engine) : engine_(engine) {}

  spirv::exec::Interest interest() const override {
    return {.numbers = (engine_.catches() & kCatchNan) != 0, .printf = true, .debug = true};
  }
  std::shared_ptr<ProgramTool> attach(const ShaderIdentity& shader, const spirv::Program& program) override {
    if (!program.sources || !program.sources->variables) return nullptr;
    auto subject = std::make_shared<const Subject>(shader, program);
    engine_.know(subject);
    return std::make_shared<DebugProgram>(engine_, std::move(subject));
  }

 private:
  Engine& engine_;
};

/// With the socket that it listens to.
class ConnectedTool : public Tool {
 public:
  explicit ConnectedTool(int socket) : face_(socket), tool_(engine_) {
    face_.listen(engine_);
    engine_.start();
  }

  spirv::exec::Interest interest() const override { return tool_.interest(); }
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

std::unique_ptr<Tool> make_tool(Engine& engine) { return std::make_unique<DebugTool>(engine); }

}  // namespace debug

std::unique_ptr<Tool> make_debug() {
  const char* path = std::getenv("VITRINE_DEBUG");
  const int socket = path == nullptr ? -1 : debug::connect_to(path);
  if (socket >= 0) return std::make_unique<debug::ConnectedTool>(socket);
  complain("debug: nobody listens at VITRINE_DEBUG; `vitrine debug` sets it");
  return std::make_unique<debug::NoTool>();
}

}  // namespace vitrine::glass

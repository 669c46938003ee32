// A tool: watches shaders and commands and says what it has found. One file a tool, one row in tools.def.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "glass/finding.h"
#include "raster/observe.h"
#include "spirv/exec/observe.h"

namespace vitrine::raster {
struct DrawCall;
}

namespace vitrine::glass {

/// A shader that is about to be compiled.
struct ShaderIdentity {
  VkShaderStageFlagBits stage = VK_SHADER_STAGE_VERTEX_BIT;
  std::string_view entry_point;
  std::span<const std::uint32_t> words;
};

/// What a tool keeps of one program. Threads that run the program call watch() and the watches at the same time.
class ProgramTool {
 public:
  virtual ~ProgramTool() = default;
  /// As spirv::exec::Observer::watch().
  virtual std::unique_ptr<spirv::exec::Watch> watch(const spirv::Wave& wave, const spirv::Instruction* start) = 0;
  /// As spirv::exec::Observer::lasting_watch(), for who wants blocks alone.
  virtual spirv::exec::Watch* lasting_watch() { return nullptr; }
  /// As spirv::exec::Observer::apart() and in_order().
  virtual void apart(const spirv::Wave&) {}
  virtual bool in_order() const { return false; }
  /// The program is the vertex shader of a draw that comes next. The thread that replays calls it.
  virtual void draw(const raster::DrawCall&) {}
};

class Tool {
 public:
  virtual ~Tool() = default;
  virtual spirv::exec::Interest interest() const = 0;
  /// As spirv::exec::Observer::rehearsed().
  virtual spirv::exec::Interest rehearsed() const { return {}; }
  /// A program has been made for a shader. It may be destroyed before the tool's state is.
  virtual std::shared_ptr<ProgramTool> attach(const ShaderIdentity& shader, const spirv::Program& program) = 0;
  /// A command breaks a rule by itself, whatever its shaders do. The thread that replays calls it.
  virtual void broken(const spirv::ObservedCommand&, std::string_view /*rule*/, const std::string& /*message*/) {}
  /// Whether it reads or writes the shadow of device memory (glass/memory_shadow.h): none is kept if no tool does.
  virtual bool shadows_memory() const { return false; }
  /// The work of these commands is done, of all that have run since the last call for the same owner
  /// (ObservedCommand::owner): what one invocation read and another has written can be told apart.
  virtual void commands_done(const void* /*owner*/) {}
  /// Whether it must see every fragment that is shaded, those behind others, too.
  virtual bool needs_every_fragment() const { return true; }
  /// Who is told of draws; null: the tool does not want to be, and its draws are drawn as others are.
  virtual raster::DrawObserver* draws() { return nullptr; }
  /// A submission is done: what has been found since the last one, in an order that does not depend on threads.
  virtual std::vector<Finding> take_findings() { return {}; }
  /// Writes what the tool writes of itself (coverage, counts). Called when a device is destroyed and when the library
  /// is unloaded; may be called again.
  virtual void write() {}
};

}  // namespace vitrine::glass

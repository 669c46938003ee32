// Observed programs: whoever observes one is told of what its waves do, as much as he asks for. Which loop runs is
// decided before a draw or dispatch; the plain one knows nothing of observers. An observed program computes the same
// bits.
//
// Who wants to see all that a shader says rehearses its waves: in front of a wave that runs he runs one of a second
// program (Observation::rehearsal), which has been rewritten only as far as it must be, and takes back what that wrote.
#pragma once

#include <atomic>
#include <memory>

#include "spirv/program.h"
#include "spirv/shader.h"

namespace vitrine::spirv::exec {

/// How many came by a probe of blocks. Written by one thread.
struct BlockCell {
  std::atomic<std::uint64_t> invocations{0}, helpers{0}, waves{0};
};

/// One run of a wave: from its start or from a barrier to its end or the next barrier. The thread that runs the wave
/// makes, calls and destroys it.
class Watch {
 public:
  virtual ~Watch() = default;
  /// Where probes of blocks count, by row of Program::probe_ops, instead of calling probe(). Null: they call.
  BlockCell* cells() const { return cells_; }
  /// Around every instruction, if Interest::instructions.
  virtual void before(const Wave&, const Instruction*) {}
  /// `next`: what runs now; null: the wave has ended or waits.
  virtual void after(const Wave&, const Instruction*, const Instruction* /*next*/) {}
  /// Before an instruction that reads or writes memory or an image, if Interest::accesses.
  virtual void access(const Wave&, const Instruction*, const InstructionNote&) {}
  /// Before an instruction that may end invocations, if Interest::discards.
  virtual void discard(const Wave&, const Instruction*, const InstructionNote&) {}
  /// The active lanes come by a probe.
  virtual void probe(const Wave&, const ProbeOp&) {}
  /// The same, of as many waves.
  virtual void probes(const Wave& wave, const ProbeOp& op, std::uint64_t times) {
    for (; times != 0; --times) probe(wave, op);
  }

 protected:
  BlockCell* cells_ = nullptr;
};

/// What an observer wants to be told. Fixed when a program is made.
struct Interest {
  bool instructions = false;    ///< all of them: no chains, every instruction leaves its result in a register
  bool accesses = false;        ///< of memory and images: each stays where and what the shader has it
  bool images = false;          ///< accesses of images alone: nothing else changes
  bool discards = false;        ///< instructions by which fragments end
  bool arithmetic = false;      ///< probes of operations that are undefined for some operands
  bool numbers = false;         ///< probes of floating-point results
  bool initialization = false;  ///< probes of variables that may not have been written where they are read
  bool control = false;         ///< probes of what needs invocations together, and of what must not be reached
  bool blocks = false;          ///< probes where blocks begin
  bool printf = false;          ///< probes of NonSemantic.DebugPrintf
  bool debug = false;           ///< probes of lines, and of the values that variables get: Probe::Kind::kStep, kAssign
  bool order = false;           ///< probes of barriers; what orders accesses in their Origin (spirv/memory_order.h)
  bool rehearsal = false;       ///< Observation::rehearsal
  bool operator==(const Interest&) const = default;
};

/// Shared by all threads that run a program.
class Observer {
 public:
  virtual ~Observer() = default;
  virtual Interest interest() const { return {.instructions = true}; }
  /// If Interest::rehearsal: the interest that the second program is made for.
  virtual Interest rehearsed() const { return {}; }
  /// Called when a program that this observes has been made.
  virtual void made(const Program&) const {}
  /// Waves of a workgroup wait, as this one does, at a barrier that the others have not reached or will not reach.
  virtual void apart(const Wave&) const {}
  /// Whether workgroups of a dispatch run one after the other, in order, on one thread.
  virtual bool in_order() const { return false; }
  /// A watch, the observer's own, of whatever the calling thread runs of the program; null: watch() makes one a run.
  virtual Watch* lasting_watch() const { return nullptr; }
  /// Called before each run. Null: this one is not watched.
  virtual std::unique_ptr<Watch> watch(const Wave& wave, const Instruction* start) const = 0;
};

/// Who observes a program, and what only the interface knows: where inputs and outputs lie. Unless he wants to be told
/// of blocks alone, its inputs hold what tells invocations apart, read by the shader or not: VertexIndex and
/// InstanceIndex, FragCoord.xy, kIdentity.
struct Observation {
  std::shared_ptr<const Observer> observer;
  ShaderInterface interface;
  Interest interest;
  std::vector<Handler> hooked;  ///< per instruction that is watched: what it does; null: it is not
  /// The second program: no wave runs it by itself. The program's inputs are all that it has.
  std::shared_ptr<const Shader> rehearsal;
};

/// Whether slots of two programs for the same shader hold the same.
bool hold_the_same(const InterfaceSlot& a, const InterfaceSlot& b);

/// Lets the wave's watch be told before the instructions of `program` that its observer wants to know of: accesses and
/// discards. A program without any is not observed if the observer wants nothing else.
void hook_instructions(Program& program);

/// As execute(), for a program with an Observation.
void execute_observed(Wave& wave, const Instruction* start);

/// What a wave that waits at a barrier waits at.
inline const InstructionNote& waits_at(const Wave& wave) {
  return wave.program->notes[static_cast<std::size_t>(wave.resume - wave.program->code.data()) - 1];
}

/// Of a hooked discard: the lanes that it ends.
base::LaneMask discarded_lanes(const Wave& wave, const Instruction* i);

/// Adds lanes that come by a probe of blocks, in as many waves.
void count_block(const Wave& wave, BlockCell& cell, base::LaneMask lanes, std::uint64_t times);

/// The lanes that come by a probe.
base::LaneMask lanes_at(const Wave& wave, const ProbeOp& op);
/// A word of an operand in `lane`; masks as 0 or 1.
std::uint32_t word_of(const Wave& wave, OperandPlace place, std::size_t lane);

}  // namespace vitrine::spirv::exec

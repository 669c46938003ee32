// Observed programs: a second execution loop, chosen before a draw or dispatch, that tells somebody about every
// instruction of the waves he asks for. The plain loop knows nothing of it. An observed program is lowered without
// chains, so that every instruction leaves its result in a register, and computes the same bits.
#pragma once

#include <memory>

#include "spirv/program.h"
#include "spirv/shader.h"

namespace vitrine::spirv::exec {

/// One run of a wave: from its start or from a barrier to its end or the next barrier. The thread that runs the wave
/// makes, calls and destroys it.
class Watch {
 public:
  virtual ~Watch() = default;
  virtual void before(const Wave& wave, const Instruction* instruction) = 0;
  /// `next`: what runs now; null: the wave has ended or waits.
  virtual void after(const Wave& wave, const Instruction* instruction, const Instruction* next) = 0;
};

/// Shared by all threads that run a program.
class Observer {
 public:
  virtual ~Observer() = default;
  /// Called before each run. Null: this one is not watched.
  virtual std::unique_ptr<Watch> watch(const Wave& wave, const Instruction* start) const = 0;
};

/// Who observes a program, and what only the interface knows: where inputs and outputs lie. Its inputs hold what tells
/// invocations apart, read by the shader or not: VertexIndex and InstanceIndex, FragCoord.xy.
struct Observation {
  std::shared_ptr<const Observer> observer;
  ShaderInterface interface;
};

/// As execute(), for a program with an Observation.
void execute_observed(Wave& wave, const Instruction* start);

}  // namespace vitrine::spirv::exec

// The loop of observed programs.
#include "spirv/exec/observe.h"

namespace vitrine::spirv::exec {

void execute_observed(Wave& wave, const Instruction* start) {
  const std::unique_ptr<Watch> watch = wave.program->observation->observer->watch(wave, start);
  if (!watch) return execute(wave, start);
  wave.status = Wave::Status::kRunning;
  for (const Instruction* next = start; next != nullptr;) {
    const Instruction* const instruction = next;
    watch->before(wave, instruction);
    next = instruction->handler(wave, instruction);
    watch->after(wave, instruction, next);
  }
}

}  // namespace vitrine::spirv::exec

// See spirv/counted_runs.h.
#include "spirv/counted_runs.h"

#include <algorithm>

#include "spirv/exec/observe.h"

namespace vitrine::spirv {

/// All lanes come by the first block once. If the only probe is that of it and of blocks that the same lanes come by,
/// nothing depends on what the shader computes.
bool is_counted(const BoundShader& shader) {
  const Program& program = shader.shader().program();
  if (!program.observation || program.observation->interest != exec::Interest{.blocks = true}) return false;
  if (program.probe_ops.size() != 1 || program.has_barrier) return false;
  const ProbeOp& op = program.probe_ops[0];
  return op.guards.empty() && program.probes[op.probe].kind == Probe::Kind::kBlock;
}

bool is_counted_constant(const BoundShader& shader, std::uint32_t reg) {
  const Program& program = shader.shader().program();
  if (program.code.size() > 2) return false;  // the probe and the end
  return std::any_of(program.register_presets.begin(), program.register_presets.end(),
                     [&](const Preset& p) { return p.to == reg * kRegisterStride; });
}

void count_runs(const BoundShader& shader, base::LaneMask active, base::LaneMask helpers, std::uint64_t times) {
  if (shader.fault().raised.load(std::memory_order_relaxed)) return;  // the device is lost: nothing runs
  const Program& program = shader.shader().program();
  Wave wave;
  wave.program = &program;
  wave.resources = &shader.resources();
  wave.active = wave.launched = active;
  wave.live = active & ~helpers;
  const exec::Observer& observer = *program.observation->observer;
  if (exec::Watch* lasting = observer.lasting_watch()) return lasting->probes(wave, program.probe_ops[0], times);
  if (const auto watch = observer.watch(wave, program.code.data())) watch->probes(wave, program.probe_ops[0], times);
}

}  // namespace vitrine::spirv

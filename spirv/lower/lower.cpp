// The passes of the lowering in their order.
#include "spirv/lower/lower.h"

#include <algorithm>
#include <utility>

#include "base/log.h"
#include "base/simd.h"
#include "spirv/exec/observe.h"
#include "spirv/lower/alike.h"
#include "spirv/lower/emit.h"
#include "spirv/lower/registers.h"
#include "spirv/lower/scalar.h"
#include "spirv/lower/tables.h"

namespace vitrine::spirv {
namespace {

/// Varying registers of a program: 16 MiB of wave memory.
constexpr std::uint32_t kMaxRegisters = 65536;
/// Of a rehearsal: with more of them a person waits for minutes.
constexpr std::uint32_t kMaxRehearsedRegisters = 8192;

}  // namespace

base::Result<std::unique_ptr<Shader>> lower(ir::Function&& function, std::shared_ptr<const exec::Observer> observer,
                                            std::shared_ptr<const Shader> rehearsal) {
  base::select_simd_target();
  const exec::Interest interest = observer ? observer->interest() : exec::Interest{};
  std::string error;
  if (interest.order) lowering::mark_alike(function);
  lowering::make_tables(function);
  lowering::ScalarFunction scalars = lowering::scalarize(function, error, interest.accesses);
  if (!error.empty()) return base::Error{error};
  lowering::remove_dead(scalars);
  lowering::find_wave_uniform(scalars);
  lowering::hoist_invariants(scalars);
  lowering::fuse_tests(scalars);
  lowering::combine_loads(scalars);
  if (observer) lowering::join_probes(scalars);
  lowering::remove_dead(scalars);
  lowering::fuse_multiply_add(scalars);
  lowering::fuse_integers(scalars);
  lowering::select_operations(scalars);
  lowering::schedule_chains(scalars, interest.instructions);
  ShaderInterface interface = function.interface;
  if (observer && observer->interest() != exec::Interest{.blocks = true}) lowering::keep_identity(scalars, interface);
  if (rehearsal) lowering::keep_inputs(scalars, interface, rehearsal->interface());
  const lowering::Allocation allocation = lowering::allocate(scalars);
  const bool rehearses = interest.rehearsal && !rehearsal;
  if (allocation.register_count > (rehearses ? kMaxRehearsedRegisters : kMaxRegisters))
    return base::Error{"the shader keeps too many values alive"};
  std::unique_ptr<Program> program = lowering::emit(scalars, allocation, interface, error);
  if (!error.empty()) return base::Error{error};
  program->flush_denormals = interface.stage != VK_SHADER_STAGE_COMPUTE_BIT;
  for (int i = 0; i < 3; ++i) program->local_size[i] = interface.local_size[i];
  program->groups_per_wave = scalars.groups_per_wave;
  if (rehearsal) program->groups_per_wave = std::min(program->groups_per_wave, rehearsal->program().groups_per_wave);
  program->uses_subgroups = scalars.uses_subgroups;
  program->helpers_take_part = function.helpers_take_part;
  program->sources = std::move(function.sources);
  program->shared_bytes = interface.shared_bytes;
  program->zeroed_shared = interface.zeroed_shared;
  if (observer) {
    program->observation = std::make_shared<exec::Observation>(
        exec::Observation{std::move(observer), interface, interest, {}, std::move(rehearsal)});
    if (interest.accesses || interest.images || interest.discards) exec::hook_instructions(*program);
    if (program->observation) program->observation->observer->made(*program);
  }
  if (base::log_enabled("shader")) base::log("shader", disassemble(*program));
  return std::make_unique<Shader>(std::move(interface), std::unique_ptr<const Program>(std::move(program)));
}

}  // namespace vitrine::spirv

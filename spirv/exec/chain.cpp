// Finds the handler of a chain link among the families.
#include "spirv/exec/chain.h"

#include "base/check.h"
#include "base/simd.h"
#include "spirv/exec/chain_families.h"

namespace vitrine::spirv::exec {
namespace {

Handler find(ir::Op op, int accumulator, UniformSources uniform, Link link) {
  base::select_simd_target();
  for (const auto family : {alu::float_chain, alu::integer_chain, alu::compare_chain})
    if (const Handler handler = family(op, accumulator, uniform, link)) return handler;
  return nullptr;
}

}  // namespace

const Instruction* no_chain(Wave&, const Instruction* instruction) {
  VITRINE_UNREACHABLE("a chain in a target without chains");
  return instruction + 1;
}

bool is_chain_link(ir::Op op, int accumulator, UniformSources uniform, Link link) {
  return find(op, accumulator, uniform, link) != nullptr;
}

Handler chain_handler(ir::Op op, int accumulator, UniformSources uniform, Link link) {
  const Handler handler = find(op, accumulator, uniform, link);
  return handler == no_chain ? nullptr : handler;
}

}  // namespace vitrine::spirv::exec

// Finds the handler of a chain link among the families.
#include "spirv/exec/chain.h"

#include "base/simd.h"
#include "spirv/exec/chain_families.h"

namespace vitrine::spirv::exec {

Handler chain_handler(ir::Op op, int accumulator, UniformSources uniform, Link link) {
  base::select_simd_target();
  for (const auto family : {alu::float_chain, alu::integer_chain, alu::compare_chain})
    if (const Handler handler = family(op, accumulator, uniform, link)) return handler;
  return nullptr;
}

}  // namespace vitrine::spirv::exec

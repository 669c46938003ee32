// The parts of the chain table, one per translation unit.
#pragma once

#include "spirv/exec/chain.h"

namespace vitrine::spirv::exec {

/// Stands for the handler of a link in targets that have none; never called.
const Instruction* no_chain(Wave& wave, const Instruction* instruction);

}  // namespace vitrine::spirv::exec

namespace vitrine::spirv::alu {

Handler float_chain(ir::Op op, int accumulator, UniformSources uniform, exec::Link link);
Handler integer_chain(ir::Op op, int accumulator, UniformSources uniform, exec::Link link);
Handler compare_chain(ir::Op op, int accumulator, UniformSources uniform, exec::Link link);

}  // namespace vitrine::spirv::alu

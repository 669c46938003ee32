// Finds the handler of an ALU op among the families (spirv/program.h).
#include "base/simd.h"
#include "spirv/alu/family.h"
#include "spirv/program.h"

namespace vitrine::spirv {
namespace {

/// The family's row that has handlers for `op`. Every row of ops.def is in one family (tests/spirv/alu).
const alu::OpHandlers& handlers_of(ir::Op op) {
  base::select_simd_target();
  const auto index = static_cast<std::size_t>(op);
  for (const auto family :
       {alu::float_family, alu::compare_family, alu::integer_family, alu::convert_family, alu::transcendental_family}) {
    const alu::OpHandlers& handlers = family()[index];
    if (handlers.scalar) return handlers;
  }
  return alu::boolean_family()[index];
}

}  // namespace

Handler alu_handler(ir::Op op, UniformSources uniform) {
  const alu::OpHandlers& handlers = handlers_of(op);
  const unsigned sources = ir::alu_info(op).sources;
  return handlers.wave[uniform & ((1u << sources) - 1)];
}

Handler alu_scalar_handler(ir::Op op) { return handlers_of(op).scalar; }

}  // namespace vitrine::spirv

// Scalar model of every row of spirv/ops.def, written from lavapipe-shader-math.md alone: what the tests compare the
// wave handlers with. Runs in the floating-point mode of the caller.
#pragma once

#include <cstdint>

#include "spirv/ir.h"

namespace vitrine::spirv::alu_model {

/// Result bits of `op` for operand bits (booleans: 0 / 1). Derivatives are not lane operations: not in here.
std::uint32_t evaluate(ir::Op op, std::uint32_t a, std::uint32_t b, std::uint32_t c);

/// Equal bits, or both NaN when `op` gives a float.
bool same_result(ir::Op op, std::uint32_t want, std::uint32_t got);

}  // namespace vitrine::spirv::alu_model

// Operations on constants, as the reference's compiler computes them on the host
// (nir_constant_expressions.py; lavapipe-optimizer.md 4.7).
#pragma once

#include <cstdint>

#include "spirv/rewrite/graph/graph.h"

namespace vitrine::spirv::rewriting {

/// Result bits of `op` for constant operands (booleans 0 / 1). False: this op is not folded.
bool evaluate(ir::Op op, const std::uint32_t operand[3], std::uint32_t& result);

/// Result of the float operation `inst` for constant operands, component `c`: words, of a comparison 0 or 1. False: it
/// is not folded.
bool evaluate_sized(const Graph& graph, const Inst& inst, unsigned c, std::uint32_t words[2]);

/// The same for conversions of wide_ops.def that make a float.
bool evaluate_conversion(const Graph& graph, const Inst& inst, std::uint32_t words[2]);

/// The same for operations of wide_ops.def on 64-bit integers, also where not all operands are constant: x - x.
bool evaluate_integers(const Graph& graph, const Inst& inst, std::uint32_t words[2]);

/// The 32-bit number that `inst` takes the low 8 or 16 bits of and extends from their sign, if it is such a number
/// already: a smaller or larger one of extended numbers. None: it is something else.
Src extended_before(const Graph& graph, const Inst& inst);

/// True for a word of min(0, x) of unsigned 64-bit integers, which is spelled 0 < x ? 0 : x: it is 0.
bool is_minimum_with_zero(const Graph& graph, const Inst& select);

}  // namespace vitrine::spirv::rewriting

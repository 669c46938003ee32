// Literals of 16, 32 and 64 bits as the rules and constant folding read and write them.
#pragma once

#include <array>
#include <cstdint>

#include "spirv/rewrite/graph.h"

namespace vitrine::spirv::rewriting {

/// The float of `width` bits that an operand with this swizzle reads first.
double literal_number(const Inst& constant, const std::array<std::uint8_t, 4>& swizzle, unsigned width);

/// Words of `number`, rounded to `width` bits: two of a double, else one.
void literal_words(double number, unsigned width, std::uint32_t words[2]);

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

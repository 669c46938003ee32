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

/// The same for conversions of wide_ops.def that make a float, and for comparisons with 0 of 64-bit integers that are
/// never negative.
bool evaluate_conversion(const Graph& graph, const Inst& inst, std::uint32_t words[2]);

}  // namespace vitrine::spirv::rewriting

// What a comparison of integers gives whatever they are, as far as the optimiser of the reference's code generator
// tells it: by known bits, by ranges of operations with a literal that do not overflow, and by what an equality says
// about the operand behind such operations.
#pragma once

#include <cstdint>

#include "spirv/rewrite/known_bits.h"

namespace vitrine::spirv::rewriting {

/// Bounds of a 32-bit integer, read as an unsigned and as a signed number.
struct IntegerRange {
  KnownBits bits;
  std::uint32_t least = 0, largest = ~0u;
  std::int32_t least_signed = INT32_MIN, largest_signed = INT32_MAX;
};

/// Of what an operation on scalars reads.
IntegerRange integer_range(const Graph& graph, Src src);

/// The result (0 or 1) of a comparison of 32-bit integers; -1 if it can be either or `inst` is none.
int known_comparison(const Graph& graph, const Inst& inst);

}  // namespace vitrine::spirv::rewriting

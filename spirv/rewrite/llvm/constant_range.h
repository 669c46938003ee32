// Bounds of integers as far as the optimiser of the reference's code generator tells them: by known bits, by operations
// with a literal that do not overflow, and by what an equality says about the operand behind such operations
// (lavapipe-optimizer.md 7.5).
#pragma once

#include <cstdint>
#include <optional>

#include "spirv/rewrite/llvm/known_bits.h"

namespace vitrine::spirv::rewriting {

/// Bounds of a 32-bit integer, read as an unsigned and as a signed number.
struct ConstantRange {
  KnownBits bits;
  std::uint32_t least = 0, largest = ~0u;
  std::int32_t least_signed = INT32_MIN, largest_signed = INT32_MAX;
};

/// What asks for a range. Signed comparisons do not see the least quotient or minimum of unsigned numbers, equalities
/// see nothing of what is divided: they are asked of the dividend (can_be).
enum class Asking : std::uint8_t { kUnsigned, kSigned, kEquality };

/// Of what an operation on scalars reads.
ConstantRange constant_range(const Graph& graph, Src src, Asking asking = Asking::kUnsigned);

/// What the bits alone tell.
ConstantRange range_of_bits(const Graph& graph, Src src);

/// The integer, if all of its bits are known.
std::optional<std::uint32_t> known_literal(const Graph& graph, Src src);

/// Whether the integer can be this literal.
bool can_be(const Graph& graph, Src src, std::uint32_t literal);

/// Whether the integer is below `limit` where it is a sum with a literal, if the other operand's bits tell.
std::optional<bool> is_below(const Graph& graph, Src src, std::uint32_t limit);

}  // namespace vitrine::spirv::rewriting

// What can be told about the bits of a 32-bit integer without running the shader, as far as the optimiser of the
// reference's code generator tells it: through six operations, as its passes do (lavapipe-optimizer.md 7.4).
#pragma once

#include <cstdint>

#include "spirv/rewrite/graph/graph.h"

namespace vitrine::spirv::rewriting {

struct KnownBits {
  std::uint32_t possible = ~0u;  ///< bits that are not known to be zero: the largest unsigned value
  std::uint32_t certain = 0;     ///< bits that are known to be one: the least unsigned value

  std::uint32_t known() const { return ~(possible ^ certain); }
  std::int32_t least_signed() const { return static_cast<std::int32_t>(certain | (possible & kSign)); }
  std::int32_t largest_signed() const { return static_cast<std::int32_t>((possible & ~kSign) | (certain & kSign)); }

  static constexpr std::uint32_t kSign = 0x80000000;
};

/// Of a + literal.
KnownBits sum(KnownBits a, std::uint32_t literal);

/// Of what an operation on scalars reads.
KnownBits known_bits(const Graph& graph, Src src);

/// Whether it is known not to be zero: by a bit that is set, or by what makes it.
bool is_nonzero(const Graph& graph, Src src);

}  // namespace vitrine::spirv::rewriting

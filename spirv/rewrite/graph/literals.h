// Literals of 16, 32 and 64 bits as the rules and constant folding read and write them.
#pragma once

#include <array>
#include <cstdint>

#include "spirv/rewrite/graph/graph.h"

namespace vitrine::spirv::rewriting {

/// The float of `width` bits that an operand with this swizzle reads first.
double literal_number(const Inst& constant, const std::array<std::uint8_t, 4>& swizzle, unsigned width);

/// Words of `number`, rounded to `width` bits: two of a double, else one.
void literal_words(double number, unsigned width, std::uint32_t words[2]);

}  // namespace vitrine::spirv::rewriting

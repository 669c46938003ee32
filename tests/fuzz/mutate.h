// Structure-aware mutation of SPIR-V modules: instructions stay instructions, operands become ids of the same type.
#pragma once

#include <cstdint>
#include <vector>

#include "tests/fuzz/random.h"

namespace vitrine::fuzz {

using Words = std::vector<std::uint32_t>;

/// One to a few changes; most modules stay valid or nearly so.
void mutate(Words& words, Random& random);

/// A few changes of what functions compute: opcodes of one shape and operands of one type stand in for each other.
/// What decides where memory is read or written and when loops end stays as it is, so that a module without races gets
/// none. So does what keeps the bits of NaNs from the results (OpIsNan, choices by it, OpBitcast),
/// and what becomes an integer.
void mutate_values(Words& words, Random& random);

}  // namespace vitrine::fuzz

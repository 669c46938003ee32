// Structure-aware mutation of SPIR-V modules: instructions stay instructions, operands become ids of the same type.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

namespace vitrine::fuzz {

using Words = std::vector<std::uint32_t>;
using Random = std::mt19937_64;

/// One to a few changes; most modules stay valid or nearly so.
void mutate(Words& words, Random& random);

}  // namespace vitrine::fuzz

// Valid relatives of the cases' shaders (--mutate).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace vitrine::cts {

/// A module that computes something else where `words` computes values, and is still valid; `words` if none is found.
/// The same for the same words and seed.
std::vector<uint32_t> mutant_of(const std::vector<uint32_t>& words, uint64_t seed);

std::string disassemble(const std::vector<uint32_t>& words);

}  // namespace vitrine::cts

// Where mutation takes its choices from.
#pragma once

#include <cstddef>
#include <random>

namespace vitrine::fuzz {

using Random = std::mt19937_64;

/// In [0, count); count > 0.
inline std::size_t below(Random& random, std::size_t count) { return static_cast<std::size_t>(random() % count); }

}  // namespace vitrine::fuzz

// Compute shaders made at random, and what must be seen of them: whatever is written to the text is also put together
// as something that can be run here, statement by statement, which records every line that it comes to with the
// values of all variables that are visible there. Integers are exact; floating-point numbers are multiples of a
// quarter that are small enough for every order of operations to be exact.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace vitrine::glass::debug::test {

inline constexpr std::uint32_t kRandomLanes = 8;

struct ExpectedFrame {
  std::uint32_t line = 0;
  std::vector<std::pair<std::string, std::string>> values;  ///< of visible variables, by name
};

/// A line that the invocation comes to.
struct ExpectedStop {
  std::vector<ExpectedFrame> frames;  ///< innermost first
};

struct RandomShader {
  std::string text;
  std::vector<ExpectedStop> stops;  ///< of the invocation that was asked for
  /// What the buffer (binding 0 of set 0) holds at the end, where it began with kRandomWords words, 10, 11, ...
  std::vector<std::uint32_t> words;
};
inline constexpr std::uint32_t kRandomWords = 64;

RandomShader make_random_shader(std::uint32_t seed, std::uint32_t lane);

}  // namespace vitrine::glass::debug::test

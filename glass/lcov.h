// Coverage as an lcov tracefile (geninfo(1)): functions, lines and branches of source files, with how often they ran.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vitrine::glass {

struct FileCoverage {
  struct Function {
    std::uint32_t line = 0;
    std::uint64_t count = 0;
  };
  std::map<std::string, Function> functions;
  std::map<std::uint32_t, std::uint64_t> lines;
  /// (line, number of the branching place on it) -> how often each way was taken; nothing: it was never asked.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::optional<std::uint64_t>>> branches;
};

/// By file name.
using Coverage = std::map<std::string, FileCoverage>;

/// A function's line is the first behind its beginning that has code.
std::string to_lcov(const Coverage& coverage);

}  // namespace vitrine::glass

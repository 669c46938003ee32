// Coverage of several processes and runs: lcov tracefiles (geninfo(1)) read and added up.
#pragma once

#include <string>
#include <string_view>

#include "glass/lcov.h"

namespace vitrine::glass::cli {

/// Adds what a tracefile says. False: a line of it is none of a tracefile (`error` names it).
bool add_tracefile(std::string_view text, Coverage& coverage, std::string& error);

/// How much there is and how much of it ran.
struct CoverageSummary {
  struct Part {
    std::size_t found = 0, hit = 0;
    double percent() const { return found == 0 ? 100 : 100.0 * static_cast<double>(hit) / static_cast<double>(found); }
  } lines, functions, branches;
};
CoverageSummary summary_of(const Coverage& coverage);

}  // namespace vitrine::glass::cli

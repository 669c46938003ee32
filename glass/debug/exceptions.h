// What shaders may be stopped for besides lines: what happens in them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "glass/debug/run.h"
#include "glass/finding.h"

namespace vitrine::glass::debug {

/// Bits of what is caught.
enum Catch : unsigned {
  kCatchPrintf = 1,   ///< a message of NonSemantic.DebugPrintf
  kCatchNan = 2,      ///< an operation makes a NaN of numbers
  kCatchFinding = 4,  ///< the tools sanitize and race find something
};

/// "printf", "nan", "finding"; 0: it is none.
unsigned catch_of(std::string_view name);
/// Their names, separated by commas; empty: nothing is caught.
std::string catches_text(unsigned catches);

/// Whether the shader has probes of what is caught.
bool may_raise(const Subject& subject, unsigned catches);

/// "finding: error: load of 4 bytes ... [vitrine/race-shared]", with what it is about.
std::string finding_text(const Finding& finding);

struct Raised {
  std::size_t lane = 0;
  std::string text;  ///< "printf: i is 5", "nan: NaN made of 0.0, 0.0"
};
/// What happens at a probe in the first of `lanes` in which it does, `preferred` before others.
std::optional<Raised> raised_at(const spirv::Probe& probe, const spirv::Wave& wave, const spirv::ProbeOp& op,
                                base::LaneMask lanes, std::size_t preferred, unsigned catches);

}  // namespace vitrine::glass::debug

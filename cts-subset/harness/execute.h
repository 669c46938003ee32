// Runs one case on both devices and judges it.
#pragma once

#include <string>

#include "harness/case.h"

namespace vitrine::cts {

enum class Verdict { kIdentical, kDeviation, kUnsupported, kKnown, kDiffering, kCrashed };

struct Judgement {
  Verdict verdict = Verdict::kIdentical;
  std::string message;    ///< empty unless something is to be told
  bool nan_bits = false;  ///< identical but for bits of NaNs, where they are free
  bool blank = false;     ///< every output had one value everywhere (allowed)
};

/// The case's full name: group.name.
std::string full_name(const Case& c);
/// The case's seed, from the suite's seed and its name.
uint64_t case_seed(const Case& c);
Judgement execute(const Case& c);
/// Reads the list of known differences that the options name. Throws when it cannot be read.
void load_known_differences();
/// Asks the reference for its CPU-dependent behaviour and prints it (DESIGN.md section 8).
void probe_reference();

}  // namespace vitrine::cts

// What this driver's tools may find in the suite's cases: those that do wrong on purpose.
#pragma once

#include <span>
#include <string>

#include "harness/gpu.h"

namespace vitrine::cts {

/// Reads the list that the options name: a line has cases (a full name, or the beginning of one and a '*'), the rule
/// that they break, and the reason. Throws when it cannot be read.
void load_expected_findings();

/// The findings of a case that the list does not have, as lines of its message; empty without a list.
std::string unexpected_findings(const std::string& name, std::span<const Finding> findings);

}  // namespace vitrine::cts

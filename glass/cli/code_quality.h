// Findings as GitLab's report of code quality, which merge requests show at their lines:
// https://docs.gitlab.com/ci/testing/code_quality, "Code Quality report format".
#pragma once

#include <string>
#include <vector>

#include "glass/finding.h"

namespace vitrine::glass::cli {

/// A JSON list with an object a finding: "description", "check_name", "fingerprint" (no two have the same), "severity",
/// "location". Findings without a file are left out, as the format has no place for them.
std::string code_quality(const std::vector<Finding>& findings);

}  // namespace vitrine::glass::cli

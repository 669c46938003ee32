// Findings as the commands that GitHub's runners read in a job's output, and show at the lines of a pull request:
// https://docs.github.com/actions/reference/workflow-commands-for-github-actions, "Setting an error message".
#pragma once

#include <string>
#include <vector>

#include "glass/finding.h"

namespace vitrine::glass::cli {

/// A line a finding: "::error file=a.comp,line=3,title=vitrine/out-of-bounds-store::store of 4 bytes...". What shaders
/// say (Severity::kNote) is a notice.
std::string annotations(const std::vector<Finding>& findings);

}  // namespace vitrine::glass::cli

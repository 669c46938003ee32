// Files of findings as code hosts know them: by their path in the repository.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "glass/finding.h"

namespace vitrine::glass::cli {

/// Where paths of the repository start: the nearest folder with a .git of this one and those above it; none: this one.
std::filesystem::path repository_root(const std::filesystem::path& folder);

/// The name that a shader's compiler has noted, from the root on. `folder`: the current one. Absolute names lie below
/// the root; relative ones exist in `folder`, or were noted in another one ("../a.comp", by a build in build/) and
/// exist below the root or `folder` without the steps upwards. Else the name stays.
std::string path_in_repository(const std::string& file, const std::filesystem::path& root,
                               const std::filesystem::path& folder);

/// The same for all frames of all findings, from the current folder on.
std::vector<Finding> in_repository(std::vector<Finding> findings);

/// Some finding lies in the disassembly that the driver made of a module without debug information, not in a file.
bool any_in_disassembly(const std::vector<Finding>& findings);

}  // namespace vitrine::glass::cli

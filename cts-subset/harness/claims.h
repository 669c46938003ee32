// What cases ask of the reference before they run (its formats, features and extensions), as text: where it is only
// recorded, they draw the same shaders, formats and states as when it was there.
#pragma once

#include <string>
#include <vector>

#include "harness/gpu.h"

namespace vitrine::cts {

/// One claim a line: "extensions NAME...", "features BITS", "structure TYPE BITS", "format NUMBER LINEAR OPTIMAL
/// BUFFER".
std::vector<std::string> claims_of(const Gpu& gpu);
/// A device that can be asked and not be used.
Gpu gpu_of_claims(const std::string& name, const std::vector<std::string>& claims);

}  // namespace vitrine::cts

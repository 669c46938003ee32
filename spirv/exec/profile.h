// How often and how long each kind of instruction of a program ran (VITRINE_LOG=shader-profile).
#pragma once

#include <string>

#include "spirv/program.h"

namespace vitrine::spirv::exec {

/// Whether execute() records. Constant over the life of the process.
bool profile_enabled();

/// As execute(), and records under the wave's program. The clock is read around every handler: times of short ones are
/// mostly its own.
void execute_profiled(Wave& wave, const Instruction* start);

/// The record of a program as a table, longest first; forgets it. Empty if nothing ran.
std::string take_profile(const Program& program);

}  // namespace vitrine::spirv::exec

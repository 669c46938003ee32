// Why two accesses are not ordered, and the code that would order them.
#pragma once

#include <string>

#include "glass/race/conflict.h"

namespace vitrine::glass::race {

/// ": no barrier of shared memory lies between them".
std::string reason_of(const Conflict& conflict);
/// "barrier();" with where it goes.
std::string remedy_of(const Conflict& conflict);

}  // namespace vitrine::glass::race

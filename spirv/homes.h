// Homes of variables: in a rehearsed program (spirv/exec/observe.h) those of functions, private ones and outputs keep
// their values in local arrays, so that whoever debugs it can change them. Rows of Program::probes say where; no
// instruction names these rows.
#pragma once

#include "spirv/probe.h"

namespace vitrine::spirv {

/// A row of Kind::kAssign with a number: `cells` cells from `first_cell` on (spirv/source_variables.h) are the elements
/// of a local array. `number` - 1: in ir::Function the number of the array, in a Program the byte offset of its first
/// element from Wave::arrays. A vector of 64-bit numbers has its low words in front of its high words.
inline bool is_home(const Probe& probe) { return probe.kind == Probe::Kind::kAssign && probe.number != 0; }

}  // namespace vitrine::spirv

// The steps of `vitrine reduce`: each makes a bug smaller as long as what was found in it stays.
#pragma once

#include <functional>

#include "glass/bug/bug.h"

namespace vitrine::glass::cli {

/// Whether what is looked for is still found in a candidate.
using StillFound = std::function<bool(const bug::Bug&)>;

/// Fewer workgroups, draws, instances, vertices.
void reduce_invocations(bug::Bug& bug, const StillFound& still);
/// Fewer descriptors, and none of the objects that only they named.
void reduce_descriptors(bug::Bug& bug, const StillFound& still);
/// Less memory: what is left out is as the device allocates it.
void reduce_memory(bug::Bug& bug, const StillFound& still);
/// State that is as it is by default.
void reduce_state(bug::Bug& bug, const StillFound& still);

/// Takes away objects that nothing names.
void drop_unused(bug::Bug& bug);
/// Takes away descriptors that no stage declares, and what only they named.
void drop_undeclared(bug::Bug& bug);

}  // namespace vitrine::glass::cli

// What a comparison of integers gives whatever they are, as far as the optimiser of the reference's code generator
// tells it: by their ranges, and by how operations relate to their own operands (lavapipe-optimizer.md 7.6).
#pragma once

#include "spirv/rewrite/graph/graph.h"

namespace vitrine::spirv::rewriting {

/// The result (0 or 1) of a comparison of 32-bit integers; -1 if it can be either or `inst` is none.
int simplify_icmp(const Graph& graph, const Inst& inst);

}  // namespace vitrine::spirv::rewriting

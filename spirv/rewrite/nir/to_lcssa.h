// Values that leave loops: read behind the loop as they are while the rewrites run, results of the loop otherwise
// (nir_to_lcssa.c; lavapipe-optimizer.md 5.18).
#pragma once

#include "spirv/rewrite/graph/graph.h"

namespace vitrine::spirv::rewriting {

/// Uses of results of loops read the value that the loop ends with, where that is one value; unused results go.
bool leave_lcssa(Graph& graph);

/// The opposite, which the shader core and unrolling need: what leaves a loop (`only` this one, kNone: any) is a
/// result.
void convert_to_lcssa(Graph& graph, InstId only = kNone);

/// True when something behind the loop reads a value of the loop that is no result.
bool is_used_behind(const Graph& graph, InstId loop);

}  // namespace vitrine::spirv::rewriting

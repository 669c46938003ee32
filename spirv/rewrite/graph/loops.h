// Loops in the form that the rewrites keep: every value that changes is a parameter; what goes round is passed at the
// end of the body and by Continue, parameter by parameter; the continue construct only hands it on
// (lavapipe-optimizer.md 2.2).
#pragma once

#include <vector>

#include "spirv/rewrite/graph/graph.h"

namespace vitrine::spirv::rewriting {

bool has_loops(const Graph& graph);

/// Jumps of this kind that belong to the loop around `block`, in their order.
void collect_jumps(const Graph& graph, BlockId block, Op op, std::vector<InstId>& found);

/// Continues, and the end of the body if it is a way back.
std::vector<InstId> ways_back(const Graph& graph, InstId loop);

/// The way back of a loop that has one only, the end of its body; kNone: none or several.
InstId latch_of(const Graph& graph, InstId loop);

/// What the reference calls the header block: the body's instructions before its first If or Loop.
std::vector<InstId> header_of(const Graph& graph, InstId loop);

/// Index of the parameter, or -1.
int param_index(const Graph& graph, InstId loop, ValueId value);

/// A new parameter, the same `next` on every way back.
ValueId add_param(Graph& graph, InstId loop, ValueId like, Src init, Src next);

/// New parameters, every one with its `initial` value on the ways back, too.
std::vector<ValueId> add_params(Graph& graph, InstId loop, const std::vector<ValueId>& initial);

}  // namespace vitrine::spirv::rewriting

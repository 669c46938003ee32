// Loops in the form that the rewrites keep: every value that changes is a parameter; what goes round is passed at the
// end of the body and by Continue, parameter by parameter; the continue construct only hands it on.
#pragma once

#include <vector>

#include "spirv/rewrite/graph.h"

namespace vitrine::spirv::rewriting {

bool has_loops(const Graph& graph);

/// Gives every loop that form.
void straighten_loops(Graph& graph);

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

/// A value equal to `src`, of the type of `like`, in front of `position`. The reference takes what a loop starts and
/// goes on with through a register that it writes as far up as each block has one successor; where ways join in
/// between, the next round's rules see only that they join.
Src through_register(Graph& graph, InstId position, Src src, ValueId like);

/// All that the loop starts and goes on with.
void pass_through_registers(Graph& graph, InstId loop);

/// All that the loop ends with.
void leave_through_registers(Graph& graph, InstId loop);

/// The results of an If at the top level of a loop's body, before registers join them.
struct Join {
  InstId branch = kNone;
  std::size_t results = 0;
};
std::vector<Join> joins_in(const Graph& graph, InstId loop);

/// All that those Ifs hand on, which is read from its register behind each.
void join_through_registers(Graph& graph, const std::vector<Join>& joins);

/// Drops parameters of loops and results that only serve themselves.
bool drop_dead_joins(Graph& graph);

/// What runs from the second iteration on, and has stayed at the top of the body, becomes the continue construct.
void close_continues(Graph& graph);

}  // namespace vitrine::spirv::rewriting

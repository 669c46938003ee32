// Joins of a loop that become registers and joins again where a step of the reference moves blocks
// (lavapipe-optimizer.md 5.17).
#pragma once

#include <vector>

#include "spirv/rewrite/graph/graph.h"

namespace vitrine::spirv::rewriting {

/// A value equal to `src`, of the type of `like`, in front of `position`. The reference takes what a loop starts and
/// goes on with through a register that it writes as far up as each block has one successor; where ways join in
/// between, the next round's rules see only that they join.
Src through_register(Graph& graph, InstId position, Src src, ValueId like);

/// All that the loop starts and goes on with.
void pass_through_registers(Graph& graph, InstId loop);

/// All that the loop ends with.
void leave_through_registers(Graph& graph, InstId loop);

/// The results of an If at the top level of a loop's body, before registers join them.
struct BranchJoin {
  InstId branch = kNone;
  std::size_t results = 0;
};
std::vector<BranchJoin> joins_in(const Graph& graph, InstId loop);

/// All that those Ifs hand on, which is read from its register behind each.
void join_through_registers(Graph& graph, const std::vector<BranchJoin>& joins);

}  // namespace vitrine::spirv::rewriting

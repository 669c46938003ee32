// What instructions do besides computing, and what they read.
#pragma once

#include "spirv/rewrite/graph/graph.h"

namespace vitrine::spirv::rewriting {

/// Components that a user reads of operand `index`; 0: all of them, in their order.
unsigned components_read(const Graph& graph, const Inst& user, std::uint32_t index);

/// True when removing the instruction changes nothing if its result is unused.
bool is_pure(const Graph& graph, const Inst& inst);

}  // namespace vitrine::spirv::rewriting

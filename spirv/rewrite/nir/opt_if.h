// The steps of opt_if(), named as in nir_opt_if.c, for one If or loop each.
#pragma once

#include "spirv/rewrite/graph/graph.h"

namespace vitrine::spirv::rewriting {

/// The second of two branches on one condition with nothing between them.
bool opt_if_merge(Graph& graph, InstId id);

/// A branch with nothing to do on its first side, on a comparison: the sides change places.
bool opt_if_simplification(Graph& graph, InstId id);

/// Results that are true on one side and false on the other are the condition or its negation.
bool opt_if_phi_is_condition(Graph& graph, InstId id);

/// Neighbouring ways out of a loop become one.
bool opt_merge_breaks(Graph& graph, InstId id);

/// Arithmetic on parameters of a loop in its header moves to where they are made.
bool opt_split_alu_of_phi(Graph& graph, InstId loop);

/// Selections that only the first iteration decides become parameters.
bool opt_simplify_bcsel_of_phi(Graph& graph, InstId loop);

/// Where only the first iteration decides the first branch: what it does there goes in front of the loop.
bool opt_peel_loop_initial_if(Graph& graph, InstId loop);

}  // namespace vitrine::spirv::rewriting

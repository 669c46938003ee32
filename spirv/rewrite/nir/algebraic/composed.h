// Operations that are single ones in the reference until its rules come to them, and several here.
#pragma once

#include <vector>

#include "spirv/rewrite/graph/graph.h"

namespace vitrine::spirv::rewriting {

/// In the first run of the rules the reference has dot products as single operations; after it, products are open, and
/// sums of two in their next run; sums of three and four stay closed. Shortened dot products open after the round.
/// Remainders and ldexp are single operations until the rules come to them.
void hide_composed(Graph& graph);
void show_products(Graph& graph);
void show_short_products(Graph& graph);

/// The instructions that make a remainder or ldexp together with the closed one that ends it, operands first; none: it
/// ends neither.
std::vector<InstId> parts_of_composed(const Graph& graph, InstId id);

/// Before the rules of the first round: dot products with vectors that end in zeros.
void shorten_dot_products(Graph& graph);

/// What the reference counts for an arithmetic instruction where its limits count instructions.
unsigned cost_of(const Graph& graph, const Inst& inst);

}  // namespace vitrine::spirv::rewriting

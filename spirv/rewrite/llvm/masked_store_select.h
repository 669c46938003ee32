// Which branches the reference's optimiser sees as selections, and which selections of floats it keeps as such
// (lavapipe-optimizer.md 7.9).
#pragma once

#include "spirv/rewrite/graph/graph.h"

namespace vitrine::spirv::rewriting {

/// A comparison of 32-bit integers: their type is that of the masks which select between two literals, and the
/// reference's code generator does not move the conversion to float into such a selection, which hides it.
bool compares_integers(const Graph& graph, Src condition);

/// A comparison of floats: what selects between floats by it converts to integers as a whole.
bool compares_floats(const Graph& graph, Src condition);

/// True when the conversion to float moves into a selection of a literal and `operand`.
bool converts_sides(const Graph& graph, Src condition, Src operand);

/// The result of `branch`, of which one `side` (1: then, 2: else) is the literal `identity` and the other one
/// `written`, is one selection.
bool writes_selection(const Graph& graph, const Inst& branch, unsigned side, Src written, std::uint32_t identity);

}  // namespace vitrine::spirv::rewriting

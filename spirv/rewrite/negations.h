// Which operand of a product the reference's optimiser negates instead of the product.
#pragma once

#include "spirv/rewrite/graph.h"

namespace vitrine::spirv::rewriting {

/// True when the product (scalar code) is negated by its only user, and the reference's optimiser negates operand
/// `index` of it instead. That operand is a selection.
bool negates_selection(Graph& graph, InstId product, std::uint32_t index);

}  // namespace vitrine::spirv::rewriting

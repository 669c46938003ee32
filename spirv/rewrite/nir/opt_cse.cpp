// Common subexpressions (nir_opt_cse.c).
#include "spirv/rewrite/graph/merge_equal.h"
#include "spirv/rewrite/nir/passes.h"

namespace vitrine::spirv::rewriting {

bool opt_cse(Graph& graph, bool push) { return merge_equal(graph, {.push = push}); }

}  // namespace vitrine::spirv::rewriting

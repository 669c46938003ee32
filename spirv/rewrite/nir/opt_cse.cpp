// Common subexpressions (nir_opt_cse.c; lavapipe-optimizer.md 3.6).
#include "spirv/rewrite/graph/merge_equal.h"
#include "spirv/rewrite/nir/passes.h"

namespace vitrine::spirv::rewriting {

bool opt_cse(Graph& graph) { return merge_equal(graph, {}); }
bool opt_cse_but_push(Graph& graph) { return merge_equal(graph, {.push = false}); }

}  // namespace vitrine::spirv::rewriting

// Common subexpressions of scalar code (EarlyCSE.cpp; lavapipe-optimizer.md 7.1).
#include "spirv/rewrite/graph/merge_equal.h"
#include "spirv/rewrite/llvm/passes.h"

namespace vitrine::spirv::rewriting {

bool early_cse(Graph& graph) { return merge_equal(graph, {.by_value = true}); }

}  // namespace vitrine::spirv::rewriting

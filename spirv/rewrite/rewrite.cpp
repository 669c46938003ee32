// The algebra that the reference applies to every shader (lavapipe-shader-math.md section 4, lavapipe-optimizer.md):
// the steps of passes.def over a graph.
#include "spirv/rewrite/rewrite.h"

#include "spirv/rewrite/passes.h"

namespace vitrine::spirv {

void rewrite(ir::Function& function) {
  rewriting::Graph graph(function);
  rewriting::run_passes(graph);
  graph.write_back();
}

}  // namespace vitrine::spirv

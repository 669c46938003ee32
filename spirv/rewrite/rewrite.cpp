// The algebra that the reference applies to every shader (lavapipe-shader-math.md section 4, lavapipe-optimizer.md):
// the steps of passes.def over a graph.
#include "spirv/rewrite/rewrite.h"

#include "base/log.h"
#include "spirv/ir_passes.h"
#include "spirv/rewrite/passes.h"

namespace vitrine::spirv {
namespace {

/// What observers alone have asked for becomes part of the shader, after all that looks at it: the steps that the
/// lowering relies on take it apart.
void release_attached(rewriting::Graph& graph, const std::vector<Probe>& probes, const StepListener& listener) {
  graph.release_attached(probes);
  for (const char* step :
       {"lower_alu_to_scalar", "lower_flrp", "lower_operations", "build_sums", "expand_sized", "convert_to_lcssa"})
    rewriting::find_pass(step)->run(graph);
  if (!listener && !base::log_enabled("ir")) return;
  const std::string text = ir::dump(rewriting::snapshot(graph), ir::Origins::kShow);
  if (listener) listener("with what observers ask for", "after all steps", text);
  if (base::log_enabled("ir")) base::log("ir", "with what observers ask for\n" + text);
}

}  // namespace

void rewrite(ir::Function& function, const StepListener& listener, Steps steps) {
  rewriting::Graph graph(function);
  rewriting::run_passes(graph, listener, steps);
  if (!graph.attached.empty()) release_attached(graph, function.probes, listener);
  graph.write_back();
}

}  // namespace vitrine::spirv

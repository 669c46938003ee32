// Minima and maxima with an operand that is known to be a number become plain ones (lavapipe-shader-math.md 5.1, which
// also swaps operands; lavapipe-optimizer.md 6.4).
#include "spirv/rewrite/gallivm/passes.h"
#include "spirv/rewrite/nir/range_analysis.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

void plain_extremum(Graph& graph, RangeAnalysis& ranges, InstId id) {
  const bool second = ranges.of_source(graph.insts[id], 1).number;
  if (!second && !ranges.of_source(graph.insts[id], 0).number) return;
  if (!second) {
    const Src first = graph.source(graph.insts[id], 0);
    graph.set_source(id, 0, graph.source(graph.insts[id], 1));
    graph.set_source(id, 1, first);
  }
  if (graph.insts[id].kind == Kind::kSized) return;  // b is a number, so that nobody asks whether it is one
  graph.insts[id].op = graph.insts[id].op == Op::kFMin ? Op::kFMinPlain : Op::kFMaxPlain;
}

}  // namespace

void choose_min_max(Graph& graph) {
  RangeAnalysis ranges(graph, false);
  // From the end, so that the analysis still sees the operands' original operations.
  std::vector<InstId> order;
  auto visit = [&](InstId id) {
    const Inst& inst = graph.insts[id];
    if (computes(inst) && (inst.op == Op::kFMin || inst.op == Op::kFMax)) order.push_back(id);
  };
  for_each_inst(graph, graph.root, visit);
  for (auto id = order.rbegin(); id != order.rend(); ++id) plain_extremum(graph, ranges, *id);
}

}  // namespace vitrine::spirv::rewriting

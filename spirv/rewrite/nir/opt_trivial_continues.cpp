// Continues at the end of a loop become the way there (nir_opt_trivial_continues.c; lavapipe-optimizer.md 5.4).
#include "spirv/rewrite/graph/copier.h"
#include "spirv/rewrite/graph/loops.h"
#include "spirv/rewrite/graph/tree.h"
#include "spirv/rewrite/nir/passes.h"
#include "spirv/rewrite/nir/phis_to_regs.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

/// `block` ends with what the loop continues with: a Continue there, or in a branch right before, becomes a Yield.
bool drop_continues(Graph& graph, BlockId block, const std::vector<ValueId>& params) {
  const InstId end = graph.blocks[block].tail;
  bool changed = false;
  if (is_jump(graph.insts[end], Op::kContinue)) {
    graph.insts[end].op = Op::kYield;
    changed = true;
  }
  if (!is_jump(graph.insts[end], Op::kYield)) return changed;
  const InstId branch = graph.insts[end].previous;
  if (branch == kNone || graph.insts[branch].kind != Kind::kIf) return changed;
  const BlockId side[2] = {graph.insts[branch].child[0], graph.insts[branch].child[1]};
  if (!contains_continue(graph, side[0]) && !contains_continue(graph, side[1])) return changed;
  move_attached_into_sides(graph, branch, end);
  const std::vector<ValueId> results = graph.nodes[graph.insts[branch].node]->results;
  const std::vector<Src> passed = operands_of(graph, end);
  for (const BlockId child : side) {
    const InstId last = graph.blocks[child].tail;
    if (!is_jump(graph.insts[last], Op::kYield)) continue;
    const std::vector<Src> yielded = operands_of(graph, last);
    std::vector<Src> values;
    for (const Src& src : passed) values.push_back(substituted(src, results, yielded));
    graph.set_operands(last, values);
  }
  graph.nodes[graph.insts[branch].node]->results.clear();
  graph.set_operands(end, add_results(graph, branch, params));
  for (const BlockId child : side)
    if (!ends_in(graph, child, Op::kBreak)) drop_continues(graph, child, params);
  return true;
}

bool drop_trivial_continues(Graph& graph, BlockId block) {
  bool changed = false;
  for (InstId id = graph.blocks[block].head; id != kNone; id = graph.insts[id].next) {
    for (const unsigned side : {0u, 1u}) {
      const BlockId child = graph.insts[id].child[side];
      if (child != kNone) changed |= drop_trivial_continues(graph, child);
    }
    if (graph.insts[id].kind != Kind::kLoop) continue;
    const std::vector<ValueId> params = graph.nodes[graph.insts[id].node]->continue_params;
    const BlockId body = graph.insts[id].child[0];
    if (graph.blocks[body].tail == kNone) continue;
    const bool dropped = drop_continues(graph, body, params);
    if (!dropped && !(graph.first_round && ends_in(graph, body, Op::kYield))) continue;
    pass_through_registers(graph, id);
    changed = true;
  }
  return changed;
}

}  // namespace

bool opt_trivial_continues(Graph& graph) {
  const bool dropped = drop_trivial_continues(graph, graph.root);
  return dropped || (graph.first_round && has_loops(graph));
}

}  // namespace vitrine::spirv::rewriting

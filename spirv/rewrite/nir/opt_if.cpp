// Branches and what follows them (nir_opt_if.c; lavapipe-optimizer.md 5.8, 5.13): the walks of the pass, and the steps
// on branches that leave. Which code is unconditional decides what later steps see.
#include "spirv/rewrite/nir/opt_if.h"
#include "spirv/rewrite/graph/tree.h"
#include "spirv/rewrite/nir/passes.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

/// One side leaves: the other side's code need not be conditional.
bool opt_if_loop_terminator(Graph& graph, InstId id) {
  for (const unsigned side : {0u, 1u}) {
    const BlockId leaving = graph.insts[id].child[side], staying = graph.insts[id].child[1 - side];
    if (ends_in(graph, leaving, Op::kYield) || !ends_in(graph, staying, Op::kYield)) continue;
    const InstId last = graph.blocks[staying].tail;
    if (graph.blocks[staying].head == last && graph.insts[last].count == 0) return false;
    const std::vector<Src> yielded = operands_of(graph, last);
    graph.set_operands(last, {});
    InstId position = id;
    while (graph.blocks[staying].head != last) {
      const InstId moved = graph.blocks[staying].head;
      std::vector<InstId> with = graph.attached.take(moved);
      graph.move_after(position, moved);
      graph.attached.give(moved, std::move(with));
      position = moved;
    }
    replace_results(graph, id, yielded, position);
    graph.nodes[graph.insts[id].node]->results.clear();
    return true;
  }
  return false;
}

/// What follows the last branch that continues moves into the branch's other side.
bool opt_if_loop_last_continue(Graph& graph, InstId loop) {
  const BlockId body = graph.insts[loop].child[0];
  const InstId end = graph.blocks[body].tail;
  if (end == kNone || !is_jump(graph.insts[end], Op::kYield)) return false;
  InstId branch = graph.insts[end].previous;
  unsigned leaving = 2;
  for (; branch != kNone; branch = graph.insts[branch].previous) {
    const Inst& inst = graph.insts[branch];
    if (inst.kind != Kind::kIf) continue;
    const bool stays[2] = {ends_in(graph, inst.child[0], Op::kYield), ends_in(graph, inst.child[1], Op::kYield)};
    if (!stays[0] && !stays[1]) return false;
    leaving = ends_in(graph, inst.child[0], Op::kContinue) ? 0 : ends_in(graph, inst.child[1], Op::kContinue) ? 1 : 2;
    if (leaving != 2) break;
  }
  if (branch == kNone || graph.insts[branch].next == end) return false;
  if (!graph.nodes[graph.insts[branch].node]->results.empty()) return false;  // hoisting comes first
  const BlockId other = graph.insts[branch].child[1 - leaving];
  const InstId other_end = graph.blocks[other].tail;
  graph.move_range_before(other_end, graph.insts[branch].next, end);
  const std::vector<Src> passed = operands_of(graph, end);
  graph.set_operands(other_end, passed);
  graph.set_operands(end, add_results(graph, branch, graph.nodes[graph.insts[loop].node]->continue_params));
  return true;
}

bool opt_if_cf_list(Graph& graph, BlockId block) {
  bool changed = false;
  for (InstId id = graph.blocks[block].head; id != kNone; id = graph.insts[id].next) {
    for (const unsigned side : {0u, 1u}) {
      const BlockId child = graph.insts[id].child[side];
      if (child != kNone) changed |= opt_if_cf_list(graph, child);
    }
    if (graph.insts[id].kind == Kind::kIf) {
      changed |= opt_if_loop_terminator(graph, id);
      changed |= opt_if_merge(graph, id);
      changed |= opt_if_simplification(graph, id);
      changed |= opt_if_phi_is_condition(graph, id);
    }
    if (graph.insts[id].kind != Kind::kLoop) continue;
    changed |= opt_simplify_bcsel_of_phi(graph, id);
    changed |= opt_if_loop_last_continue(graph, id);
  }
  return changed;
}

/// Afterwards: what moves code around the loops.
bool opt_if_regs_cf_list(Graph& graph, BlockId block) {
  bool changed = false;
  for (InstId id = graph.blocks[block].head; id != kNone; id = graph.insts[id].next) {
    for (const unsigned side : {0u, 1u}) {
      const BlockId child = graph.insts[id].child[side];
      if (child != kNone) changed |= opt_if_regs_cf_list(graph, child);
    }
    if (graph.insts[id].kind == Kind::kIf && opt_merge_breaks(graph, id)) {
      changed = true;
      for (const unsigned side : {0u, 1u}) opt_if_regs_cf_list(graph, graph.insts[id].child[side]);
    }
    if (graph.insts[id].kind == Kind::kLoop) changed |= opt_peel_loop_initial_if(graph, id);
  }
  return changed;
}

}  // namespace

bool opt_if(Graph& graph) {
  const bool changed = opt_if_cf_list(graph, graph.root);
  return opt_if_regs_cf_list(graph, graph.root) || changed;
}

}  // namespace vitrine::spirv::rewriting

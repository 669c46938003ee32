// The shape of control flow: branches on constants, code behind branches that leave, continues at the end of a loop.
// The steps and their order are the reference's (lavapipe-shader-math.md 3.2): which code is unconditional decides what
// later steps see.
#include "spirv/rewrite/loops.h"
#include "spirv/rewrite/passes.h"
#include "spirv/rewrite/tree.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

// ---- what never runs

void collect_values(const Graph& graph, InstId id, std::vector<ValueId>& values) {
  const Inst& inst = graph.insts[id];
  if (inst.components != 0) values.push_back(inst.result);
  if (inst.kind != Kind::kIf && inst.kind != Kind::kLoop) return;
  const ir::Node& node = *graph.nodes[inst.node];
  for (const auto* list : {&node.results, &node.params, &node.continue_params})
    values.insert(values.end(), list->begin(), list->end());
  for (const BlockId child : inst.child)
    for (InstId inner = graph.blocks[child].head; inner != kNone; inner = graph.insts[inner].next)
      collect_values(graph, inner, values);
}

/// Removes `id`, which never runs. Nor does what still reads its values (code behind a loop whose only way out this
/// was): that reads zeros.
void remove_unreached(Graph& graph, InstId id) {
  std::vector<ValueId> values;
  collect_values(graph, id, values);
  graph.remove(id);
  for (const ValueId value : values) {
    if (graph.values[value].uses == 0) continue;
    constexpr std::uint32_t kZeros[4] = {};
    const InstId zero = graph.create_const(graph.values[value].components, graph.values[value].boolean, kZeros);
    graph.insert_before(graph.blocks[graph.root].head, zero);
    graph.replace_uses(value, graph.insts[zero].result);
  }
}

/// Removes `block`'s instructions from `first` to the end.
void remove_from(Graph& graph, BlockId block, InstId first) {
  if (first == kNone) return;
  for (bool last = false; !last;) {
    const InstId tail = graph.blocks[block].tail;
    last = tail == first;
    remove_unreached(graph, tail);
  }
}

void take_branch(Graph& graph, InstId id, BlockId taken) {
  if (ends_in(graph, taken, Op::kYield)) {
    const std::vector<Src> yielded = operands_of(graph, graph.blocks[taken].tail);
    graph.remove(graph.blocks[taken].tail);
    graph.splice_before(id, taken);
    replace_results(graph, id, yielded);
  } else {
    graph.splice_before(id, taken);
    remove_from(graph, graph.insts[id].block, graph.insts[id].next);
  }
  remove_unreached(graph, id);
}

/// A loop that has no effect but the values it carries.
bool only_computes(const Graph& graph, BlockId block) {
  for (InstId id = graph.blocks[block].head; id != kNone; id = graph.insts[id].next) {
    const Inst& inst = graph.insts[id];
    if (inst.kind == Kind::kIf || inst.kind == Kind::kLoop) {
      if (!only_computes(graph, inst.child[0]) || !only_computes(graph, inst.child[1])) return false;
    } else if (!is_jump(inst, Op::kYield) && !leaves_loop(inst) && !is_pure(graph, inst)) {
      return false;
    }
  }
  return true;
}

bool is_dead_loop(const Graph& graph, InstId id) {
  for (const ValueId result : graph.nodes[graph.insts[id].node]->results)
    if (graph.values[result].uses != 0) return false;
  return only_computes(graph, graph.insts[id].child[0]) && only_computes(graph, graph.insts[id].child[1]) &&
         !is_used_behind(graph, id);
}

/// Removes the branch or loop `id` if it need not be: a branch on a constant becomes the side that it takes.
bool prune_node(Graph& graph, InstId id) {
  const Inst inst = graph.insts[id];
  if (inst.kind == Kind::kLoop && is_dead_loop(graph, id)) {
    graph.remove(id);
    return true;
  }
  if (inst.kind != Kind::kIf) return false;
  const Src condition = graph.source(inst, 0);
  const Inst* constant = graph.constant(condition.value);
  if (constant) take_branch(graph, id, inst.child[constant->imm[condition.swizzle[0]] ? 0 : 1]);
  return constant != nullptr;
}

/// After a removal the next branch or loop of the block stays until the next round, as in the reference.
bool prune(Graph& graph, BlockId block) {
  bool changed = false, removed = false;
  for (InstId id = graph.blocks[block].head; id != kNone;) {
    const Inst inst = graph.insts[id];
    if (inst.kind != Kind::kIf && inst.kind != Kind::kLoop) {
      id = inst.next;
      continue;
    }
    removed = !removed && prune_node(graph, id);
    changed |= removed;
    if (removed) {
      id = inst.previous == kNone ? graph.blocks[block].head : graph.insts[inst.previous].next;
      continue;
    }
    for (const BlockId child : inst.child)
      if (child != kNone) changed |= prune(graph, child);
    id = graph.insts[id].next;
  }
  return changed;
}

// ---- code behind a branch that leaves

/// One side leaves: the other side's code need not be conditional.
bool hoist_staying_side(Graph& graph, InstId id) {
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
      graph.move_after(position, moved);
      position = moved;
    }
    replace_results(graph, id, yielded, position);
    graph.nodes[graph.insts[id].node]->results.clear();
    return true;
  }
  return false;
}

/// What follows the last branch that continues moves into the branch's other side.
bool enclose_after_continue(Graph& graph, InstId loop) {
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
  while (graph.insts[branch].next != end) graph.move_before(other_end, graph.insts[branch].next);
  const std::vector<Src> passed = operands_of(graph, end);
  graph.set_operands(other_end, passed);
  graph.set_operands(end, add_results(graph, branch, graph.nodes[graph.insts[loop].node]->continue_params));
  return true;
}

// ---- continues where the loop would go on anyway

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

/// `first`: in the reference every body that goes round ends in a continue.
bool drop_trivial_continues(Graph& graph, BlockId block, bool first) {
  bool changed = false;
  for (InstId id = graph.blocks[block].head; id != kNone; id = graph.insts[id].next) {
    for (const unsigned side : {0u, 1u}) {
      const BlockId child = graph.insts[id].child[side];
      if (child != kNone) changed |= drop_trivial_continues(graph, child, first);
    }
    if (graph.insts[id].kind != Kind::kLoop) continue;
    const std::vector<ValueId> params = graph.nodes[graph.insts[id].node]->continue_params;
    const BlockId body = graph.insts[id].child[0];
    if (graph.blocks[body].tail == kNone) continue;
    const bool dropped = drop_continues(graph, body, params);
    if (!dropped && !(first && ends_in(graph, body, Op::kYield))) continue;
    pass_through_registers(graph, id);
    changed = true;
  }
  return changed;
}

bool improve(Graph& graph, BlockId block) {
  bool changed = false;
  for (InstId id = graph.blocks[block].head; id != kNone; id = graph.insts[id].next) {
    for (const unsigned side : {0u, 1u}) {
      const BlockId child = graph.insts[id].child[side];
      if (child != kNone) changed |= improve(graph, child);
    }
    if (graph.insts[id].kind == Kind::kIf) {
      changed |= hoist_staying_side(graph, id);
      changed |= merge_branches(graph, id);
    }
    if (graph.insts[id].kind != Kind::kLoop) continue;
    changed |= simplify_selections(graph, id);
    changed |= enclose_after_continue(graph, id);
  }
  return changed;
}

/// Afterwards: what moves code around the loops.
bool move_code(Graph& graph, BlockId block) {
  bool changed = false;
  for (InstId id = graph.blocks[block].head; id != kNone; id = graph.insts[id].next) {
    for (const unsigned side : {0u, 1u}) {
      const BlockId child = graph.insts[id].child[side];
      if (child != kNone) changed |= move_code(graph, child);
    }
    if (graph.insts[id].kind == Kind::kIf && merge_breaks(graph, id)) {
      changed = true;
      for (const unsigned side : {0u, 1u}) move_code(graph, graph.insts[id].child[side]);
    }
    if (graph.insts[id].kind == Kind::kLoop) changed |= peel_loop(graph, id);
  }
  return changed;
}

}  // namespace

bool take_constant_branches(Graph& graph) { return prune(graph, graph.root); }

bool remove_trivial_continues(Graph& graph, bool first) { return drop_trivial_continues(graph, graph.root, first); }

bool improve_branches(Graph& graph) {
  const bool changed = improve(graph, graph.root);
  return move_code(graph, graph.root) || changed;
}

}  // namespace vitrine::spirv::rewriting

// Control flow that need not be (nir_opt_dead_cf.c; lavapipe-optimizer.md 5.16): branches on constants, code that never
// runs, loops without effect.
#include <algorithm>

#include "spirv/rewrite/graph/build.h"
#include "spirv/rewrite/graph/effects.h"
#include "spirv/rewrite/graph/match.h"
#include "spirv/rewrite/graph/tree.h"
#include "spirv/rewrite/nir/passes.h"
#include "spirv/rewrite/nir/to_lcssa.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

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
  graph.attached.drop(graph, id);
  graph.remove(id);
  for (const ValueId value : values) {
    if (graph.values[value].uses == 0 && !graph.attached.reads(value)) continue;
    constexpr std::uint32_t kZeros[4] = {};
    Builder first(graph, graph.blocks[graph.root].head);
    const Value shape = graph.values[value];
    graph.replace_uses(value, first.literal(shape.components, shape.boolean, kZeros).value);
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
  graph.attached.leave(graph, id, false);  // what was at the end of the branch
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

/// Observers look into the loop, or need a value of it: whether what follows is reached may depend on one.
bool is_observed(const Graph& graph, InstId loop) {
  if (graph.attached.empty()) return false;
  const Inst& inst = graph.insts[loop];
  if (graph.attached.any_in(graph, inst.child[0]) || graph.attached.any_in(graph, inst.child[1])) return true;
  std::vector<ValueId> values;
  collect_values(graph, loop, values);
  return std::any_of(values.begin(), values.end(), [&](ValueId value) { return graph.attached.reads(value); });
}

bool is_dead_loop(const Graph& graph, InstId id) {
  for (const ValueId result : graph.nodes[graph.insts[id].node]->results)
    if (graph.values[result].uses != 0) return false;
  if (is_observed(graph, id)) return false;
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
  const std::optional<std::uint32_t> condition = literal_of(graph, graph.source(inst, 0));
  if (condition) take_branch(graph, id, inst.child[*condition != 0 ? 0 : 1]);
  return condition.has_value();
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

}  // namespace

bool opt_dead_cf(Graph& graph) { return prune(graph, graph.root); }

}  // namespace vitrine::spirv::rewriting

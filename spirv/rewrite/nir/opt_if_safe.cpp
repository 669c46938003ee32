// What a branch knows of its condition: where only one side of an If leads, its condition is a constant (nir_opt_if.c;
// lavapipe-optimizer.md 5.5, 5.6).
#include <vector>

#include "spirv/rewrite/graph/build.h"
#include "spirv/rewrite/graph/tree.h"
#include "spirv/rewrite/nir/opt_if.h"
#include "spirv/rewrite/nir/passes.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

enum class Known : std::uint8_t { kNothing, kTrue, kFalse };

Known side_of(unsigned child) { return child == 0 ? Known::kTrue : Known::kFalse; }

/// What `branch` says of its condition where `user` reads it.
Known condition_at(const Graph& graph, InstId branch, InstId user) {
  const Inst& inst = graph.insts[branch];
  unsigned staying = 2;  ///< the only side that goes on behind the If
  for (const unsigned side : {0u, 1u})
    if (!ends_in(graph, inst.child[side], Op::kYield) && ends_in(graph, inst.child[1 - side], Op::kYield))
      staying = 1 - side;
  for (InstId at = user; at != kNone;) {
    const BlockId block = graph.insts[at].block;
    if (block == inst.child[0] || block == inst.child[1]) return side_of(block == inst.child[0] ? 0 : 1);
    if (block == inst.block && staying != 2 && at != branch)
      for (InstId before = at; before != kNone; before = graph.insts[before].previous)
        if (before == branch) return side_of(staying);
    at = graph.blocks[block].owner;
  }
  return Known::kNothing;
}

bool hands_on(const Inst& inst, std::uint32_t operand) {
  if (inst.kind != Kind::kAlu || inst.components != 1) return false;
  switch (inst.op) {
    case Op::kAndB:
    case Op::kOrB:
    case Op::kNotB:
    case Op::kB2I:
      return true;
    case Op::kSelect:
    case Op::kSelectB:
      return operand == 0;
    default:
      return false;
  }
}

/// Readers of an instruction that reads the condition get a copy of it that reads what is known.
bool evaluate_reader(Graph& graph, InstId branch, ValueId condition, InstId reader) {
  bool changed = false;
  for (const Slot use : uses_of(graph, graph.insts[reader].result)) {
    const InstId user = graph.sources[use].user;
    const Known known = condition_at(graph, branch, user);
    if (known == Known::kNothing) continue;
    const Inst inst = graph.insts[reader];
    const InstId copy = graph.create(Kind::kAlu, inst.op, inst.components, inst.boolean, inst.count);
    graph.insts[copy].exact = inst.exact;
    graph.insts[copy].origin = inst.origin;
    const Src truth = Builder(graph, user).truth(known == Known::kTrue);
    for (std::uint32_t i = 0; i < inst.count; ++i) {
      const Src src = graph.source(inst, i);
      graph.set_source(copy, i, src.value == condition ? truth : src);
    }
    graph.insert_before(user, copy);
    const std::uint32_t operand = use - graph.insts[user].first;
    graph.set_source(user, operand, {graph.insts[copy].result, graph.source(graph.insts[user], operand).swizzle});
    changed = true;
  }
  return changed;
}

bool opt_if_evaluate_condition_use(Graph& graph, InstId branch) {
  const ValueId condition = graph.source(graph.insts[branch], 0).value;
  if (graph.values[condition].components != 1 || graph.constant(condition)) return false;
  bool changed = false;
  for (const Slot use : uses_of(graph, condition)) {
    const InstId user = graph.sources[use].user;
    if (user == branch) continue;
    const std::uint32_t operand = use - graph.insts[user].first;
    const Known known = condition_at(graph, branch, user);
    if (known != Known::kNothing) {
      graph.set_source(user, operand, Builder(graph, user).truth(known == Known::kTrue));
      changed = true;
    } else if (hands_on(graph.insts[user], operand)) {
      changed |= evaluate_reader(graph, branch, condition, user);
    }
  }
  return changed;
}

/// Reads of one component, where a branch knows it to equal a constant, read the constant.
bool take_equal_in(Graph& graph, BlockId side, Src unknown, Src known) {
  bool changed = false;
  for (const Slot use : uses_of(graph, unknown.value)) {
    const InstId user = graph.sources[use].user;
    const Inst inst = graph.insts[user];
    bool inside = false;
    for (InstId at = user; at != kNone && !inside; at = graph.blocks[graph.insts[at].block].owner)
      inside = graph.insts[at].block == side;
    if (!inside || inst.kind == Kind::kIf || inst.kind == Kind::kLoop) continue;
    const Src src = graph.sources[use].src;
    const unsigned read = computes(inst) ? operand_components(inst, use - inst.first) : inst.kind == Kind::kVec ? 1 : 0;
    bool only = read != 0 || graph.values[unknown.value].components == 1;
    for (unsigned c = 0; c < read; ++c) only &= src.swizzle[c] == unknown.swizzle[0];
    if (!only) continue;
    const std::uint8_t s = known.swizzle[0];
    graph.set_source(user, use - inst.first, {known.value, {s, s, s, s}});
    changed = true;
  }
  return changed;
}

bool take_equal_by(Graph& graph, InstId branch, ValueId condition, bool accept_unequal, unsigned depth) {
  const Inst* def = graph.def(condition);
  if (!def || def->kind != Kind::kAlu || def->components != 1 || depth > 16) return false;
  const Inst inst = *def;
  if (inst.op == Op::kAndB) {
    const ValueId parts[2] = {graph.source(inst, 0).value, graph.source(inst, 1).value};
    bool changed = take_equal_by(graph, branch, parts[0], false, depth + 1);
    changed |= take_equal_by(graph, branch, parts[1], false, depth + 1);
    return changed;
  }
  const bool unequal = inst.op == Op::kINe || inst.op == Op::kXorB;
  const bool equal = inst.op == Op::kIEq || inst.op == Op::kEqB;
  if (!equal && !(unequal && accept_unequal)) return false;
  for (const std::uint32_t i : {0u, 1u}) {
    const Src known = graph.source(inst, i), unknown = graph.source(inst, 1 - i);
    if (graph.constant(known.value) && unknown.value != known.value)
      return take_equal_in(graph, graph.insts[branch].child[equal ? 0 : 1], unknown, known);
  }
  return false;
}

bool opt_if_rewrite_uniform_uses(Graph& graph, InstId branch) {
  return take_equal_by(graph, branch, graph.source(graph.insts[branch], 0).value, true, 0);
}

/// Innermost first.
bool opt_if_safe_cf_list(Graph& graph, BlockId block) {
  bool changed = false;
  for (InstId id = graph.blocks[block].head; id != kNone; id = graph.insts[id].next) {
    for (const unsigned side : {0u, 1u}) {
      const BlockId child = graph.insts[id].child[side];
      if (child != kNone) changed |= opt_if_safe_cf_list(graph, child);
    }
    if (graph.insts[id].kind == Kind::kIf) {
      changed |= opt_if_evaluate_condition_use(graph, id);
      changed |= opt_if_rewrite_uniform_uses(graph, id);
    }
    if (graph.insts[id].kind == Kind::kLoop) changed |= opt_split_alu_of_phi(graph, id);
  }
  return changed;
}

}  // namespace

bool opt_if_safe(Graph& graph) { return opt_if_safe_cf_list(graph, graph.root); }

}  // namespace vitrine::spirv::rewriting

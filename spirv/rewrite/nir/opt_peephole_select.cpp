// Small branches become unconditional code and selections (nir_opt_peephole_select.c; lavapipe-optimizer.md 5.1, 5.2).
#include "spirv/rewrite/graph/build.h"
#include "spirv/rewrite/graph/match.h"
#include "spirv/rewrite/graph/tree.h"
#include "spirv/rewrite/nir/passes.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

/// Instructions that both branches together may hold to become selects; moves, negations, absolute values and
/// saturations are free.
constexpr unsigned kFlattenLimit = 8;

bool is_free(const Inst& inst) {
  switch (inst.op) {
    case Op::kMov:
    case Op::kMovB:
    case Op::kFNeg:
    case Op::kINeg:
    case Op::kFAbs:
    case Op::kIAbs:
    case Op::kFSat:
    case Op::kFAddInSum:
      return true;
    default:
      return false;
  }
}

bool may_hoist(const Inst& inst) {
  switch (inst.op) {
    case Op::kUndef:
    case Op::kLoadInput:
    case Op::kHelperInvocation:
    case Op::kNumWorkgroups:
    case Op::kWorkgroupId:
    case Op::kLocalInvocationId:
    case Op::kLocalInvocationIndex:
    case Op::kGlobalInvocationId:
    case Op::kSubgroupId:
    case Op::kSubgroupInvocation:
      return true;
    default:
      return false;
  }
}

/// A shift that is a part of extending the sign of a number of 8 or 16 bits. Here and below, operations are vectors in
/// the first round, which patterns do not match.
bool extends_sign(const Graph& graph, const Inst& inst) {
  const auto by = [&](const Inst& shift, std::uint32_t bits) {
    return is_literal(graph, graph.source(shift, 1), bits);
  };
  const auto narrow = [&](const Inst& shift) { return by(shift, 16) || by(shift, 24); };
  if (inst.op == Op::kIShr && narrow(inst)) {
    const Inst* def = graph.def(graph.source(inst, 0).value);
    return def && def->op == Op::kShl && by(*def, by(inst, 16) ? 16 : 24);
  }
  if (inst.op != Op::kShl || !narrow(inst)) return false;
  const Slot use = graph.values[inst.result].first_use;
  if (use == kNone || graph.values[inst.result].uses != 1) return false;
  const Inst& user = graph.insts[graph.sources[use].user];
  return user.op == Op::kIShr && by(user, by(inst, 16) ? 16 : 24);
}

/// The instruction is no operation of its own in the reference, which has numbers of every width: it ends a conversion
/// from or to halves, or extends the sign of an operand. What packs or unpacks halves is not meant.
bool is_part(const Graph& graph, const Inst& inst) {
  if (inst.count == 0) return false;
  const auto is_arithmetic = [](const Inst& half) { return !half.packs; };
  const Inst* def = graph.def(graph.source(inst, 0).value);
  switch (inst.op) {
    case Op::kF2Half:
      return def && is_arithmetic(inst) &&
             (def->op == Op::kI2F || def->op == Op::kU2F || def->op == Op::kFFromD || def->op == Op::kFFromL ||
              def->op == Op::kFFromQ);
    case Op::kF2I:
    case Op::kF2U:
    case Op::kDFromF:
    case Op::kLFromF:
    case Op::kQFromF:
      return def && def->op == Op::kHalf2F && is_arithmetic(*def);
    default:
      return extends_sign(graph, inst);
  }
}

/// Adds what an instruction costs; false if it must stay conditional.
bool can_hoist(const Graph& graph, const Inst& inst, unsigned& cost) {
  switch (inst.kind) {
    case Kind::kConst:
    case Kind::kVec:
      return true;
    case Kind::kAlu:
    case Kind::kSized:
      cost += is_free(inst) || is_part(graph, inst) ? 0 : 1;
      return true;
    case Kind::kIntrinsic:
      if (ir::is_wide(inst.op)) {
        cost += is_part(graph, inst) ? 0 : 1;
        return true;
      }
      return inst.op == Op::kYield || may_hoist(inst);
    default:
      return false;
  }
}

bool can_flatten(const Graph& graph, BlockId block, unsigned& cost) {
  for (InstId id = graph.blocks[block].head; id != kNone; id = graph.insts[id].next)
    if (!can_hoist(graph, graph.insts[id], cost)) return false;
  return ends_in(graph, block, Op::kYield);
}

/// What a branch yields; the branch's instructions move in front of the If.
std::vector<Src> take_branch(Graph& graph, InstId id, unsigned side) {
  const BlockId block = graph.insts[id].child[side];
  graph.attached.guard(graph, block, graph.source(graph.insts[id], 0), side == 0);
  const InstId last = graph.blocks[block].tail;
  std::vector<Src> yielded = operands_of(graph, last);
  graph.remove(last);
  graph.splice_before(id, block);
  return yielded;
}

bool is_half(const Graph& graph, ValueId value) {
  const Inst* inst = graph.def(value);
  return inst && computes(*inst) && inst->width == 16 && !inst->boolean;
}

void flatten(Graph& graph, InstId id) {
  const Src condition = scalar(graph.source(graph.insts[id], 0));
  const std::vector<Src> then_values = take_branch(graph, id, 0);
  const std::vector<Src> else_values = take_branch(graph, id, 1);
  const std::vector<ValueId> results = graph.nodes[graph.insts[id].node]->results;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Value value = graph.values[results[i]];
    const bool halves = is_half(graph, then_values[i].value) || is_half(graph, else_values[i].value);
    const Op op = value.boolean ? Op::kSelectB : Op::kSelect;
    const ValueId chosen =
        Builder(graph, id).alu(op, {condition, then_values[i], else_values[i]}, value.components).value;
    if (halves) graph.insts[graph.values[chosen].def].width = 16;
    graph.replace_uses(results[i], chosen);
  }
  graph.remove(id);
}

/// What `outer` yields for results of `inner` when it does not run must be what `inner` yields when it does not; the
/// operands of outer's first Yield that are such results.
bool results_agree(const Graph& graph, InstId outer, InstId inner, std::vector<std::uint32_t>& operands) {
  const InstId then_end = graph.blocks[graph.insts[outer].child[0]].tail;
  const InstId outer_else = graph.blocks[graph.insts[outer].child[1]].tail;
  const InstId inner_else = graph.blocks[graph.insts[inner].child[1]].tail;
  const std::vector<ValueId>& results = graph.nodes[graph.insts[inner].node]->results;
  for (std::size_t i = 0; i < results.size(); ++i)
    for (Slot use = graph.values[results[i]].first_use; use != kNone; use = graph.sources[use].next) {
      if (graph.sources[use].user != then_end) return false;
      const std::uint32_t operand = use - graph.insts[then_end].first;
      const Src skipped = graph.source(graph.insts[inner_else], static_cast<std::uint32_t>(i));
      if (!same_value(graph, graph.source(graph.insts[outer_else], operand), skipped, results[i])) return false;
      operands.push_back(operand);
    }
  return true;
}

/// A branch in a branch, both with one side only, on both conditions.
bool collapse(Graph& graph, InstId inner) {
  const InstId outer = graph.blocks[graph.insts[inner].block].owner;
  if (outer == kNone || graph.insts[outer].kind != Kind::kIf) return false;
  const BlockId then_block = graph.insts[outer].child[0], else_block = graph.insts[outer].child[1];
  if (graph.insts[inner].block != then_block || !is_empty(graph, else_block) ||
      !is_empty(graph, graph.insts[inner].child[1]) || is_empty(graph, graph.insts[inner].child[0]))
    return false;
  const InstId then_end = graph.insts[inner].next;
  if (then_end == kNone || !is_jump(graph.insts[then_end], Op::kYield)) return false;
  unsigned cost = 0;
  for (InstId id = graph.blocks[then_block].head; id != inner; id = graph.insts[id].next)
    if (!can_hoist(graph, graph.insts[id], cost)) return false;
  std::vector<std::uint32_t> operands;
  if (cost > kFlattenLimit || !results_agree(graph, outer, inner, operands)) return false;
  for (const std::uint32_t operand : operands)
    graph.set_source(graph.blocks[else_block].tail, operand, graph.source(graph.insts[then_end], operand));
  const auto condition = [&](InstId id) { return scalar(graph.source(graph.insts[id], 0)); };
  graph.set_source(inner, 0, Builder(graph, inner).alu(Op::kAndB, {condition(inner), condition(outer)}));
  graph.attached.guard(graph, then_block, graph.source(graph.insts[outer], 0), true);
  graph.move_range_before(outer, graph.blocks[then_block].head, then_end);
  return true;
}

/// Innermost first, so that a flattened branch may let the one around it flatten.
bool flatten_in(Graph& graph, BlockId block) {
  bool changed = false;
  for (InstId id = graph.blocks[block].head; id != kNone;) {
    const InstId next = graph.insts[id].next;
    const BlockId child[2] = {graph.insts[id].child[0], graph.insts[id].child[1]};
    for (const BlockId side : child)
      if (side != kNone) changed |= flatten_in(graph, side);
    if (graph.insts[id].kind == Kind::kIf && collapse(graph, id)) {
      changed = true;
    } else if (graph.insts[id].kind == Kind::kIf) {
      unsigned cost = 0;
      if (can_flatten(graph, child[0], cost) && can_flatten(graph, child[1], cost) && cost <= kFlattenLimit) {
        flatten(graph, id);
        changed = true;
      }
    }
    id = next;
  }
  return changed;
}

}  // namespace

bool opt_peephole_select(Graph& graph) { return flatten_in(graph, graph.root); }

}  // namespace vitrine::spirv::rewriting

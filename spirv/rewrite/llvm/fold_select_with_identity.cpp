// Selections with a literal side as operands of arithmetic, in scalar code: the reference's optimiser and its masked
// instructions move the operation into the side that is not literal, so that x op identity is x, denormal or not
// (lavapipe-optimizer.md 7.9).
#include <algorithm>

#include "base/float_mode.h"
#include "base/numeric.h"
#include "base/reference_cpu.h"
#include "spirv/rewrite/graph/build.h"
#include "spirv/rewrite/graph/match.h"
#include "spirv/rewrite/graph/tree.h"
#include "spirv/rewrite/llvm/masked_store_select.h"
#include "spirv/rewrite/llvm/operand_rank.h"
#include "spirv/rewrite/llvm/passes.h"
#include "spirv/rewrite/nir/constant_expressions.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

constexpr std::uint32_t kOne = 0x3f800000, kMinusZero = 0x80000000;

/// The literal that leaves the other operand of `op` as it is; false: none.
bool identity_of(Op op, std::uint32_t& bits) {
  bits = op == Op::kFAdd ? kMinusZero : kOne;
  return op == Op::kFAdd || op == Op::kFMul || op == Op::kFDiv;
}

/// A selection with a literal side, in either of its forms.
struct Selection {
  Src condition;
  std::uint32_t side = 0;  ///< of the literal: 1 (where the condition holds) or 2
  Src operand;             ///< the other side; none where it converts
  bool converts = false;   ///< bool to float: 1 and 0
};

/// The operation of this op that makes what is read, for one user.
const Inst* only_user_of(const Graph& graph, Src src, Op op) {
  return is_used_once(graph, src) ? scalar_operation(graph, src, op) : nullptr;
}

/// Users of one component.
std::uint32_t users_of(const Graph& graph, Src src) {
  std::uint32_t users = 0;
  for (Slot slot = graph.values[src.value].first_use; slot != kNone; slot = graph.sources[slot].next) {
    const Inst& user = graph.insts[graph.sources[slot].user];
    const bool scalar = (user.kind == Kind::kAlu && user.components == 1) || user.kind == Kind::kVec;
    users += !scalar || graph.sources[slot].src.swizzle[0] == src.swizzle[0] ? 1 : 0;
  }
  return users;
}

/// The result of an If outside of loops, for one user: a selection if one branch yields a literal.
bool find_result(const Graph& graph, Src src, std::uint32_t identity, Selection& found) {
  const Inst* branch = graph.def(src.value);
  if (!branch || branch->kind != Kind::kIf || users_of(graph, src) != 1 ||
      !ends_in(graph, branch->child[0], Op::kYield) || !ends_in(graph, branch->child[1], Op::kYield))
    return false;
  const std::vector<ValueId>& results = graph.nodes[branch->node]->results;
  const auto index = static_cast<std::uint32_t>(std::find(results.begin(), results.end(), src.value) - results.begin());
  const auto yielded = [&](unsigned side) {
    const Inst& end = graph.insts[graph.blocks[branch->child[side - 1]].tail];
    return component_of(graph, graph.source(end, index), src.swizzle[0]);
  };
  for (const unsigned side : {2u, 1u}) {
    if (!is_literal(graph, yielded(side), identity)) continue;
    found = {graph.source(*branch, 0), side, src, false};
    return writes_selection(graph, *branch, side, yielded(3 - side), identity);
  }
  return false;
}

/// What selects the literal `identity` on one side, for one user.
bool find_selection(const Graph& graph, Src src, std::uint32_t identity, Selection& found) {
  if (const Inst* conversion = only_user_of(graph, src, Op::kB2F)) {
    if (identity != kOne && identity != 0) return false;
    found = {graph.source(*conversion, 0), identity == kOne ? 1u : 2u, {}, true};
    return !compares_integers(graph, found.condition);
  }
  const Inst* select = only_user_of(graph, src, Op::kSelect);
  if (!select) return find_result(graph, src, identity, found);
  for (const std::uint32_t side : {1u, 2u}) {
    if (!is_literal(graph, graph.source(*select, side), identity)) continue;
    found = {graph.source(*select, 0), side, graph.source(*select, 3 - side), false};
    return converts_sides(graph, found.condition, found.operand);
  }
  return false;
}

/// A selection of two literals for one user, negated or not.
bool find_literals(const Graph& graph, Src src, Src& condition, std::uint32_t (&literals)[2]) {
  const Inst* negation = only_user_of(graph, src, Op::kFNeg);
  if (negation) src = graph.source(*negation, 0);
  if (const Inst* conversion = only_user_of(graph, src, Op::kB2F)) {
    condition = graph.source(*conversion, 0);
    literals[0] = kOne;
    literals[1] = 0;
  } else {
    const Inst* select = only_user_of(graph, src, Op::kSelect);
    if (!select) return false;
    condition = graph.source(*select, 0);
    for (const std::uint32_t side : {1u, 2u}) {
      const std::optional<std::uint32_t> literal = literal_of(graph, graph.source(*select, side));
      if (!literal) return false;
      literals[side - 1] = *literal;
    }
  }
  for (std::uint32_t& literal : literals)
    if (negation) literal ^= kMinusZero;
  return true;
}

/// A sum or product of a literal and a selection of two literals becomes a selection of two literals.
bool fold_into_selection(Graph& graph, InstId id) {
  const Op op = graph.insts[id].op;
  if (op != Op::kFAdd && op != Op::kFMul) return false;
  for (const std::uint32_t index : {0u, 1u}) {
    const std::optional<std::uint32_t> other = literal_of(graph, graph.source(graph.insts[id], 1 - index));
    Src condition;
    std::uint32_t literals[2];
    if (!other || !find_literals(graph, graph.source(graph.insts[id], index), condition, literals)) continue;
    Builder build(graph, id);
    Src sides[2];
    for (const std::uint32_t side : {0u, 1u}) {
      const std::uint32_t operands[3] = {literals[side], *other};
      std::uint32_t bits = 0;
      evaluate(op, operands, bits);
      sides[side] = build.literal(bits);
    }
    replace_inst(graph, id, build.alu(Op::kSelect, {condition, sides[0], sides[1]}).value);
    return true;
  }
  return false;
}

/// The side of the selection that is not the identity.
Src other_side(Graph& graph, InstId position, const Selection& selection) {
  if (!selection.converts) return selection.operand;
  return Builder(graph, position).literal(selection.side == 1 ? 0 : kOne);
}

/// The result of `id` becomes that of `id` on one side of the selection and `kept` on the other.
void select_result(Graph& graph, InstId id, const Selection& selection, Src kept) {
  const Src result = result_of(graph, id);
  const Src selected = Builder::behind(graph, id).alu(Op::kSelect, {selection.condition, kept, kept});
  graph.replace_uses(result.value, selected.value);
  graph.set_source(graph.values[selected.value].def, 3 - selection.side, result);
}

/// Added to what is negated, an operand is what the reference subtracts from, and zero is no identity of that.
bool is_subtracted(const Graph& graph, const Inst& sum, Src src) {
  const Inst* inst = graph.def(src.value);
  return sum.op == Op::kFAdd && inst && inst->kind == Kind::kAlu && inst->op == Op::kFNeg;
}

/// Operand `index` of `id`, a selection used once with `identity` on one side: x op (c ? y : identity) becomes
/// c ? x op y : x, which keeps denormals of x.
bool select_operation(Graph& graph, OperandRanks& products, InstId id, std::uint32_t index, std::uint32_t identity) {
  const Src other = graph.source(graph.insts[id], 1 - index);
  Selection selection;
  if (graph.constant(other.value) || is_subtracted(graph, graph.insts[id], other)) return false;
  if (!find_selection(graph, graph.source(graph.insts[id], index), identity, selection)) return false;
  if (products.negates_selection(id, index)) return false;
  const Src operand = other_side(graph, id, selection);
  select_result(graph, id, selection, other);
  graph.set_source(id, index, operand);
  return true;
}

/// A power is 0 where its base is 0 or NaN, a sign where its operand is, by a selection (lavapipe-shader-math.md 6.4).
bool find_zero(Graph& graph, Src src, Selection& found) {
  const Inst* power = only_user_of(graph, src, Op::kFPow);
  const Inst* selecting = power ? power : only_user_of(graph, src, Op::kFSign);
  if (!selecting) return false;
  const Src base = graph.source(*selecting, 0);
  Builder build(graph, graph.values[selecting->result].def);
  const Src zero = build.literal(0);
  const Src condition = build.alu(Op::kFLt, {zero, build.alu(Op::kFAbs, {base})});
  found = {condition, 2, src, false};
  return true;
}

/// The same for the subtraction of a selected zero, x + -(c ? y : 0).
bool select_subtraction(Graph& graph, OperandRanks& products, InstId id, std::uint32_t index) {
  const Src negated = graph.source(graph.insts[id], index), other = graph.source(graph.insts[id], 1 - index);
  const Inst* negation = only_user_of(graph, negated, Op::kFNeg);
  Selection selection;
  if (!negation || graph.constant(other.value) || is_subtracted(graph, graph.insts[id], other)) return false;
  const Src subtracted = graph.source(*negation, 0);
  if (!find_zero(graph, subtracted, selection) && !find_selection(graph, subtracted, 0, selection)) return false;
  const InstId negate = graph.values[negated.value].def;
  const Src operand = other_side(graph, negate, selection);
  select_result(graph, id, selection, other);
  graph.set_source(negate, 0, operand);
  products.forget(negated.value);
  return true;
}

/// No integer of the type that `op` converts to is near the number.
bool is_undefined(Op op, std::uint32_t bits) {
  const float number = base::float_of(bits);
  return op == Op::kF2U ? !(number > -1.0f && number < 4294967296.0f)
                        : !(number >= -2147483648.0f && number < 2147483648.0f);
}

/// A selected literal that converts to no integer is never selected: the integer would be undefined.
void drop_undefined(Graph& graph, InstId id) {
  for (;;) {
    const Inst* select = only_user_of(graph, graph.source(graph.insts[id], 0), Op::kSelect);
    Src kept;
    for (const std::uint32_t side : {1u, 2u}) {
      if (!select) break;
      const std::optional<std::uint32_t> literal = literal_of(graph, graph.source(*select, side));
      const Src other = graph.source(*select, 3 - side);
      if (!literal || !is_undefined(graph.insts[id].op, *literal)) continue;
      const Src condition = graph.source(*select, 0);
      if (!compares_floats(graph, condition) && converts_sides(graph, condition, other)) kept = other;
    }
    if (kept.value == ir::kNoValue) return;
    graph.set_source(id, 0, kept);
  }
}

}  // namespace

void fold_select_with_identity(Graph& graph) {
  const base::ScopedFloatMode mode(base::Denormals::kHonour);
  OperandRanks products(graph);
  auto visit = [&](InstId id) {
    const Inst& inst = graph.insts[id];
    std::uint32_t identity = 0;
    if (inst.kind == Kind::kAlu && inst.components == 1 && (inst.op == Op::kF2I || inst.op == Op::kF2U))
      drop_undefined(graph, id);
    if (inst.kind != Kind::kAlu || inst.components != 1 || !identity_of(inst.op, identity)) return;
    if (fold_into_selection(graph, id) || base::reference_lacks_avx512()) return;
    const bool commutes = inst.op != Op::kFDiv, adds = inst.op == Op::kFAdd;
    if (select_operation(graph, products, id, 1, identity) ||
        (commutes && select_operation(graph, products, id, 0, identity)))
      return;
    if (adds && !select_subtraction(graph, products, id, 1)) select_subtraction(graph, products, id, 0);
  };
  for_each_inst(graph, graph.root, visit);
}

}  // namespace vitrine::spirv::rewriting

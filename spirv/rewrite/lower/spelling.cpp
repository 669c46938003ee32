// Equal bits, fewer instructions: subtractions from additions of negations, extracted bits from shifts and masks
// (lavapipe-optimizer.md 8.2).
#include <bit>

#include "spirv/rewrite/graph/tree.h"
#include "spirv/rewrite/lower/passes.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

/// The operand negated by `op`, if operand `index` is that.
bool negated_operand(const Graph& graph, const Inst& inst, std::uint32_t index, Op op, Src& result) {
  const Src src = graph.source(inst, index);
  const Inst* def = graph.def(src.value);
  if (!def || def->kind != Kind::kAlu || def->op != op) return false;
  const Src inner = graph.source(*def, 0);
  result = inner;
  for (unsigned c = 0; c < inst.components; ++c) result.swizzle[c] = inner.swizzle[src.swizzle[c]];
  return true;
}

/// a + (-b) and (-b) + a.
void subtract(Graph& graph, InstId id, Op negate, Op subtraction) {
  Src inner;
  for (const std::uint32_t index : {1u, 0u}) {
    if (!negated_operand(graph, graph.insts[id], index, negate, inner)) continue;
    const Src other = graph.source(graph.insts[id], 1 - index);
    graph.insts[id].op = subtraction;
    graph.set_source(id, 0, other);
    graph.set_source(id, 1, inner);
    return;
  }
}

const Inst* scalar(const Graph& graph, Src src, Op op) {
  const Inst* inst = graph.def(src.value);
  return inst && inst->kind == Kind::kAlu && inst->op == op && inst->components == 1 ? inst : nullptr;
}

/// What is added to or taken from, if the other operand of the addition or subtraction is this literal.
Src beside_literal(const Graph& graph, Src sum, Op op, unsigned index, std::uint32_t bits) {
  const Inst* inst = scalar(graph, sum, op);
  return inst && is_literal(graph, graph.source(*inst, index), bits) ? graph.source(*inst, 1 - index) : Src{};
}

void extract(Graph& graph, InstId id, Op op, Src word, Src offset, Src bits) {
  const InstId made = graph.create(Kind::kAlu, op, 1, false, 3);
  graph.insts[made].origin = graph.insts[id].origin;
  graph.set_source(made, 0, word);
  graph.set_source(made, 1, offset);
  graph.set_source(made, 2, bits);
  graph.insert_before(id, made);
  graph.replace_uses(graph.insts[id].result, graph.insts[made].result);
  graph.remove(id);
}

Src new_literal(Graph& graph, InstId position, std::uint32_t bits) {
  const InstId made = graph.create_const(1, false, &bits);
  graph.insert_before(position, made);
  return {graph.insts[made].result, {0, 0, 0, 0}};
}

/// The number of bits c where `mask` is c == 32 ? ~0 : (1 << c) + -1.
Src bits_of_mask(const Graph& graph, Src mask) {
  const Inst* select = scalar(graph, mask, Op::kSelect);
  if (!select || !is_literal(graph, graph.source(*select, 1), ~0u)) return {};
  const Src whole = beside_literal(graph, graph.source(*select, 0), Op::kIEq, 1, 32);
  const Src power = beside_literal(graph, graph.source(*select, 2), Op::kIAdd, 1, ~0u);
  if (whole.value == ir::kNoValue || power.value == ir::kNoValue) return {};
  const Src bits = beside_literal(graph, power, Op::kShl, 0, 1);
  return bits.value == whole.value && bits.swizzle[0] == whole.swizzle[0] ? bits : Src{};
}

/// (a >> b) & mask.
void extract_unsigned(Graph& graph, InstId id) {
  for (const std::uint32_t index : {0u, 1u}) {
    const Inst* shift = scalar(graph, graph.source(graph.insts[id], index), Op::kUShr);
    if (!shift || graph.values[shift->result].uses != 1) continue;
    const Src word = graph.source(*shift, 0), offset = graph.source(*shift, 1);
    const Src mask = graph.source(graph.insts[id], 1 - index);
    Src bits = bits_of_mask(graph, mask);
    if (const Inst* literal = graph.constant(mask.value)) {
      const std::uint32_t ones = literal->imm[mask.swizzle[0]];
      if (ones != 0 && ones != ~0u && (ones & (ones + 1)) == 0)
        bits = new_literal(graph, id, static_cast<std::uint32_t>(std::popcount(ones)));
    }
    if (bits.value != ir::kNoValue) return extract(graph, id, Op::kBfeU, word, offset, bits);
  }
}

/// bits == 0 ? 0 : (a << 32 - bits - offset) >> 32 - bits.
void extract_signed(Graph& graph, InstId id) {
  const Inst& select = graph.insts[id];
  const Inst* right = scalar(graph, graph.source(select, 2), Op::kIShr);
  if (!right || !is_literal(graph, graph.source(select, 1), 0)) return;
  const Inst* left = scalar(graph, graph.source(*right, 0), Op::kShl);
  const Inst* rest = left ? scalar(graph, graph.source(*left, 1), Op::kISub) : nullptr;
  if (!rest || graph.source(*rest, 0).value != graph.source(*right, 1).value) return;
  const Src bits = beside_literal(graph, graph.source(*right, 1), Op::kISub, 0, 32);
  const Src none = beside_literal(graph, graph.source(select, 0), Op::kIEq, 0, 0);
  if (bits.value == ir::kNoValue || bits.value != none.value || bits.swizzle[0] != none.swizzle[0]) return;
  extract(graph, id, Op::kBfeI, graph.source(*left, 0), graph.source(*rest, 1), bits);
}

}  // namespace

void choose_spelling(Graph& graph) {
  auto visit = [&](InstId id) {
    if (graph.insts[id].kind != Kind::kAlu) return;
    if (graph.insts[id].op == Op::kFAdd) subtract(graph, id, Op::kFNeg, Op::kFSub);
    if (graph.insts[id].op == Op::kIAdd) subtract(graph, id, Op::kINeg, Op::kISub);
    if (graph.insts[id].components != 1) return;
    if (graph.insts[id].op == Op::kAnd) extract_unsigned(graph, id);
    if (graph.insts[id].op == Op::kSelect) extract_signed(graph, id);
  };
  for_each_inst(graph, graph.root, visit);
}

}  // namespace vitrine::spirv::rewriting

// Equal bits, fewer instructions: subtractions from additions of negations, extracted bits from shifts and masks
// (lavapipe-optimizer.md 8.2).
#include <bit>

#include "spirv/rewrite/graph/build.h"
#include "spirv/rewrite/graph/match.h"
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

void extract(Graph& graph, InstId id, Op op, Src word, Src offset, Src bits) {
  replace_inst(graph, id, Builder(graph, id).alu(op, {word, offset, bits}).value);
}

/// The number of bits c where `mask` is c == 32 ? ~0 : (1 << c) + -1.
Src bits_of_mask(const Graph& graph, Src mask) {
  Src bits;
  const auto is_whole = m_op(Op::kIEq, m_value(bits), m_literal(32));
  const auto power = m_op(Op::kShl, m_literal(1), m_same(bits));
  return match(graph, mask, m_op(Op::kSelect, is_whole, m_literal(~0u), m_op(Op::kIAdd, power, m_literal(~0u))))
             ? bits
             : Src{};
}

/// (a >> b) & mask.
void extract_unsigned(Graph& graph, InstId id) {
  for (const std::uint32_t index : {0u, 1u}) {
    Src word, offset;
    const Src shift = graph.source(graph.insts[id], index), mask = graph.source(graph.insts[id], 1 - index);
    if (!match(graph, shift, m_once(m_op(Op::kUShr, m_value(word), m_value(offset))))) continue;
    Src bits = bits_of_mask(graph, mask);
    if (const std::optional<std::uint32_t> ones = literal_of(graph, mask))
      if (*ones != 0 && *ones != ~0u && (*ones & (*ones + 1)) == 0)
        bits = Builder(graph, id).literal(static_cast<std::uint32_t>(std::popcount(*ones)));
    if (bits.value != ir::kNoValue) return extract(graph, id, Op::kBfeU, word, offset, bits);
  }
}

/// bits == 0 ? 0 : (a << 32 - bits - offset) >> 32 - bits.
void extract_signed(Graph& graph, InstId id) {
  Src bits, word, offset, rest, left;
  const auto is_empty = m_op(Op::kIEq, m_literal(0), m_value(bits));
  const auto shifted = m_op(Op::kShl, m_value(word), m_op(Op::kISub, m_value(rest), m_value(offset)));
  const Inst& select = graph.insts[id];
  const bool found = match(graph, graph.source(select, 0), is_empty) && is_literal(graph, graph.source(select, 1), 0) &&
                     match(graph, graph.source(select, 2), m_op(Op::kIShr, shifted, m_value(left))) &&
                     rest.value == left.value && match(graph, left, m_op(Op::kISub, m_literal(32), m_same(bits)));
  if (found) extract(graph, id, Op::kBfeI, word, offset, bits);
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

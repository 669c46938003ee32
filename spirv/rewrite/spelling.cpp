// Equal bits, fewer instructions: subtractions from additions of negations. And the plain minimum and maximum where an
// operand is known to be a number (lavapipe-shader-math.md 5.1, which also swaps operands).
#include "spirv/rewrite/passes.h"
#include "spirv/rewrite/range.h"

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

void choose_extrema(Graph& graph) {
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

void choose_spelling(Graph& graph) {
  auto visit = [&](InstId id) {
    if (graph.insts[id].kind != Kind::kAlu) return;
    if (graph.insts[id].op == Op::kFAdd) subtract(graph, id, Op::kFNeg, Op::kFSub);
    if (graph.insts[id].op == Op::kIAdd) subtract(graph, id, Op::kINeg, Op::kISub);
  };
  for_each_inst(graph, graph.root, visit);
}

}  // namespace vitrine::spirv::rewriting

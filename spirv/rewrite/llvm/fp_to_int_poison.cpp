// What the reference makes of results that are undefined, where that differs from what its operations give
// (lavapipe-optimizer.md 7.10).
#include "spirv/rewrite/graph/build.h"
#include "spirv/rewrite/graph/match.h"
#include "spirv/rewrite/llvm/passes.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

/// The sine or cosine that alone decides the operand: itself, or a sum or product of it with literals; each used once.
const Inst* only_wave(const Graph& graph, Src src) {
  const Inst* inst = scalar_operation(graph, src);
  if (!inst || !is_used_once(graph, src)) return nullptr;
  if (inst->op == Op::kFSin || inst->op == Op::kFCos) return inst;
  if (inst->op != Op::kFAdd && inst->op != Op::kFMul) return nullptr;
  for (const std::uint32_t index : {0u, 1u})
    if (literal_of(graph, graph.source(*inst, 1 - index))) return only_wave(graph, graph.source(*inst, index));
  return nullptr;
}

}  // namespace

void fold_fp_to_int_poison(Graph& graph) {
  auto visit = [&](InstId id) {
    const Inst& inst = graph.insts[id];
    if (inst.kind != Kind::kAlu || (inst.op != Op::kF2I && inst.op != Op::kF2U)) return;
    const Inst* wave = only_wave(graph, graph.source(inst, 0));
    if (!wave) return;
    const Src result{wave->result, {}};
    Builder build = Builder::behind(graph, graph.values[result.value].def);
    const Src one = build.literal(0x3f800000);
    const Src clamped = build.alu(Op::kFMinPlain, {one, one});
    graph.replace_uses(result.value, clamped.value);
    graph.set_source(graph.values[clamped.value].def, 0, result);
  };
  for_each_inst(graph, graph.root, visit);
}

}  // namespace vitrine::spirv::rewriting

// What the reference makes of results that are undefined, where that differs from what its operations give
// (lavapipe-optimizer.md 7.10).
#include "spirv/rewrite/llvm/passes.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

/// The sine or cosine that alone decides the operand: itself, or a sum or product of it with literals; each used once.
const Inst* only_wave(const Graph& graph, Src src) {
  const Inst* inst = graph.def(src.value);
  if (!inst || inst->kind != Kind::kAlu || inst->components != 1 || graph.values[src.value].uses != 1) return nullptr;
  if (inst->op == Op::kFSin || inst->op == Op::kFCos) return inst;
  if (inst->op != Op::kFAdd && inst->op != Op::kFMul) return nullptr;
  for (const std::uint32_t index : {0u, 1u})
    if (graph.constant(graph.source(*inst, 1 - index).value)) return only_wave(graph, graph.source(*inst, index));
  return nullptr;
}

}  // namespace

void fold_fp_to_int_poison(Graph& graph) {
  auto visit = [&](InstId id) {
    const Inst& inst = graph.insts[id];
    if (inst.kind != Kind::kAlu || (inst.op != Op::kF2I && inst.op != Op::kF2U)) return;
    const Inst* wave = only_wave(graph, graph.source(inst, 0));
    if (!wave) return;
    const ValueId result = wave->result;
    const InstId definition = graph.values[result].def;
    const std::uint32_t one_bits = 0x3f800000;
    const InstId one = graph.create_const(1, false, &one_bits);
    const InstId clamped = graph.create(Kind::kAlu, Op::kFMinPlain, 1, false, 2);
    graph.insts[clamped].origin = graph.insts[definition].origin;
    graph.insert_after(definition, clamped);
    graph.insert_after(definition, one);
    graph.replace_uses(result, graph.insts[clamped].result);
    graph.set_source(clamped, 0, {result, {0, 0, 0, 0}});
    graph.set_source(clamped, 1, {graph.insts[one].result, {0, 0, 0, 0}});
  };
  for_each_inst(graph, graph.root, visit);
}

}  // namespace vitrine::spirv::rewriting

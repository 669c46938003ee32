// Arithmetic on vectors becomes arithmetic on their components (nir_lower_alu_to_scalar.c).
#include "spirv/rewrite/nir/passes.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

/// One scalar instruction per component, and a Vec of them.
void split(Graph& graph, InstId id) {
  const Inst inst = graph.insts[id];
  const InstId vec = graph.create(Kind::kVec, Op::kVec, inst.components, inst.boolean, inst.components);
  graph.insts[vec].origin = inst.origin;
  for (unsigned c = 0; c < inst.components; ++c) {
    const InstId part = graph.create(inst.kind, inst.op, 1, inst.boolean, inst.count);
    graph.insts[part].width = inst.width;
    graph.insts[part].exact = inst.exact;
    graph.insts[part].opaque = inst.opaque;
    graph.insts[part].opens = inst.opens;
    graph.insts[part].origin = inst.origin;
    for (std::uint32_t i = 0; i < inst.count; ++i) {
      const Src src = graph.source(inst, i);
      const std::uint8_t s = src.swizzle[c];
      graph.set_source(part, i, {src.value, {s, s, s, s}});
    }
    graph.insert_before(id, part);
    graph.set_source(vec, c, {graph.insts[part].result, {0, 0, 0, 0}});
  }
  graph.insert_before(id, vec);
  graph.replace_uses(inst.result, graph.insts[vec].result);
  graph.remove(id);
}

}  // namespace

bool lower_alu_to_scalar(Graph& graph) {
  bool changed = false;
  auto visit = [&](InstId id) {
    const Inst& inst = graph.insts[id];
    if (!computes(inst) || inst.width == 64 || inst.components < 2) return;
    split(graph, id);
    changed = true;
  };
  for_each_inst(graph, graph.root, visit);
  return changed;
}

}  // namespace vitrine::spirv::rewriting

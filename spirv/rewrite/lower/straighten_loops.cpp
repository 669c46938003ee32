// Gives loops the form that the rewrites keep (graph/loops.h), before the first of them (lavapipe-optimizer.md 2.2).
#include "spirv/rewrite/graph/loops.h"
#include "spirv/rewrite/graph/tree.h"
#include "spirv/rewrite/lower/passes.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

void straighten(Graph& graph, InstId loop) {
  const InstId last = graph.blocks[graph.insts[loop].child[1]].tail;
  if (last == kNone || graph.blocks[graph.insts[loop].child[1]].head != last || !is_jump(graph.insts[last], Op::kYield))
    return;
  const std::vector<Src> next = operands_of(graph, last);
  const std::vector<ValueId> before = node_of(graph, loop).continue_params;
  for (const InstId id : ways_back(graph, loop)) {
    const std::vector<Src> passed = operands_of(graph, id);
    std::vector<Src> values;
    for (const Src& src : next) values.push_back(substituted(src, before, passed));
    graph.set_operands(id, values);
  }
  std::vector<ValueId> after;
  std::vector<Src> forwarded;
  for (const ValueId param : std::vector<ValueId>(node_of(graph, loop).params)) {
    after.push_back(new_value(graph, loop, param));
    forwarded.push_back({after.back(), kWhole});
  }
  node_of(graph, loop).continue_params = after;
  graph.set_operands(last, forwarded);
}

}  // namespace

void straighten_loops(Graph& graph) {
  auto visit = [&](InstId id) {
    if (graph.insts[id].kind == Kind::kLoop) straighten(graph, id);
  };
  for_each_inst(graph, graph.root, visit);
}

}  // namespace vitrine::spirv::rewriting

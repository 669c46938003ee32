// See loops.h.
#include "spirv/rewrite/graph/loops.h"

#include <algorithm>

#include "spirv/rewrite/graph/tree.h"

namespace vitrine::spirv::rewriting {

using Kind = Inst::Kind;

void collect_jumps(const Graph& graph, BlockId block, Op op, std::vector<InstId>& found) {
  for (InstId id = graph.blocks[block].head; id != kNone; id = graph.insts[id].next) {
    const Inst& inst = graph.insts[id];
    if (is_jump(inst, op)) found.push_back(id);
    if (inst.kind != Kind::kIf) continue;
    for (const BlockId child : inst.child) collect_jumps(graph, child, op, found);
  }
}

std::vector<InstId> ways_back(const Graph& graph, InstId loop) {
  const BlockId body = graph.insts[loop].child[0];
  std::vector<InstId> found;
  collect_jumps(graph, body, Op::kContinue, found);
  if (ends_in(graph, body, Op::kYield)) found.push_back(graph.blocks[body].tail);
  return found;
}

bool has_loops(const Graph& graph) {
  return std::any_of(graph.insts.begin(), graph.insts.end(),
                     [](const Inst& inst) { return inst.kind == Kind::kLoop && !inst.removed; });
}

InstId latch_of(const Graph& graph, InstId loop) {
  const BlockId body = graph.insts[loop].child[0];
  if (!ends_in(graph, body, Op::kYield) || contains_continue(graph, body)) return kNone;
  return graph.blocks[body].tail;
}

std::vector<InstId> header_of(const Graph& graph, InstId loop) {
  std::vector<InstId> header;
  for (InstId id = graph.blocks[graph.insts[loop].child[0]].head; id != kNone; id = graph.insts[id].next) {
    const Kind kind = graph.insts[id].kind;
    if (kind == Kind::kIf || kind == Kind::kLoop) break;
    header.push_back(id);
  }
  return header;
}

int param_index(const Graph& graph, InstId loop, ValueId value) {
  const auto& params = graph.nodes[graph.insts[loop].node]->params;
  for (std::size_t i = 0; i < params.size(); ++i)
    if (params[i] == value) return static_cast<int>(i);
  return -1;
}

ValueId add_param(Graph& graph, InstId loop, ValueId like, Src init, Src next) {
  const ValueId param = new_value(graph, loop, like), passed = new_value(graph, loop, like);
  node_of(graph, loop).params.push_back(param);
  node_of(graph, loop).continue_params.push_back(passed);
  append_operands(graph, loop, {init});
  for (const InstId way : ways_back(graph, loop)) append_operands(graph, way, {next});
  append_operands(graph, graph.blocks[graph.insts[loop].child[1]].tail, {{passed, kWhole}});
  return param;
}

std::vector<ValueId> add_params(Graph& graph, InstId loop, const std::vector<ValueId>& initial) {
  std::vector<ValueId> params;
  std::vector<Src> first, passed;
  for (const ValueId value : initial) {
    params.push_back(new_value(graph, loop, value));
    node_of(graph, loop).params.push_back(params.back());
    first.push_back({value, kWhole});
    passed.push_back({new_value(graph, loop, value), kWhole});
    node_of(graph, loop).continue_params.push_back(passed.back().value);
  }
  append_operands(graph, loop, first);
  for (const InstId way : ways_back(graph, loop)) append_operands(graph, way, first);
  append_operands(graph, graph.blocks[graph.insts[loop].child[1]].tail, passed);
  return params;
}

}  // namespace vitrine::spirv::rewriting

// The opposite of what the front end does to continue constructs: what runs from the second iteration on, and has
// stayed at the top of the body, becomes the continue construct (lavapipe-optimizer.md 8.3).
#include "spirv/rewrite/graph/loops.h"
#include "spirv/rewrite/graph/match.h"
#include "spirv/rewrite/graph/tree.h"
#include "spirv/rewrite/lower/passes.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

/// Index of the parameter that is `first` before the first iteration and !first in all others, as `condition` reads.
bool is_continue_flag(const Graph& graph, InstId loop, Src condition, bool& first) {
  const int index = param_index(graph, loop, condition.value);
  if (index < 0) return false;
  const auto i = static_cast<std::uint32_t>(index);
  const auto read = [&](Src src, bool& value) {
    const std::optional<std::uint32_t> literal = literal_of(graph, src);
    value = literal.value_or(value ? 1 : 0) != 0;
    return literal.has_value();
  };
  if (!read(graph.source(graph.insts[loop], i), first)) return false;
  for (const InstId way : ways_back(graph, loop)) {
    bool again = first;
    if (!read(graph.source(graph.insts[way], i), again) || again == first) return false;
  }
  return true;
}

void replace_uses_in(Graph& graph, BlockId block, const std::vector<ValueId>& from, const std::vector<Src>& to) {
  auto visit = [&](InstId id) {
    for (std::uint32_t i = 0; i < graph.insts[id].count; ++i) {
      const Src src = graph.source(graph.insts[id], i);
      const Src by = substituted(src, from, to);
      if (by.value != src.value) graph.set_source(id, i, by);
    }
  };
  for_each_inst(graph, block, visit);
}

void close_continue(Graph& graph, InstId loop) {
  const InstId branch = graph.blocks[graph.insts[loop].child[0]].head;
  if (branch == kNone || graph.insts[branch].kind != Kind::kIf) return;
  bool first = false;
  if (!is_continue_flag(graph, loop, graph.source(graph.insts[branch], 0), first)) return;
  const BlockId again = graph.insts[branch].child[first ? 1 : 0], skipped = graph.insts[branch].child[first ? 0 : 1];
  const InstId skipped_end = graph.blocks[skipped].tail, end = graph.blocks[again].tail;
  const InstId last = graph.blocks[graph.insts[loop].child[1]].tail;
  if (graph.blocks[skipped].head != skipped_end || !is_jump(graph.insts[skipped_end], Op::kYield) ||
      !is_jump(graph.insts[end], Op::kYield))
    return;
  const std::vector<ValueId> params = node_of(graph, loop).params;
  const std::vector<ValueId> results = node_of(graph, branch).results;
  const std::vector<Src> init = operands_of(graph, loop), at_first = operands_of(graph, skipped_end);
  std::vector<Src> passed;
  for (const ValueId param : node_of(graph, loop).continue_params) passed.push_back({param, kWhole});
  replace_uses_in(graph, again, params, passed);
  std::vector<Src> next = passed, entry = init;
  for (const Src& src : operands_of(graph, end)) next.push_back(src);
  for (const Src& src : at_first) entry.push_back(substituted(src, params, init));
  graph.remove(end);
  graph.splice_before(last, again);
  graph.set_operands(last, next);
  graph.set_operands(loop, entry);
  for (const ValueId result : results) {
    node_of(graph, loop).params.push_back(result);
    graph.values[result].def = loop;
  }
  node_of(graph, branch).results.clear();
  graph.remove(branch);
}

}  // namespace

void close_continues(Graph& graph) {
  auto visit = [&](InstId id) {
    if (graph.insts[id].kind == Kind::kLoop) close_continue(graph, id);
  };
  for_each_inst(graph, graph.root, visit);
}

}  // namespace vitrine::spirv::rewriting

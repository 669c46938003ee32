// Results and parameters that always carry one value are that value (nir_opt_remove_phis.c; lavapipe-optimizer.md 5.3).
#include "spirv/rewrite/graph/loops.h"
#include "spirv/rewrite/graph/tree.h"
#include "spirv/rewrite/nir/passes.h"
#include "spirv/rewrite/nir/to_lcssa.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

/// What all of `sources`, apart from `joined`, are copies of; no value if they are not.
Src copied_source(const Graph& graph, const std::vector<Src>& sources, ValueId joined) {
  Src common;
  for (const Src& src : sources) {
    if (src.value == joined) continue;
    const Inst* def = graph.def(src.value);
    if (!def || !is_move(*def) || !is_whole(graph, src, joined)) return {};
    const Src source = graph.source(*def, 0);
    if (common.value != ir::kNoValue && !same_value(graph, common, source, joined)) return {};
    common = source;
  }
  return common;
}

/// Where all ways that join bring copies of one value, a copy of it is what they join to; kNone if they do not. The
/// copy is not in a block yet.
InstId join_moves(Graph& graph, InstId id, const std::vector<Src>& sources, ValueId joined) {
  const Src source = copied_source(graph, sources, joined);
  if (source.value == ir::kNoValue) return kNone;
  const InstId copy = make_move(graph, source, joined);
  graph.insts[copy].origin = graph.insts[id].origin;
  graph.replace_uses(joined, graph.insts[copy].result);
  return copy;
}

/// Results of an If whose branches yield the same value.
bool remove_equal_results(Graph& graph, InstId id) {
  bool changed = false;
  const BlockId then_block = graph.insts[id].child[0], else_block = graph.insts[id].child[1];
  if (!ends_in(graph, then_block, Op::kYield) || !ends_in(graph, else_block, Op::kYield)) return false;
  const std::vector<ValueId> results = graph.nodes[graph.insts[id].node]->results;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const auto index = static_cast<std::uint32_t>(i);
    const Src a = graph.source(graph.insts[graph.blocks[then_block].tail], index);
    const Src b = graph.source(graph.insts[graph.blocks[else_block].tail], index);
    if (graph.values[results[i]].uses == 0) continue;
    if (same_value(graph, a, b, results[i])) {
      graph.replace_uses(results[i], whole_value(graph, id, a, results[i]));
    } else {
      const InstId copy = join_moves(graph, id, {a, b}, results[i]);
      if (copy == kNone) continue;
      graph.insert_after(id, copy);
    }
    changed = true;
  }
  return changed;
}

/// Results of an If of which one side leaves: what the other yields, if that is known outside. To the reference nothing
/// joins there.
bool remove_single_results(Graph& graph, InstId id) {
  const BlockId child[2] = {graph.insts[id].child[0], graph.insts[id].child[1]};
  const bool stays[2] = {ends_in(graph, child[0], Op::kYield), ends_in(graph, child[1], Op::kYield)};
  if (stays[0] == stays[1]) return false;
  const InstId end = graph.blocks[child[stays[0] ? 0 : 1]].tail;
  const std::vector<ValueId> results = graph.nodes[graph.insts[id].node]->results;
  bool changed = false;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Src value = graph.source(graph.insts[end], static_cast<std::uint32_t>(i));
    if (graph.values[results[i]].uses == 0 || is_inside(graph, value.value, id)) continue;
    graph.replace_uses(results[i], whole_value(graph, id, value, results[i]));
    changed = true;
  }
  return changed;
}

/// The value that all of `sources` are, apart from `self`; false if they differ or need a swizzle.
bool common_source(const Graph& graph, const std::vector<Src>& sources, ValueId self, Src& common) {
  common = {};
  for (const Src& src : sources) {
    if (src.value == self) continue;
    if (common.value != ir::kNoValue && !same_value(graph, common, src, self)) return false;
    common = src;
  }
  for (unsigned c = 0; c < graph.values[self].components; ++c)
    if (common.swizzle[c] != c) return false;
  return common.value != ir::kNoValue && graph.values[common.value].components == graph.values[self].components;
}

/// Parameters of a loop that are handed on as they are.
bool remove_constant_params(Graph& graph, InstId id) {
  bool changed = false;
  const std::vector<ValueId> params = graph.nodes[graph.insts[id].node]->params;
  const std::vector<InstId> ways = ways_back(graph, id);
  for (std::size_t i = 0; i < params.size(); ++i) {
    const auto index = static_cast<std::uint32_t>(i);
    if (graph.values[params[i]].uses == 0) continue;
    const Src init = graph.source(graph.insts[id], index);
    std::vector<Src> sources{init};
    for (const InstId way : ways) sources.push_back(graph.source(graph.insts[way], index));
    Src common;
    if (ways.empty()) {
      graph.replace_uses(params[i], whole_value(graph, id, init, params[i]));
    } else if (common_source(graph, sources, params[i], common)) {
      graph.replace_uses(params[i], common.value);
    } else {
      const InstId copy = join_moves(graph, id, sources, params[i]);
      if (copy == kNone) continue;
      graph.insert_before(graph.blocks[graph.insts[id].child[0]].head, copy);
    }
    changed = true;
  }
  return changed;
}

/// In the order in which ways join: those of an If behind what is in it, those of a loop in front.
bool remove_equal_joins(Graph& graph, BlockId block) {
  bool changed = false;
  for (InstId id = graph.blocks[block].head; id != kNone; id = graph.insts[id].next) {
    if (graph.insts[id].kind == Kind::kLoop) changed |= remove_constant_params(graph, id);
    for (const unsigned side : {0u, 1u}) {
      const BlockId child = graph.insts[id].child[side];
      if (child != kNone) changed |= remove_equal_joins(graph, child);
    }
    if (graph.insts[id].kind == Kind::kIf) changed |= remove_equal_results(graph, id);
  }
  return changed;
}

}  // namespace

bool opt_remove_phis(Graph& graph) {
  bool changed = leave_lcssa(graph);
  auto visit_single = [&](InstId id) {
    if (graph.insts[id].kind == Kind::kIf) changed |= remove_single_results(graph, id);
  };
  for_each_inst(graph, graph.root, visit_single);
  return remove_equal_joins(graph, graph.root) || changed;
}

}  // namespace vitrine::spirv::rewriting

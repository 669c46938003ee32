// Control flow that need not be: small branches (selects instead), results and parameters that carry one value.
#include "spirv/rewrite/loops.h"
#include "spirv/rewrite/passes.h"
#include "spirv/rewrite/tree.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

/// Instructions that both branches together may hold to become selects; moves, negations and absolute values are free.
constexpr unsigned kFlattenLimit = 8;

bool is_free(const Inst& inst) {
  switch (inst.op) {
    case Op::kMov:
    case Op::kMovB:
    case Op::kFNeg:
    case Op::kINeg:
    case Op::kFAbs:
    case Op::kIAbs:
      return true;
    default:
      return false;
  }
}

bool may_hoist(const Inst& inst) {
  switch (inst.op) {
    case Op::kUndef:
    case Op::kLoadInput:
    case Op::kHelperInvocation:
    case Op::kNumWorkgroups:
    case Op::kWorkgroupId:
    case Op::kLocalInvocationId:
    case Op::kLocalInvocationIndex:
    case Op::kGlobalInvocationId:
    case Op::kSubgroupId:
    case Op::kSubgroupInvocation:
      return true;
    default:
      return false;
  }
}

/// Adds the cost of a branch; false if something in it must stay conditional.
bool can_flatten(const Graph& graph, BlockId block, unsigned& cost) {
  for (InstId id = graph.blocks[block].head; id != kNone; id = graph.insts[id].next) {
    const Inst& inst = graph.insts[id];
    switch (inst.kind) {
      case Kind::kConst:
      case Kind::kVec:
        break;
      case Kind::kAlu:
        cost += is_free(inst) ? 0 : cost_of(graph, inst);
        break;
      case Kind::kIntrinsic:
        if (inst.op != Op::kYield && !may_hoist(inst)) return false;
        break;
      default:
        return false;
    }
  }
  return ends_in(graph, block, Op::kYield);
}

/// What a branch yields; the branch's instructions move in front of the If.
std::vector<Src> take_branch(Graph& graph, InstId id, BlockId block) {
  const InstId last = graph.blocks[block].tail;
  std::vector<Src> yielded = operands_of(graph, last);
  graph.remove(last);
  graph.splice_before(id, block);
  return yielded;
}

void flatten(Graph& graph, InstId id) {
  const Src condition = graph.source(graph.insts[id], 0);
  const std::uint8_t lane = condition.swizzle[0];
  const std::vector<Src> then_values = take_branch(graph, id, graph.insts[id].child[0]);
  const std::vector<Src> else_values = take_branch(graph, id, graph.insts[id].child[1]);
  const std::vector<ValueId> results = graph.nodes[graph.insts[id].node]->results;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Value value = graph.values[results[i]];
    const InstId select =
        graph.create(Kind::kAlu, value.boolean ? Op::kSelectB : Op::kSelect, value.components, value.boolean, 3);
    graph.insts[select].origin = graph.insts[id].origin;
    graph.set_source(select, 0, {condition.value, {lane, lane, lane, lane}});
    graph.set_source(select, 1, then_values[i]);
    graph.set_source(select, 2, else_values[i]);
    graph.insert_before(id, select);
    graph.replace_uses(results[i], graph.insts[select].result);
  }
  graph.remove(id);
}

/// Innermost first, so that a flattened branch may let the one around it flatten.
bool flatten_in(Graph& graph, BlockId block) {
  bool changed = false;
  for (InstId id = graph.blocks[block].head; id != kNone;) {
    const InstId next = graph.insts[id].next;
    const BlockId child[2] = {graph.insts[id].child[0], graph.insts[id].child[1]};
    for (const BlockId side : child)
      if (side != kNone) changed |= flatten_in(graph, side);
    if (graph.insts[id].kind == Kind::kIf) {
      unsigned cost = 0;
      if (can_flatten(graph, child[0], cost) && can_flatten(graph, child[1], cost) && cost <= kFlattenLimit) {
        flatten(graph, id);
        changed = true;
      }
    }
    id = next;
  }
  return changed;
}

bool same_value(const Graph& graph, const Src& a, const Src& b, ValueId like) {
  if (a.value != b.value) return false;
  for (unsigned c = 0; c < graph.values[like].components; ++c)
    if (a.swizzle[c] != b.swizzle[c]) return false;
  return true;
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
    if (graph.values[results[i]].uses == 0 || !same_value(graph, a, b, results[i])) continue;
    graph.replace_uses(results[i], whole_value(graph, id, a, results[i]));
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
    if (ways.empty())
      graph.replace_uses(params[i], whole_value(graph, id, init, params[i]));
    else if (common_source(graph, sources, params[i], common))
      graph.replace_uses(params[i], common.value);
    else
      continue;
    changed = true;
  }
  return changed;
}

}  // namespace

bool flatten_branches(Graph& graph) { return flatten_in(graph, graph.root); }

bool remove_trivial_results(Graph& graph) {
  bool changed = open_loops(graph);
  auto visit = [&](InstId id) {
    if (graph.insts[id].kind == Kind::kIf) changed |= remove_equal_results(graph, id);
    if (graph.insts[id].kind == Kind::kLoop) changed |= remove_constant_params(graph, id);
  };
  for_each_inst(graph, graph.root, visit);
  return changed;
}

}  // namespace vitrine::spirv::rewriting

// Control flow that need not be: branches on constants, small branches (selects instead), results that carry one value.
#include "spirv/rewrite/passes.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

/// Instructions that both branches together may hold to become selects; moves, negations and absolute values are free.
constexpr unsigned kFlattenLimit = 8;

bool is_jump(const Inst& inst, Op op) { return inst.kind == Kind::kIntrinsic && inst.op == op; }

bool ends_in_yield(const Graph& graph, BlockId block) {
  const InstId last = graph.blocks[block].tail;
  return last != kNone && is_jump(graph.insts[last], Op::kYield);
}

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
      return inst.opaque && inst.op == Op::kFAdd;  // the reference has one dot product where we have a chain
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
        cost += is_free(inst) ? 0 : 1;
        break;
      case Kind::kIntrinsic:
        if (inst.op != Op::kYield && !may_hoist(inst)) return false;
        break;
      default:
        return false;
    }
  }
  return ends_in_yield(graph, block);
}

/// What a branch yields; the branch's instructions move in front of the If.
std::vector<Src> take_branch(Graph& graph, InstId id, BlockId block) {
  const InstId last = graph.blocks[block].tail;
  std::vector<Src> yielded;
  for (std::uint32_t i = 0; i < graph.insts[last].count; ++i) yielded.push_back(graph.source(graph.insts[last], i));
  graph.remove(last);
  graph.splice_before(id, block);
  return yielded;
}

/// A value equal to `src`, with as many components as `result`.
ValueId value_of(Graph& graph, InstId position, const Src& src, ValueId result) {
  const std::uint8_t components = graph.values[result].components;
  bool whole = graph.values[src.value].components == components;
  for (unsigned c = 0; c < components; ++c) whole &= src.swizzle[c] == c;
  if (whole) return src.value;
  const bool boolean = graph.values[result].boolean;
  const InstId move = graph.create(Kind::kAlu, boolean ? Op::kMovB : Op::kMov, components, boolean, 1);
  graph.set_source(move, 0, src);
  graph.insert_before(position, move);
  return graph.insts[move].result;
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

void take_constant_branch(Graph& graph, InstId id, BlockId block) {
  const std::vector<Src> yielded = take_branch(graph, id, block);
  const std::vector<ValueId> results = graph.nodes[graph.insts[id].node]->results;
  for (std::size_t i = 0; i < results.size(); ++i)
    graph.replace_uses(results[i], value_of(graph, id, yielded[i], results[i]));
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
      const Src condition = graph.source(graph.insts[id], 0);
      const Inst* constant = graph.constant(condition.value);
      const BlockId taken = constant && constant->imm[condition.swizzle[0]] ? child[0] : child[1];
      unsigned cost = 0;
      if (constant && ends_in_yield(graph, taken)) {
        take_constant_branch(graph, id, taken);
        changed = true;
      } else if (can_flatten(graph, child[0], cost) && can_flatten(graph, child[1], cost) && cost <= kFlattenLimit) {
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
  if (!ends_in_yield(graph, then_block) || !ends_in_yield(graph, else_block)) return false;
  const std::vector<ValueId> results = graph.nodes[graph.insts[id].node]->results;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const auto index = static_cast<std::uint32_t>(i);
    const Src a = graph.source(graph.insts[graph.blocks[then_block].tail], index);
    const Src b = graph.source(graph.insts[graph.blocks[else_block].tail], index);
    if (graph.values[results[i]].uses == 0 || !same_value(graph, a, b, results[i])) continue;
    graph.replace_uses(results[i], value_of(graph, id, a, results[i]));
    changed = true;
  }
  return changed;
}

}  // namespace

bool flatten_branches(Graph& graph) { return flatten_in(graph, graph.root); }

bool remove_trivial_results(Graph& graph) {
  bool changed = false;
  auto visit = [&](InstId id) {
    if (graph.insts[id].kind == Kind::kIf) changed |= remove_equal_results(graph, id);
  };
  for_each_inst(graph, graph.root, visit);
  return changed;
}

}  // namespace vitrine::spirv::rewriting

// What joins goes through a register (nir_from_ssa.c: nir_lower_phis_to_regs_block; nir_lower_regs_to_ssa.c): steps
// that move blocks lower the joins of a loop to registers, which become joins again, though where the writes are.
#include "spirv/rewrite/nir/phis_to_regs.h"

#include <array>

#include "spirv/rewrite/graph/loops.h"
#include "spirv/rewrite/graph/tree.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

/// The If or Loop whose end starts the block that `position` is in; kNone: the list does.
InstId join_before(const Graph& graph, InstId position) {
  InstId at = graph.insts[position].previous;
  while (at != kNone && graph.insts[at].kind != Kind::kIf && graph.insts[at].kind != Kind::kLoop)
    at = graph.insts[at].previous;
  return at;
}

/// `value` is defined behind `join` in the same list, or is a result of it.
bool is_behind(const Graph& graph, InstId join, ValueId value) {
  const InstId def = graph.values[value].def;
  if (def == kNone || def == join) return def == join;
  if (graph.insts[def].block != graph.insts[join].block) return false;
  for (InstId at = graph.insts[join].next; at != kNone; at = graph.insts[at].next)
    if (at == def) return true;
  return false;
}

/// A copy of the whole value in front of `position`.
Src copy_of(Graph& graph, InstId position, ValueId value) { return copied(graph, position, {value, kWhole}, value); }

ValueId join_at_if(Graph& graph, InstId id, ValueId value) {
  const auto children = std::to_array(graph.insts[id].child);  // a copy: new instructions move the old ones
  for (const BlockId child : children)
    if (!ends_in(graph, child, Op::kYield)) return value;
  const ValueId result = add_results(graph, id, {value})[0].value;
  for (const BlockId child : children) {
    const InstId end = graph.blocks[child].tail;
    append_operands(graph, end, {through_register(graph, end, {value, kWhole}, value)});
  }
  return result;
}

ValueId join_at_loop(Graph& graph, InstId id, ValueId value) {
  std::vector<InstId> breaks;
  for (const BlockId child : graph.insts[id].child) collect_jumps(graph, child, Op::kBreak, breaks);
  if (breaks.size() < 2) return value;
  const ValueId result = add_results(graph, id, {value})[0].value;
  for (const InstId jump : breaks) append_operands(graph, jump, {copy_of(graph, jump, value)});
  return result;
}

ValueId join_at_header(Graph& graph, InstId loop, ValueId value) {
  const ValueId param = add_param(graph, loop, value, copy_of(graph, loop, value), {value, kWhole});
  for (const InstId way : ways_back(graph, loop))
    graph.set_source(way, graph.insts[way].count - 1, copy_of(graph, way, value));
  return param;
}

}  // namespace

Src through_register(Graph& graph, InstId position, Src src, ValueId like) {
  const Value shape = graph.values[like];
  const InstId join = join_before(graph, position);
  const InstId owner = graph.blocks[graph.insts[position].block].owner;
  ValueId value = src.value;
  bool whole = graph.values[value].components == shape.components;
  for (unsigned c = 0; c < shape.components; ++c) whole &= src.swizzle[c] == c;
  if (whole && join != kNone && !is_behind(graph, join, value)) {
    value = graph.insts[join].kind == Kind::kIf ? join_at_if(graph, join, value) : join_at_loop(graph, join, value);
  } else if (whole && join == kNone && owner != kNone && graph.insts[owner].kind == Kind::kLoop &&
             graph.insts[position].block == graph.insts[owner].child[0] && !is_inside(graph, value, owner)) {
    value = join_at_header(graph, owner, value);
  }
  if (value != src.value) return {value, kWhole};
  return copied(graph, position, src, like);
}

void pass_through_registers(Graph& graph, InstId loop) {
  const std::vector<ValueId> params = node_of(graph, loop).params;
  std::vector<InstId> ends = ways_back(graph, loop);
  ends.push_back(loop);
  for (const InstId id : ends)
    for (std::uint32_t i = 0; i < params.size(); ++i)
      graph.set_source(id, i, through_register(graph, id, graph.source(graph.insts[id], i), params[i]));
}

void leave_through_registers(Graph& graph, InstId loop) {
  const std::vector<ValueId> results = node_of(graph, loop).results;
  std::vector<InstId> breaks;
  for (const BlockId child : graph.insts[loop].child) collect_jumps(graph, child, Op::kBreak, breaks);
  for (const InstId id : breaks)
    for (std::uint32_t i = 0; i < results.size(); ++i)
      graph.set_source(id, i, through_register(graph, id, graph.source(graph.insts[id], i), results[i]));
}

std::vector<BranchJoin> joins_in(const Graph& graph, InstId loop) {
  std::vector<BranchJoin> joins;
  for (InstId id = graph.blocks[graph.insts[loop].child[0]].head; id != kNone; id = graph.insts[id].next) {
    const Inst& inst = graph.insts[id];
    if (inst.kind != Kind::kIf || !ends_in(graph, inst.child[0], Op::kYield) ||
        !ends_in(graph, inst.child[1], Op::kYield))
      continue;
    joins.push_back({id, graph.nodes[inst.node]->results.size()});
  }
  return joins;
}

void join_through_registers(Graph& graph, const std::vector<BranchJoin>& joins) {
  for (const auto& [branch, count] : joins)
    for (std::uint32_t i = 0; i < count; ++i) {
      const ValueId result = node_of(graph, branch).results[i];
      for (const BlockId child : std::to_array(graph.insts[branch].child)) {
        const InstId end = graph.blocks[child].tail;
        graph.set_source(end, i, through_register(graph, end, graph.source(graph.insts[end], i), result));
      }
      const InstId read = make_move(graph, {result, kWhole}, result);
      graph.replace_uses(result, graph.insts[read].result);
      graph.set_source(read, 0, {result, kWhole});
      graph.insert_after(branch, read);
    }
}

}  // namespace vitrine::spirv::rewriting

// Neighbouring branches and neighbouring ways out of a loop that become one (nir_opt_if.c; lavapipe-optimizer.md 5.9 to
// 5.11, 5.14).
#include "spirv/rewrite/nir/opt_if.h"

#include <algorithm>

#include "spirv/rewrite/graph/build.h"
#include "spirv/rewrite/graph/copier.h"
#include "spirv/rewrite/graph/match.h"
#include "spirv/rewrite/graph/tree.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

bool is_comparison(const Inst* inst) {
  if (!inst || inst->kind != Kind::kAlu || inst->components != 1) return false;
  if (inst->op == Op::kNotB || inst->op == Op::kXorB || inst->op == Op::kEqB) return true;
  const ir::AluInfo& info = ir::alu_info(inst->op);
  return info.sources == 2 && info.result == 'B' && info.operands[0] != 'B';
}

void become_yield(Graph& graph, InstId jump) { graph.insts[jump].op = Op::kYield; }

/// Both sides leave the loop.
void break_behind(Graph& graph, InstId id) {
  const InstId first = graph.blocks[graph.insts[id].child[0]].tail, last = graph.blocks[graph.insts[id].child[1]].tail;
  const std::vector<ValueId> like = node_of(graph, loop_around(graph, graph.insts[id].block)).results;
  become_yield(graph, first);
  become_yield(graph, last);
  node_of(graph, id).results.clear();
  const InstId jump = make_jump(graph, Op::kBreak, add_results(graph, id, like));
  graph.append(graph.insts[id].block, jump);
}

/// One side leaves the loop, as does what follows the other.
bool break_once(Graph& graph, InstId id, unsigned leaving) {
  const BlockId staying = graph.insts[id].child[1 - leaving];
  const InstId end = graph.blocks[graph.insts[id].block].tail;
  if (!ends_in(graph, staying, Op::kYield) || end == id || !is_jump(graph.insts[end], Op::kBreak)) return false;
  for (InstId at = graph.insts[id].next; at != end; at = graph.insts[at].next)
    if (jumps(graph, at)) return false;
  const std::vector<ValueId> like = node_of(graph, loop_around(graph, graph.insts[id].block)).results;
  const InstId stay_end = graph.blocks[staying].tail;
  replace_results(graph, id, operands_of(graph, stay_end), graph.insts[stay_end].previous);
  node_of(graph, id).results.clear();
  graph.move_range_before(stay_end, graph.insts[id].next, end);
  const std::vector<Src> values = operands_of(graph, end);
  graph.set_operands(stay_end, values);
  become_yield(graph, graph.blocks[graph.insts[id].child[leaving]].tail);
  graph.set_operands(end, add_results(graph, id, like));
  return true;
}

/// What is attached between two branches on one condition goes to the ends of the first one's sides; but for arithmetic
/// on what was there before, which others may read and which goes in front of it.
void move_attached_between(Graph& graph, InstId first, InstId second) {
  std::vector<InstId> before = graph.attached.take(first), between;
  for (const InstId id : graph.attached.take(second)) {
    const Inst& inst = graph.insts[id];
    bool moves = inst.kind != Kind::kIntrinsic;
    for (const Src& src : operands_of(graph, id))
      moves &= std::find(between.begin(), between.end(), graph.values[src.value].def) == between.end();
    (moves ? before : between).push_back(id);
  }
  graph.attached.give(first, std::move(before));
  graph.attached.give(second, std::move(between));
  move_attached_into_sides(graph, first, second);
}

}  // namespace

bool opt_merge_breaks(Graph& graph, InstId id) {
  const bool leaves[2] = {ends_in(graph, graph.insts[id].child[0], Op::kBreak),
                          ends_in(graph, graph.insts[id].child[1], Op::kBreak)};
  if (!leaves[0] && !leaves[1]) return false;
  if (!leaves[0] || !leaves[1]) return break_once(graph, id, leaves[0] ? 0 : 1);
  if (graph.insts[id].next != kNone) return false;
  break_behind(graph, id);
  return true;
}

bool opt_if_merge(Graph& graph, InstId id) {
  const InstId next = graph.insts[id].next;
  if (next == kNone || graph.insts[next].kind != Kind::kIf || !node_of(graph, id).results.empty()) return false;
  const Src a = graph.source(graph.insts[id], 0), b = graph.source(graph.insts[next], 0);
  if (a.value != b.value || a.swizzle[0] != b.swizzle[0]) return false;
  for (const BlockId child : graph.insts[id].child)
    if (!ends_in(graph, child, Op::kYield)) return false;
  if (!graph.attached.empty()) move_attached_between(graph, id, next);
  for (const unsigned side : {0u, 1u}) {
    const BlockId to = graph.insts[id].child[side], from = graph.insts[next].child[side];
    const InstId end = graph.blocks[to].tail;
    graph.splice_before(end, from);
    graph.remove(end);
  }
  node_of(graph, id).results = std::move(node_of(graph, next).results);
  node_of(graph, next).results.clear();
  for (const ValueId result : node_of(graph, id).results) graph.values[result].def = id;
  graph.remove(next);
  return true;
}

bool opt_if_simplification(Graph& graph, InstId id) {
  if (!is_empty(graph, graph.insts[id].child[0]) || is_empty(graph, graph.insts[id].child[1])) return false;
  const Src condition = graph.source(graph.insts[id], 0);
  if (!is_comparison(graph.def(condition.value))) return false;
  graph.set_source(id, 0, Builder::behind(graph, graph.values[condition.value].def).alu(Op::kNotB, {condition}));
  std::swap(graph.insts[id].child[0], graph.insts[id].child[1]);
  return true;
}

bool opt_if_phi_is_condition(Graph& graph, InstId id) {
  const BlockId side[2] = {graph.insts[id].child[0], graph.insts[id].child[1]};
  if (!ends_in(graph, side[0], Op::kYield) || !ends_in(graph, side[1], Op::kYield)) return false;
  const Src condition = graph.source(graph.insts[id], 0);
  const std::vector<ValueId> results = node_of(graph, id).results;
  bool changed = false;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Value value = graph.values[results[i]];
    if (!value.boolean || value.components != 1 || value.uses == 0) continue;
    bool truth[2] = {};
    bool known = true;
    for (const unsigned s : {0u, 1u}) {
      const Src src = graph.source(graph.insts[graph.blocks[side[s]].tail], static_cast<std::uint32_t>(i));
      const std::optional<std::uint32_t> literal = literal_of(graph, src);
      known &= literal.has_value();
      truth[s] = literal.value_or(0) != 0;
    }
    if (!known || truth[0] == truth[1]) continue;
    const Src by = truth[1] ? Builder(graph, id).alu(Op::kNotB, {condition}) : condition;
    graph.replace_uses(results[i], whole_value(graph, id, by, results[i]));
    changed = true;
  }
  return changed;
}

}  // namespace vitrine::spirv::rewriting

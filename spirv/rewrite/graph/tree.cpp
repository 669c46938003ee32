// Questions about the tree of blocks that several rewriting passes ask.
#include "spirv/rewrite/graph/tree.h"

namespace vitrine::spirv::rewriting {

bool same_value(const Graph& graph, Src a, Src b, ValueId like) {
  if (a.value != b.value) return false;
  for (unsigned c = 0; c < graph.values[like].components; ++c)
    if (a.swizzle[c] != b.swizzle[c]) return false;
  return true;
}

bool is_empty(const Graph& graph, BlockId block) {
  const InstId last = graph.blocks[block].tail;
  return last != kNone && graph.blocks[block].head == last && is_jump(graph.insts[last], Op::kYield);
}

bool jumps(const Graph& graph, InstId id) {
  const Inst& inst = graph.insts[id];
  if (leaves_loop(inst) || is_jump(inst, Op::kKill) || is_jump(inst, Op::kReturn)) return true;
  for (const BlockId child : inst.child)
    if (child != kNone && contains_jump(graph, child)) return true;
  return false;
}

bool contains_jump(const Graph& graph, BlockId block) {
  for (InstId id = graph.blocks[block].head; id != kNone; id = graph.insts[id].next)
    if (jumps(graph, id)) return true;
  return false;
}

InstId loop_around(const Graph& graph, BlockId block) {
  InstId owner = graph.blocks[block].owner;
  while (owner != kNone && graph.insts[owner].kind != Inst::Kind::kLoop)
    owner = graph.blocks[graph.insts[owner].block].owner;
  return owner;
}

std::vector<Slot> uses_of(const Graph& graph, ValueId value) {
  std::vector<Slot> uses;
  for (Slot use = graph.values[value].first_use; use != kNone; use = graph.sources[use].next) uses.push_back(use);
  return uses;
}

bool contains_continue(const Graph& graph, BlockId block) {
  for (InstId id = graph.blocks[block].head; id != kNone; id = graph.insts[id].next) {
    const Inst& inst = graph.insts[id];
    if (is_jump(inst, Op::kContinue)) return true;
    if (inst.kind == Inst::Kind::kIf &&
        (contains_continue(graph, inst.child[0]) || contains_continue(graph, inst.child[1])))
      return true;
  }
  return false;
}

bool is_inside(const Graph& graph, ValueId value, InstId loop) {
  for (InstId at = graph.values[value].def; at != kNone; at = graph.blocks[graph.insts[at].block].owner)
    if (at == loop) return true;
  return false;
}

std::vector<Src> operands_of(const Graph& graph, InstId id) {
  std::vector<Src> result;
  for (std::uint32_t i = 0; i < graph.insts[id].count; ++i) result.push_back(graph.source(graph.insts[id], i));
  return result;
}

void append_operands(Graph& graph, InstId id, const std::vector<Src>& more) {
  std::vector<Src> operands = operands_of(graph, id);
  operands.insert(operands.end(), more.begin(), more.end());
  graph.set_operands(id, operands);
}

ValueId new_value(Graph& graph, InstId def, ValueId like) {
  const Value shape = graph.values[like];
  graph.values.push_back({def, kNone, kNone, 0, shape.components, shape.boolean});
  return static_cast<ValueId>(graph.values.size() - 1);
}

Src substituted(Src src, const std::vector<ValueId>& values, const std::vector<Src>& by) {
  for (std::size_t i = 0; i < values.size() && i < by.size(); ++i) {
    if (values[i] != src.value) continue;
    Src result{by[i].value, {}};
    for (unsigned c = 0; c < 4; ++c) result.swizzle[c] = by[i].swizzle[src.swizzle[c]];
    return result;
  }
  return src;
}

bool is_whole(const Graph& graph, Src src, ValueId like) {
  bool whole = graph.values[src.value].components == graph.values[like].components;
  for (unsigned c = 0; c < graph.values[like].components; ++c) whole &= src.swizzle[c] == c;
  return whole;
}

InstId make_move(Graph& graph, Src src, ValueId like) {
  const Value shape = graph.values[like];
  const InstId move =
      graph.create(Inst::Kind::kAlu, shape.boolean ? Op::kMovB : Op::kMov, shape.components, shape.boolean, 1);
  graph.set_source(move, 0, src);
  return move;
}

Src copied(Graph& graph, InstId position, Src src, ValueId like) {
  const InstId move = make_move(graph, src, like);
  graph.insert_before(position, move);
  return {graph.insts[move].result, kWhole};
}

ValueId whole_value(Graph& graph, InstId position, Src src, ValueId like) {
  if (is_whole(graph, src, like)) return src.value;
  return copied(graph, position, src, like).value;
}

Src component_of(const Graph& graph, Src src, std::uint8_t component) {
  const std::uint8_t s = src.swizzle[component];
  const Inst* vec = graph.def(src.value);
  return vec && vec->kind == Inst::Kind::kVec ? graph.source(*vec, s) : Src{src.value, {s, s, s, s}};
}

void replace_results(Graph& graph, InstId id, const std::vector<Src>& values, InstId after) {
  const std::vector<ValueId> results = graph.nodes[graph.insts[id].node]->results;
  for (std::size_t i = 0; i < results.size() && i < values.size(); ++i) {
    ValueId value = values[i].value;
    if (!is_whole(graph, values[i], results[i])) {
      const InstId move = make_move(graph, values[i], results[i]);
      if (after == kNone) {
        graph.insert_before(id, move);
      } else {
        graph.insert_after(after, move);
      }
      value = graph.insts[move].result;
    }
    graph.replace_uses(results[i], value);
  }
}

std::vector<Src> add_results(Graph& graph, InstId id, const std::vector<ValueId>& like) {
  std::vector<Src> made;
  for (const ValueId value : like) {
    const Value shape = graph.values[value];
    const auto result = static_cast<ValueId>(graph.values.size());
    graph.values.push_back({id, kNone, kNone, 0, shape.components, shape.boolean});
    graph.nodes[graph.insts[id].node]->results.push_back(result);
    made.push_back({result, {0, 1, 2, 3}});
  }
  return made;
}

}  // namespace vitrine::spirv::rewriting

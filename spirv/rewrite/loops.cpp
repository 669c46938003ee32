// See loops.h.
#include "spirv/rewrite/loops.h"

#include <algorithm>
#include <array>
#include <map>

#include "spirv/rewrite/passes.h"
#include "spirv/rewrite/tree.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

void collect_jumps(const Graph& graph, BlockId block, Op op, std::vector<InstId>& found) {
  for (InstId id = graph.blocks[block].head; id != kNone; id = graph.insts[id].next) {
    const Inst& inst = graph.insts[id];
    if (is_jump(inst, op)) found.push_back(id);
    if (inst.kind != Kind::kIf) continue;
    for (const BlockId child : inst.child) collect_jumps(graph, child, op, found);
  }
}

ir::Node& node_of(Graph& graph, InstId id) { return *graph.nodes[graph.insts[id].node]; }

ValueId new_value(Graph& graph, InstId def, ValueId like) {
  const Value shape = graph.values[like];
  graph.values.push_back({def, kNone, kNone, 0, shape.components, shape.boolean});
  return static_cast<ValueId>(graph.values.size() - 1);
}

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

void append_operands(Graph& graph, InstId id, const std::vector<Src>& more) {
  std::vector<Src> operands = operands_of(graph, id);
  operands.insert(operands.end(), more.begin(), more.end());
  graph.set_operands(id, operands);
}

void append_operand(Graph& graph, InstId id, Src src) { append_operands(graph, id, {src}); }

void erase_operand(Graph& graph, InstId id, std::size_t index) {
  std::vector<Src> operands = operands_of(graph, id);
  operands.erase(operands.begin() + static_cast<std::ptrdiff_t>(index));
  graph.set_operands(id, operands);
}

template <class T>
void erase_at(std::vector<T>& items, std::size_t index) {
  items.erase(items.begin() + static_cast<std::ptrdiff_t>(index));
}

/// Marks what effects need through everything that joins values, then drops the joins that are not marked.
class JoinSweeper {
 public:
  explicit JoinSweeper(Graph& graph) : graph_(graph), live_(graph.values.size(), false) {}

  bool run() {
    index(graph_.root, kNone);
    while (!pending_.empty()) {
      const ValueId value = pending_.back();
      pending_.pop_back();
      trace(value);
    }
    bool changed = false;
    for (const auto& [loop, ways] : loops_) changed |= sweep_loop(loop, ways);
    return changed;
  }

 private:
  struct Ways {
    std::vector<InstId> back, out;
  };

  void need(ValueId value) {
    if (live_[value]) return;
    live_[value] = true;
    pending_.push_back(value);
  }

  void need_operand(InstId id, std::size_t index) {
    if (index < graph_.insts[id].count) need(graph_.source(graph_.insts[id], static_cast<std::uint32_t>(index)).value);
  }

  void index(BlockId block, InstId loop) {
    for (InstId id = graph_.blocks[block].head; id != kNone; id = graph_.insts[id].next) {
      const Inst& inst = graph_.insts[id];
      if (inst.kind == Kind::kLoop) {
        loops_.try_emplace(id).first->second.back = ways_back(graph_, id);
        for (const BlockId child : inst.child) index(child, id);
      } else if (inst.kind == Kind::kIf) {
        need(graph_.source(inst, 0).value);
        for (const BlockId child : inst.child) index(child, loop);
      } else if (is_jump(inst, Op::kBreak)) {
        if (loop != kNone) loops_.try_emplace(loop).first->second.out.push_back(id);
      } else if (inst.kind == Kind::kIntrinsic && !is_jump(inst, Op::kYield) && !leaves_loop(inst) &&
                 !is_pure(graph_, inst)) {
        for (std::uint32_t i = 0; i < inst.count; ++i) need_operand(id, i);
      }
    }
  }

  void trace(ValueId value) {
    const InstId id = graph_.values[value].def;
    if (id == kNone) return;
    const Inst& inst = graph_.insts[id];
    if (inst.kind == Kind::kLoop) {
      trace_loop(id, value);
    } else if (inst.kind == Kind::kIf) {
      const auto& results = graph_.nodes[inst.node]->results;
      for (std::size_t i = 0; i < results.size(); ++i)
        if (results[i] == value)
          for (const BlockId child : inst.child)
            if (ends_in(graph_, child, Op::kYield)) need_operand(graph_.blocks[child].tail, i);
    } else {
      for (std::uint32_t i = 0; i < inst.count; ++i) need_operand(id, i);
    }
  }

  void trace_loop(InstId loop, ValueId value) {
    const ir::Node& node = *graph_.nodes[graph_.insts[loop].node];
    const Ways& ways = loops_[loop];
    for (std::size_t i = 0; i < node.params.size(); ++i) {
      if (node.params[i] == value) {
        need_operand(loop, i);
        need_operand(graph_.blocks[graph_.insts[loop].child[1]].tail, i);
      }
      if (i < node.continue_params.size() && node.continue_params[i] == value)
        for (const InstId way : ways.back) need_operand(way, i);
    }
    for (std::size_t i = 0; i < node.results.size(); ++i)
      if (node.results[i] == value)
        for (const InstId way : ways.out) need_operand(way, i);
  }

  bool sweep_loop(InstId loop, const Ways& ways) {
    ir::Node& node = *graph_.nodes[graph_.insts[loop].node];
    bool changed = false;
    const InstId last = graph_.blocks[graph_.insts[loop].child[1]].tail;
    for (std::size_t i = node.params.size(); i-- > 0;) {
      if (live_[node.params[i]] || node.continue_params.size() != node.params.size()) continue;
      erase_at(node.params, i);
      erase_at(node.continue_params, i);
      erase_operand(graph_, loop, i);
      erase_operand(graph_, last, i);
      for (const InstId way : ways.back) erase_operand(graph_, way, i);
      changed = true;
    }
    for (std::size_t i = node.results.size(); i-- > 0;) {
      if (live_[node.results[i]]) continue;
      erase_at(node.results, i);
      for (const InstId way : ways.out) erase_operand(graph_, way, i);
      changed = true;
    }
    return changed;
  }

  Graph& graph_;
  std::vector<bool> live_;
  std::vector<ValueId> pending_;
  std::map<InstId, Ways> loops_;
};

// ---- the continue construct

/// Index of the parameter that is `first` before the first iteration and !first in all others, as `condition` reads.
bool is_continue_flag(const Graph& graph, InstId loop, Src condition, bool& first) {
  const int index = param_index(graph, loop, condition.value);
  if (index < 0) return false;
  const auto i = static_cast<std::uint32_t>(index);
  const auto read = [&](Src src, bool& value) {
    const Inst* constant = graph.constant(src.value);
    if (constant) value = constant->imm[src.swizzle[0]] != 0;
    return constant != nullptr;
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

void straighten_loops(Graph& graph) {
  auto visit = [&](InstId id) {
    if (graph.insts[id].kind == Kind::kLoop) straighten(graph, id);
  };
  for_each_inst(graph, graph.root, visit);
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
  append_operand(graph, loop, init);
  for (const InstId way : ways_back(graph, loop)) append_operand(graph, way, next);
  append_operand(graph, graph.blocks[graph.insts[loop].child[1]].tail, {passed, kWhole});
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

namespace {

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
    append_operand(graph, end, through_register(graph, end, {value, kWhole}, value));
  }
  return result;
}

ValueId join_at_loop(Graph& graph, InstId id, ValueId value) {
  std::vector<InstId> breaks;
  for (const BlockId child : graph.insts[id].child) collect_jumps(graph, child, Op::kBreak, breaks);
  if (breaks.size() < 2) return value;
  const ValueId result = add_results(graph, id, {value})[0].value;
  for (const InstId jump : breaks) append_operand(graph, jump, copy_of(graph, jump, value));
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

std::vector<Join> joins_in(const Graph& graph, InstId loop) {
  std::vector<Join> joins;
  for (InstId id = graph.blocks[graph.insts[loop].child[0]].head; id != kNone; id = graph.insts[id].next) {
    const Inst& inst = graph.insts[id];
    if (inst.kind != Kind::kIf || !ends_in(graph, inst.child[0], Op::kYield) ||
        !ends_in(graph, inst.child[1], Op::kYield))
      continue;
    joins.push_back({id, graph.nodes[inst.node]->results.size()});
  }
  return joins;
}

void join_through_registers(Graph& graph, const std::vector<Join>& joins) {
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

bool drop_dead_joins(Graph& graph) { return JoinSweeper(graph).run(); }

void close_continues(Graph& graph) {
  auto visit = [&](InstId id) {
    if (graph.insts[id].kind == Kind::kLoop) close_continue(graph, id);
  };
  for_each_inst(graph, graph.root, visit);
}

}  // namespace vitrine::spirv::rewriting

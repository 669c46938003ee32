// Dead code (nir_opt_dce.c; lavapipe-optimizer.md 3.5). What joins values, results of an If and parameters and results
// of a loop, is dead where nothing but such joins reads it.
#include <map>
#include <vector>

#include "spirv/rewrite/graph/effects.h"
#include "spirv/rewrite/graph/loops.h"
#include "spirv/rewrite/graph/tree.h"
#include "spirv/rewrite/nir/passes.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

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
    need_attached(graph_.attached.at_end(block));
    for (InstId id = graph_.blocks[block].head; id != kNone; id = graph_.insts[id].next) {
      const Inst& inst = graph_.insts[id];
      need_attached(graph_.attached.in_front(id));
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

  void need_attached(const std::vector<InstId>& list) {
    for (const InstId id : list)
      for (std::uint32_t i = 0; i < graph_.insts[id].count; ++i) need_operand(id, i);
  }

  void trace(ValueId value) {
    const InstId id = graph_.values[value].def;
    if (id == kNone || (graph_.insts[id].removed && graph_.insts[id].child[0] != kNone)) return;
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

/// Drops results of an If that nobody uses, with what its branches yield for them.
bool drop_unused_results(Graph& graph, InstId id) {
  bool changed = false;
  auto& results = graph.nodes[graph.insts[id].node]->results;
  for (std::size_t i = results.size(); i-- > 0;) {
    if (graph.values[results[i]].uses != 0 || graph.attached.reads(results[i])) continue;
    for (const BlockId child : graph.insts[id].child) {
      const InstId last = graph.blocks[child].tail;
      if (last != kNone && graph.insts[last].kind == Kind::kIntrinsic && graph.insts[last].op == Op::kYield)
        erase_operand(graph, last, i);
    }
    results.erase(results.begin() + static_cast<std::ptrdiff_t>(i));
    changed = true;
  }
  return changed;
}

/// Backwards through a block, so that whole chains die in one walk.
bool remove_dead_in(Graph& graph, BlockId block) {
  bool changed = false;
  for (InstId id = graph.blocks[block].tail; id != kNone;) {
    const InstId before = graph.insts[id].previous;
    const Kind kind = graph.insts[id].kind;
    if (kind == Kind::kIf) changed |= drop_unused_results(graph, id);
    if (kind == Kind::kIf || kind == Kind::kLoop)
      for (const int side : {1, 0}) changed |= remove_dead_in(graph, graph.insts[id].child[side]);
    const Inst& inst = graph.insts[id];
    const bool unused = inst.result == ir::kNoValue || graph.values[inst.result].uses == 0;
    const bool empty_if = kind == Kind::kIf && graph.nodes[inst.node]->results.empty();
    if ((kind == Kind::kIf ? empty_if : unused && inst.result != ir::kNoValue) && is_pure(graph, inst)) {
      if (kind == Kind::kIf) graph.attached.keep_branches(graph, id);
      graph.remove(id);
      changed = true;
    }
    id = before;
  }
  return changed;
}

}  // namespace

bool opt_dce(Graph& graph) {
  const bool changed = JoinSweeper(graph).run();
  return remove_dead_in(graph, graph.root) || changed;
}

}  // namespace vitrine::spirv::rewriting

// See program_order.h.
#include "spirv/rewrite/gallivm/program_order.h"

#include "spirv/rewrite/graph/tree.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

class Walk {
 public:
  Walk(const Graph& graph, ProgramOrder& order) : graph_(graph), o_(order) {
    o_.block.assign(graph.values.size(), kNone);
    o_.definition.assign(graph.values.size(), 0);
    o_.user_block.assign(graph.insts.size(), kNone);
    o_.user_position.assign(graph.insts.size(), 0);
  }

  void run() { walk(graph_.root, new_block({})); }

 private:
  struct Loop {
    InstId id;
    std::uint32_t header;
    std::size_t first_param;  ///< in ProgramOrder::joins
    std::vector<InstId> breaks;
  };

  std::uint32_t new_block(std::vector<std::uint32_t> predecessors) {
    std::erase(predecessors, kNone);
    o_.blocks.push_back({std::move(predecessors)});
    return static_cast<std::uint32_t>(o_.blocks.size() - 1);
  }

  void place(InstId id, std::uint32_t block) {
    o_.user_block[id] = block;
    o_.user_position[id] = position_++;
    const Inst& inst = graph_.insts[id];
    if (inst.result == ir::kNoValue) return;
    o_.block[inst.result] = block;
    o_.definition[inst.result] = o_.user_position[id];
  }

  /// The block that the list ends in, kNone when it ends in a jump.
  std::uint32_t walk(BlockId list, std::uint32_t block) {
    for (InstId id = graph_.blocks[list].head; id != kNone; id = graph_.insts[id].next) {
      const Inst& inst = graph_.insts[id];
      place(id, block);
      if (inst.kind == Kind::kIf) {
        block = walk_if(id, block);
      } else if (inst.kind == Kind::kLoop) {
        block = walk_loop(id, block);
      } else if (leaves_loop(inst)) {
        leave(id, block);
        return kNone;
      } else if (is_jump(inst, Op::kReturn) || is_jump(inst, Op::kKill)) {
        return kNone;
      }
    }
    return block;
  }

  std::uint32_t walk_if(InstId id, std::uint32_t block) {
    std::uint32_t ends[2];
    for (const int side : {0, 1}) ends[side] = walk(graph_.insts[id].child[side], new_block({block}));
    const std::uint32_t merge = new_block({ends[0], ends[1]});
    std::vector<InstId> ways;
    for (const int side : {0, 1})
      if (ends[side] != kNone && ends_in(graph_, graph_.insts[id].child[side], Op::kYield))
        ways.push_back(graph_.blocks[graph_.insts[id].child[side]].tail);
    add_joins(id, graph_.nodes[graph_.insts[id].node]->results, false, merge, ways);
    return merge;
  }

  std::uint32_t walk_loop(InstId id, std::uint32_t block) {
    const std::uint32_t header = new_block({block});
    loops_.push_back({id, header, o_.joins.size(), {}});
    add_joins(id, graph_.nodes[graph_.insts[id].node]->params, true, header, {id});
    const BlockId body = graph_.insts[id].child[0];
    const std::uint32_t end = walk(body, header);
    if (end != kNone && ends_in(graph_, body, Op::kYield)) go_back(graph_.blocks[body].tail, end);
    std::vector<std::uint32_t> from;
    for (const InstId way : loops_.back().breaks) from.push_back(o_.user_block[way]);
    const std::vector<InstId> breaks = std::move(loops_.back().breaks);
    loops_.pop_back();
    const std::uint32_t exit = new_block(from);
    add_joins(id, graph_.nodes[graph_.insts[id].node]->results, false, exit, breaks);
    return exit;
  }

  void leave(InstId id, std::uint32_t block) {
    if (graph_.insts[id].op == Op::kBreak) {
      loops_.back().breaks.push_back(id);
    } else {
      go_back(id, block);
    }
  }

  void go_back(InstId way, std::uint32_t block) {
    const Loop& loop = loops_.back();
    o_.blocks[loop.header].predecessors.push_back(block);
    const std::size_t params = graph_.nodes[graph_.insts[loop.id].node]->params.size();
    for (std::uint32_t i = 0; i < params; ++i) o_.joins[loop.first_param + i].join.ways.push_back({way, i});
  }

  void add_joins(InstId owner, const std::vector<ValueId>& values, bool parameters, std::uint32_t block,
                 const std::vector<InstId>& ways) {
    const std::size_t first = o_.joins.size();
    for (std::uint32_t i = 0; i < values.size(); ++i) {
      OrderedJoin join{{values[i], owner, parameters, kNone, {}}, block, position_++, 0};
      for (const InstId way : ways) join.join.ways.push_back({way, i});
      o_.joins.push_back(std::move(join));
    }
    const std::uint32_t copies = position_++;
    for (std::uint32_t i = 0; i < values.size(); ++i) {
      o_.joins[first + i].copy_position = copies;
      o_.block[values[i]] = block;
      o_.definition[values[i]] = copies;
    }
  }

  const Graph& graph_;
  ProgramOrder& o_;
  std::uint32_t position_ = 0;
  std::vector<Loop> loops_;
};

}  // namespace

ProgramOrder::ProgramOrder(const Graph& graph) { Walk(graph, *this).run(); }

}  // namespace vitrine::spirv::rewriting

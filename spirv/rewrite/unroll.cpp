// Loops with a constant number of iterations become straight-line code, as in the reference
// (lavapipe-shader-math.md 3.2 and 9): unrolled code sees the counter as constants, which changes what the algebraic
// rules do. Covered: one exit, at the top level of the body, on a counter that starts and steps by constants.
#include <algorithm>
#include <array>
#include <bit>
#include <unordered_map>

#include "base/float_mode.h"
#include "spirv/rewrite/passes.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;
using Bits = std::array<std::uint32_t, 4>;

constexpr unsigned kMaxIterations = 32;
constexpr unsigned kMaxCost = 26 * kMaxIterations;  ///< instructions times iterations

bool is_jump(const Inst& inst, Op op) { return inst.kind == Kind::kIntrinsic && inst.op == op; }

bool leaves_loop(const Inst& inst) { return is_jump(inst, Op::kBreak) || is_jump(inst, Op::kContinue); }

/// Breaks and continues of the loop that owns `block`, other than a Continue at its very end.
unsigned count_exits(const Graph& graph, BlockId block) {
  unsigned exits = 0;
  for (InstId id = graph.blocks[block].head; id != kNone; id = graph.insts[id].next) {
    const Inst& inst = graph.insts[id];
    if (leaves_loop(inst)) ++exits;
    if (inst.kind == Kind::kIf) exits += count_exits(graph, inst.child[0]) + count_exits(graph, inst.child[1]);
  }
  return exits;
}

struct Cost {
  unsigned instructions = 0;
  bool has_loop = false;
};

void add_cost(const Graph& graph, BlockId block, Cost& cost) {
  for (InstId id = graph.blocks[block].head; id != kNone; id = graph.insts[id].next) {
    const Inst& inst = graph.insts[id];
    const bool jump = leaves_loop(inst) || is_jump(inst, Op::kYield);
    if (inst.kind == Kind::kAlu || inst.kind == Kind::kVec || (inst.kind == Kind::kIntrinsic && !jump))
      ++cost.instructions;
    cost.has_loop |= inst.kind == Kind::kLoop;
    for (const BlockId child : inst.child)
      if (child != kNone) add_cost(graph, child, cost);
  }
}

/// A loop in the covered shape.
struct Shape {
  InstId exit = kNone;      ///< the If that leaves the loop
  unsigned break_side = 0;  ///< its branch that ends in Break
  unsigned iterations = 0;  ///< times the exit is not taken
};

class Counter {
 public:
  Counter(const Graph& graph, InstId loop) : graph_(graph), loop_(loop) {
    const Inst& inst = graph.insts[loop];
    const ir::Node& node = *graph.nodes[inst.node];
    for (std::size_t i = 0; i < node.params.size(); ++i)
      if (const Inst* constant = graph.constant(graph.source(inst, static_cast<std::uint32_t>(i)).value))
        known_[node.params[i]] = read(constant->imm, graph.source(inst, static_cast<std::uint32_t>(i)).swizzle);
  }

  /// Runs the loop on what is constant. False: the exit is not decided by constants within the limit.
  bool count(Shape& shape) {
    const base::ScopedFloatMode mode(base::Denormals::kHonour);
    for (shape.iterations = 0; shape.iterations <= kMaxIterations; ++shape.iterations) {
      Bits condition;
      if (!value(graph_.source(graph_.insts[shape.exit], 0), condition)) return false;
      if ((condition[0] != 0) == (shape.break_side == 0)) return true;
      if (!step()) return false;
    }
    return false;
  }

 private:
  static Bits read(const std::uint32_t* imm, const std::array<std::uint8_t, 4>& swizzle) {
    return {imm[swizzle[0]], imm[swizzle[1]], imm[swizzle[2]], imm[swizzle[3]]};
  }

  bool value(const Src& src, Bits& bits) {
    Bits whole;
    if (!value_of(src.value, whole, 0)) return false;
    bits = read(whole.data(), src.swizzle);
    return true;
  }

  bool value_of(ValueId id, Bits& bits, unsigned depth) {
    if (const auto known = known_.find(id); known != known_.end()) {
      bits = known->second;
      return true;
    }
    const Inst* inst = graph_.def(id);
    if (!inst || depth > 16) return false;
    if (inst->kind == Kind::kConst) {
      std::copy(std::begin(inst->imm), std::end(inst->imm), bits.begin());
      return true;
    }
    if (inst->kind != Kind::kAlu) return false;
    Bits operand[3] = {};
    for (std::uint32_t i = 0; i < inst->count; ++i) {
      Bits whole;
      if (!value_of(graph_.source(*inst, i).value, whole, depth + 1)) return false;
      operand[i] = read(whole.data(), graph_.source(*inst, i).swizzle);
    }
    for (unsigned c = 0; c < inst->components; ++c) {
      const std::uint32_t in[3] = {operand[0][c], operand[1][c], operand[2][c]};
      if (!evaluate(inst->op, in, bits[c])) return false;
    }
    return true;
  }

  /// Parameters of the next iteration; those that are not constant are forgotten.
  bool step() {
    const Inst& loop = graph_.insts[loop_];
    const ir::Node& node = *graph_.nodes[loop.node];
    const Inst& end = graph_.insts[graph_.blocks[loop.child[0]].tail];
    std::unordered_map<ValueId, Bits> passed = known_;
    Bits bits;
    for (std::size_t i = 0; i < node.continue_params.size() && i < end.count; ++i)
      if (value(graph_.source(end, static_cast<std::uint32_t>(i)), bits)) passed[node.continue_params[i]] = bits;
    known_ = std::move(passed);
    const Inst& next = graph_.insts[graph_.blocks[loop.child[1]].tail];
    std::unordered_map<ValueId, Bits> params;
    for (std::size_t i = 0; i < node.params.size() && i < next.count; ++i)
      if (value(graph_.source(next, static_cast<std::uint32_t>(i)), bits)) params[node.params[i]] = bits;
    known_ = std::move(params);
    return !known_.empty();
  }

  const Graph& graph_;
  InstId loop_;
  std::unordered_map<ValueId, Bits> known_;
};

/// The reference finds a count only for counters that step by adding a constant and are compared with a constant.
bool counts_by_adding(const Graph& graph, InstId loop, Src condition) {
  const Inst* compare = graph.def(condition.value);
  while (compare && compare->kind == Kind::kAlu && compare->op == Op::kNotB)
    compare = graph.def(graph.source(*compare, 0).value);
  if (!compare || compare->kind != Kind::kAlu || compare->count != 2) return false;
  const bool left = graph.constant(graph.source(*compare, 0).value) != nullptr;
  const bool right = graph.constant(graph.source(*compare, 1).value) != nullptr;
  if (left == right) return false;
  const ValueId counter = graph.source(*compare, left ? 1 : 0).value;
  const Inst& inst = graph.insts[loop];
  const ir::Node& node = *graph.nodes[inst.node];
  const auto at = std::find(node.params.begin(), node.params.end(), counter);
  if (at == node.params.end()) return false;
  const Inst& next = graph.insts[graph.blocks[inst.child[1]].tail];
  const Inst* step = graph.def(graph.source(next, static_cast<std::uint32_t>(at - node.params.begin())).value);
  if (!step || step->kind != Kind::kAlu || (step->op != Op::kIAdd && step->op != Op::kFAdd)) return false;
  return graph.constant(graph.source(*step, 0).value) || graph.constant(graph.source(*step, 1).value);
}

bool find_shape(const Graph& graph, InstId loop, Shape& shape) {
  const Inst& inst = graph.insts[loop];
  const InstId body_end = graph.blocks[inst.child[0]].tail, next = graph.blocks[inst.child[1]].tail;
  if (body_end == kNone || next == kNone || !is_jump(graph.insts[next], Op::kYield)) return false;
  const Inst& end = graph.insts[body_end];
  if (!is_jump(end, Op::kYield) && !is_jump(end, Op::kContinue)) return false;
  const unsigned allowed = is_jump(end, Op::kContinue) ? 2 : 1;
  if (count_exits(graph, inst.child[0]) != allowed || count_exits(graph, inst.child[1]) != 0) return false;
  for (InstId id = graph.blocks[inst.child[0]].head; id != kNone; id = graph.insts[id].next) {
    const Inst& candidate = graph.insts[id];
    if (candidate.kind != Kind::kIf) continue;
    for (const unsigned side : {0u, 1u}) {
      const InstId last = graph.blocks[candidate.child[side]].tail;
      const InstId other = graph.blocks[candidate.child[1 - side]].tail;
      if (last == kNone || other == kNone || !is_jump(graph.insts[last], Op::kBreak)) continue;
      if (!is_jump(graph.insts[other], Op::kYield)) return false;
      shape.exit = id;
      shape.break_side = side;
      return counts_by_adding(graph, loop, graph.source(candidate, 0)) && Counter(graph, loop).count(shape);
    }
  }
  return false;
}

/// Copies instructions in front of the loop, operands translated.
class Copier {
 public:
  Copier(Graph& graph, InstId position) : graph_(graph), position_(position) {}

  Src translated(const Src& src) const {
    const auto entry = map_.find(src.value);
    if (entry == map_.end()) return src;
    Src result{entry->second.value, {}};
    for (unsigned c = 0; c < 4; ++c) result.swizzle[c] = entry->second.swizzle[src.swizzle[c]];
    return result;
  }

  void bind(ValueId value, const Src& src) { map_[value] = src; }

  /// Copies [first, last) in front of the position.
  void copy(InstId first, InstId last) {
    for (InstId id = first; id != last; id = graph_.insts[id].next) graph_.insert_before(position_, copy_inst(id));
  }

  /// Copies a branch without its final jump; returns the translated operands of the jump.
  std::vector<Src> copy_branch(BlockId block) {
    const InstId last = graph_.blocks[block].tail;
    copy(graph_.blocks[block].head, last);
    return operands_of(last);
  }

  std::vector<Src> operands_of(InstId id) const {
    std::vector<Src> result;
    for (std::uint32_t i = 0; i < graph_.insts[id].count; ++i)
      result.push_back(translated(graph_.source(graph_.insts[id], i)));
    return result;
  }

 private:
  ValueId fresh(ValueId value) {
    const Value like = graph_.values[value];
    const auto id = static_cast<ValueId>(graph_.values.size());
    graph_.values.push_back({kNone, kNone, kNone, 0, like.components, like.boolean});
    map_[value] = {id, {0, 1, 2, 3}};
    return id;
  }

  InstId copy_inst(InstId id) {
    const Inst original = graph_.insts[id];
    const auto made = static_cast<InstId>(graph_.insts.size());
    graph_.insts.push_back(original);
    const std::vector<Src> operands = operands_of(id);
    graph_.insts[made].count = 0;
    graph_.insts[made].next = graph_.insts[made].previous = kNone;
    graph_.set_operands(made, operands);
    if (original.result != ir::kNoValue) {
      const ValueId result = fresh(original.result);
      graph_.insts[made].result = result;
      graph_.values[result].def = made;
    }
    if (original.node != kNone) copy_node(made, original.node);
    for (const unsigned side : {0u, 1u}) {
      if (original.child[side] == kNone) continue;
      const BlockId block = copy_block(original.child[side], made);
      graph_.insts[made].child[side] = block;
    }
    return made;
  }

  void copy_node(InstId made, std::uint32_t from) {
    auto node = std::make_unique<ir::Node>();
    const ir::Node& original = *graph_.nodes[from];
    node->kind = original.kind;
    node->instr = original.instr;
    const auto renew = [&](const std::vector<ValueId>& values, std::vector<ValueId>& copies) {
      for (const ValueId value : values) {
        copies.push_back(fresh(value));
        graph_.values[copies.back()].def = made;
      }
    };
    renew(original.params, node->params);
    renew(original.continue_params, node->continue_params);
    renew(original.results, node->results);
    graph_.insts[made].node = static_cast<std::uint32_t>(graph_.nodes.size());
    graph_.nodes.push_back(std::move(node));
  }

  BlockId copy_block(BlockId from, InstId owner) {
    const auto block = static_cast<BlockId>(graph_.blocks.size());
    graph_.blocks.push_back({kNone, kNone, owner});
    for (InstId id = graph_.blocks[from].head; id != kNone; id = graph_.insts[id].next) {
      const InstId made = copy_inst(id);
      graph_.append(block, made);
    }
    return block;
  }

  Graph& graph_;
  InstId position_;
  std::unordered_map<ValueId, Src> map_;
};

/// A value equal to `src` with the components of `like`.
ValueId as_value(Graph& graph, InstId position, const Src& src, ValueId like) {
  const Value shape = graph.values[like];
  bool whole = graph.values[src.value].components == shape.components;
  for (unsigned c = 0; c < shape.components; ++c) whole &= src.swizzle[c] == c;
  if (whole) return src.value;
  const InstId move =
      graph.create(Kind::kAlu, shape.boolean ? Op::kMovB : Op::kMov, shape.components, shape.boolean, 1);
  graph.set_source(move, 0, src);
  graph.insert_before(position, move);
  return graph.insts[move].result;
}

void unroll(Graph& graph, InstId loop, const Shape& shape) {
  const BlockId body = graph.insts[loop].child[0], continuing = graph.insts[loop].child[1];
  const BlockId leave = graph.insts[shape.exit].child[shape.break_side];
  const BlockId stay = graph.insts[shape.exit].child[1 - shape.break_side];
  const std::vector<ValueId> params = graph.nodes[graph.insts[loop].node]->params;
  const std::vector<ValueId> continue_params = graph.nodes[graph.insts[loop].node]->continue_params;
  const std::vector<ValueId> exit_results = graph.nodes[graph.insts[shape.exit].node]->results;
  const std::vector<ValueId> results = graph.nodes[graph.insts[loop].node]->results;
  Copier copier(graph, loop);
  const auto bind_all = [&](const std::vector<ValueId>& values, const std::vector<Src>& sources) {
    for (std::size_t i = 0; i < values.size() && i < sources.size(); ++i) copier.bind(values[i], sources[i]);
  };
  bind_all(params, copier.operands_of(loop));
  for (unsigned iteration = 0; iteration < shape.iterations; ++iteration) {
    copier.copy(graph.blocks[body].head, shape.exit);
    bind_all(exit_results, copier.copy_branch(stay));
    const InstId end = graph.blocks[body].tail;
    copier.copy(graph.insts[shape.exit].next, end);
    bind_all(continue_params, copier.operands_of(end));
    bind_all(params, copier.copy_branch(continuing));
  }
  copier.copy(graph.blocks[body].head, shape.exit);
  const std::vector<Src> values = copier.copy_branch(leave);
  for (std::size_t i = 0; i < results.size(); ++i)
    graph.replace_uses(results[i], as_value(graph, loop, values[i], results[i]));
  graph.remove(loop);
}

/// Innermost loops first; a loop around one that was unrolled waits for the next round, as in the reference.
bool unroll_in(Graph& graph, BlockId block) {
  bool changed = false;
  for (InstId id = graph.blocks[block].head; id != kNone;) {
    const InstId next = graph.insts[id].next;
    const BlockId child[2] = {graph.insts[id].child[0], graph.insts[id].child[1]};
    bool inside = false;
    for (const BlockId side : child)
      if (side != kNone) inside |= unroll_in(graph, side);
    changed |= inside;
    Shape shape;
    if (!inside && graph.insts[id].kind == Kind::kLoop && find_shape(graph, id, shape)) {
      Cost cost;
      add_cost(graph, child[0], cost);
      add_cost(graph, child[1], cost);
      const bool nested_ok = !cost.has_loop || shape.iterations == 1;
      if (nested_ok && shape.iterations <= kMaxIterations && cost.instructions * shape.iterations <= kMaxCost) {
        unroll(graph, id, shape);
        changed = true;
      }
    }
    id = next;
  }
  return changed;
}

}  // namespace

bool unroll_loops(Graph& graph) { return unroll_in(graph, graph.root); }

}  // namespace vitrine::spirv::rewriting

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
  InstId second = kNone;    ///< another If that may leave the loop, after `exit`
  unsigned second_side = 0;
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

/// The branch of `candidate` that breaks while the other goes on; 2: none.
unsigned break_side_of(const Graph& graph, const Inst& candidate) {
  if (candidate.kind != Kind::kIf) return 2;
  for (const unsigned side : {0u, 1u}) {
    const InstId last = graph.blocks[candidate.child[side]].tail;
    const InstId other = graph.blocks[candidate.child[1 - side]].tail;
    if (last == kNone || other == kNone) continue;
    if (is_jump(graph.insts[last], Op::kBreak) && is_jump(graph.insts[other], Op::kYield)) return side;
  }
  return 2;
}

/// The first exit must be the one that counts; a second one is allowed.
bool find_shape(const Graph& graph, InstId loop, Shape& shape) {
  const Inst& inst = graph.insts[loop];
  const InstId body_end = graph.blocks[inst.child[0]].tail, next = graph.blocks[inst.child[1]].tail;
  if (body_end == kNone || next == kNone || !is_jump(graph.insts[next], Op::kYield)) return false;
  const Inst& end = graph.insts[body_end];
  if (!is_jump(end, Op::kYield) && !is_jump(end, Op::kContinue)) return false;
  unsigned exits = count_exits(graph, inst.child[0]) - (is_jump(end, Op::kContinue) ? 1 : 0);
  if (exits == 0 || exits > 2 || count_exits(graph, inst.child[1]) != 0) return false;
  for (InstId id = graph.blocks[inst.child[0]].head; id != kNone; id = graph.insts[id].next) {
    const unsigned side = break_side_of(graph, graph.insts[id]);
    if (side == 2) continue;
    --exits;
    if (shape.exit == kNone) {
      shape.exit = id;
      shape.break_side = side;
    } else {
      shape.second = id;
      shape.second_side = side;
    }
  }
  if (exits != 0 || shape.exit == kNone) return false;
  const Src condition = graph.source(graph.insts[shape.exit], 0);
  return counts_by_adding(graph, loop, condition) && Counter(graph, loop).count(shape);
}

/// Copies instructions to the end of a block, operands translated.
class Copier {
 public:
  explicit Copier(Graph& graph) : graph_(graph) {}

  Src translated(const Src& src) const {
    const auto entry = map_.find(src.value);
    if (entry == map_.end()) return src;
    Src result{entry->second.value, {}};
    for (unsigned c = 0; c < 4; ++c) result.swizzle[c] = entry->second.swizzle[src.swizzle[c]];
    return result;
  }

  void bind(ValueId value, const Src& src) { map_[value] = src; }

  /// Copies [first, last).
  void copy(InstId first, InstId last, BlockId to) {
    for (InstId id = first; id != last; id = graph_.insts[id].next) {
      const InstId made = copy_inst(id);
      graph_.append(to, made);
    }
  }

  /// Copies a branch without its final jump; returns the translated operands of the jump.
  std::vector<Src> copy_branch(BlockId block, BlockId to) {
    const InstId last = graph_.blocks[block].tail;
    copy(graph_.blocks[block].head, last, to);
    return operands_of(last);
  }

  void bind_all(const std::vector<ValueId>& values, const std::vector<Src>& sources) {
    for (std::size_t i = 0; i < values.size() && i < sources.size(); ++i) bind(values[i], sources[i]);
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

/// Builds the iterations of one loop.
class Unroller {
 public:
  Unroller(Graph& graph, InstId loop, const Shape& shape) : graph_(graph), loop_(loop), shape_(shape), copier_(graph) {}

  void run() {
    copier_.bind_all(node(loop_).params, copier_.operands_of(loop_));
    const BlockId made = new_block(kNone);
    const std::vector<Src> values = iterate(0, made);
    graph_.splice_before(loop_, made);
    const std::vector<ValueId> results = node(loop_).results;
    for (std::size_t i = 0; i < results.size(); ++i)
      graph_.replace_uses(results[i], as_value(graph_, loop_, values[i], results[i]));
    graph_.remove(loop_);
  }

 private:
  const ir::Node& node(InstId id) const { return *graph_.nodes[graph_.insts[id].node]; }
  BlockId child(InstId id, unsigned side) const { return graph_.insts[id].child[side]; }

  BlockId new_block(InstId owner) {
    graph_.blocks.push_back({kNone, kNone, owner});
    return static_cast<BlockId>(graph_.blocks.size() - 1);
  }

  /// Appends iteration `number` and all that follow; returns the values the loop ends with.
  std::vector<Src> iterate(unsigned number, BlockId to) {
    const BlockId body = child(loop_, 0);
    copier_.copy(graph_.blocks[body].head, shape_.exit, to);
    if (number == shape_.iterations) return copier_.copy_branch(child(shape_.exit, shape_.break_side), to);
    stay(shape_.exit, shape_.break_side, to);
    if (shape_.second == kNone) {
      finish(graph_.insts[shape_.exit].next, to);
      return iterate(number + 1, to);
    }
    copier_.copy(graph_.insts[shape_.exit].next, shape_.second, to);
    return branch(number, to);
  }

  /// The other way past a conditional exit.
  void stay(InstId exit, unsigned break_side, BlockId to) {
    const std::vector<ValueId> results = node(exit).results;
    copier_.bind_all(results, copier_.copy_branch(child(exit, 1 - break_side), to));
  }

  /// From `first` to the end of the body, then the continue construct.
  void finish(InstId first, BlockId to) {
    const InstId end = graph_.blocks[child(loop_, 0)].tail;
    copier_.copy(first, end, to);
    copier_.bind_all(node(loop_).continue_params, copier_.operands_of(end));
    const std::vector<Src> next = copier_.copy_branch(child(loop_, 1), to);
    copier_.bind_all(node(loop_).params, next);
  }

  /// An If on the second exit, with the rest of the loop in the branch that stays.
  std::vector<Src> branch(unsigned number, BlockId to) {
    const auto made = graph_.create(Kind::kIf, Op::kMov, 0, false, 1);
    graph_.set_source(made, 0, copier_.operands_of(shape_.second)[0]);
    auto description = std::make_unique<ir::Node>();
    description->kind = ir::Node::Kind::kIf;
    std::vector<Src> results;
    for (const ValueId like : node(loop_).results) {
      const Value shape = graph_.values[like];
      const auto value = static_cast<ValueId>(graph_.values.size());
      graph_.values.push_back({made, kNone, kNone, 0, shape.components, shape.boolean});
      description->results.push_back(value);
      results.push_back({value, {0, 1, 2, 3}});
    }
    graph_.insts[made].origin = graph_.insts[shape_.second].origin;
    graph_.insts[made].node = static_cast<std::uint32_t>(graph_.nodes.size());
    graph_.nodes.push_back(std::move(description));
    graph_.append(to, made);
    const BlockId leave = new_block(made), go_on = new_block(made);
    graph_.insts[made].child[shape_.second_side] = leave;
    graph_.insts[made].child[1 - shape_.second_side] = go_on;
    yield(leave, copier_.copy_branch(child(shape_.second, shape_.second_side), leave));
    stay(shape_.second, shape_.second_side, go_on);
    finish(graph_.insts[shape_.second].next, go_on);
    yield(go_on, iterate(number + 1, go_on));
    return results;
  }

  void yield(BlockId block, const std::vector<Src>& values) {
    const auto made = graph_.create(Kind::kIntrinsic, Op::kYield, 0, false, 0);
    graph_.insts[made].node = static_cast<std::uint32_t>(graph_.nodes.size());
    graph_.nodes.push_back(std::make_unique<ir::Node>());
    graph_.set_operands(made, values);
    graph_.append(block, made);
  }

  Graph& graph_;
  InstId loop_;
  Shape shape_;
  Copier copier_;
};

bool try_unroll(Graph& graph, InstId loop) {
  Shape shape;
  if (!find_shape(graph, loop, shape)) return false;
  Cost cost;
  for (const BlockId side : graph.insts[loop].child) add_cost(graph, side, cost);
  if (cost.has_loop && shape.iterations != 1) return false;
  if (shape.iterations > kMaxIterations || cost.instructions * shape.iterations > kMaxCost) return false;
  Unroller(graph, loop, shape).run();
  return true;
}

/// Innermost first; after one loop of a list the others wait for the next round, as does a loop around an unrolled one.
bool unroll_in(Graph& graph, BlockId block) {
  bool changed = false;
  for (InstId id = graph.blocks[block].head; id != kNone; id = graph.insts[id].next) {
    bool inside = false;
    for (const BlockId side : {graph.insts[id].child[0], graph.insts[id].child[1]})
      if (side != kNone) inside |= unroll_in(graph, side);
    changed |= inside;
    if (graph.insts[id].kind == Kind::kLoop && !inside && try_unroll(graph, id)) return true;
  }
  return changed;
}

}  // namespace

bool unroll_loops(Graph& graph) { return unroll_in(graph, graph.root); }

}  // namespace vitrine::spirv::rewriting

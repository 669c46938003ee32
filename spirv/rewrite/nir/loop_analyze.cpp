// How often loops run, by their exits that constants decide, and what an iteration costs, counted as the reference
// does.
#include "spirv/rewrite/nir/loop_analyze.h"

#include <algorithm>
#include <array>
#include <unordered_map>

#include "base/float_mode.h"
#include "spirv/rewrite/graph/tree.h"
#include "spirv/rewrite/nir/constant_expressions.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

using Bits = std::array<std::uint32_t, 4>;

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
  bool count(Exit& exit) {
    const base::ScopedFloatMode mode(base::Denormals::kHonour);
    for (exit.trips = 0; exit.trips <= kMaxIterations; ++exit.trips) {
      Bits condition;
      if (!value(graph_.source(graph_.insts[exit.branch], 0), condition)) return false;
      if ((condition[0] != 0) == (exit.break_side == 0)) return true;
      if (!step()) return false;
    }
    return false;
  }

 private:
  static Bits read(const std::uint32_t* imm, const std::array<std::uint8_t, 4>& swizzle) {
    return {imm[swizzle[0]], imm[swizzle[1]], imm[swizzle[2]], imm[swizzle[3]]};
  }

  bool value(Src src, Bits& bits) {
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

/// What a loop parameter becomes for the next iteration.
Src next_value(const Graph& graph, InstId loop, std::size_t param) {
  const BlockId body = graph.insts[loop].child[0], continuing = graph.insts[loop].child[1];
  const Src next = graph.source(graph.insts[graph.blocks[continuing].tail], static_cast<std::uint32_t>(param));
  return substituted(next, graph.nodes[graph.insts[loop].node]->continue_params,
                     operands_of(graph, graph.blocks[body].tail));
}

/// Counters: parameters that start at a constant and step by adding one at the top level of the body, and those sums.
bool is_counter(const Graph& graph, InstId loop, ValueId value) {
  const ir::Node& node = *graph.nodes[graph.insts[loop].node];
  for (std::size_t i = 0; i < node.params.size(); ++i) {
    const ValueId param = node.params[i];
    if (!graph.constant(graph.source(graph.insts[loop], static_cast<std::uint32_t>(i)).value)) continue;
    const Src next = next_value(graph, loop, i);
    if (value != param && value != next.value) continue;
    const Inst* step = graph.def(next.value);
    if (!step || step->kind != Kind::kAlu || (step->op != Op::kIAdd && step->op != Op::kFAdd)) continue;
    if (graph.blocks[step->block].owner != loop) continue;
    for (const std::uint32_t side : {0u, 1u})
      if (graph.source(*step, side).value == param && graph.constant(graph.source(*step, 1 - side).value)) return true;
  }
  return false;
}

/// A comparison of a counter with a constant, perhaps negated.
bool is_counted(const Graph& graph, InstId loop, Src condition) {
  const Inst* compare = graph.def(condition.value);
  if (compare && compare->kind == Kind::kAlu && compare->op == Op::kNotB)
    compare = graph.def(graph.source(*compare, 0).value);
  if (!compare || compare->kind != Kind::kAlu || compare->count != 2 || compare->boolean == false) return false;
  const bool left = graph.constant(graph.source(*compare, 0).value) != nullptr;
  const bool right = graph.constant(graph.source(*compare, 1).value) != nullptr;
  return left != right && is_counter(graph, loop, graph.source(*compare, left ? 1 : 0).value);
}

/// False: the loop has an exit of another kind.
bool find_exits(const Graph& graph, InstId loop, LoopInfo& info) {
  for (InstId id = graph.blocks[graph.insts[loop].child[0]].head; id != kNone; id = graph.insts[id].next) {
    const Inst& inst = graph.insts[id];
    if (inst.kind != Kind::kIf) continue;
    const unsigned exits[2] = {count_exits(graph, inst.child[0]), count_exits(graph, inst.child[1])};
    if (exits[0] + exits[1] == 0) continue;
    const unsigned side = ends_in(graph, inst.child[0], Op::kBreak) ? 0 : 1;
    if (exits[side] != 1 || exits[1 - side] != 0 || !ends_in(graph, inst.child[side], Op::kBreak) ||
        !ends_in(graph, inst.child[1 - side], Op::kYield))
      return false;
    const Inst* condition = graph.def(graph.source(inst, 0).value);
    if (!condition || condition->kind == Kind::kIf || condition->kind == Kind::kLoop) return false;
    info.exits.push_back({id, side});
  }
  return true;
}

class Pricer {
 public:
  Pricer(const Graph& graph, InstId loop, unsigned trips) : graph_(graph), loop_(loop), trips_(trips) {}

  LoopCost price() {
    for (const BlockId side : graph_.insts[loop_].child) add(side);
    return cost_;
  }

 private:
  /// The reference computes addresses of buffers later.
  bool is_address(const Inst& inst, unsigned depth) const {
    if (inst.kind != Kind::kAlu || inst.count != 2 || graph_.values[inst.result].uses == 0) return false;
    const bool scale = (inst.op == Op::kShl || inst.op == Op::kIMul) && graph_.constant(graph_.source(inst, 1).value);
    if (!scale && inst.op != Op::kIAdd) return false;
    for (Slot use = graph_.values[inst.result].first_use; use != kNone; use = graph_.sources[use].next) {
      const Inst& user = graph_.insts[graph_.sources[use].user];
      const std::uint32_t operand = use - user.first;
      if (user.kind == Kind::kAlu && depth < 3 && is_address(user, depth + 1)) continue;
      if (user.kind != Kind::kIntrinsic) return false;
      switch (user.op) {
        case Op::kLoadStorage:
        case Op::kLoadUniform:
        case Op::kStoreStorage:
        case Op::kAtomicStorage:
          if (operand == 1) continue;
          return false;
        case Op::kLoadPush:
        case Op::kLoadShared:
        case Op::kStoreShared:
        case Op::kAtomicShared:
          if (operand == 0) continue;
          return false;
        default:
          return false;
      }
    }
    return true;
  }

  bool compares_counter(const Inst& select) const {
    const Inst* compare = graph_.def(graph_.source(select, 0).value);
    if (!compare || compare->kind != Kind::kAlu || compare->count != 2 || !compare->boolean) return false;
    for (const std::uint32_t side : {0u, 1u})
      if (graph_.constant(graph_.source(*compare, side).value) &&
          is_counter(graph_, loop_, graph_.source(*compare, 1 - side).value))
        return true;
    return false;
  }

  unsigned price_of(const Inst& inst) const {
    if (inst.kind == Kind::kVec) return 1;
    if (inst.kind == Kind::kIntrinsic) return leaves_loop(inst) || is_jump(inst, Op::kYield) ? 0 : 1;
    if (inst.op == Op::kFAddInSum) return 0;
    if (inst.kind == Kind::kSized) return 1;
    if (inst.kind != Kind::kAlu || is_address(inst, 0)) return 0;
    if ((inst.op == Op::kSelect || inst.op == Op::kSelectB) && compares_counter(inst))
      return graph_.values[graph_.source(inst, 0).value].uses == 1 ? ~0u : 0;  // the comparison goes as well
    return 1;
  }

  bool walks_array(const Inst& inst) const {
    if (inst.kind != Kind::kIntrinsic || (inst.op != Op::kLoadArray && inst.op != Op::kStoreArray)) return false;
    std::uint32_t elements = graph_.function.arrays[graph_.nodes[inst.node]->instr.data[0]].elements;
    ValueId index = graph_.source(inst, 0).value;
    if (const Inst* scaled = graph_.def(index); scaled && scaled->kind == Kind::kAlu && scaled->op == Op::kIMul) {
      const Inst* by = graph_.constant(graph_.source(*scaled, 1).value);
      if (!by || by->imm[0] == 0) return false;
      elements /= by->imm[0];
      index = graph_.source(*scaled, 0).value;
    }
    return elements == trips_ && is_counter(graph_, loop_, index);
  }

  void add(BlockId block) {
    for (InstId id = graph_.blocks[block].head; id != kNone; id = graph_.insts[id].next) {
      const Inst& inst = graph_.insts[id];
      cost_.instructions += price_of(inst);
      cost_.has_loop |= inst.kind == Kind::kLoop;
      cost_.wanted |= walks_array(inst);
      for (const BlockId child : inst.child)
        if (child != kNone) add(child);
    }
  }

  const Graph& graph_;
  InstId loop_;
  unsigned trips_;
  LoopCost cost_;
};

}  // namespace

bool analyze_loop(const Graph& graph, InstId loop, LoopInfo& info) {
  const Inst& inst = graph.insts[loop];
  const BlockId body = inst.child[0], continuing = inst.child[1];
  info.once = ends_in(graph, body, Op::kBreak);
  if (!info.once && (!ends_in(graph, body, Op::kYield) || !ends_in(graph, continuing, Op::kYield))) return false;
  if ((!info.once && count_exits(graph, continuing) != 0) || !find_exits(graph, loop, info)) return false;
  if (info.once) {
    info.exact = false;
    return info.exits.size() <= 3;
  }
  for (std::size_t i = 0; i < info.exits.size(); ++i) {
    Exit& exit = info.exits[i];
    exit.counted =
        is_counted(graph, loop, graph.source(graph.insts[exit.branch], 0)) && Counter(graph, loop).count(exit);
    info.exact &= exit.counted;
    if (exit.counted && (info.limiting == SIZE_MAX || exit.trips < info.trips())) info.limiting = i;
  }
  return info.limiting != SIZE_MAX && (info.exact || info.exits.size() == 2);
}

LoopCost cost_of_loop(const Graph& graph, InstId loop, unsigned trips) { return Pricer(graph, loop, trips).price(); }

}  // namespace vitrine::spirv::rewriting

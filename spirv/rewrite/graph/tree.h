// Small questions and changes about the tree of instructions that several steps share.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "spirv/rewrite/graph/graph.h"

namespace vitrine::spirv::rewriting {

/// All components, in their order.
inline constexpr std::array<std::uint8_t, 4> kWhole{0, 1, 2, 3};

inline bool is_jump(const Inst& inst, Op op) { return inst.kind == Inst::Kind::kIntrinsic && inst.op == op; }
inline bool leaves_loop(const Inst& inst) { return is_jump(inst, Op::kBreak) || is_jump(inst, Op::kContinue); }
inline bool ends_in(const Graph& graph, BlockId block, Op op) {
  const InstId last = graph.blocks[block].tail;
  return last != kNone && is_jump(graph.insts[last], op);
}

inline bool is_move(const Inst& inst) {
  return inst.kind == Inst::Kind::kAlu && (inst.op == Op::kMov || inst.op == Op::kMovB);
}

/// Two operands read the same components of one value, as many as `like` has.
bool same_value(const Graph& graph, Src a, Src b, ValueId like);

/// The block holds nothing but a Yield.
bool is_empty(const Graph& graph, BlockId block);

/// The instruction, or one in it, leaves a loop or ends the invocation.
bool jumps(const Graph& graph, InstId id);
bool contains_jump(const Graph& graph, BlockId block);

/// The innermost loop that `block` is in; kNone: none.
InstId loop_around(const Graph& graph, BlockId block);

/// The uses of a value, in their order: for walks that change them.
std::vector<Slot> uses_of(const Graph& graph, ValueId value);

/// A Continue of the loop around `block`.
bool contains_continue(const Graph& graph, BlockId block);

/// Defined by the loop or inside of it.
bool is_inside(const Graph& graph, ValueId value, InstId loop);

std::vector<Src> operands_of(const Graph& graph, InstId id);
void append_operands(Graph& graph, InstId id, const std::vector<Src>& more);

/// What an If, a Loop or an intrinsic has besides its operands.
inline ir::Node& node_of(Graph& graph, InstId id) { return *graph.nodes[graph.insts[id].node]; }

/// A value of the type of `like` that `def` defines.
ValueId new_value(Graph& graph, InstId def, ValueId like);

/// `src`, or the value that stands for it if it is one of `values`.
Src substituted(Src src, const std::vector<ValueId>& values, const std::vector<Src>& by);

/// `src` reads the components of its value in their order, and as many as `like` has.
bool is_whole(const Graph& graph, Src src, ValueId like);

/// A Mov of `src`, of the type of `like`, that is in no block yet.
InstId make_move(Graph& graph, Src src, ValueId like);

/// The same in front of `position`; what reads it.
Src copied(Graph& graph, InstId position, Src src, ValueId like);

/// A value equal to `src` with the components of `like`; a Mov that it may need goes before `position`.
ValueId whole_value(Graph& graph, InstId position, Src src, ValueId like);

/// Component `component` of `src`, of the vector that composes it if there is one.
Src component_of(const Graph& graph, Src src, std::uint8_t component);

/// Uses of the results of an If or Loop become uses of `values`; Movs go in front of it, or behind `after`.
void replace_results(Graph& graph, InstId id, const std::vector<Src>& values, InstId after = kNone);

/// New results of an If, of the types of `like`; what its branches yield for them is the caller's business.
std::vector<Src> add_results(Graph& graph, InstId id, const std::vector<ValueId>& like);

}  // namespace vitrine::spirv::rewriting

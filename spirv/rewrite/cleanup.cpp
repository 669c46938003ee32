// Copy propagation, dead code, scalarisation: the steps that change no value.
#include <array>
#include <vector>

#include "spirv/ir_walk.h"
#include "spirv/rewrite/loops.h"
#include "spirv/rewrite/passes.h"
#include "spirv/rewrite/tree.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

/// Looks through one copy. False: the operand's definition is no copy, or the components read come from several values.
bool look_through(const Graph& graph, Src& src, unsigned read) {
  const Inst* copy = graph.def(src.value);
  if (!copy) return false;
  if (is_move(*copy)) {
    const Src from = graph.source(*copy, 0);
    Src result{from.value, {}};
    for (unsigned i = 0; i < 4; ++i) result.swizzle[i] = from.swizzle[src.swizzle[i < read ? i : 0]];
    src = result;
    return true;
  }
  if (copy->kind != Kind::kVec) return false;
  const Src first = graph.source(*copy, src.swizzle[0]);
  Src result{first.value, {first.swizzle[0], first.swizzle[0], first.swizzle[0], first.swizzle[0]}};
  for (unsigned i = 1; i < read; ++i) {
    const Src component = graph.source(*copy, src.swizzle[i]);
    if (component.value != first.value) return false;
    result.swizzle[i] = component.swizzle[0];
  }
  src = result;
  return true;
}

/// A whole vector that is another value, component by component.
bool look_through_whole(const Graph& graph, Src& src) {
  const Inst* copy = graph.def(src.value);
  if (!copy || !is_whole(graph, src, src.value)) return false;
  const bool move = is_move(*copy);
  if (!move && copy->kind != Kind::kVec) return false;
  const ValueId from = graph.source(*copy, 0).value;
  if (graph.values[from].components != copy->components) return false;
  for (unsigned i = 0; i < copy->components; ++i) {
    const Src component = graph.source(*copy, move ? 0 : i);
    if (component.value != from || component.swizzle[move ? i : 0] != i) return false;
  }
  src.value = from;
  return true;
}

/// A Mov that gathers components of several values of `vec` gives its uses to a Vec.
bool move_to_vec(Graph& graph, InstId id, const Inst& vec) {
  const Inst inst = graph.insts[id];
  if (!is_move(inst) || inst.components < 2) return false;
  const Src from = graph.source(inst, 0);
  std::array<Src, 4> parts;
  for (unsigned i = 0; i < inst.components; ++i) parts[i] = graph.source(vec, from.swizzle[i]);
  const InstId made = graph.create(Kind::kVec, Op::kVec, inst.components, inst.boolean, inst.components);
  graph.insts[made].origin = inst.origin;
  for (unsigned i = 0; i < inst.components; ++i) graph.set_source(made, i, parts[i]);
  graph.insert_after(id, made);
  graph.replace_uses(inst.result, graph.insts[made].result);
  return true;
}

/// A sum that is still closed reads a vector of two products as a whole: of several values, it stays one.
bool reads_whole(const Graph& graph, const Inst& user, const Inst& copy) {
  if (!user.opaque || user.opens != Opens::kVisitedAfterRound || copy.kind != Kind::kVec) return false;
  for (std::uint32_t i = 1; i < copy.count; ++i)
    if (graph.source(copy, i).value != graph.source(copy, 0).value) return true;
  return false;
}

/// The uses of a copy become uses of what it copies, in their order, which is the order in which the rules wake users.
/// A join reads whole values, a component of one by a copy, unless `into_joins`.
bool propagate(Graph& graph, InstId id, bool into_joins) {
  if (!is_move(graph.insts[id]) && graph.insts[id].kind != Kind::kVec) return false;
  std::vector<Slot> uses;
  for (Slot slot = graph.values[graph.insts[id].result].first_use; slot != kNone; slot = graph.sources[slot].next)
    uses.push_back(slot);
  bool changed = false;
  for (const Slot slot : uses) {
    const InstId user = graph.sources[slot].user;
    if (reads_whole(graph, graph.insts[user], graph.insts[id])) continue;
    const std::uint32_t index = slot - graph.insts[user].first;
    Src src = graph.source(graph.insts[user], index);
    unsigned read = components_read(graph, graph.insts[user], index);
    if (read == 0 && into_joins && graph.values[src.value].components == 1) read = 1;
    if (read == 0 ? look_through_whole(graph, src) : look_through(graph, src, read)) {
      graph.set_source(user, index, src);
      changed = true;
    } else if (graph.insts[id].kind == Kind::kVec) {
      changed |= move_to_vec(graph, user, Inst(graph.insts[id]));
    }
  }
  return changed;
}

bool is_effect(const Graph& graph, const Inst& inst) {
  if (inst.op == Op::kYield || inst.op == Op::kBreak || inst.op == Op::kContinue) return true;
  return ir::has_effect(inst.op, inst.op == Op::kImage ? graph.nodes[inst.node]->instr.image.get() : nullptr);
}

bool block_is_pure(const Graph& graph, BlockId block) {
  for (InstId id = graph.blocks[block].head; id != kNone; id = graph.insts[id].next) {
    const Inst& inst = graph.insts[id];
    if (inst.op == Op::kYield && inst.kind == Kind::kIntrinsic) continue;
    if (!is_pure(graph, inst)) return false;
  }
  return true;
}

/// Drops operand `index` of an instruction.
void drop_operand(Graph& graph, InstId id, std::uint32_t index) {
  std::vector<Src> kept;
  for (std::uint32_t i = 0; i < graph.insts[id].count; ++i)
    if (i != index) kept.push_back(graph.source(graph.insts[id], i));
  graph.set_operands(id, kept);
}

/// Drops results of an If that nobody uses, with what its branches yield for them.
bool drop_unused_results(Graph& graph, InstId id) {
  bool changed = false;
  auto& results = graph.nodes[graph.insts[id].node]->results;
  for (std::size_t i = results.size(); i-- > 0;) {
    if (graph.values[results[i]].uses != 0) continue;
    for (const BlockId child : graph.insts[id].child) {
      const InstId last = graph.blocks[child].tail;
      if (last != kNone && graph.insts[last].kind == Kind::kIntrinsic && graph.insts[last].op == Op::kYield)
        drop_operand(graph, last, static_cast<std::uint32_t>(i));
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
      graph.remove(id);
      changed = true;
    }
    id = before;
  }
  return changed;
}

/// One scalar instruction per component, and a Vec of them.
void split(Graph& graph, InstId id) {
  const Inst inst = graph.insts[id];
  const InstId vec = graph.create(Kind::kVec, Op::kVec, inst.components, inst.boolean, inst.components);
  graph.insts[vec].origin = inst.origin;
  for (unsigned c = 0; c < inst.components; ++c) {
    const InstId part = graph.create(inst.kind, inst.op, 1, inst.boolean, inst.count);
    graph.insts[part].width = inst.width;
    graph.insts[part].exact = inst.exact;
    graph.insts[part].opaque = inst.opaque;
    graph.insts[part].opens = inst.opens;
    graph.insts[part].origin = inst.origin;
    for (std::uint32_t i = 0; i < inst.count; ++i) {
      const Src src = graph.source(inst, i);
      const std::uint8_t s = src.swizzle[c];
      graph.set_source(part, i, {src.value, {s, s, s, s}});
    }
    graph.insert_before(id, part);
    graph.set_source(vec, c, {graph.insts[part].result, {0, 0, 0, 0}});
  }
  graph.insert_before(id, vec);
  graph.replace_uses(inst.result, graph.insts[vec].result);
  graph.remove(id);
}

}  // namespace

unsigned components_read(const Graph& graph, const Inst& user, std::uint32_t index) {
  switch (user.kind) {
    case Kind::kAlu:
    case Kind::kSized:
      return operand_components(user, index);
    case Kind::kVec:
    case Kind::kIf:
      return 1;
    case Kind::kIntrinsic:
      break;
    default:
      return 0;
  }
  switch (user.op) {
    case Op::kStoreOutput:
    case Op::kLoadPush:
    case Op::kLoadUniform:
    case Op::kLoadStorage:
    case Op::kArrayLength:
    case Op::kLoadShared:
    case Op::kLoadArray:
    case Op::kStoreArray:
    case Op::kAtomicStorage:
    case Op::kAtomicShared:
    case Op::kLoadGlobal:
    case Op::kAtomicGlobal:
    case Op::kReadFirst:
    case Op::kBallot:
    case Op::kShuffle:
    case Op::kReduce:
      return 1;
    case Op::kStoreStorage:
      return index < 2 ? 1 : 0;
    case Op::kStoreShared:
      return index < 1 ? 1 : 0;
    case Op::kStoreGlobal:
      return index < 3 ? 1 : 0;
    case Op::kYield:
    case Op::kBreak:
    case Op::kContinue:
      return 0;
    default:
      return graph.values[graph.source(user, index).value].components == 1 ? 1 : 0;
  }
}

bool is_pure(const Graph& graph, const Inst& inst) {
  switch (inst.kind) {
    case Kind::kAlu:
    case Kind::kSized:
    case Kind::kConst:
    case Kind::kVec:
      return true;
    case Kind::kIf:
      return block_is_pure(graph, inst.child[0]) && block_is_pure(graph, inst.child[1]);
    case Kind::kLoop:
      return false;
    case Kind::kIntrinsic:
      return !is_effect(graph, inst);
  }
  return false;
}

bool propagate_copies(Graph& graph, bool into_joins) {
  bool changed = false;
  auto visit = [&](InstId id) { changed |= propagate(graph, id, into_joins); };
  for_each_inst(graph, graph.root, visit);
  return changed;
}

bool remove_dead(Graph& graph) {
  const bool changed = drop_dead_joins(graph);
  return remove_dead_in(graph, graph.root) || changed;
}

bool scalarize(Graph& graph) {
  bool changed = false;
  auto visit = [&](InstId id) {
    const Inst& inst = graph.insts[id];
    if (!computes(inst) || inst.width == 64 || inst.components < 2) return;
    split(graph, id);
    changed = true;
  };
  for_each_inst(graph, graph.root, visit);
  return changed;
}

}  // namespace vitrine::spirv::rewriting

// An instruction equal to one that dominates it is replaced by that one. A scope's entries are forgotten when its block
// ends, but for those that all ways behind it pass: of the side of an If that stays when the other leaves, and of a
// loop what lies in front of every Break.
#include "spirv/rewrite/graph/merge_equal.h"

#include <algorithm>
#include <utility>

#include "spirv/rewrite/graph/tree.h"
#include "spirv/rewrite/nir/algebraic/pattern.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

bool is_uniform_load(const Inst& inst) {
  return inst.kind == Kind::kIntrinsic && (inst.op == Op::kLoadInput || inst.op == Op::kLoadUniform);
}

bool is_push_load(const Inst& inst) { return inst.kind == Kind::kIntrinsic && inst.op == Op::kLoadPush; }

bool is_invocation_constant(const Inst& inst) {
  if (inst.kind != Kind::kIntrinsic) return false;
  switch (inst.op) {
    case Op::kWorkgroupId:
    case Op::kNumWorkgroups:
    case Op::kLocalInvocationId:
    case Op::kGlobalInvocationId:
    case Op::kLocalInvocationIndex:
    case Op::kSubgroupInvocation:
    case Op::kSubgroupId:
      return true;
    default:
      return false;
  }
}

/// Arithmetic on 64-bit numbers and conversions of them: without effects, as all of wide_ops.def.
bool is_wide_operation(const Inst& inst) { return inst.kind == Kind::kIntrinsic && ir::is_wide(inst.op); }

/// The two operands may be swapped (the reference compares them that way too).
bool may_swap(const Inst& inst) { return computes(inst) && inst.count == 2 && is_commutative(inst.op); }

class Merger {
 public:
  Merger(Graph& graph, const Merging& what) : graph_(graph), what_(what), table_(256, kNone) {}

  bool run() {
    visit(graph_.root);
    return changed_;
  }

 private:
  bool makes_double(const Inst& inst) const {
    if (inst.kind != Kind::kVec || inst.components != 2 || graph_.values[inst.result].uses == 0) return false;
    const Inst& user = graph_.insts[graph_.sources[graph_.values[inst.result].first_use].user];
    return computes(user) && user.width == 64;
  }

  bool candidate(const Inst& inst) const {
    if (what_.only_doubles) return makes_double(inst);
    if (is_push_load(inst)) return what_.push;
    return is_uniform_load(inst) || computes(inst) || inst.kind == Kind::kConst || inst.kind == Kind::kVec ||
           is_invocation_constant(inst) || is_wide_operation(inst);
  }

  unsigned components_of_operand(const Inst& inst, std::uint32_t index) const {
    return computes(inst) ? operand_components(inst, index) : 1;
  }

  const Inst* literal_of(const Inst& inst, std::uint32_t index, Src src) const {
    return what_.by_value && components_of_operand(inst, index) == 1 ? graph_.constant(src.value) : nullptr;
  }

  std::uint32_t hash_operand(const Inst& inst, std::uint32_t index) const {
    const Src src = graph_.source(inst, index);
    if (const Inst* literal = literal_of(inst, index, src)) return literal->imm[src.swizzle[0]] * 0xC2B2AE3Du;
    std::uint32_t h = src.value * 0x9E3779B1u;
    for (unsigned c = 0; c < components_of_operand(inst, index); ++c) h = (h ^ src.swizzle[c]) * 0x85EBCA6Bu;
    return h;
  }

  std::uint32_t hash(const Inst& inst) const {
    std::uint32_t h = static_cast<std::uint32_t>(inst.op) * 0xC2B2AE35u + inst.components;
    const bool swap = may_swap(inst);
    for (std::uint32_t i = 0; i < inst.count; ++i) {
      const std::uint32_t operand = hash_operand(inst, i);
      h = swap ? h + operand : (h ^ operand) * 0x27D4EB2Fu + (h >> 15);
    }
    if (inst.kind == Kind::kConst)
      for (unsigned c = 0; c < inst.components; ++c) h = (h ^ inst.imm[c]) * 0x165667B1u;
    if (inst.node != kNone)
      for (const std::uint32_t data : graph_.nodes[inst.node]->instr.data) h = (h ^ data) * 0x165667B1u;
    return h ^ (h >> 16);
  }

  bool same_operand(const Inst& a, std::uint32_t i, const Inst& b, std::uint32_t j) const {
    const Src x = graph_.source(a, i);
    const Src y = graph_.source(b, j);
    const Inst *literal = literal_of(a, i, x), *other = literal_of(b, j, y);
    if (literal && other) return literal->imm[x.swizzle[0]] == other->imm[y.swizzle[0]];
    if (x.value != y.value) return false;
    for (unsigned c = 0; c < components_of_operand(a, i); ++c)
      if (x.swizzle[c] != y.swizzle[c]) return false;
    return true;
  }

  bool same_details(const Inst& a, const Inst& b) const {
    if (a.kind == Kind::kConst)
      for (unsigned c = 0; c < a.components; ++c)
        if (a.imm[c] != b.imm[c]) return false;
    if (a.node == kNone) return true;
    const ir::Instr& x = graph_.nodes[a.node]->instr;
    const ir::Instr& y = graph_.nodes[b.node]->instr;
    for (int i = 0; i < 4; ++i)
      if (x.data[i] != y.data[i] || x.imm[static_cast<std::size_t>(i)] != y.imm[static_cast<std::size_t>(i)])
        return false;
    return true;
  }

  bool equal(const Inst& a, const Inst& b) const {
    if (a.op != b.op || a.kind != b.kind || a.components != b.components || a.width != b.width ||
        a.boolean != b.boolean || a.count != b.count || a.opaque != b.opaque || !same_details(a, b))
      return false;
    bool same = true;
    for (std::uint32_t i = 0; i < a.count && same; ++i) same = same_operand(a, i, b, i);
    if (same || !may_swap(a)) return same;
    return same_operand(a, 0, b, 1) && same_operand(a, 1, b, 0);
  }

  void merge(InstId id) {
    const std::uint32_t mask = static_cast<std::uint32_t>(table_.size()) - 1;
    std::uint32_t at = hash(graph_.insts[id]) & mask;
    for (; table_[at] != kNone; at = (at + 1) & mask) {
      Inst& kept = graph_.insts[table_[at]];
      if (kept.removed || !equal(kept, graph_.insts[id])) continue;
      kept.exact |= graph_.insts[id].exact;
      graph_.replace_uses(graph_.insts[id].result, kept.result);
      graph_.remove(id);
      changed_ = true;
      return;
    }
    enter_at(at, id);
  }

  void enter_at(std::uint32_t at, InstId id) {
    table_[at] = id;
    entered_.push_back(at);
    if (entered_.size() * 2 > table_.size()) grow();
  }

  /// Rebuilds a larger table with the entries in their order.
  void grow() {
    std::vector<InstId> ids;
    for (const std::uint32_t at : entered_) ids.push_back(table_[at]);
    table_.assign(table_.size() * 4, kNone);
    const std::uint32_t mask = static_cast<std::uint32_t>(table_.size()) - 1;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      std::uint32_t at = hash(graph_.insts[ids[i]]) & mask;
      while (table_[at] != kNone) at = (at + 1) & mask;
      table_[at] = ids[i];
      entered_[i] = at;
    }
  }

  /// Enters without looking for an equal one.
  void enter(InstId id) {
    const std::uint32_t mask = static_cast<std::uint32_t>(table_.size()) - 1;
    std::uint32_t at = hash(graph_.insts[id]) & mask;
    while (table_[at] != kNone) at = (at + 1) & mask;
    enter_at(at, id);
  }

  std::vector<InstId> entered_since(std::size_t scope) const {
    std::vector<InstId> ids;
    for (std::size_t i = scope; i < entered_.size(); ++i) ids.push_back(table_[entered_[i]]);
    return ids;
  }

  /// Last in, first out: probing chains of what remains stay whole.
  void forget_since(std::size_t scope) {
    while (entered_.size() > scope) {
      table_[entered_.back()] = kNone;
      entered_.pop_back();
    }
  }

  /// Visits the block in a scope of its own; what the scope holds at its end.
  std::vector<InstId> visit_scope(BlockId block) {
    const std::size_t scope = entered_.size();
    visit(block);
    const std::vector<InstId> held = entered_since(scope);
    forget_since(scope);
    return held;
  }

  void visit_if(const Inst& inst) {
    const BlockId child[2] = {inst.child[0], inst.child[1]};
    std::vector<InstId> held[2];
    for (const unsigned side : {0u, 1u}) held[side] = visit_scope(child[side]);
    const bool stays[2] = {ends_in(graph_, child[0], Op::kYield), ends_in(graph_, child[1], Op::kYield)};
    if (!what_.by_value && stays[0] != stays[1])
      for (const InstId id : held[stays[0] ? 0 : 1]) enter(id);
  }

  void visit_loop(const Inst& inst) {
    const BlockId child[2] = {inst.child[0], inst.child[1]};
    Ways around = std::exchange(ways_, Ways{entered_.size(), false, {}});
    for (const BlockId block : child) visit_scope(block);
    const Ways out = std::exchange(ways_, std::move(around));
    if (!what_.by_value)
      for (const InstId id : out.common) enter(id);
  }

  /// Keeps of what lies in front of every Break what lies in front of this one, too.
  void leave() {
    const std::vector<InstId> held = entered_since(ways_.scope);
    if (!std::exchange(ways_.any, true)) {
      ways_.common = held;
    } else {
      std::erase_if(ways_.common, [&](InstId id) { return std::find(held.begin(), held.end(), id) == held.end(); });
    }
  }

  void visit(BlockId block) {
    for (InstId id = graph_.blocks[block].head; id != kNone;) {
      const Inst& inst = graph_.insts[id];
      const InstId next = inst.next;
      if (inst.kind == Kind::kIf) {
        visit_if(inst);
      } else if (inst.kind == Kind::kLoop) {
        visit_loop(inst);
      } else if (is_jump(inst, Op::kBreak)) {
        leave();
      } else if (candidate(inst)) {
        merge(id);
      }
      id = next;
    }
  }

  /// The ways out of the innermost loop.
  struct Ways {
    std::size_t scope = 0;  ///< entries in front of the loop
    bool any = false;
    std::vector<InstId> common;  ///< in front of every Break so far
  };

  Graph& graph_;
  const Merging what_;
  std::vector<InstId> table_;           ///< open addressing, a power of two
  std::vector<std::uint32_t> entered_;  ///< slots in use, in order of entry
  Ways ways_;
  bool changed_ = false;
};

}  // namespace

bool merge_equal(Graph& graph, const Merging& what) { return Merger(graph, what).run(); }

}  // namespace vitrine::spirv::rewriting

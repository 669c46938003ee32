// Elements of local arrays whose value is known where they are read, because a store or load of the same element, at a
// constant index or at the same dynamic one, comes before; and stores of what an element already holds. What stays of
// an array that a loop walked through once the loop is unrolled (lavapipe-optimizer.md 3.3).
#include <algorithm>
#include <compare>
#include <cstdint>
#include <map>
#include <vector>

#include "spirv/rewrite/graph/build.h"
#include "spirv/rewrite/nir/passes.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

/// Elements remembered at a time: bounds the work for absurd modules.
constexpr std::size_t kMostKnown = 1024;

bool is_access(const Inst& inst, Op op) { return inst.kind == Kind::kIntrinsic && inst.op == op; }

class Forwarder {
 public:
  explicit Forwarder(Graph& graph) : graph_(graph) {}

  bool run() {
    visit(graph_.root);
    return changed_;
  }

 private:
  /// Of an array. At a constant index: `index` is kNone, `added` the whole index; else the index plus `added`.
  struct Element {
    std::uint32_t array;
    ValueId index;
    std::uint32_t swizzle;
    std::uint64_t added;
    auto operator<=>(const Element&) const = default;
  };
  using Known = std::map<Element, Src>;

  const ir::Instr& node(const Inst& inst) const { return graph_.nodes[inst.node]->instr; }

  Element element_of(const Inst& inst) const {
    const Src index = graph_.source(inst, 0);
    const ir::Instr& access = node(inst);
    const Inst* constant = graph_.constant(index.value);
    if (constant == nullptr) return {access.data[0], index.value, index.swizzle[0], access.data[1]};
    return {access.data[0], kNone, 0, std::uint64_t{constant->imm[index.swizzle[0]]} + access.data[1]};
  }

  /// Forgets what a store to `stored` may change: not the elements whose index differs from it by a constant.
  void forget(const Element& stored) {
    const Element first = {stored.array, stored.index, stored.swizzle, 0};
    const Element last = {stored.array, stored.index, stored.swizzle, UINT64_MAX};
    known_.erase(known_.lower_bound({stored.array, 0, 0, 0}), known_.lower_bound(first));
    known_.erase(known_.upper_bound(last), known_.lower_bound({stored.array + 1, 0, 0, 0}));
    known_.erase(stored);
  }

  void remember(const Element& element, const Src& value) {
    if (known_.size() < kMostKnown) known_.emplace(element, value);
  }

  void store(InstId id) {
    const Inst& inst = graph_.insts[id];
    const Element element = element_of(inst);
    const Src value = graph_.source(inst, 1);
    const auto entry = known_.find(element);
    if (entry != known_.end() && entry->second.value == value.value && entry->second.swizzle[0] == value.swizzle[0]) {
      changed_ = true;
      return graph_.remove(id);
    }
    forget(element);
    remember(element, value);
  }

  void load(InstId id) {
    const Inst inst = graph_.insts[id];
    const Element element = element_of(inst);
    const auto entry = known_.find(element);
    if (entry == known_.end()) return remember(element, Src{inst.result, {}});
    const Src value = entry->second;
    changed_ = true;
    if (graph_.values[value.value].components == 1) {
      graph_.replace_uses(inst.result, value.value);
    } else {
      graph_.replace_uses(inst.result, Builder::behind(graph_, id).vec({value}).value);
    }
    graph_.remove(id);
  }

  /// Forgets what the block stores.
  void forget_stored(BlockId block) {
    if (block == kNone) return;
    for (InstId id = graph_.blocks[block].head; id != kNone; id = graph_.insts[id].next) {
      const Inst& inst = graph_.insts[id];
      if (is_access(inst, Op::kStoreArray)) forget(element_of(inst));
      for (const BlockId child : inst.child) forget_stored(child);
    }
  }

  void visit_children(InstId id) {
    const BlockId child[2] = {graph_.insts[id].child[0], graph_.insts[id].child[1]};
    const auto forget_children = [&] {
      forget_stored(child[0]);
      forget_stored(child[1]);
    };
    if (graph_.insts[id].kind == Kind::kLoop) forget_children();
    const Known before = known_;
    for (const BlockId block : child) {
      if (block == kNone) continue;
      visit(block);
      known_ = before;
    }
    forget_children();
  }

  void visit(BlockId block) {
    for (InstId id = graph_.blocks[block].head; id != kNone;) {
      const Inst& inst = graph_.insts[id];
      const InstId next = inst.next;
      if (is_access(inst, Op::kStoreArray)) {
        store(id);
      } else if (is_access(inst, Op::kLoadArray)) {
        load(id);
      } else if (inst.child[0] != kNone) {
        visit_children(id);
      }
      id = next;
    }
  }

  Graph& graph_;
  Known known_;
  bool changed_ = false;
};

/// Takes away the stores to arrays that nothing reads.
bool remove_unread(Graph& graph) {
  std::vector<bool> read(graph.function.arrays.size(), false);
  std::vector<InstId> stores;
  const auto array_of = [&](InstId id) { return graph.nodes[graph.insts[id].node]->instr.data[0]; };
  auto look = [&](InstId id) {
    if (is_access(graph.insts[id], Op::kLoadArray)) read[array_of(id)] = true;
    if (is_access(graph.insts[id], Op::kStoreArray)) stores.push_back(id);
  };
  for_each_inst(graph, graph.root, look);
  std::erase_if(stores, [&](InstId id) { return read[array_of(id)]; });
  for (const InstId id : stores) graph.remove(id);
  return !stores.empty();
}

}  // namespace

bool opt_copy_prop_arrays(Graph& graph) {
  if (graph.function.arrays.empty()) return false;
  const bool forwarded = Forwarder(graph).run();
  return remove_unread(graph) || forwarded;
}

}  // namespace vitrine::spirv::rewriting

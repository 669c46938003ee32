// Elements of local arrays whose value is known where they are read, because a store or load of the same element comes
// before: what stays of an array that a loop walked through once the loop is unrolled (lavapipe-shader-math.md 3.2
// step 3, copy propagation and splitting of variables).
#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "spirv/rewrite/passes.h"

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
  using Element = std::pair<std::uint32_t, std::uint32_t>;  ///< array, index
  using Known = std::map<Element, Src>;
  /// The last store to an array, at an index that is not constant.
  struct Stored {
    Src index, value;
    std::uint32_t added = 0;
  };
  using Latest = std::map<std::uint32_t, Stored>;

  const ir::Instr& node(const Inst& inst) const { return graph_.nodes[inst.node]->instr; }

  /// False: its index is not constant, or behind the array.
  bool element_of(const Inst& inst, Element& element) const {
    const Src index = graph_.source(inst, 0);
    const Inst* constant = graph_.constant(index.value);
    if (constant == nullptr) return false;
    const std::uint64_t number = std::uint64_t{constant->imm[index.swizzle[0]]} + node(inst).data[1];
    element = {node(inst).data[0], static_cast<std::uint32_t>(number)};
    return number < graph_.function.arrays[element.first].elements;
  }

  void forget(std::uint32_t array) {
    known_.erase(known_.lower_bound({array, 0}), known_.lower_bound({array + 1, 0}));
    latest_.erase(array);
  }

  static bool same(const Src& a, const Src& b) { return a.value == b.value && a.swizzle[0] == b.swizzle[0]; }

  /// Writes once more what the last store to the array wrote there.
  bool repeats(const Inst& inst) const {
    const auto entry = latest_.find(node(inst).data[0]);
    return entry != latest_.end() && entry->second.added == node(inst).data[1] &&
           same(entry->second.index, graph_.source(inst, 0)) && same(entry->second.value, graph_.source(inst, 1));
  }

  void store(InstId id) {
    const Inst& inst = graph_.insts[id];
    Element element;
    if (!element_of(inst, element)) {
      if (repeats(inst)) {
        changed_ = true;
        return graph_.remove(id);
      }
      const std::uint32_t array = node(inst).data[0];
      forget(array);
      if (latest_.size() < kMostKnown)
        latest_[array] = {graph_.source(inst, 0), graph_.source(inst, 1), node(inst).data[1]};
      return;
    }
    known_.erase(element);
    latest_.erase(element.first);
    if (known_.size() < kMostKnown) known_.emplace(element, graph_.source(inst, 1));
  }

  void load(InstId id) {
    const Inst inst = graph_.insts[id];
    Element element;
    if (!element_of(inst, element)) return;
    const auto entry = known_.find(element);
    if (entry == known_.end()) {
      if (known_.size() < kMostKnown) known_.emplace(element, Src{inst.result, {}});
      return;
    }
    const Src value = entry->second;
    changed_ = true;
    if (graph_.values[value.value].components == 1) {
      graph_.replace_uses(inst.result, value.value);
    } else {
      const InstId made = graph_.create(Kind::kVec, Op::kVec, 1, false, 1);
      graph_.insts[made].origin = inst.origin;
      graph_.replace_uses(inst.result, graph_.insts[made].result);
      graph_.set_source(made, 0, value);
      graph_.insert_after(id, made);
    }
    graph_.remove(id);
  }

  /// Forgets what the block stores.
  void forget_stored(BlockId block) {
    if (block == kNone) return;
    for (InstId id = graph_.blocks[block].head; id != kNone; id = graph_.insts[id].next) {
      const Inst& inst = graph_.insts[id];
      Element element;
      if (is_access(inst, Op::kStoreArray)) {
        if (element_of(inst, element)) {
          known_.erase(element);
          latest_.erase(element.first);
        } else {
          forget(node(inst).data[0]);
        }
      }
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
    const Latest latest_before = latest_;
    for (const BlockId block : child) {
      if (block == kNone) continue;
      visit(block);
      known_ = before;
      latest_ = latest_before;
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
  Latest latest_;
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

bool forward_arrays(Graph& graph) {
  if (graph.function.arrays.empty()) return false;
  const bool forwarded = Forwarder(graph).run();
  return remove_unread(graph) || forwarded;
}

}  // namespace vitrine::spirv::rewriting

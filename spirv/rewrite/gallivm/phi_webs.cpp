// See phi_webs.h. Each way into a join copies to a register of the join, and the join's value is a copy of that one;
// then copies whose two sides do not live at the same time become one register, in the order of blocks.
#include "spirv/rewrite/gallivm/phi_webs.h"

#include <algorithm>
#include <numeric>

#include "spirv/rewrite/graph/tree.h"

namespace vitrine::spirv::rewriting {
namespace {

using Kind = Inst::Kind;

/// Values times blocks: what is above costs more than it is worth.
constexpr std::size_t kMaxLiveness = std::size_t{1} << 25;
/// Pairs of definitions to compare, likewise.
constexpr std::size_t kMaxPairs = std::size_t{1} << 24;

class Coalescer {
 public:
  explicit Coalescer(const Graph& graph) : graph_(graph), order_(graph) {}

  PhiWebs run() {
    webs_.web.assign(graph_.values.size(), kNone);
    if (order_.joins.empty()) return std::move(webs_);
    collect();
    if (tracked_.size() * order_.blocks.size() > kMaxLiveness) return std::move(webs_);
    for (const std::uint32_t node : tracked_) find_liveness(node);
    for (const OrderedJoin& join : order_.joins)
      for (const std::uint32_t copy : copies_[&join - order_.joins.data()])
        if (copy != kNone) merge(phi_node(join), copy);
    for (BlockId block = 0; block < order_.blocks.size(); ++block) coalesce(block);
    if (pairs_ <= kMaxPairs) publish();
    return std::move(webs_);
  }

 private:
  /// A definition: of a value, of a join (behind all values) or of a copy at the end of a way into one.
  struct Node {
    std::uint32_t block = 0, position = 0;
    std::uint32_t last = 0;  ///< joins: where their value takes it over
    ValueId value = ir::kNoValue;
    std::vector<bool> live_out;  ///< values: per block
  };
  struct Copy {
    std::uint32_t from, to;
  };

  std::uint32_t node_of_value(ValueId value) {
    std::uint32_t& node = node_of_[value];
    if (node != kNone) return node;
    node = add({order_.block[value], order_.definition[value], 0, value, {}});
    tracked_.push_back(node);
    return node;
  }
  std::uint32_t add(Node node) {
    nodes_.push_back(std::move(node));
    members_.push_back({static_cast<std::uint32_t>(nodes_.size() - 1)});
    set_.push_back(static_cast<std::uint32_t>(nodes_.size() - 1));
    return set_.back();
  }
  std::uint32_t phi_node(const OrderedJoin& join) const { return phi_[&join - order_.joins.data()]; }

  void collect() {
    node_of_.assign(graph_.values.size(), kNone);
    at_start_.resize(order_.blocks.size());
    at_end_.resize(order_.blocks.size());
    copies_.resize(order_.joins.size());
    for (std::size_t j = 0; j < order_.joins.size(); ++j) {
      const OrderedJoin& join = order_.joins[j];
      phi_.push_back(add({join.block, join.position, join.copy_position, ir::kNoValue, {}}));
      at_start_[join.block].push_back({phi_.back(), node_of_value(join.join.value)});
      for (const Join::Way& way : join.join.ways) copies_[j].push_back(copy_at(way, join.join.value));
    }
  }

  /// The copy at the end of one way in; kNone where it brings no value.
  std::uint32_t copy_at(const Join::Way& way, ValueId like) {
    const Src src = graph_.source(graph_.insts[way.end], way.operand);
    const Inst* def = graph_.def(src.value);
    if (def && def->kind == Kind::kIntrinsic && def->op == Op::kUndef) return kNone;
    const std::uint32_t block = order_.user_block[way.end];
    const std::uint32_t copy = add({block, order_.user_position[way.end], 0, ir::kNoValue, {}});
    if (def && is_literal(*def)) return copy;
    if (is_whole(graph_, src, like)) at_end_[block].push_back({node_of_value(src.value), copy});
    return copy;
  }

  bool is_literal(const Inst& inst) const {
    if (inst.kind == Kind::kConst) return true;
    if (inst.kind != Kind::kVec) return false;
    for (std::uint32_t i = 0; i < inst.count; ++i)
      if (!graph_.constant(graph_.source(inst, i).value)) return false;
    return true;
  }

  // ---- lives

  void find_liveness(std::uint32_t id) {
    Node& node = nodes_[id];
    node.live_out.assign(order_.blocks.size(), false);
    std::vector<std::uint32_t> live_in;
    for (Slot slot = graph_.values[node.value].first_use; slot != kNone; slot = graph_.sources[slot].next) {
      const std::uint32_t block = order_.user_block[graph_.sources[slot].user];
      if (block != kNone && block != node.block) live_in.push_back(block);
    }
    while (!live_in.empty()) {
      const std::uint32_t block = live_in.back();
      live_in.pop_back();
      for (const std::uint32_t before : order_.blocks[block].predecessors) {
        if (node.live_out[before]) continue;
        node.live_out[before] = true;
        if (before != node.block) live_in.push_back(before);
      }
    }
  }

  bool is_read_behind(ValueId value, std::uint32_t block, std::uint32_t position) const {
    for (Slot slot = graph_.values[value].first_use; slot != kNone; slot = graph_.sources[slot].next) {
      const InstId user = graph_.sources[slot].user;
      if (order_.user_block[user] == block && order_.user_position[user] > position) return true;
    }
    return false;
  }

  bool interfere(const Node& a, const Node& b) const {
    if (a.position == b.position) return true;
    if (a.position > b.position) return interfere(b, a);
    if (a.value != ir::kNoValue) return a.live_out[b.block] || is_read_behind(a.value, b.block, b.position);
    return a.block == b.block && b.position < a.last;
  }

  bool sets_interfere(std::uint32_t a, std::uint32_t b) {
    pairs_ += members_[a].size() * members_[b].size();
    if (pairs_ > kMaxPairs) return true;
    for (const std::uint32_t x : members_[a])
      for (const std::uint32_t y : members_[b])
        if (interfere(nodes_[x], nodes_[y])) return true;
    return false;
  }

  // ---- merging

  void merge(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t to = set_[a], from = set_[b];
    if (to == from) return;
    for (const std::uint32_t node : members_[from]) set_[node] = to;
    members_[to].insert(members_[to].end(), members_[from].begin(), members_[from].end());
    members_[from].clear();
  }

  void coalesce(std::uint32_t block) {
    for (const std::vector<Copy>* copies : {&at_start_[block], &at_end_[block]})
      for (const Copy& copy : *copies)
        if (set_[copy.from] != set_[copy.to] && !sets_interfere(set_[copy.from], set_[copy.to]))
          merge(copy.from, copy.to);
  }

  void publish() {
    for (std::size_t j = 0; j < order_.joins.size(); ++j) {
      webs_.joins.push_back(order_.joins[j].join);
      webs_.joins.back().web = set_[phi_[j]];
    }
    // What a way in copies is in a register also where it did not merge: in one of its own.
    for (const std::uint32_t node : tracked_) webs_.web[nodes_[node].value] = set_[node];
  }

  const Graph& graph_;
  const ProgramOrder order_;
  std::size_t pairs_ = 0;
  PhiWebs webs_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> node_of_;                ///< per value
  std::vector<std::uint32_t> phi_;                    ///< per join
  std::vector<std::vector<std::uint32_t>> copies_;    ///< per join
  std::vector<std::vector<Copy>> at_start_, at_end_;  ///< per block
  std::vector<std::uint32_t> tracked_;                ///< nodes of values
  std::vector<std::uint32_t> set_;                    ///< per node
  std::vector<std::vector<std::uint32_t>> members_;   ///< per set
};

}  // namespace

PhiWebs phi_webs(const Graph& graph) { return Coalescer(graph).run(); }

}  // namespace vitrine::spirv::rewriting

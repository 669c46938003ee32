// What a shader computes for its observers alone: probes (spirv/probe.h), and the instructions that nothing but probes
// reads. They are kept beside the blocks, each in front of an instruction or at the end of a block, so that no step of
// the rewrites sees them, and their operands count as no uses: whoever looks changes no result. An instruction that
// loses its last use but is read by a probe becomes one of them.
#pragma once

#include <unordered_map>
#include <vector>

#include "spirv/rewrite/graph/data.h"

namespace vitrine::spirv::rewriting {

class Attachments {
 public:
  /// Nobody observes: nothing in here does anything.
  bool empty() const { return in_front_.empty() && at_end_.empty(); }

  /// The instruction `inst` of `graph`, which is in no block, goes behind everything of `block`.
  void append(GraphData& graph, BlockId block, InstId inst);
  /// An instruction is about to be appended to `block`: what was at its end is in front of that one.
  void settle(BlockId block, InstId next);
  /// What is in front of `inst`, which leaves its place, goes to what follows. `keep`: with the instruction itself.
  void leave(GraphData& graph, InstId inst, bool keep);
  /// What is in front of `inst` is gone: it is never reached, or somebody has made copies.
  void drop(GraphData& graph, InstId inst) { forget_list(graph, take(inst)); }
  /// What is in `block` and in blocks inside of it is gone with it.
  void forget(GraphData& graph, BlockId block);
  /// The instructions [first, last) of `block` are about to move in front of `position`, and what is attached between
  /// and behind them with them. `last` kNone: to the block's end.
  void splice(InstId position, InstId first, InstId last, BlockId block);
  /// What is in front of `inst` moves with it.
  std::vector<InstId> take(InstId inst);
  void give(InstId inst, std::vector<InstId> list);
  /// Probes in `block` act only where `condition` is `holds` from now on.
  void guard(GraphData& graph, BlockId block, ir::Src condition, bool holds);
  /// What is in the branches of an If that is about to be removed moves in front of it, guarded.
  void keep_branches(GraphData& graph, InstId branch);
  /// Whether something is attached in the block or in blocks inside of it.
  bool any_in(const GraphData& graph, BlockId block) const;

  const std::vector<InstId>& in_front(InstId inst) const;
  const std::vector<InstId>& at_end(BlockId block) const;

  /// Gives an attached instruction another list of operands.
  void set_operands(GraphData& graph, InstId inst, const std::vector<Src>& src);

  // ---- uses by what is attached
  void link(GraphData& graph, InstId user);
  void unlink(GraphData& graph, InstId user);
  bool reads(ir::ValueId value) const { return uses_.count(value) != 0; }
  void replace_uses(GraphData& graph, ir::ValueId from, ir::ValueId to) {
    replace_uses(graph, from, {to, {0, 1, 2, 3}});
  }
  void replace_uses(GraphData& graph, ir::ValueId from, Src to);

 private:
  void forget_list(GraphData& graph, const std::vector<InstId>& list);
  void guard_list(GraphData& graph, const std::vector<InstId>& list, Src condition, bool holds);

  std::unordered_map<InstId, std::vector<InstId>> in_front_;
  std::unordered_map<BlockId, std::vector<InstId>> at_end_;
  std::unordered_multimap<ir::ValueId, Slot> uses_;
};

}  // namespace vitrine::spirv::rewriting

// Which operand of a product the reference's optimiser negates instead of the product (lavapipe-optimizer.md 7.2).
#pragma once

#include <compare>
#include <unordered_map>
#include <vector>

#include "spirv/rewrite/graph/graph.h"

namespace vitrine::spirv::rewriting {

/// Answers for one walk over a shader (scalar code) in the order of its instructions, which neither moves nor makes
/// instructions with a fixed place. What has been found of earlier values is kept.
class OperandRanks {
 public:
  explicit OperandRanks(Graph& graph) : graph_(graph) {}

  /// True when the product is negated by its only user, and the reference's optimiser negates operand `index` of it
  /// instead. That operand is a selection.
  bool negates_selection(InstId product, std::uint32_t index);

  /// The operands of the instruction that computes `value` have changed.
  void forget(ValueId value) { known_.erase(value); }

 private:
  /// When a value is ready: after the last instruction with a fixed place that it depends on, and so many operations.
  struct Rank {
    std::uint32_t place = 0;
    std::uint32_t operations = 0;
    auto operator<=>(const Rank&) const = default;
  };

  void number_places();
  Rank rank(Src read);
  Rank rank_of_yields(const Inst& branch, ValueId value);

  Graph& graph_;
  std::vector<std::uint32_t> places_;  ///< of each instruction; empty until somebody asks
  std::unordered_map<ValueId, Rank> known_;
  std::uint32_t depth_ = 0;
};

}  // namespace vitrine::spirv::rewriting

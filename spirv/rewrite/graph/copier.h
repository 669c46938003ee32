// Copies of instructions with other operands: iterations of loops.
#pragma once

#include <unordered_map>
#include <vector>

#include "spirv/rewrite/graph/graph.h"

namespace vitrine::spirv::rewriting {

/// Copies instructions to the end of a block, operands translated.
class Copier {
 public:
  explicit Copier(Graph& graph) : graph_(graph) {}

  Src translated(Src src) const;
  void bind(ValueId value, Src src) { map_[value] = src; }
  void bind_all(const std::vector<ValueId>& values, const std::vector<Src>& sources);

  /// Copies [first, last).
  void copy(InstId first, InstId last, BlockId to);
  /// Copies a branch without its final jump; returns the translated operands of the jump.
  std::vector<Src> copy_branch(BlockId block, BlockId to);
  std::vector<Src> operands_of(InstId id) const;
  /// What is attached and reads the originals, which are about to go, reads the last copies instead.
  void hand_over_attached();

 private:
  ValueId fresh(ValueId value);
  InstId copy_inst(InstId id);
  void copy_node(InstId made, std::uint32_t from);
  void copy_attached(const std::vector<InstId>& list, BlockId to);
  BlockId copy_block(BlockId from, InstId owner);

  Graph& graph_;
  std::unordered_map<ValueId, Src> map_;
};

/// What is attached between the branch `branch` and what follows it, `position`, goes to the ends of those sides that
/// come there, with what they yield for the branch's results. Where no side comes there it is gone: it has never run.
void move_attached_into_sides(Graph& graph, InstId branch, InstId position);

}  // namespace vitrine::spirv::rewriting

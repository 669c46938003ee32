// Where in a shader some lanes of a quad may be missing while others run.
#pragma once

#include <vector>

#include "spirv/rewrite/graph/graph.h"

namespace vitrine::spirv::rewriting {

class Divergence {
 public:
  explicit Divergence(const Graph& graph);

  /// Lanes may wait while `block` runs: it is in an If on something that differs between invocations, or in a loop that
  /// they leave or go round separately.
  bool divides(BlockId block) const;

 private:
  void visit_block(BlockId block);
  void visit(InstId id);
  void visit_jump(const Inst& inst);
  void vary(ValueId value);
  void split(InstId owner);
  bool any_operand_varies(const Inst& inst) const;
  bool varies(const Inst& inst) const;
  void join(const std::vector<ValueId>& values, const Inst& way, bool separate);

  const Graph& graph_;
  std::vector<bool> varies_;   ///< per value
  std::vector<bool> divides_;  ///< per instruction: Ifs and Loops
  bool returns_ = false;       ///< some lanes end early
  bool changed_ = false;
};

}  // namespace vitrine::spirv::rewriting

// What can be told about a float value without running the shader: its possible signs, whether it can be NaN, infinite
// or fractional (lavapipe-shader-math.md 4.3, 5.1 min/max; lavapipe-optimizer.md 4.4).
#pragma once

#include <cstdint>
#include <vector>

#include "spirv/rewrite/graph/graph.h"

namespace vitrine::spirv::rewriting {

struct Range {
  /// Union of the possible signs.
  static constexpr std::uint8_t kNegative = 1, kZero = 2, kPositive = 4, kAny = 7;
  std::uint8_t signs = kAny;
  bool integral = false;
  bool number = false;  ///< cannot be NaN
  bool finite = false;  ///< neither infinite nor NaN
};

/// Caches results until clear(); the graph may not change in between.
class RangeAnalysis {
 public:
  /// The reference's code generator knows nothing of what is selected.
  explicit RangeAnalysis(const Graph& graph, bool knows_selections = true)
      : graph_(graph), knows_selections_(knows_selections) {}
  void clear() { ++epoch_; }

  /// Of operand `index` of a float operation, over its components.
  Range of_source(const Inst& inst, std::uint32_t index);

 private:
  struct Entry {
    std::uint32_t epoch[3] = {};  ///< by type
    Range range[3];
  };
  /// `type`: how the operand is read, F I U.
  Range of_typed_source(const Inst& inst, std::uint32_t index, char type);
  Range of_constant(const Inst& user, std::uint32_t index, const Inst& constant, char type) const;
  Range of_sized_constant(const Inst& user, std::uint32_t index, const Inst& constant) const;
  Range of_result(const Inst& inst, char type);
  Range of_float_result(const Inst& inst);
  Range of_dot(const Inst& inst);
  Range of_sum(const Inst& inst);
  Range of_product(const Inst& inst);
  Range of_power(const Inst& inst);
  Range of_extremum(const Inst& inst);
  Range of_rounding(const Inst& inst);
  Range of_converted(const Inst& inst);

  const Graph& graph_;
  bool knows_selections_;
  std::vector<Entry> cache_;
  std::uint32_t epoch_ = 1;
};

}  // namespace vitrine::spirv::rewriting

// Which shapes of the rule table an instruction has, and which rules may therefore apply to it, by sets of bits: the
// rows of Rules once more, so that nobody goes through all of an operation's shapes for each of its instructions.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "spirv/rewrite/nir/algebraic/pattern.h"

namespace vitrine::spirv::rewriting {

/// Bit per shape of its operation that an instruction has.
struct ShapeState {
  std::uint64_t shapes = 0;
  ir::Op op = ir::Op::kMov;  ///< shape_op()
};

/// The shapes of one operation.
class ShapeSet {
 public:
  explicit ShapeSet(const std::vector<Shape>& shapes);

  bool empty() const { return all_ == 0; }
  /// By bit: shapes that operands of these states fit, those of commutative operations in either order.
  /// `constant` bit i: operand i is a constant.
  std::uint64_t fitting(const std::array<ShapeState, kMaxChildren>& operands, unsigned constant) const;

 private:
  /// Shapes that want shape `bit` of operation `op` as operand `child`.
  struct Wanted {
    ir::Op op;
    std::uint8_t child, bit;
    std::uint64_t shapes;
  };

  /// Shapes that accept an operand of this state as their operand `child`.
  std::uint64_t accepting(unsigned child, const ShapeState& operand, bool constant) const;

  std::uint64_t all_ = 0, commutative_ = 0;
  std::array<std::uint64_t, kMaxChildren> any_{}, constant_{};
  std::vector<Wanted> wanted_;  ///< by operation
};

/// The candidates of one operation.
class CandidateSet {
 public:
  explicit CandidateSet(const std::vector<Candidate>& candidates);

  /// Calls f(rule) for those that fit an instruction of these shapes, in table order, until it returns true; whether
  /// it has.
  template <class F>
  bool until(std::uint64_t shapes, const F& f) const {
    for (std::size_t word = 0; word < words_; ++word) {
      std::uint64_t fitting = any_[word];
      for (std::uint64_t rest = shapes; rest != 0; rest &= rest - 1)
        fitting |= by_shape_[static_cast<std::size_t>(std::countr_zero(rest)) * words_ + word];
      for (; fitting != 0; fitting &= fitting - 1)
        if (f(rules_[word * 64 + static_cast<std::size_t>(std::countr_zero(fitting))])) return true;
    }
    return false;
  }

 private:
  std::size_t words_;
  std::vector<std::uint16_t> rules_;
  std::vector<std::uint64_t> any_, by_shape_;  ///< bit per candidate
};

/// The sets of all operations, by their number.
struct ShapeSets {
  explicit ShapeSets(const Rules& rules);

  std::vector<ShapeSet> shapes;
  std::vector<CandidateSet> candidates;
};

/// Of the tables, made at first use.
const ShapeSets& main_shape_sets();
const ShapeSets& late_shape_sets();

}  // namespace vitrine::spirv::rewriting

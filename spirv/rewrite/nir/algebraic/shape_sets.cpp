// See shape_sets.h; lavapipe-shader-math.md 4.1.
#include "spirv/rewrite/nir/algebraic/shape_sets.h"

#include <algorithm>

#include "base/lasting.h"

namespace vitrine::spirv::rewriting {

ShapeSet::ShapeSet(const std::vector<Shape>& shapes) {
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const std::uint64_t bit = std::uint64_t{1} << i;
    all_ |= bit;
    if (shapes[i].commutative) commutative_ |= bit;
    for (unsigned child = 0; child < kMaxChildren; ++child) {
      const std::uint16_t shape = child < shapes[i].children ? shapes[i].child[child] : kAnyShape;
      if (shape == kAnyShape) {
        any_[child] |= bit;
      } else if (shape == kConstShape) {
        constant_[child] |= bit;
      } else {
        wanted_.push_back({static_cast<ir::Op>(shape / kMaxShapes), static_cast<std::uint8_t>(child),
                           static_cast<std::uint8_t>(shape % kMaxShapes), bit});
      }
    }
  }
  std::ranges::stable_sort(wanted_, {}, &Wanted::op);
}

std::uint64_t ShapeSet::accepting(unsigned child, const ShapeState& operand, bool constant) const {
  std::uint64_t result = any_[child] | (constant ? constant_[child] : 0);
  if (operand.shapes == 0) return result;
  for (auto want = std::ranges::lower_bound(wanted_, operand.op, {}, &Wanted::op);
       want != wanted_.end() && want->op == operand.op; ++want)
    if (want->child == child && (operand.shapes >> want->bit & 1) != 0) result |= want->shapes;
  return result;
}

std::uint64_t ShapeSet::fitting(const std::array<ShapeState, kMaxChildren>& operands, unsigned constant) const {
  std::uint64_t others = all_;
  for (unsigned i = 2; i < kMaxChildren; ++i) others &= accepting(i, operands[i], (constant >> i & 1) != 0);
  if (others == 0) return 0;
  const bool first = (constant & 1) != 0, second = (constant & 2) != 0;
  const std::uint64_t straight = accepting(0, operands[0], first) & accepting(1, operands[1], second);
  const std::uint64_t swapped =
      commutative_ != 0 ? commutative_ & accepting(1, operands[0], first) & accepting(0, operands[1], second) : 0;
  return others & (straight | swapped);
}

CandidateSet::CandidateSet(const std::vector<Candidate>& candidates)
    : words_((candidates.size() + 63) / 64), any_(words_), by_shape_(words_ * kMaxShapes) {
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    rules_.push_back(candidates[i].rule);
    const std::uint16_t shape = candidates[i].shape;
    std::uint64_t& word = shape == kAnyShape ? any_[i / 64] : by_shape_[shape % kMaxShapes * words_ + i / 64];
    word |= std::uint64_t{1} << i % 64;
  }
}

ShapeSets::ShapeSets(const Rules& rules) {
  for (const std::vector<Shape>& of_op : rules.shapes) shapes.emplace_back(of_op);
  for (const std::vector<Candidate>& of_op : rules.by_op) candidates.emplace_back(of_op);
}

const ShapeSets& main_shape_sets() {
  static const ShapeSets& sets = base::lasting([] { return ShapeSets(main_rules()); });
  return sets;
}

const ShapeSets& late_shape_sets() {
  static const ShapeSets& sets = base::lasting([] { return ShapeSets(late_rules()); });
  return sets;
}

}  // namespace vitrine::spirv::rewriting

// Shapes and candidates as sets of bits: what going through the rows of the table says.
#include "spirv/rewrite/nir/algebraic/shape_sets.h"

#include <gtest/gtest.h>

#include <random>

namespace vitrine::spirv::rewriting {
namespace {

using Operands = std::array<ShapeState, kMaxChildren>;

bool accepts(std::uint16_t wanted, const ShapeState& state, bool constant) {
  if (wanted == kAnyShape) return true;
  if (wanted == kConstShape) return constant;
  return static_cast<std::size_t>(state.op) == wanted / kMaxShapes && (state.shapes >> wanted % kMaxShapes & 1) != 0;
}

bool fits(const Shape& shape, const Operands& operands, unsigned constant, bool swapped) {
  for (unsigned i = 0; i < shape.children; ++i) {
    const unsigned operand = swapped && i < 2 ? i ^ 1 : i;
    if (!accepts(shape.child[i], operands[operand], (constant >> operand & 1) != 0)) return false;
  }
  return true;
}

std::uint64_t by_rows(const std::vector<Shape>& shapes, const Operands& operands, unsigned constant) {
  std::uint64_t result = 0;
  for (std::size_t i = 0; i < shapes.size(); ++i)
    if (fits(shapes[i], operands, constant, false) ||
        (shapes[i].commutative && fits(shapes[i], operands, constant, true)))
      result |= std::uint64_t{1} << i;
  return result;
}

/// Operands as the shapes of the operation want them, and others.
Operands random_operands(const Rules& rules, const std::vector<Shape>& shapes, std::mt19937_64& random) {
  Operands operands;
  for (ShapeState& operand : operands) {
    const Shape& shape = shapes[random() % shapes.size()];
    const std::uint16_t wanted = shape.child[random() % std::max<unsigned>(shape.children, 1)];
    const std::size_t op = wanted < kConstShape ? wanted / kMaxShapes : random() % std::size(rules.shapes);
    const std::size_t count = rules.shapes[op].size();
    operand = {count == 0 ? 0 : random() & (~std::uint64_t{0} >> (64 - count)), static_cast<ir::Op>(op)};
  }
  return operands;
}

void compare(const Rules& rules, const ShapeSets& sets) {
  std::mt19937_64 random(1);
  std::size_t fitting = 0;
  for (std::size_t op = 0; op < std::size(rules.shapes); ++op) {
    const std::vector<Shape>& shapes = rules.shapes[op];
    EXPECT_EQ(sets.shapes[op].empty(), shapes.empty());
    for (int round = 0; round < 200 && !shapes.empty(); ++round) {
      const Operands operands = random_operands(rules, shapes, random);
      const auto constant = static_cast<unsigned>(random() % 16);
      const std::uint64_t expected = by_rows(shapes, operands, constant);
      ASSERT_EQ(sets.shapes[op].fitting(operands, constant), expected) << ir::op_name(static_cast<ir::Op>(op));
      fitting += expected != 0 ? 1 : 0;
    }
  }
  EXPECT_GT(fitting, 1000u);
}

TEST(ShapeSets, FitWhatTheRowsFit) { compare(main_rules(), main_shape_sets()); }
TEST(ShapeSets, FitWhatTheRowsOfTheLateTableFit) { compare(late_rules(), late_shape_sets()); }

TEST(ShapeSets, CandidatesComeInTableOrder) {
  const Rules& rules = main_rules();
  std::mt19937_64 random(2);
  for (std::size_t op = 0; op < std::size(rules.by_op); ++op) {
    const std::uint64_t shapes = random() & random();
    std::vector<std::uint16_t> expected, found;
    for (const Candidate& candidate : rules.by_op[op])
      if (candidate.shape == kAnyShape || (shapes >> candidate.shape % kMaxShapes & 1) != 0)
        expected.push_back(candidate.rule);
    EXPECT_FALSE(main_shape_sets().candidates[op].until(shapes, [&](std::uint16_t rule) {
      found.push_back(rule);
      return false;
    }));
    EXPECT_EQ(found, expected);
    if (expected.empty()) continue;
    EXPECT_TRUE(
        main_shape_sets().candidates[op].until(shapes, [&](std::uint16_t rule) { return rule == expected[0]; }));
  }
}

}  // namespace
}  // namespace vitrine::spirv::rewriting

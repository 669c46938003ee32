// Bounds and bits of integers hold for what operations compute: random graphs over random inputs.
#include <random>

#include <gtest/gtest.h>

#include "spirv/rewrite/llvm/constant_range.h"
#include "spirv/rewrite/llvm/simplify_icmp.h"
#include "spirv/rewrite/nir/constant_expressions.h"
#include "tests/spirv/ir_builder.h"

namespace vitrine::spirv::test {
namespace {

using rewriting::Graph;
using rewriting::Inst;

constexpr Op kOps[] = {Op::kMov,  Op::kSelect,   Op::kINeg, Op::kIAdd,      Op::kISub,      Op::kIMul, Op::kIDiv,
                       Op::kUDiv, Op::kIRem,     Op::kIMod, Op::kUMod,      Op::kIMin,      Op::kIMax, Op::kUMin,
                       Op::kUMax, Op::kAnd,      Op::kOr,   Op::kXor,       Op::kNot,       Op::kShl,  Op::kIShr,
                       Op::kUShr, Op::kBitCount, Op::kB2I,  Op::kUAddCarry, Op::kUSubBorrow};
constexpr Op kComparisons[] = {Op::kIEq, Op::kINe, Op::kILt, Op::kIGe, Op::kULt, Op::kUGe};
constexpr std::uint32_t kInputs = 3, kOperations = 40;

class RandomGraph {
 public:
  explicit RandomGraph(std::uint32_t seed) : random_(seed) {
    for (std::uint32_t i = 0; i < kInputs; ++i) words_.push_back(builder_.input(i));
    for (std::uint32_t i = 0; i < kOperations; ++i) {
      const ValueId a = word(), b = word();
      conditions_.push_back(builder_.alu(pick(kComparisons), {a, b}));
      const Op op = pick(kOps);
      if (op == Op::kSelect) {
        words_.push_back(builder_.alu(op, {conditions_[below(conditions_.size())], a, b}));
      } else if (op == Op::kB2I) {
        words_.push_back(builder_.alu(op, {conditions_[below(conditions_.size())]}));
      } else if (ir::alu_info(op).sources == 1) {
        words_.push_back(builder_.alu(op, {a}));
      } else {
        words_.push_back(builder_.alu(op, {a, b}));
      }
      // Beside its own operand.
      const ValueId made = words_.back(), operand = below(2) == 0 ? a : b;
      conditions_.push_back(below(2) == 0 ? builder_.alu(pick(kComparisons), {made, operand})
                                          : builder_.alu(pick(kComparisons), {operand, made}));
    }
  }

  ir::Function& function() { return builder_.function; }

 private:
  std::uint32_t below(std::size_t n) { return static_cast<std::uint32_t>(random_() % n); }
  template <std::size_t kCount>
  Op pick(const Op (&ops)[kCount]) {
    return ops[below(kCount)];
  }
  /// A literal, mostly a small one, or what there is already.
  ValueId word() {
    if (below(2) == 0) return words_[below(words_.size())];
    return builder_.constant(below(3) != 0 ? below(40) : static_cast<std::uint32_t>(random_() >> below(32)));
  }

  std::mt19937 random_;
  Builder builder_;
  std::vector<ValueId> words_, conditions_;
};

std::uint32_t decided = 0;

/// Runs the graph's one block over random inputs.
void check(const Graph& graph, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<std::uint32_t> value(graph.values.size());
  std::vector<bool> has_value(graph.values.size());
  for (int round = 0; round < 20; ++round) {
    std::fill(has_value.begin(), has_value.end(), false);
    for (rewriting::InstId id = graph.blocks[graph.root].head; id != rewriting::kNone; id = graph.insts[id].next) {
      const Inst& inst = graph.insts[id];
      if (inst.result == ir::kNoValue) continue;
      if (inst.kind == Inst::Kind::kConst) {
        value[inst.result] = inst.imm[0];
        has_value[inst.result] = true;
      }
      if (inst.kind == Inst::Kind::kIntrinsic) {
        value[inst.result] = static_cast<std::uint32_t>(random() >> random() % 32);
        has_value[inst.result] = true;
      }
      if (inst.kind != Inst::Kind::kAlu) continue;
      std::uint32_t operand[3] = {};
      bool all = true;
      for (std::uint32_t i = 0; i < inst.count; ++i) {
        operand[i] = value[graph.source(inst, i).value];
        all = all && has_value[graph.source(inst, i).value];
      }
      std::uint32_t result = 0;
      if (!all || !rewriting::evaluate(inst.op, operand, result)) continue;
      value[inst.result] = result;
      has_value[inst.result] = true;
      if (inst.boolean) {
        const int known = rewriting::simplify_icmp(graph, inst);
        decided += known >= 0;
        ASSERT_TRUE(known < 0 || static_cast<std::uint32_t>(known) == result) << ir::op_name(inst.op) << ' ' << seed;
        continue;
      }
      const rewriting::ConstantRange range = rewriting::constant_range(graph, {inst.result, {0, 0, 0, 0}});
      const auto number = static_cast<std::int32_t>(result);
      ASSERT_EQ(result & ~range.bits.possible, 0u) << ir::op_name(inst.op) << ' ' << seed;
      ASSERT_EQ(range.bits.certain & ~result, 0u) << ir::op_name(inst.op) << ' ' << seed;
      ASSERT_TRUE(range.least <= result && result <= range.largest) << ir::op_name(inst.op) << ' ' << seed;
      ASSERT_TRUE(range.least_signed <= number && number <= range.largest_signed)
          << ir::op_name(inst.op) << ' ' << seed;
    }
  }
}

TEST(ConstantRange, HoldsForWhatIsComputed) {
  for (std::uint32_t seed = 0; seed < 2000; ++seed) {
    RandomGraph random(seed);
    const Graph graph(random.function());
    check(graph, seed);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(decided, 1000u);
}

}  // namespace
}  // namespace vitrine::spirv::test

// Random programs: nested branches, loops with break and continue, early returns, buffers, local arrays and outputs
// under divergent and uniform control flow, compared with the lane-by-lane oracle.
#include <gtest/gtest.h>

#include <random>

#include "spirv/lower/lower.h"
#include "spirv/program.h"
#include "tests/spirv/evaluator.h"
#include "tests/spirv/ir_builder.h"

namespace vitrine::spirv::test {
namespace {

constexpr std::uint32_t kInputs = 4, kOutputs = 3, kBufferWords = 64, kArrayElements = 5;

/// Writes one random function. Every loop counts in its first parameter, so that it ends.
class Generator {
 public:
  explicit Generator(std::uint32_t seed) : random_(seed) {}

  ir::Function make() {
    b_.function.arrays.push_back({kArrayElements});
    for (std::uint32_t i = 0; i < kInputs; ++i) words_.push_back(b_.input(i));
    for (const std::uint32_t k : {0u, 1u, 2u, 7u, 0xffffffffu}) words_.push_back(b_.constant(k));
    words_.push_back(b_.load(Op::kLoadUniform, 0, 0, b_.constant(8), 1));  // uniform
    bools_.push_back(b_.alu(Op::kULt, {words_[0], words_[1]}));
    statements(3 + pick(8), 0);
    for (std::uint32_t i = 0; i < kOutputs; ++i) b_.output(i, word());
    return std::move(b_.function);
  }

 private:
  std::uint32_t pick(std::uint32_t count) { return random_() % count; }
  ValueId word() {
    return words_[pick(4) ? words_.size() - 1 - pick(std::min<std::uint32_t>(6, words_.size())) : pick(words_.size())];
  }
  /// What control flow passes on: a word or a component of a vector.
  Src argument() {
    if (!vectors_.empty() && pick(4) == 0)
      return src(vectors_[pick(static_cast<std::uint32_t>(vectors_.size()))], static_cast<std::uint8_t>(pick(3)));
    return src(word());
  }
  ValueId boolean() {
    if (pick(3) == 0) return bools_[pick(bools_.size())];
    const Op ops[] = {Op::kULt, Op::kIGe, Op::kIEq, Op::kINe};
    return b_.alu(ops[pick(4)],
                  {b_.alu(Op::kAnd, {word(), b_.constant(3)}), b_.alu(Op::kAnd, {word(), b_.constant(3)})});
  }

  void arithmetic() {
    const Op ops[] = {Op::kIAdd, Op::kISub, Op::kIMul, Op::kXor, Op::kAnd, Op::kOr, Op::kUShr, Op::kIMax};
    switch (pick(10)) {
      case 0:
        words_.push_back(b_.alu(Op::kSelect, {boolean(), word(), word()}));
        break;
      case 1:
        bools_.push_back(b_.alu(pick(2) ? Op::kAndB : Op::kXorB, {boolean(), boolean()}));
        break;
      case 2:
        words_.push_back(b_.alu(Op::kB2I, {boolean()}));
        break;
      case 3:
        words_.push_back(bits());
        break;
      default:
        words_.push_back(b_.alu(ops[pick(8)], {word(), word()}));
    }
  }

  /// What superinstructions of integers are made of.
  ValueId bits() {
    const ValueId a = word(), b = word(), c = word();
    const std::uint32_t n = 1 + pick(31);
    const auto shifted = [&](Op op, std::uint32_t by) { return b_.alu(op, {a, b_.constant(by)}); };
    const auto both = [&](ValueId x, ValueId y) { return b_.alu(Op::kAnd, {x, y}); };
    switch (pick(7)) {
      case 0:
        return b_.alu(pick(2) ? Op::kOr : Op::kXor, {shifted(Op::kShl, n), shifted(Op::kUShr, 32 - n)});
      case 1:
        return b_.alu(Op::kXor, {pick(2) ? a : b, shifted(pick(2) ? Op::kShl : Op::kUShr, n)});
      case 2:
        return b_.alu(Op::kIAdd, {b, shifted(Op::kShl, n)});
      case 3:
        return b_.alu(Op::kIAdd, {b_.alu(pick(2) ? Op::kIMul : Op::kIAdd, {a, b}), c});
      case 4:
        return b_.alu(pick(2) ? Op::kXor : Op::kOr, {both(a, b), both(b_.alu(Op::kNot, {a}), c)});
      case 5:
        return b_.alu(Op::kXor, {b_.alu(Op::kXor, {both(a, b), both(a, c)}), both(b, c)});
      default:
        return b_.alu(Op::kXor, {c, both(a, b_.alu(Op::kXor, {b, c}))});
    }
  }

  void memory() {
    const ValueId index = b_.alu(Op::kAnd, {word(), b_.constant(4 * kBufferWords * 2 - 4)});
    switch (pick(4)) {
      case 0:
        words_.push_back(b_.load(pick(2) ? Op::kLoadUniform : Op::kLoadStorage, 0, 0, index, 1));
        break;
      case 1: {
        const ValueId v = b_.load(Op::kLoadStorage, 0, 0, index, 3, 4);
        words_.push_back(b_.append(Op::kIAdd, 1, false, {src(v, 0), src(v, 2)}).result);
        vectors_.push_back(v);
        break;
      }
      case 2: {
        ir::Instr& load = b_.append(Op::kLoadArray, 1, false, {src(word())});
        words_.push_back(load.result);
        break;
      }
      default: {
        const ValueId element = b_.alu(Op::kAnd, {word(), b_.constant(7)}), value = word();
        b_.append(Op::kStoreArray, 0, false, {src(element), src(value)});
      }
    }
  }

  /// A list in its own scope.
  template <class F>
  void scope(F&& f) {
    const auto words = words_.size(), bools = bools_.size(), vectors = vectors_.size();
    f();
    words_.resize(words);
    bools_.resize(bools);
    vectors_.resize(vectors);
  }

  void statements(std::uint32_t count, int depth) {
    for (std::uint32_t i = 0; i < count; ++i) {
      switch (pick(12)) {
        case 0:
        case 1:
          if (depth < 4) branch(depth);
          break;
        case 2:
          if (depth < 3) loop(depth);
          break;
        case 3:
          memory();
          break;
        case 4:
          if (pick(4) == 0) b_.output(pick(kOutputs), word());
          break;
        default:
          arithmetic();
      }
    }
  }

  void jump_or_yield(std::uint32_t results) {
    const std::uint32_t kind = pick(8);
    if (kind == 0 && pick(3) == 0) return b_.jump(Op::kReturn);
    if (kind == 1 && loop_results_ != ~0u) {
      Src a = argument(), c = argument();
      std::vector<Src> values{a, c};
      values.resize(loop_results_);
      b_.append(Op::kBreak, 0, false, values);
      return;
    }
    if (kind == 2 && loop_continues_ != ~0u) {
      std::vector<Src> values{argument(), argument()};
      values.resize(loop_continues_);
      b_.append(Op::kContinue, 0, false, values);
      return;
    }
    std::vector<Src> values;
    for (std::uint32_t i = 0; i < results; ++i) values.push_back(argument());
    b_.append(Op::kYield, 0, false, values);
  }

  void branch(int depth) {
    const std::uint32_t results = pick(3);
    const ValueId condition = boolean();
    const std::uint32_t sizes[2] = {pick(3) ? pick(25) : 0, pick(2) ? pick(25) : 0};
    int side = 0;
    const auto fill = [&] {
      const int own = side++;
      scope([&] {
        statements(sizes[own], depth + 1);
        jump_or_yield(results);
      });
    };
    const auto values = b_.branch(condition, results, fill, fill);
    // Results exist only if a branch falls through; both jumping is rare and the oracle then never reads them.
    for (const ValueId id : values) words_.push_back(id);
  }

  void loop(int depth) {
    const std::uint32_t outer_results = loop_results_, outer_continues = loop_continues_;
    const std::uint32_t results = pick(3), continues = pick(3);
    const std::vector<ValueId> init{b_.constant(0), word(), word()};
    const ValueId limit = b_.alu(Op::kAnd, {word(), b_.constant(pick(2) ? 7 : 3)});
    const std::uint32_t size = pick(12);
    const auto values = b_.loop(
        init, continues, results,
        [&](const std::vector<ValueId>& p) {
          scope([&] {
            loop_results_ = results;
            loop_continues_ = continues;
            words_.insert(words_.end(), p.begin(), p.end());
            std::vector<Src> leave{argument(), argument()};
            leave.resize(results);
            b_.branch(
                b_.alu(Op::kUGe, {p[0], limit}), 0, [&] { b_.append(Op::kBreak, 0, false, leave); },
                [&] { b_.yield(); });
            statements(size, depth + 1);
            std::vector<Src> next{argument(), argument()};
            next.resize(continues);
            b_.append(Op::kYield, 0, false, next);
          });
        },
        [&](const std::vector<ValueId>& p, const std::vector<ValueId>& c) {
          scope([&] {
            loop_continues_ = ~0u;
            loop_results_ = ~0u;
            words_.insert(words_.end(), p.begin(), p.end());
            words_.insert(words_.end(), c.begin(), c.end());
            for (std::uint32_t i = pick(4); i > 0; --i) arithmetic();
            const ValueId counter = b_.alu(Op::kIAdd, {p[0], b_.constant(1)});
            std::vector<Src> next{src(counter), argument(), src(pick(3) ? word() : p[1])};
            b_.append(Op::kYield, 0, false, next);
          });
        });
    loop_results_ = outer_results;
    loop_continues_ = outer_continues;
    for (const ValueId id : values) words_.push_back(id);
  }

  std::mt19937 random_;
  Builder b_;
  std::vector<ValueId> words_, bools_, vectors_;
  std::uint32_t loop_results_ = ~0u, loop_continues_ = ~0u;
};

void run_case(std::uint32_t seed) {
  ir::Function function = Generator(seed).make();
  std::mt19937 random(seed * 7919 + 1);
  std::vector<std::uint32_t> buffer(kBufferWords);
  for (std::uint32_t& word : buffer) word = random() >> (random() % 32);
  base::WaveRegister inputs[kInputs];
  for (std::uint32_t i = 0; i < kInputs; ++i)
    for (std::uint32_t lane = 0; lane < base::kWaveWidth; ++lane)
      inputs[i].lane[lane] = i == 0 ? lane : i == 1 ? lane / 4 : random() >> (random() % 32);
  base::LaneMask active = random() % 4 ? base::kAllLanes : (std::uint64_t{random()} << 32 | random());
  if (random() % 4 == 0) active = base::first_lanes(random() % 64 + 1);

  std::vector<std::vector<std::uint32_t>> want;
  for (std::uint32_t lane = 0; lane < base::kWaveWidth; ++lane) {
    Evaluator oracle(function);
    for (const auto& input : inputs) oracle.inputs.push_back(input.lane[lane]);
    oracle.buffers = {&buffer};
    oracle.run();
    want.push_back(oracle.outputs);
  }

  Descriptor descriptor;
  descriptor.data = reinterpret_cast<std::byte*>(buffer.data());
  descriptor.size = buffer.size() * 4;
  ResourceTable table;
  table.set[0] = &descriptor;
  table.set_size[0] = 1;
  auto shader = lower(std::move(function));
  ASSERT_TRUE(shader.ok()) << shader.message();
  Fault fault;
  BoundShader bound(*shader.value(), table, fault);
  WaveRunner wave;
  wave.bind(bound);
  for (int repeat = 0; repeat < 2; ++repeat) {
    for (const InterfaceSlot& slot : shader.value()->interface().inputs) wave.input(slot.reg) = inputs[slot.location];
    wave.run(active, 0);
    ASSERT_FALSE(fault.raised) << fault.message;
    for (const InterfaceSlot& slot : shader.value()->interface().outputs)
      base::for_each_lane(active, [&](std::size_t lane) {
        ASSERT_EQ(wave.output(slot.reg).lane[lane], want[lane][slot.location])
            << "seed " << seed << " lane " << lane << " output " << slot.location << '\n'
            << disassemble(shader.value()->program());
      });
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(RandomPrograms, EqualTheOracle) {
  for (std::uint32_t seed = 0; seed < 800; ++seed) {
    run_case(seed);
    if (HasFatalFailure()) return;
  }
}

}  // namespace
}  // namespace vitrine::spirv::test

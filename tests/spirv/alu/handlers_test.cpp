// Every row of spirv/ops.def, for every combination of uniform operands, in every SIMD target and both denormal modes,
// against the scalar model.
#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <vector>

#include "base/float_mode.h"
#include "spirv/program.h"
#include "tests/simd_targets.h"
#include "tests/spirv/alu/model.h"

namespace vitrine::spirv {
namespace {

using ir::Op;

constexpr std::size_t kLanes = base::kWaveWidth;

/// A wave with three source registers, one result, three masks, and words for uniform operands.
struct TestWave {
  base::WaveRegister registers[4];
  alignas(64) std::uint32_t uniforms[4];
  base::LaneMask masks[4];
  Wave wave;
  Instruction code[1];

  TestWave() {
    wave.registers = reinterpret_cast<std::byte*>(registers);
    wave.uniforms = uniforms;
    wave.masks = masks;
    wave.active = base::kAllLanes;
  }
};

std::uint32_t interesting_bits(std::mt19937& random) {
  static constexpr std::uint32_t kSpecials[] = {
      0,          0x80000000, 1,          0x80000001, 2,          31,         32,         33,         0x007fffff,
      0x00800000, 0x7f7fffff, 0x7f800000, 0xff800000, 0x7fc00001, 0xff800001, 0x3f800000, 0xbf800000, 0x4f000000,
      0x4f7fffff, 0x4f800000, 0xcf000000, 0xbf7fffff, 0x477ff000, 0x38800000, 0x7fffffff, 0xffffffff, 0x42fe0000,
      0x43000000, 0xc2fe0000, 0x40490fdb, 0x3fc90fdb, 0x3f000000, 0x40200000, 3,          0xfffffffe, 0x00010000};
  switch (random() % 6) {
    case 0:
      return random();
    case 1:
      return kSpecials[random() % std::size(kSpecials)];
    case 2:
      return (random() & 0x83ffffff) | 0x3c000000;
    case 3:
      return random() % 64;
    case 4:
      return random() >> (random() % 32);
    default:
      return (random() & 0x801fffff) + ((random() % 255) << 23);
  }
}

void fill(TestWave& test, std::mt19937& random) {
  for (auto& reg : test.registers)
    for (auto& lane : reg.lane) lane = interesting_bits(random);
  for (std::size_t i = 0; i < kLanes; ++i)  // some equal operands
    if (random() % 8 == 0) test.registers[1].lane[i] = test.registers[0].lane[i];
  for (auto& word : test.uniforms) word = interesting_bits(random);
  for (auto& mask : test.masks) mask = (static_cast<std::uint64_t>(random()) << 32) | random();
}

bool is_boolean(Op op, unsigned source) { return ir::alu_info(op).operands[source] == 'B'; }
bool is_derivative(Op op) { return op == Op::kFDdx || op == Op::kFDdy; }

/// Runs the wave handler on filled operands and checks each lane.
void check_wave(Op op, unsigned uniform, std::mt19937& random) {
  const ir::AluInfo& info = ir::alu_info(op);
  TestWave test;
  fill(test, random);
  Instruction& code = test.code[0];
  code.handler = alu_handler(op, static_cast<UniformSources>(uniform));
  ASSERT_NE(code.handler, nullptr);
  for (unsigned i = 0; i < 3; ++i)
    code.src[i] = i < info.sources && is_boolean(op, i) ? i * 8
                  : (uniform >> i & 1)                  ? i * 4
                                                        : i * static_cast<unsigned>(sizeof(base::WaveRegister));
  code.dst = info.result == 'B' ? 3 * 8 : 3 * sizeof(base::WaveRegister);
  ASSERT_EQ(code.handler(test.wave, &code), &code + 1);
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    std::uint32_t operand[3] = {};
    for (unsigned i = 0; i < info.sources; ++i)
      operand[i] = is_boolean(op, i)    ? test.masks[i] >> lane & 1
                   : (uniform >> i & 1) ? test.uniforms[i]
                                        : test.registers[i].lane[lane];
    const std::uint32_t got = info.result == 'B' ? test.masks[3] >> lane & 1 : test.registers[3].lane[lane];
    const std::uint32_t want = alu_model::evaluate(op, operand[0], operand[1], operand[2]);
    ASSERT_TRUE(alu_model::same_result(op, want, got))
        << info.name << std::hex << " " << operand[0] << " " << operand[1] << " " << operand[2] << " want " << want
        << " got " << got << " uniform mask " << uniform;
  }
}

void check_scalar(Op op, std::mt19937& random) {
  const ir::AluInfo& info = ir::alu_info(op);
  TestWave test;
  fill(test, random);
  for (unsigned i = 0; i < info.sources; ++i)
    if (is_boolean(op, i)) test.uniforms[i] &= 1;
  Instruction& code = test.code[0];
  code = {alu_scalar_handler(op), 12, {0, 4, 8}, {}};
  ASSERT_NE(code.handler, nullptr);
  const std::uint32_t want = alu_model::evaluate(op, test.uniforms[0], test.uniforms[1], test.uniforms[2]);
  ASSERT_EQ(code.handler(test.wave, &code), &code + 1);
  ASSERT_TRUE(alu_model::same_result(op, want, test.uniforms[3]))
      << info.name << std::hex << " " << test.uniforms[0] << " " << test.uniforms[1] << " " << test.uniforms[2]
      << " want " << want << " got " << test.uniforms[3];
}

class EveryOp : public ::testing::TestWithParam<std::size_t> {
 protected:
  Op op() const { return static_cast<Op>(GetParam()); }
};

TEST_P(EveryOp, EqualsTheModel) {
  if (is_derivative(op())) GTEST_SKIP() << "not an operation of one lane";
  base::for_each_simd_target([&] {
    for (const auto mode : {base::Denormals::kHonour, base::Denormals::kFlush}) {
      const base::ScopedFloatMode scope(mode);
      std::mt19937 random(1);
      for (unsigned uniform = 0; uniform < 1u << ir::alu_info(op()).sources; ++uniform)
        for (int round = 0; round < 50 && !HasFatalFailure(); ++round) check_wave(op(), uniform, random);
      for (int round = 0; round < 1000 && !HasFatalFailure(); ++round) check_scalar(op(), random);
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Alu, EveryOp, ::testing::Range(std::size_t{0}, static_cast<std::size_t>(Op::kExecutedCount)),
                         [](const auto& info) { return ir::op_name(static_cast<Op>(info.param)); });

/// Results of one op on random operands, NaNs of all kinds among them, for every combination of uniform operands.
std::vector<std::uint32_t> results_of(Op op) {
  static constexpr std::uint32_t kNans[] = {0x7fc00001, 0xffc00002, 0x7fc00003, 0xffc00000, 0x7f800004};
  const ir::AluInfo& info = ir::alu_info(op);
  std::mt19937 random(2);
  std::vector<std::uint32_t> results;
  for (unsigned uniform = 0; uniform < 1u << info.sources; ++uniform) {
    for (int round = 0; round < 16; ++round) {
      TestWave test;
      fill(test, random);
      for (auto& reg : test.registers)
        for (auto& lane : reg.lane)
          if (random() % 2 == 0) lane = kNans[random() % std::size(kNans)];
      for (auto& word : test.uniforms)
        if (random() % 2 == 0) word = kNans[random() % std::size(kNans)];
      Instruction& code = test.code[0];
      code.handler = alu_handler(op, static_cast<UniformSources>(uniform));
      for (unsigned i = 0; i < 3; ++i)
        code.src[i] = (uniform >> i & 1) ? i * 4 : i * static_cast<unsigned>(sizeof(base::WaveRegister));
      code.dst = 3 * sizeof(base::WaveRegister);
      code.handler(test.wave, &code);
      results.insert(results.end(), std::begin(test.registers[3].lane), std::end(test.registers[3].lane));
    }
  }
  return results;
}

TEST_P(EveryOp, GivesTheSameNansInEveryTarget) {
  if (ir::alu_info(op()).result != 'F' || is_boolean(op(), 0)) GTEST_SKIP() << "no float of floats";
  std::vector<std::vector<std::uint32_t>> found;
  base::for_each_simd_target([&] { found.push_back(results_of(op())); });
  for (const auto& results : found) EXPECT_EQ(results, found[0]);
}

TEST(Derivatives, DifferWithinRowAndColumnOfTheQuad) {
  base::for_each_simd_target([] {
    TestWave test;
    for (std::size_t i = 0; i < kLanes; ++i) {
      const float value = static_cast<float>(i * i * i);
      std::memcpy(&test.registers[0].lane[i], &value, 4);
    }
    for (const Op op : {Op::kFDdx, Op::kFDdy}) {
      Instruction code{alu_handler(op, 0), sizeof(base::WaveRegister), {0, 0, 0}, {}};
      code.handler(test.wave, &code);
      for (std::size_t i = 0; i < kLanes; ++i) {
        const std::size_t near = op == Op::kFDdx ? i & ~std::size_t{1} : i & ~std::size_t{2};
        const std::size_t far = op == Op::kFDdx ? i | 1 : i | 2;
        float got, a, b;
        std::memcpy(&got, &test.registers[1].lane[i], 4);
        std::memcpy(&a, &test.registers[0].lane[near], 4);
        std::memcpy(&b, &test.registers[0].lane[far], 4);
        EXPECT_EQ(got, b - a) << ir::op_name(op) << " lane " << i;
      }
    }
  });
}

}  // namespace
}  // namespace vitrine::spirv

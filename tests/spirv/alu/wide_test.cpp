// Every row of wide_ops.def: the wave's handler and that of the uniform file give the same words in every SIMD target,
// whichever file operands lie in; and the corner values that wide_ops.def names.
#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <random>

#include "base/lanes.h"
#include "spirv/program.h"

namespace vitrine::spirv {
namespace {

constexpr std::size_t kRegisters = 6;

struct Row {
  ir::Op op;
  std::uint32_t sources, results;
};

std::vector<Row> rows() {
  std::vector<Row> all;
  for (auto op = static_cast<ir::Op>(static_cast<int>(ir::Op::kIntrinsicEnd) + 1); op < ir::Op::kCount;
       op = static_cast<ir::Op>(static_cast<int>(op) + 1)) {
    const ir::WideInfo& info = ir::wide_info(op);
    std::uint32_t words = 0;
    for (const char* letter = info.operands; *letter != 0; ++letter) words += ir::wide_words(*letter);
    all.push_back({op, words, ir::wide_words(info.result)});
  }
  return all;
}

/// Six registers, as many uniform words, one mask.
struct Files {
  alignas(64) base::WaveRegister registers[kRegisters];
  std::uint32_t uniforms[kRegisters] = {};
  base::LaneMask masks[1] = {};

  Wave wave() {
    Wave wave;
    wave.registers = reinterpret_cast<std::byte*>(registers);
    wave.uniforms = uniforms;
    wave.masks = masks;
    wave.active = base::kAllLanes;
    return wave;
  }
};

/// Sources in places 0.., results in places 4 and 5; bit i of `uniform`: source i is in the uniform file.
Instruction instruction(const Row& row, bool scalar, unsigned uniform) {
  const auto place = [&](std::uint32_t k, bool word) { return word ? 4 * k | kUniformPlace : k * kRegisterStride; };
  Instruction i{wide_handler(row.op, scalar), 0, {kNoOperand, kNoOperand, kNoOperand}, {kNoOperand, kNoOperand}};
  for (std::uint32_t k = 0; k < row.sources; ++k)
    (k < 3 ? i.src[k] : i.extra[0]) = place(k, scalar || (uniform >> k & 1) != 0);
  const bool boolean = ir::wide_info(row.op).result == 'B';
  i.dst = boolean && !scalar ? 0 : place(4, scalar);
  if (row.results == 2) i.extra[1] = place(5, scalar);
  return i;
}

std::uint32_t operand(std::mt19937& random) {
  constexpr std::uint32_t kCorners[] = {0,          1,          0xffffffff, 0x80000000, 0x7fffffff, 0x7ff00000,
                                        0xfff80000, 0x3ff00000, 0x43e00000, 0x5f000000, 0x7f800000, 0x000fffff};
  return random() % 2 == 0 ? kCorners[random() % std::size(kCorners)] : static_cast<std::uint32_t>(random());
}

TEST(Wide, WaveAndScalarAgree) {
  std::mt19937 random(1);
  for (const Row& row : rows()) {
    Files files;
    for (auto& reg : files.registers)
      for (std::uint32_t& lane : reg.lane) lane = operand(random);
    Wave wave = files.wave();
    const Instruction i = instruction(row, false, 0);
    EXPECT_EQ(i.handler(wave, &i), &i + 1);
    for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane) {
      Files one;
      for (std::size_t k = 0; k < 4; ++k) one.uniforms[k] = files.registers[k].lane[lane];
      Wave scalar = one.wave();
      const Instruction s = instruction(row, true, 0);
      s.handler(scalar, &s);
      if (ir::wide_info(row.op).result == 'B') {
        EXPECT_EQ(one.uniforms[4], files.masks[0] >> lane & 1) << ir::op_name(row.op);
        continue;
      }
      for (std::size_t k = 4; k < 4 + row.results; ++k)
        EXPECT_EQ(one.uniforms[k], files.registers[k].lane[lane]) << ir::op_name(row.op) << " lane " << lane;
    }
  }
}

TEST(Wide, UniformSourcesAreBroadcast) {
  std::mt19937 random(2);
  for (const Row& row : rows())
    for (unsigned uniform = 1; uniform < 1u << row.sources; ++uniform) {
      Files files;
      for (std::size_t k = 0; k < kRegisters; ++k) {
        files.uniforms[k] = operand(random);
        for (std::uint32_t& lane : files.registers[k].lane) lane = files.uniforms[k];
      }
      Files same = files;
      Wave a = files.wave(), b = same.wave();
      const Instruction mixed = instruction(row, false, uniform), plain = instruction(row, false, 0);
      mixed.handler(a, &mixed);
      plain.handler(b, &plain);
      EXPECT_EQ(files.masks[0], same.masks[0]) << ir::op_name(row.op);
      EXPECT_EQ(std::memcmp(files.registers, same.registers, sizeof(files.registers)), 0) << ir::op_name(row.op);
    }
}

std::uint64_t of_two(ir::Op op, std::uint64_t a, std::uint64_t b) {
  Files files;
  files.uniforms[0] = static_cast<std::uint32_t>(a);
  files.uniforms[1] = static_cast<std::uint32_t>(a >> 32);
  files.uniforms[2] = static_cast<std::uint32_t>(b);
  files.uniforms[3] = static_cast<std::uint32_t>(b >> 32);
  Wave wave = files.wave();
  const Instruction i = instruction({op, 4, 2}, true, 0);
  i.handler(wave, &i);
  return files.uniforms[4] | std::uint64_t{files.uniforms[5]} << 32;
}

TEST(Wide, DivisionCorners) {
  constexpr std::uint64_t kLeast = std::uint64_t{1} << 63, kOnes = ~std::uint64_t{0};
  EXPECT_EQ(of_two(ir::Op::kLDiv, kLeast, kOnes), kLeast);
  EXPECT_EQ(of_two(ir::Op::kLDiv, 7, 0), 0u);
  EXPECT_EQ(of_two(ir::Op::kQDiv, 7, 0), kOnes);
  EXPECT_EQ(of_two(ir::Op::kLRem, kLeast, kOnes), 0u);
  EXPECT_EQ(of_two(ir::Op::kLRem, 7, 0), kOnes);
  EXPECT_EQ(of_two(ir::Op::kLMod, static_cast<std::uint64_t>(-7), 3), 2u);
  EXPECT_EQ(of_two(ir::Op::kQMod, 7, 0), kOnes);
  EXPECT_EQ(of_two(ir::Op::kQMulHigh, kOnes, kOnes), kOnes - 1);
  EXPECT_EQ(of_two(ir::Op::kLMulHigh, kLeast, 2), kOnes);
}

TEST(Wide, MinimumPrefersNumbers) {
  const auto nan = std::bit_cast<std::uint64_t>(__builtin_nan("")), two = std::bit_cast<std::uint64_t>(2.0);
  EXPECT_EQ(of_two(ir::Op::kDMin, two, nan), two);
  EXPECT_EQ(of_two(ir::Op::kDMin, nan, two), two);
  EXPECT_EQ(of_two(ir::Op::kDMax, two, nan), two);
}

}  // namespace
}  // namespace vitrine::spirv

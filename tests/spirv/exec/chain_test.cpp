// Every link of a chain gives the bits of the plain handler of its operation.
#include "spirv/exec/chain.h"

#include <gtest/gtest.h>

#include <random>

#include "spirv/program.h"

namespace vitrine::spirv::exec {
namespace {

using base::WaveRegister;
using ir::Op;

/// Registers 0..2 are operands, 3 zeros, 4 and 5 results; words 0..2 are operands; masks 0..2 operands, 4 and 5
/// results.
struct Machine {
  WaveRegister registers[6];
  std::uint32_t uniforms[4];
  base::LaneMask masks[6];
  Wave wave;

  explicit Machine(std::uint32_t seed) {
    std::mt19937 random(seed);
    const std::uint32_t specials[] = {0, 0x80000000, 0x3f800000, 0x7f800000, 0xff800000, 0x7fc00000, 1, 0xffffffff, 31};
    const auto value = [&]() -> std::uint32_t {
      return static_cast<std::uint32_t>(random() % 4 == 0 ? specials[random() % 9] : random());
    };
    for (WaveRegister& reg : registers)
      for (std::uint32_t& lane : reg.lane) lane = value();
    registers[3] = {};
    for (std::uint32_t& word : uniforms) word = value();
    for (base::LaneMask& mask : masks) mask = std::uint64_t{random()} << 32 | random();
    wave.registers = reinterpret_cast<std::byte*>(registers);
    wave.uniforms = uniforms;
    wave.masks = masks;
    wave.active = base::kAllLanes;
  }
};

Instruction instruction(Handler handler, Op op, UniformSources uniform, std::uint32_t dst) {
  Instruction i{};
  i.handler = handler;
  const bool mask_result = ir::alu_info(op).result == 'B';
  i.dst = dst * (mask_result ? 8 : kRegisterStride);
  for (std::uint32_t k = 0; k < ir::alu_info(op).sources; ++k) {
    const bool mask = ir::alu_info(op).operands[k] == 'B';
    i.src[k] = mask ? k * 8 : (uniform >> k & 1) ? k * 4 : k * kRegisterStride;
  }
  return i;
}

/// acc = register `from`: x | 0.
Instruction start_with(std::uint32_t from) {
  Instruction i{};
  i.handler = chain_handler(Op::kOr, kNoAccumulator, 0, Link::kKeep);
  i.src[0] = from * kRegisterStride;
  i.src[1] = 3 * kRegisterStride;
  return i;
}

Instruction last_or() {
  Instruction i{};
  i.handler = chain_handler(Op::kOr, 0, 0, Link::kLast);
  i.dst = 5 * kRegisterStride;
  i.src[1] = 3 * kRegisterStride;
  return i;
}

void expect_same(Op op, const Machine& plain, const Machine& chained, std::uint32_t dst) {
  if (ir::alu_info(op).result == 'B') {
    ASSERT_EQ(plain.masks[4], chained.masks[dst]) << ir::op_name(op);
    return;
  }
  for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane) {
    const std::uint32_t want = plain.registers[4].lane[lane], got = chained.registers[dst].lane[lane];
    ASSERT_EQ(want, got) << ir::op_name(op) << " lane " << lane;
  }
}

void check(Op op, int accumulator, UniformSources uniform, std::uint32_t seed) {
  Machine plain(seed);
  const std::uint32_t acc_register = accumulator == kAllSources ? 0 : static_cast<std::uint32_t>(accumulator);
  if (accumulator == kAllSources) plain.registers[1] = plain.registers[0];
  Machine chained = plain;
  chained.wave.registers = reinterpret_cast<std::byte*>(chained.registers);
  chained.wave.uniforms = chained.uniforms;
  chained.wave.masks = chained.masks;
  const Instruction reference = instruction(alu_handler(op, uniform), op, uniform, 4);
  reference.handler(plain.wave, &reference);
  for (const Link link : {Link::kKeep, Link::kStore, Link::kLast}) {
    const Handler handler = chain_handler(op, accumulator, uniform, link);
    if (handler == nullptr) continue;
    const Instruction tested = instruction(handler, op, uniform, 4);
    const bool start = accumulator == kNoAccumulator;
    const Instruction program[3] = {start ? tested : start_with(acc_register), start ? last_or() : tested, last_or()};
    const Instruction* end = program[0].handler(chained.wave, program);
    ASSERT_EQ(end - program, link == Link::kLast || start ? 2 : 3);
    if (link != Link::kKeep) expect_same(op, plain, chained, 4);
    if (link != Link::kLast) expect_same(op, plain, chained, 5);
  }
}

TEST(Chain, LinksEqualPlainHandlers) {
  if (chain_handler(Op::kOr, kNoAccumulator, 0, Link::kKeep) == nullptr) GTEST_SKIP() << "target without chains";
  std::uint32_t links = 0;
  for (std::uint32_t op = 0; op < static_cast<std::uint32_t>(Op::kExecutedCount); ++op) {
    for (int accumulator = kNoAccumulator; accumulator <= kAllSources; ++accumulator) {
      for (std::uint32_t uniform = 0; uniform < 8; ++uniform) {
        if (chain_handler(static_cast<Op>(op), accumulator, static_cast<UniformSources>(uniform), Link::kStore) ==
                nullptr &&
            chain_handler(static_cast<Op>(op), accumulator, static_cast<UniformSources>(uniform), Link::kLast) ==
                nullptr)
          continue;
        ++links;
        for (std::uint32_t seed = 0; seed < 4; ++seed)
          check(static_cast<Op>(op), accumulator, static_cast<UniformSources>(uniform), seed);
        if (HasFatalFailure()) return;
      }
    }
  }
  EXPECT_GT(links, 200u);
}

}  // namespace
}  // namespace vitrine::spirv::exec

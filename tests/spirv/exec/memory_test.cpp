// Loads and stores with every address pattern at every bound, atomics, shared memory and barriers.
#include <numeric>
#include <random>

#include "tests/spirv/shader_run.h"

namespace vitrine::spirv::test {
namespace {

ValueId global_index(Builder& b) { return b.append(Op::kGlobalInvocationId, 3, false, {}).result; }

std::uint32_t word_at(const std::vector<std::uint32_t>& words, std::uint32_t offset) {
  return std::uint64_t{offset} + 4 <= words.size() * 4 ? words[offset / 4] : 0;
}

/// Loads `components` words at the offsets in input 0 and compares with plain indexing.
void check_load(std::uint8_t components, const std::vector<std::uint32_t>& words, const base::WaveRegister& offsets,
                base::LaneMask active) {
  std::vector<std::uint32_t> copy = words;
  Buffers buffers{&copy};
  Builder b;
  const ValueId v = b.load(Op::kLoadStorage, 0, 0, b.input(0), components);
  for (std::uint8_t c = 0; c < components; ++c) b.output(c, b.append(Op::kMov, 1, false, {src(v, c)}).result);
  ShaderRun run(b, buffers.table);
  *run.input(0) = offsets;
  run.wave.run(active, 0);
  for (std::uint8_t c = 0; c < components; ++c)
    base::for_each_lane(active, [&](std::size_t lane) {
      ASSERT_EQ(run.output(c).lane[lane], word_at(words, offsets.lane[lane] + 4u * c))
          << "lane " << lane << " offset " << offsets.lane[lane] << " component " << int{c};
    });
}

TEST(Memory, LoadsOfEveryPattern) {
  std::mt19937 random(1);
  for (const std::size_t size : {0u, 1u, 3u, 64u, 65u, 255u, 256u, 1000u}) {
    std::vector<std::uint32_t> words(size);
    for (std::uint32_t& word : words) word = random();
    for (std::uint8_t components = 1; components <= 4; ++components) {
      for (const std::uint32_t stride : {0u, 4u, 8u, 12u, 16u, 20u, 0xfffffffcu}) {
        for (const std::uint32_t start : {0u, 4u, 40u, 3900u, 0xffffff00u}) {
          base::WaveRegister offsets;
          for (std::uint32_t lane = 0; lane < 64; ++lane) offsets.lane[lane] = start + lane * stride;
          check_load(components, words, offsets, base::kAllLanes);
          check_load(components, words, offsets, base::first_lanes(37));
          check_load(components, words, offsets, 0xf0f00000ffffffffu);
          offsets.lane[random() % 64] += 4;
          check_load(components, words, offsets, base::kAllLanes);
        }
      }
    }
  }
}

TEST(Memory, StoresOfEveryPattern) {
  std::mt19937 random(2);
  for (const std::uint32_t mask : {1u, 2u, 3u, 5u, 7u, 15u}) {
    for (const std::uint32_t stride : {4u, 8u, 12u, 16u, 20u}) {
      for (const base::LaneMask active : {base::kAllLanes, base::first_lanes(9), base::LaneMask{0xff00ff00ff00ff01}}) {
        std::vector<std::uint32_t> words(300, 0), want = words;
        Buffers buffers{&words};
        Builder b;
        const ValueId x = b.input(0), y = b.input(1);
        const ValueId value = b.append(Op::kVec, 4, false, {src(x), src(y), src(x), src(y)}).result;
        b.store(0, 0, b.input(2), vec(value), mask);
        ShaderRun run(b, buffers.table);
        for (std::uint32_t lane = 0; lane < 64; ++lane) {
          const auto a = static_cast<std::uint32_t>(random()), c1 = static_cast<std::uint32_t>(random());
          const std::uint32_t v[2] = {a, c1};
          if (run.input(0)) run.input(0)->lane[lane] = v[0];
          if (run.input(1)) run.input(1)->lane[lane] = v[1];
          run.input(2)->lane[lane] = lane * stride;
          for (std::uint32_t c = 0; c < 4; ++c)
            if ((active >> lane & 1) && (mask >> c & 1) && lane * stride / 4 + c < want.size())
              want[lane * stride / 4 + c] = v[c & 1];
        }
        run.wave.run(active, 0);
        ASSERT_EQ(words, want) << mask << " " << stride;
      }
    }
  }
}

TEST(Memory, OfStoresToOneAddressTheLastLaneRemains) {
  for (const base::LaneMask active : {base::kAllLanes, base::first_lanes(9), base::LaneMask{1} << 17}) {
    std::vector<std::uint32_t> words(8, 7), want = words;
    Buffers buffers{&words};
    Builder b;
    const ValueId value = b.append(Op::kVec, 2, false, {src(b.input(0)), src(b.input(1))}).result;
    b.store(0, 0, b.constant(8), vec(value), 3);
    b.store(0, 0, b.constant(400), src(b.input(0)));  // outside
    ShaderRun run(b, buffers.table);
    for (std::uint32_t lane = 0; lane < 64; ++lane) {
      run.input(0)->lane[lane] = lane;
      run.input(1)->lane[lane] = 100 + lane;
    }
    const base::LaneMask helpers = active == base::kAllLanes ? 0 : base::kAllLanes << 60;
    run.wave.run(active | helpers, helpers);
    want[2] = static_cast<std::uint32_t>(std::bit_width(active)) - 1;
    want[3] = 100 + want[2];
    EXPECT_EQ(words, want);
  }
}

TEST(Memory, HelpersDoNotStore) {
  std::vector<std::uint32_t> words(64, 0);
  Buffers buffers{&words};
  Builder b;
  b.store(0, 0, b.alu(Op::kIMul, {b.input(0), b.constant(4)}), src(b.constant(5)));
  ShaderRun run(b, buffers.table);
  for (std::uint32_t lane = 0; lane < 64; ++lane) run.input(0)->lane[lane] = lane;
  run.wave.run(base::first_lanes(32), 0xf);
  EXPECT_EQ(std::accumulate(words.begin(), words.end(), 0u), 28u * 5);
  EXPECT_EQ(words[3], 0u);
}

TEST(Atomics, CountersAndOldValues) {
  const std::uint32_t groups = 200;
  std::vector<std::uint32_t> counter(2, 0), seen(groups * 48, 0);
  counter[1] = 0xffffffff;
  Buffers buffers{&counter, &seen};
  Builder b;
  b.function.interface.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  b.function.interface.local_size[0] = 48;
  const ValueId id = global_index(b), zero = b.constant(0), one = b.constant(1);
  const auto atomic = [&](ir::AtomicOp op, std::uint32_t offset, ValueId operand) {
    ir::Instr& instr = b.append(Op::kAtomicStorage, 1, false, {src(zero), src(b.constant(offset)), src(operand)});
    instr.data[2] = 1;
    instr.imm[0] = static_cast<std::uint32_t>(op);
    return instr.result;
  };
  const ValueId old = atomic(ir::AtomicOp::kAdd, 0, one);
  atomic(ir::AtomicOp::kUMin, 4, b.alu(Op::kIAdd, {id, b.constant(3)}));
  b.store(0, 1, b.alu(Op::kIMul, {old, b.constant(4)}), src(one));
  ShaderRun run(b, buffers.table);
  run.dispatch_groups(groups);
  EXPECT_EQ(counter[0], groups * 48);
  EXPECT_EQ(counter[1], 3u);
  EXPECT_EQ(std::accumulate(seen.begin(), seen.end(), 0u), groups * 48);
}

/// Every invocation writes its word of shared memory; after a barrier it reads the word of the opposite one.
void exchange_in_workgroups(std::uint32_t size) {
  const std::uint32_t groups = 20;
  std::vector<std::uint32_t> out(size * groups, 0);
  Buffers buffers{&out};
  Builder b;
  b.function.interface.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  b.function.interface.local_size[0] = size;
  b.function.interface.shared_bytes = size * 4;
  const ValueId id = global_index(b), four = b.constant(4);
  const ValueId local = b.append(Op::kLocalInvocationIndex, 1, false, {}).result;
  b.append(Op::kStoreShared, 0, false, {src(b.alu(Op::kIMul, {local, four})), src(id)}).imm[0] = 1;
  b.append(Op::kBarrier, 0, false, {});
  const ValueId opposite = b.alu(Op::kISub, {b.constant(size - 1), local});
  const ValueId v = b.append(Op::kLoadShared, 1, false, {src(b.alu(Op::kIMul, {opposite, four}))}).result;
  b.store(0, 0, b.alu(Op::kIMul, {id, four}), src(v));
  ShaderRun run(b, buffers.table);
  run.dispatch_groups(groups);
  for (std::uint32_t g = 0; g < groups; ++g)
    for (std::uint32_t i = 0; i < size; ++i) ASSERT_EQ(out[g * size + i], g * size + size - 1 - i);
}

TEST(Barrier, WavesSeeEachOther) {
  for (const std::uint32_t size : {1u, 16u, 64u, 65u, 200u}) exchange_in_workgroups(size);
}

}  // namespace
}  // namespace vitrine::spirv::test

// The executor on hand-written functions: interface, preamble, branches, loops, buffers, compute.
#include <algorithm>
#include <cstdlib>

#include "tests/spirv/shader_run.h"

namespace vitrine::spirv::test {
namespace {

/// Read once per process, at the first run of a wave: set before any test.
const int budget_is_set = setenv("VITRINE_SHADER_BUDGET", "1000000", 1);

TEST(Execute, StraightLine) {
  Builder b;
  const ValueId x = b.input(0), y = b.input(1);
  b.output(0, b.alu(Op::kFAdd, {b.alu(Op::kFMul, {x, y}), b.constant_float(1.0f)}));
  b.output(1, b.constant_float(0.5f));
  b.output(2, x);
  ShaderRun run(b);
  for (std::uint32_t lane = 0; lane < 64; ++lane) {
    run.input(0)->lane[lane] = base::bits_of(static_cast<float>(lane));
    run.input(1)->lane[lane] = base::bits_of(2.0f);
  }
  EXPECT_EQ(run.wave.run(base::kAllLanes, 0), base::kAllLanes);
  for (std::uint32_t lane = 0; lane < 64; ++lane) {
    EXPECT_EQ(base::float_of(run.output(0).lane[lane]), static_cast<float>(lane) * 2 + 1);
    EXPECT_EQ(base::float_of(run.output(1).lane[lane]), 0.5f);
    EXPECT_EQ(run.output(2).lane[lane], base::bits_of(static_cast<float>(lane)));
  }
}

TEST(Execute, UniformWorkRunsOncePerDraw) {
  std::uint32_t words[4] = {base::bits_of(3.0f), base::bits_of(4.0f), 7, 9};
  Descriptor descriptor;
  descriptor.data = reinterpret_cast<std::byte*>(words);
  descriptor.size = sizeof(words);
  ResourceTable table;
  table.set[0] = &descriptor;
  table.set_size[0] = 1;
  Builder b;
  const ValueId v = b.load(Op::kLoadUniform, 0, 0, b.constant(0), 2);
  const ValueId product = b.append(Op::kFMul, 1, false, {src(v, 0), src(v, 1)}).result;
  b.output(0, b.alu(Op::kFAdd, {b.input(0), product}));
  const ValueId outside = b.load(Op::kLoadUniform, 0, 0, b.constant(16), 1);
  b.output(1, outside);
  ShaderRun run(b, table);
  EXPECT_EQ(run.shader->program().code.size(), 2u) << disassemble(run.shader->program());
  for (std::uint32_t& lane : run.input(0)->lane) lane = base::bits_of(1.0f);
  run.wave.run(base::kAllLanes, 0);
  EXPECT_EQ(base::float_of(run.output(0).lane[17]), 13.0f);
  EXPECT_EQ(run.output(1).lane[17], 0u);
}

TEST(Execute, BranchKeepsTheOtherLanes) {
  Builder b;
  const ValueId x = b.input(0);
  const ValueId odd = b.alu(Op::kINe, {b.alu(Op::kAnd, {x, b.constant(1)}), b.constant(0)});
  const auto r = b.branch(
      odd, 1,
      [&] {
        ValueId v = x;
        for (int i = 0; i < 20; ++i) v = b.alu(Op::kIMul, {v, b.alu(Op::kIAdd, {x, b.constant(5)})});
        b.yield({v});
      },
      [&] { b.yield({x}); });
  b.output(0, r[0]);
  ShaderRun run(b);
  for (std::uint32_t lane = 0; lane < 64; ++lane) run.input(0)->lane[lane] = lane;
  run.wave.run(base::kAllLanes, 0);
  for (std::uint32_t lane = 0; lane < 64; ++lane) {
    std::uint32_t want = lane;
    if (lane & 1)
      for (int i = 0; i < 20; ++i) want *= lane + 5;
    EXPECT_EQ(run.output(0).lane[lane], want);
  }
}

/// sum of i for i in 0..n-1, n per lane.
TEST(Execute, DivergentLoop) {
  Builder b;
  const ValueId n = b.input(0), zero = b.constant(0), one = b.constant(1);
  const auto r = b.loop(
      {zero, zero}, 0, 1,
      [&](const std::vector<ValueId>& p) {
        b.branch(
            b.alu(Op::kUGe, {p[0], n}), 0, [&] { b.jump(Op::kBreak, {p[1]}); }, [&] { b.yield(); });
        b.yield();
      },
      [&](const std::vector<ValueId>& p, const std::vector<ValueId>&) {
        b.yield({b.alu(Op::kIAdd, {p[0], one}), b.alu(Op::kIAdd, {p[1], p[0]})});
      });
  b.output(0, r[0]);
  ShaderRun run(b);
  for (std::uint32_t lane = 0; lane < 64; ++lane) run.input(0)->lane[lane] = lane;
  run.wave.run(base::kAllLanes, 0);
  for (std::uint32_t lane = 1; lane < 64; ++lane) EXPECT_EQ(run.output(0).lane[lane], lane * (lane - 1) / 2);
}

TEST(Execute, EndlessLoopFaults) {
  Builder b;
  b.output(0, b.input(0));
  b.loop(
      {}, 0, 0, [&](const std::vector<ValueId>&) { b.yield(); },
      [&](const std::vector<ValueId>&, const std::vector<ValueId>&) { b.yield(); });
  ShaderRun run(b);
  run.wave.run(base::kAllLanes, 0);
  EXPECT_EQ(budget_is_set, 0);
  EXPECT_TRUE(run.fault.raised);
}

TEST(Execute, DiscardedLanesAreReturned) {
  Builder b;
  const ValueId x = b.input(0);
  b.branch(
      b.alu(Op::kULt, {x, b.constant(10)}), 0, [&] { b.jump(Op::kKill); }, [&] { b.yield(); });
  b.output(0, x);
  ShaderRun run(b);
  for (std::uint32_t lane = 0; lane < 64; ++lane) run.input(0)->lane[lane] = lane;
  EXPECT_EQ(run.wave.run(base::kAllLanes, 0xff0000), base::kAllLanes & ~0x3ffull & ~0xff0000ull);
}

TEST(Dispatch, GlobalIds) {
  std::vector<std::uint32_t> out(1000, 0);
  const Buffers buffers{&out};
  Builder b;
  b.function.interface.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  b.function.interface.local_size[0] = 24;
  const ValueId id = b.append(Op::kGlobalInvocationId, 3, false, {}).result;
  const ValueId offset = b.alu(Op::kIMul, {id, b.constant(4)});
  b.store(0, 0, offset, src(b.alu(Op::kIMul, {id, id})));
  ShaderRun run(b, buffers.table);
  run.dispatch_groups(50);
  for (std::uint32_t i = 0; i < out.size(); ++i) ASSERT_EQ(out[i], i * i);
}

/// LocalInvocationId of every invocation, for sizes that are powers of two and others.
TEST(Dispatch, LocalIds) {
  const std::uint32_t sizes[][3] = {{64, 1, 1}, {16, 16, 1}, {5, 3, 7}, {1, 1, 1}, {3, 1, 1}, {2, 4, 8}, {6, 2, 1}};
  for (const auto& size : sizes) {
    const std::uint32_t invocations = size[0] * size[1] * size[2], groups = 7;
    std::vector<std::uint32_t> out(invocations * groups, 0);
    Buffers buffers{&out};
    Builder b;
    b.function.interface.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    std::copy_n(size, 3, b.function.interface.local_size);
    const ValueId local = b.append(Op::kLocalInvocationId, 3, false, {}).result;
    const ValueId index = b.append(Op::kLocalInvocationIndex, 1, false, {}).result;
    const ValueId group = b.append(Op::kWorkgroupId, 3, false, {}).result;
    ValueId code = b.append(Op::kMov, 1, false, {src(local, 0)}).result;
    for (std::uint8_t c = 1; c < 3; ++c) {
      const ValueId part = b.append(Op::kShl, 1, false, {src(local, c), src(b.constant(8u * c))}).result;
      code = b.alu(Op::kOr, {code, part});
    }
    const ValueId first = b.append(Op::kIMul, 1, false, {src(group), src(b.constant(invocations))}).result;
    code = b.alu(Op::kOr, {code, b.append(Op::kShl, 1, false, {src(group), src(b.constant(24))}).result});
    b.store(0, 0, b.alu(Op::kIMul, {b.alu(Op::kIAdd, {first, index}), b.constant(4)}), src(code));
    ShaderRun run(b, buffers.table);
    run.dispatch_groups(groups);
    for (std::uint32_t i = 0; i < out.size(); ++i) {
      const std::uint32_t l = i % invocations;
      ASSERT_EQ(out[i],
                (l % size[0]) | (l / size[0] % size[1]) << 8 | (l / size[0] / size[1]) << 16 | (i / invocations) << 24)
          << size[0] << " " << i;
    }
  }
}

}  // namespace
}  // namespace vitrine::spirv::test

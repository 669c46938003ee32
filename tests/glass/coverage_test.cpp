// Which blocks of a shader ran, whatever the rewrites made of its control flow.
#include "tests/glass/observed.h"

#include <map>

namespace vitrine::glass::test {
namespace {

/// How often each block ran, in invocations, by its label in the order of the module.
class Counter : public Tool, public ProgramTool, public std::enable_shared_from_this<Counter> {
 public:
  spirv::exec::Interest interest() const override { return {.blocks = true}; }
  std::shared_ptr<ProgramTool> attach(const ShaderIdentity&, const spirv::Program& program) override {
    probes_ = program.probes;
    instructions = program.probe_ops.size();
    for (const spirv::Probe& probe : probes_) counts[probe.id] = 0;
    return std::shared_ptr<ProgramTool>(this, [](ProgramTool*) {});
  }
  std::unique_ptr<spirv::exec::Watch> watch(const spirv::Wave&, const spirv::Instruction*) override {
    struct Watch : spirv::exec::Watch {
      explicit Watch(Counter& c) : counter(c) {}
      void probe(const spirv::Wave& wave, const spirv::ProbeOp& op) override {
        const auto lanes = static_cast<unsigned>(std::popcount(spirv::exec::lanes_at(wave, op)));
        counter.counts[counter.probes_[op.probe].id] += lanes;
        for (const std::uint32_t row : op.also) counter.counts[counter.probes_[row].id] += lanes;
      }
      Counter& counter;
    };
    return std::make_unique<Watch>(*this);
  }

  std::map<std::uint32_t, unsigned> counts;
  std::size_t instructions = 0;  ///< that tell of blocks

 private:
  std::vector<spirv::Probe> probes_;
};

/// `instructions`: how many tell of the blocks.
std::vector<unsigned> counts_of(const std::string& body, std::size_t* instructions = nullptr) {
  const std::string glsl = R"(#version 460
layout(local_size_x = 8) in;
layout(set = 0, binding = 0) buffer B { uint v[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
)" + body + "}\n";
  std::vector<std::uint32_t> plain(64), observed(64);
  for (std::uint32_t i = 0; i < plain.size(); ++i) plain[i] = observed[i] = i * 3;
  Counter counter;
  run_observed(nullptr, glsl, plain, 1);
  run_observed(&counter, glsl, observed, 1);
  EXPECT_EQ(plain, observed);
  std::vector<unsigned> counts;
  for (const auto& [label, count] : counter.counts) counts.push_back(count);
  if (instructions != nullptr) *instructions = counter.instructions;
  return counts;
}

using Counts = std::vector<unsigned>;

TEST(BlockProbes, OneTellsOfBlocksThatTheSameLanesComeBy) {
  std::size_t instructions = 0;
  // Entry, loop header, merge, body, continue target, condition.
  EXPECT_EQ(counts_of("uint x = 0u; for (uint k = 0u; k < i; ++k) x += v[k]; v[i] = x;", &instructions),
            (Counts{8, 36, 28, 8, 28, 36}));
  EXPECT_EQ(instructions, 3u) << "one in front of the loop, one a turn, one behind it";
}

TEST(BlockProbes, OneTellsOfALoopWithoutTurns) {
  std::size_t instructions = 0;
  EXPECT_EQ(counts_of("uint x = i; for (uint k = 0u; k < 5u; ++k) x = x * 5u + v[i + k]; v[i] = x;", &instructions),
            (Counts{8, 48, 40, 8, 40, 48}));
  EXPECT_EQ(instructions, 1u);
}

TEST(BlockProbes, OneTellsOfWhatIsInFrontOfABranchAndBehindIt) {
  std::size_t instructions = 0;
  // Entry, then, merge, inner then, inner merge.
  EXPECT_EQ(counts_of("if (i < 6u) { v[i] = v[i + 8u] / 3u; if (i < 4u) v[i + 16u] = v[i] % 5u; v[i + 24u] = i; }\n"
                      "v[i + 32u] = i;",
                      &instructions),
            (Counts{8, 6, 8, 4, 6}));
  EXPECT_EQ(instructions, 3u);
}

TEST(BlockProbes, TellOfWhatIsBehindABranchThatLanesLeave) {
  std::size_t instructions = 0;
  // Entry, then, merge, then that returns, merge.
  EXPECT_EQ(counts_of("if (i < 6u) { v[i] = v[i + 8u] / 3u; if (i < 4u) return; v[i + 24u] = i; } v[i + 32u] = i;",
                      &instructions),
            (Counts{8, 6, 4, 4, 2}));
  EXPECT_EQ(instructions, 5u);
}

TEST(BlockProbes, OneTellsOfATurnWithABarrier) {
  std::size_t instructions = 0;
  counts_of("for (uint k = 4u; k != v[63] - 189u; --k) { if (i < k) v[i] += v[i + k]; barrier(); }", &instructions);
  EXPECT_EQ(instructions, 4u) << "one in front of the loop, one a turn, one in the branch, one behind the loop";
}

TEST(BlockProbes, OneTellsOfATurnOfThoseThatAreWrittenOut) {
  std::size_t instructions = 0;
  EXPECT_EQ(counts_of("uint a = i, b = 1u, c = 2u, d = 3u; for (uint k = 0u; k < i + 60u; ++k) {\n"
                      "uint t = d + (a ^ b & c); d = c; c = b; b = a; a = t; } v[i] = a + b + c + d;",
                      &instructions),
            (Counts{8, 516, 508, 8, 508, 516}));
  EXPECT_EQ(instructions, 6u) << "entry, end, four turns";
}

// Labels in the order in which glslang numbers them: entry, then, merge, else.
TEST(BlockProbes, SeeBranchesThatBecomeSelections) {
  EXPECT_EQ(counts_of("uint x = 1u; if (i < 3u) x = 2u; else x = 5u; v[i] = x;"), (Counts{8, 3, 8, 5}));
}

TEST(BlockProbes, SeeBranchesWithoutEffect) {
  EXPECT_EQ(counts_of("uint x = 1u; if (i < 3u) x = 2u; v[i] = 1u;"), (Counts{8, 3, 8}));
}

TEST(BlockProbes, SeeNestedBranches) {
  EXPECT_EQ(counts_of("uint x = 1u; if (i < 6u) { if (i < 2u) x = 2u; } v[i] = x;"), (Counts{8, 6, 8, 2, 6}));
}

TEST(BlockProbes, SeeBranchesOnTheSameCondition) {
  EXPECT_EQ(counts_of("if (i < 3u) v[i] = 1u; if (i < 3u) v[i + 8u] = 2u;"), (Counts{8, 3, 8, 3, 8}));
}

TEST(BlockProbes, SeeStoresUnderConditions) {
  EXPECT_EQ(counts_of("if (i < 3u) v[i] = v[i] + 7u;"), (Counts{8, 3, 8}));
}

TEST(BlockProbes, SeeConstantConditions) {
  EXPECT_EQ(counts_of("const uint k = 4u; uint n = k; if (n == 5u) v[i] = 1u; else v[i] = 2u;"), (Counts{8, 0, 8, 8}));
}

// entry, header, body, merge, continue, condition
TEST(BlockProbes, SeeUnrolledLoops) {
  const Counts counts = counts_of("uint x = 0u; for (uint k = 0u; k < 3u; ++k) x += v[i + k]; v[i] = x;");
  EXPECT_EQ(counts, (Counts{8, 32, 24, 8, 24, 32}));
}

TEST(BlockProbes, SeeLoopsThatStay) {
  const Counts counts = counts_of("uint x = 0u; for (uint k = 0u; k < i; ++k) x += v[i + k]; v[i] = x;");
  EXPECT_EQ(counts, (Counts{8, 36, 28, 8, 28, 36}));
}

TEST(BlockProbes, SeeLoopsWithoutEffect) {
  const Counts counts = counts_of("uint x = 0u; for (uint k = 0u; k < i; ++k) x += 1u; v[i] = 3u;");
  EXPECT_EQ(counts, (Counts{8, 36, 28, 8, 28, 36}));
}

// entry, header, body, merge, continue, condition, then, what a loop that continues leaves out
TEST(BlockProbes, SeeWhatContinuesLeaveOut) {
  const Counts counts = counts_of(
      "uint x = 0u; for (uint k = 0u; k < i; ++k) { x += v[k]; if (x > 8u) { x += 5u; continue; } uint unused = x; }\n"
      "v[i + 8u] = x;");
  EXPECT_EQ(counts, (Counts{8, 36, 28, 8, 28, 36, 15, 13}));
}

// Twice: both ways through the inner branch come to what the continues leave out.
TEST(BlockProbes, SeeWhatNestedContinuesLeaveOut) {
  const Counts counts = counts_of(
      "uint x = 0u; for (uint k = 0u; k < i; ++k) { x += v[k];\n"
      "if (x < 8u) { x += 1u; if (x < 3u) continue; } uint unused = x; }\n"
      "v[i + 8u] = x;");
  EXPECT_EQ(counts, (Counts{8, 36, 28, 8, 28, 36, 13, 21, 7, 6}));
}

TEST(BlockProbes, SeeLoopsThatAreLeftEarly) {
  counts_of(
      "uint s = v[i], steps = 0u; int k0 = int(v[i]) & 7;\n"
      "do { ++steps; if (v[0] != v[2]) break; } while (--k0 > 0);\n"
      "switch (((v[3] <= v[4]) ? 16 : int(i)) & 3) { case 0: int k2 = 1; while (k2-- > 0) s = s + v[5]; }\n"
      "v[i] = s + steps;");
}

}  // namespace
}  // namespace vitrine::glass::test

// Debug information that lies: whatever it says, shaders compute what they compute, tools tell what they find, and
// reports are whole documents. Mutants of what glslang writes, and lies by hand.
#include <cstring>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>

#include "glass/lcov.h"
#include "glass/report/report.h"
#include "tests/glass/observed.h"

namespace vitrine::glass::test {
namespace {

using vitrine::test::DebugInfo;
using Words = std::vector<std::uint32_t>;

constexpr std::uint32_t kHeaderWords = 5;
// SPIR-V 3.52.
constexpr std::uint32_t kSourceContinued = 2, kSource = 3, kString = 7, kLine = 8, kImport = 11, kExtInst = 12;

/// An array that ends too early, calls in calls, a loop, branches, a variable that nobody writes.
constexpr const char* kShader = R"(#version 460
layout(local_size_x = 8) in;
layout(binding = 0) buffer B { uint v[]; };
uint inner(uint x) { uint sum; for (uint k = 0u; k < x; ++k) sum += v[k]; return sum; }
uint outer(uint x) {
  if ((x & 1u) != 0u) return inner(x) + 1u / (x - 1u);
  return inner(x + 1u);
}
void main() {
  uint i = gl_GlobalInvocationID.x;
  v[i + 60u] = outer(i);
  switch (i) { case 1u: v[8] = 3u; break; case 2u: v[9] = 4u; break; default: break; }
}
)";

Words compiled(DebugInfo debug) {
  std::string log;
  Words module =
      vitrine::test::compile_glsl(VK_SHADER_STAGE_COMPUTE_BIT, kShader, vitrine::test::VulkanVersion::k12, log, debug);
  EXPECT_FALSE(module.empty()) << log;
  return module;
}

/// Calls f(first word of an instruction, opcode, words).
template <class F>
void for_each_instruction(const Words& module, F&& f) {
  for (std::size_t at = kHeaderWords; at < module.size() && module[at] >> 16 != 0; at += module[at] >> 16)
    f(at, module[at] & 0xffffu, module[at] >> 16);
}

/// Words that say something of the source: all operands, but neither results nor types.
std::vector<std::size_t> debug_words(const Words& module) {
  std::vector<std::size_t> found;
  std::uint32_t set = 0;
  for_each_instruction(module, [&](std::size_t at, std::uint32_t op, std::uint32_t words) {
    if (op == kImport && std::memcmp(&module[at + 2], "NonSemantic.Shader", 18) == 0) set = module[at + 1];
    std::uint32_t first = words;
    if (op == kSource || op == kSourceContinued || op == kLine) first = 1;
    if (op == kString) first = 2;
    if (op == kExtInst && module[at + 3] == set) first = 4;
    for (; first < words; ++first) found.push_back(at + first);
  });
  return found;
}

struct Outcome {
  bool ran = false;
  std::string message;
  Words words;
  std::vector<Finding> findings;
};

Outcome run(Tool& tool, const Words& module) {
  Outcome outcome;
  outcome.words.assign(64, 5);
  spirv::CompileOptions options;
  options.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  spirv::SetLayoutInfo set;
  spirv::BindingInfo buffer;
  buffer.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  set.bindings = {buffer};
  options.sets = {set};
  options.observer = std::make_shared<ToolObserver>(tool, ShaderIdentity{options.stage, "main", module});
  const auto shader = spirv::compile(module, options);
  if (!shader) {
    outcome.message = shader.message();
    return outcome;
  }
  spirv::Descriptor descriptor;
  descriptor.data = reinterpret_cast<std::byte*>(outcome.words.data());
  descriptor.size = outcome.words.size() * 4;
  spirv::ResourceTable table;
  table.set[0] = &descriptor;
  table.set_size[0] = 1;
  spirv::Fault fault;
  const spirv::BoundShader bound(*shader.value(), table, fault);
  const std::uint32_t base[3] = {0, 0, 0}, counts[3] = {1, 1, 1};
  spirv::dispatch(bound, base, counts);
  outcome.ran = true;
  outcome.findings = tool.take_findings();
  return outcome;
}

struct ToolRow {
  const char* name;
  std::unique_ptr<Tool> (*make)();
};
constexpr ToolRow kTools[] = {{"sanitize", make_sanitize}, {"coverage", make_coverage}, {"count", make_count}};

/// A folder for what the tools write, while the test runs.
class LyingDebugInfo : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) / ("lies" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    setenv("VITRINE_COVERAGE", (folder_ / "a.info").c_str(), 1);
    setenv("VITRINE_COUNTS", (folder_ / "a.json").c_str(), 1);
    setenv("VITRINE_SOURCES", (folder_ / "sources").c_str(), 1);
    setenv("VITRINE_COUNT_LINES", "1", 1);
  }
  void TearDown() override {
    for (const char* name : {"VITRINE_COVERAGE", "VITRINE_COUNTS", "VITRINE_SOURCES", "VITRINE_COUNT_LINES"})
      unsetenv(name);
    std::filesystem::remove_all(folder_);
  }

  /// Runs the module with every tool. `expected`: what sanitize finds in honest ones, and what runs
  /// leave in memory.
  static void run_all(const Words& module, const Outcome& expected) {
    for (const ToolRow& row : kTools) {
      const auto tool = row.make();
      const Outcome outcome = run(*tool, module);
      if (!outcome.ran) {
        ADD_FAILURE() << "no reason to refuse a shader: " << row.name << ": " << outcome.message;
        continue;
      }
      EXPECT_EQ(outcome.words, expected.words) << row.name;
      for (const ReportFormat format : {ReportFormat::kText, ReportFormat::kJson, ReportFormat::kSarif}) {
        const std::string text = to_report(format, outcome.findings);
        const bool whole = format == ReportFormat::kText || nlohmann::json::accept(text);
        EXPECT_TRUE(whole) << text;
      }
      if (row.make == make_sanitize) {
        EXPECT_EQ(outcome.findings.size(), expected.findings.size()) << "lies hide no fault";
      }
      tool->write();
    }
  }

 private:
  std::filesystem::path folder_;
};

/// What sanitize finds where nobody lies.
Outcome honest(const Words& module) {
  const auto tool = make_sanitize();
  Outcome outcome = run(*tool, module);
  EXPECT_FALSE(outcome.findings.empty());
  return outcome;
}

TEST_F(LyingDebugInfo, MutantsRunAsTheOriginal) {
  std::mt19937 random(24);
  for (const DebugInfo debug : {DebugInfo::kLines, DebugInfo::kNonSemantic}) {
    const Words module = compiled(debug);
    const Outcome expected = honest(module);
    const std::vector<std::size_t> where = debug_words(module);
    ASSERT_GT(where.size(), 50u);
    const std::uint32_t values[] = {0, 1, ~0u, 0x7fffffffu, 0x80000000u, module[3], module[3] - 1, 0x0a0a0a0au};
    constexpr std::size_t kMutants = 80;
    for (std::size_t i = 0; i < kMutants; ++i) {
      Words mutant = module;
      for (std::size_t k = 0; k < 1 + i % 4; ++k) {
        std::uint32_t& word = mutant[where[random() % where.size()]];
        const std::uint32_t choice = random() % 16;
        word = choice < std::size(values) ? values[choice]
               : choice < 12              ? random() % module[3]
                                          : module[where[random() % where.size()]];
      }
      SCOPED_TRACE("mutant " + std::to_string(i));
      run_all(mutant, expected);
    }
  }
}

/// The argument of lies about the instruction's own number.
constexpr std::uint32_t kItsNumber = ~1u;

/// A lie: what it does to a module with NonSemantic.Shader.DebugInfo.100.
struct Lie {
  const char* name;
  std::uint32_t instruction;  ///< of the set, or 0: OpString
  std::uint32_t argument;
  std::function<std::uint32_t(const Words& module, std::size_t at)> word;
};

std::uint32_t itself(const Words& module, std::size_t at) { return module[at + 2]; }
std::uint32_t absurd(const Words&, std::size_t) { return ~0u; }
std::uint32_t nothing(const Words&, std::size_t) { return 0; }
std::uint32_t newlines(const Words&, std::size_t) { return 0x0a0a0a0au; }

// NonSemantic.Shader.DebugInfo.100: 20 DebugFunction, 21 DebugLexicalBlock, 23 DebugScope, 25 DebugInlinedAt, 35
// DebugSource, 101 DebugFunctionDefinition, 103 DebugLine.
const Lie kLies[] = {
    {"functions within themselves", 20, 5, itself},
    {"functions without a name", 20, 0, absurd},
    {"blocks within themselves", 21, 3, itself},
    {"blocks of no file", 21, 0, nothing},
    {"scopes that are not there", 23, 0, absurd},
    {"calls inlined into themselves", 25, 2, itself},
    {"sources without a file name", 35, 0, absurd},
    {"sources whose text is not there", 35, 1, absurd},
    {"sources that are their own text", 35, 1, itself},
    {"definitions of nothing", 101, 0, nothing},
    {"instructions that there are not", 101, kItsNumber, absurd},
    {"lines of no file", 103, 0, nothing},
    {"lines that are no numbers", 103, 1, absurd},
    {"names of newlines", 0, 0, newlines},
    {"names that are not UTF-8", 0, 0, absurd},
    {"names without an end", 0, ~0u, newlines},
};

TEST_F(LyingDebugInfo, OfEveryKindHidesNothing) {
  const Words module = compiled(DebugInfo::kNonSemantic);
  const Outcome expected = honest(module);
  for (const Lie& lie : kLies) {
    SCOPED_TRACE(lie.name);
    Words told = module;
    std::uint32_t set = 0;
    for_each_instruction(module, [&](std::size_t at, std::uint32_t op, std::uint32_t words) {
      if (op == kImport && std::memcmp(&module[at + 2], "NonSemantic.Shader", 18) == 0) set = module[at + 1];
      const bool here = lie.instruction == 0
                            ? op == kString
                            : op == kExtInst && module[at + 3] == set && module[at + 4] == lie.instruction;
      const std::uint32_t first = lie.instruction == 0 ? 2 : 5;
      const std::uint32_t word = lie.argument == ~0u          ? words - 1
                                 : lie.argument == kItsNumber ? 4
                                                              : first + lie.argument;
      if (here && word < words) told[at + word] = lie.word(module, at);
    });
    run_all(told, expected);
  }
}

TEST_F(LyingDebugInfo, NamesOfSeveralLinesLeaveTracefilesWhole) {
  Coverage coverage;
  coverage["a\nend_of_record\n"].lines[3] = 1;
  coverage["a\nend_of_record\n"].functions["f\nDA:7,7"].line = 3;
  const std::string text = to_lcov(coverage);
  EXPECT_NE(text.find("SF:a?end_of_record?\n"), std::string::npos) << text;
  EXPECT_NE(text.find("FN:3,f?DA:7,7\n"), std::string::npos) << text;
}

}  // namespace
}  // namespace vitrine::glass::test

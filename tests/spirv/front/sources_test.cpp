// What instructions know of their sources: lines, functions and calls, from every kind of debug information.
#include "spirv/front/sources.h"

#include <algorithm>
#include <random>
#include <set>

#include "spirv/exec/observe.h"
#include "spirv/front/translate.h"
#include "tests/spirv/compute_text.h"
#include "tests/spirv/front/glsl.h"

namespace vitrine::spirv::test {
namespace {

constexpr auto kCompute = VK_SHADER_STAGE_COMPUTE_BIT;

/// Calls f(instr) for every instruction in the order of the text.
template <class F>
void for_each_instr(const ir::NodeList& list, F&& f) {
  for (const auto& node : list) {
    if (node->kind == ir::Node::Kind::kInstr) f(node->instr);
    for (const ir::NodeList* child : {&node->then_list, &node->else_list, &node->body, &node->continuing})
      for_each_instr(*child, f);
  }
}

/// The places of all instructions with this operation, each as "line function < line function < ...".
std::vector<std::string> stacks_of(const ir::Function& function, ir::Op op) {
  std::vector<std::string> result;
  const SourceInfo& sources = *function.sources;
  for_each_instr(function.body, [&](const ir::Instr& instr) {
    if (instr.op != op) return;
    std::string text;
    for (std::uint32_t place = instr.origin.place; place != 0;) {
      const SourcePlace& at = sources.places[place];
      const SourceScope& scope = sources.scopes[at.scope];
      text += (text.empty() ? "" : " < ") + std::to_string(at.line) + ' ' + sources.functions[scope.function].name;
      place = scope.call;
    }
    result.push_back(text);
  });
  return result;
}

ir::Function translated(const Words& words, const exec::Interest& interest = {}) {
  base::Result<ir::Function> function = translate(words, options_for(kCompute), interest);
  if (!function) throw std::runtime_error(function.message());
  return function.take();
}

/// Two calls within each other, the outer one twice; the text's line 1 is the #version.
const char kCalls[] = R"(layout(local_size_x = 8) in;
layout(set = 0, binding = 0) buffer B { float v[]; } b;
float twice(float x) {
  return x * 2.0;
}
void put(uint i, float x) {
  b.v[i] = twice(x);
}
void main() {
  uint i = gl_GlobalInvocationID.x;
  put(i, b.v[i + 1]);
  if (i > 2)
    put(i + 2, 5.0);
}
)";

class SourcesOfGlsl : public testing::TestWithParam<DebugInfo> {};

TEST_P(SourcesOfGlsl, CallsAreStacked) {
  const ir::Function function = translated(compile_glsl(kCompute, kCalls, GetParam()));
  EXPECT_EQ(stacks_of(function, ir::Op::kFMul),
            (std::vector<std::string>{"5 twice < 8 put < 12 main", "5 twice < 8 put < 14 main"}));
  EXPECT_EQ(stacks_of(function, ir::Op::kStoreStorage),
            (std::vector<std::string>{"8 put < 12 main", "8 put < 14 main"}));
  EXPECT_EQ(stacks_of(function, ir::Op::kLoadStorage), (std::vector<std::string>{"12 main"}));
}

TEST_P(SourcesOfGlsl, FilesHaveTheirTextForObservers) {
  const Words words = compile_glsl(kCompute, kCalls, GetParam());
  const ir::Function observed = translated(words, {.blocks = true});
  ASSERT_EQ(observed.sources->files.size(), 2u);
  EXPECT_EQ(observed.sources->files[1].name, vitrine::test::kSourceName);
  EXPECT_EQ(observed.sources->files[1].text, std::string("#version 450\n") + kCalls);
  EXPECT_EQ(translated(words).sources->files[1].text, "");
}

TEST_P(SourcesOfGlsl, FunctionsKnowWhereTheyBegin) {
  const ir::Function function = translated(compile_glsl(kCompute, kCalls, GetParam()));
  std::set<std::pair<std::string, std::uint32_t>> functions;
  for (const SourceFunction& row : function.sources->functions) functions.emplace(row.name, row.line);
  EXPECT_EQ(functions,
            (std::set<std::pair<std::string, std::uint32_t>>{{"", 0}, {"twice", 4}, {"put", 7}, {"main", 10}}));
}

INSTANTIATE_TEST_SUITE_P(, SourcesOfGlsl, testing::Values(DebugInfo::kLines, DebugInfo::kNonSemantic),
                         [](const auto& info) { return info.param == DebugInfo::kLines ? "Lines" : "NonSemantic"; });

TEST(Sources, DisassemblyStandsInForThem) {
  const Words words = compile_glsl(kCompute, kCalls);
  const ir::Function observed = translated(words, {.blocks = true});
  ASSERT_EQ(observed.sources->files.size(), 2u);
  const SourceFile& file = observed.sources->files[1];
  EXPECT_EQ(file.name, "main.spvasm");
  std::vector<std::string> lines;
  for (std::size_t at = 0, end; at < file.text.size(); at = end + 1)
    lines.push_back(file.text.substr(at, (end = file.text.find('\n', at)) - at));
  std::size_t products = 0;
  for_each_instr(observed.body, [&](const ir::Instr& instr) {
    if (instr.op != ir::Op::kFMul) return;
    ++products;
    const SourcePlace& at = observed.sources->place(instr.origin.place);
    EXPECT_NE(lines.at(at.line - 1).find("%" + std::to_string(instr.origin.spirv_id) + " = OpFMul"), std::string::npos);
    EXPECT_EQ(observed.sources->functions[observed.sources->scopes[at.scope].function].name, "twice");
  });
  EXPECT_EQ(products, 2u);
  EXPECT_EQ(translated(words).sources->places.size(), 1u);
}

TEST(Sources, StringsOfSeveralLinesMoveTheDisassembly) {
  ComputeText module;
  module.annotations = "%text = OpString \"one\ntwo ; 0x00000014\nthree\"\n";
  module.body = load_word("%x", "in") + "%sum = OpIAdd %uint %x %n\n" + store_word("%sum", "out");
  const ir::Function function = translated(assemble(module.text()), {.blocks = true});
  const std::string& text = function.sources->files.at(1).text;
  for_each_instr(function.body, [&](const ir::Instr& instr) {
    if (instr.op != ir::Op::kIAdd) return;
    std::size_t at = 0;
    for (std::uint32_t i = 1; i < function.sources->place(instr.origin.place).line; ++i) at = text.find('\n', at) + 1;
    EXPECT_NE(text.substr(at, text.find('\n', at) - at).find("OpIAdd"), std::string::npos);
  });
}

/// A module with functions a (lines 10 and on) and main (20 and on) of debug information; the instructions to be placed
/// are one IAdd in main.
struct DebugText {
  std::string more;  ///< further debug instructions of the module
  std::string before =
      "%s = OpExtInst %void %d DebugScope %main_info\n"
      "%l = OpExtInst %void %d DebugLine %source %u21 %u21 %u3 %u3\n";

  ComputeText text() const {
    ComputeText module;
    module.capabilities =
        "OpExtension \"SPV_KHR_non_semantic_info\"\n%d = OpExtInstImport \"NonSemantic.Shader.DebugInfo.100\"\n";
    module.annotations =
        "%file = OpString \"a.hlsl\"\n%name_a = OpString \"a\"\n%name_main = OpString \"main_of_hlsl\"\n"
        "%part1 = OpString \"first \"\n%part2 = OpString \"second\"\n";
    for (const char* number : {"3", "4", "5", "10", "12", "20", "21", "22"})
      module.declarations += std::string("%u") + number + " = OpConstant %uint " + number + "\n";
    module.declarations += R"(%f7 = OpConstant %uint 4294967295
%source = OpExtInst %void %d DebugSource %file %part1
%more_text = OpExtInst %void %d DebugSourceContinued %part2
%unit = OpExtInst %void %d DebugCompilationUnit %u1 %u4 %source %u5
%fn_info = OpExtInst %void %d DebugTypeFunction %u3 %void
%a_info = OpExtInst %void %d DebugFunction %name_a %fn_info %source %u10 %u1 %unit %name_a %u3 %u10
%main_info = OpExtInst %void %d DebugFunction %name_main %fn_info %source %u20 %u1 %unit %name_main %u3 %u20
%block_info = OpExtInst %void %d DebugLexicalBlock %source %u12 %u1 %a_info
)" + more;
    module.body = load_word("%x", "in") + before + "%sum = OpIAdd %uint %x %n\n" + store_word("%sum", "out");
    return module;
  }

  std::vector<std::string> stacks(const exec::Interest& interest = {}) const {
    return stacks_of(translated(assemble(text().text()), interest), ir::Op::kIAdd);
  }
};

using Stacks = std::vector<std::string>;

TEST(DebugInfoOfModules, GivesLinesAndFunctions) {
  const DebugText text;
  EXPECT_EQ(text.stacks(), Stacks{"21 main_of_hlsl"});
  const ir::Function function = translated(assemble(text.text().text()), {.blocks = true});
  ASSERT_EQ(function.sources->files.size(), 2u);
  EXPECT_EQ(function.sources->files[1].name, "a.hlsl");
  EXPECT_EQ(function.sources->files[1].text, "first second");
  for_each_instr(function.body, [&](const ir::Instr& instr) {
    if (instr.op != ir::Op::kIAdd) return;
    EXPECT_EQ(function.sources->text(instr.origin.place), "a.hlsl:21:3");
  });
}

TEST(DebugInfoOfModules, InlinedCallsAreStacked) {
  DebugText text;
  text.more =
      "%outer = OpExtInst %void %d DebugInlinedAt %u22 %main_info\n"
      "%inner = OpExtInst %void %d DebugInlinedAt %u12 %block_info %outer\n";
  text.before =
      "%s = OpExtInst %void %d DebugScope %block_info %inner\n"
      "%l = OpExtInst %void %d DebugLine %source %u10 %u10 %u1 %u1\n";
  EXPECT_EQ(text.stacks(), Stacks{"10 a < 12 a < 22 main_of_hlsl"});
}

TEST(DebugInfoOfModules, ScopesAndLinesEnd) {
  DebugText text;
  const std::string before = text.before;
  text.before = before + "%ns = OpExtInst %void %d DebugNoScope\n";
  EXPECT_EQ(text.stacks(), Stacks{"21 main"});
  text.before = before + "%nl = OpExtInst %void %d DebugNoLine\n";
  EXPECT_EQ(text.stacks(), Stacks{""});
  text.before = before + "OpBranch %next\n%next = OpLabel\n";
  EXPECT_EQ(text.stacks(), Stacks{""});
}

TEST(DebugInfoOfModules, OtherSetsAreIgnored) {
  DebugText text;
  ComputeText module = text.text();
  module.capabilities = "OpExtension \"SPV_KHR_non_semantic_info\"\n%d = OpExtInstImport \"NonSemantic.Other\"\n";
  const std::string all = module.text();
  std::string numbered;  // the assembler knows no names of that set
  for (std::size_t at = 0; at < all.size();) {
    const std::size_t end = all.find('\n', at) + 1;
    const std::string line = all.substr(at, end - at);
    if (line.find("%void %d Debug") == std::string::npos) numbered += line;
    at = end;
  }
  EXPECT_EQ(stacks_of(translated(assemble(numbered)), ir::Op::kIAdd), Stacks{""});
}

TEST(DebugInfoOfModules, PhisBehindDebugInstructionsAreWritten) {
  ComputeText module = DebugText{}.text();
  module.body = load_word("%x", "in") + R"(%big = OpUGreaterThan %bool %x %u4
OpSelectionMerge %join None
OpBranchConditional %big %yes %join
%yes = OpLabel
OpBranch %join
%join = OpLabel
%s = OpExtInst %void %d DebugScope %main_info
%p = OpPhi %uint %u3 %entry %u4 %yes
)" + store_word("%p", "out");
  std::size_t yields = 0;
  for_each_instr(translated(assemble(module.text())).body,
                 [&](const ir::Instr& instr) { yields += instr.op == ir::Op::kYield && instr.src.size() == 1; });
  EXPECT_EQ(yields, 2u);
}

struct Lie {
  const char* more;
  const char* before;
  const char* stack;
};

constexpr char kLine[] = "%l = OpExtInst %void %d DebugLine %source %u10 %u10 %u1 %u1\n";

TEST(DebugInfoOfModules, LiesAreUnknownPlaces) {
  const Lie lies[] = {
      {"%at = OpExtInst %void %d DebugInlinedAt %u22 %main_info %at\n", "DebugScope %a_info %at",
       "10 a < 22 main_of_hlsl < 22 "},
      {"%at = OpExtInst %void %d DebugInlinedAt %u22 %main_info %to\n"
       "%to = OpExtInst %void %d DebugInlinedAt %u12 %block_info %at\n",
       "DebugScope %a_info %at", "10 a < 22 main_of_hlsl < 12 a < 22 "},
      {"", "DebugScope %unit", "10 main"},
      {"", "DebugScope %x", "10 main"},
      {"", "DebugScope %a_info %source", "10 a"},
      {"%ring = OpExtInst %void %d DebugLexicalBlock %source %u12 %u1 %ring\n", "DebugScope %ring", "10 main"},
      {"%at = OpExtInst %void %d DebugInlinedAt %main_info %u22\n", "DebugScope %a_info %at", "10 a < 0 "},
      {"", "DebugLine %source %f7 %u10 %u1 %u1", ""},
      {"", "DebugLine %source %x %u10 %u1 %u1", ""},
      {"", "DebugLine %x %u12 %u10 %u1 %u1", "12 main"},
  };
  for (const Lie& lie : lies) {
    DebugText text;
    text.more = lie.more;
    text.before = std::string(kLine) + "%s = OpExtInst %void %d " + lie.before + "\n";
    EXPECT_EQ(text.stacks(), Stacks{lie.stack}) << lie.more << lie.before;
  }
}

/// Chains of calls longer than any reader wants to see end.
TEST(DebugInfoOfModules, LongChainsAreCut) {
  DebugText text;
  constexpr int kCalls = 5000;
  for (int i = 0; i < kCalls; ++i)
    text.more += "%at" + std::to_string(i) + " = OpExtInst %void %d DebugInlinedAt %u12 %a_info" +
                 (i == 0 ? "" : " %at" + std::to_string(i - 1)) + "\n";
  text.before = kLine + ("%s = OpExtInst %void %d DebugScope %a_info %at" + std::to_string(kCalls - 1)) + "\n";
  const Stacks stacks = text.stacks();
  ASSERT_EQ(stacks.size(), 1u);
  EXPECT_EQ(std::count(stacks[0].begin(), stacks[0].end(), '<'), 64);
}

/// Every place, scope and file that the tables name exists, and calls end.
void expect_whole(const SourceInfo& sources) {
  for (const SourceScope& scope : sources.scopes) {
    ASSERT_LT(scope.function, sources.functions.size());
    ASSERT_LT(scope.call, sources.places.size());
  }
  for (const SourceFunction& function : sources.functions) ASSERT_LT(function.file, sources.files.size());
  for (const SourcePlace& place : sources.places) {
    ASSERT_LT(place.file, sources.files.size());
    ASSERT_LT(place.scope, sources.scopes.size());
    std::size_t calls = 0;
    for (std::uint32_t call = sources.scopes[place.scope].call; call != 0; ++calls) {
      ASSERT_LT(calls, 200u);
      call = sources.scopes[sources.places[call].scope].call;
    }
  }
}

/// Operands of debug instructions, word by word: other ids, and numbers that are none.
TEST(DebugInfoOfModules, AnyOperandIsSurvived) {
  const Words words = compile_glsl(kCompute, kCalls, DebugInfo::kNonSemantic);
  std::vector<std::size_t> operands;
  for (std::size_t at = 5; at < words.size(); at += words[at] >> 16) {
    const auto op = static_cast<spv::Op>(words[at] & 0xffff);
    const std::size_t first = op == spv::Op::OpExtInst ? 4 : op == spv::Op::OpLine ? 1 : words[at] >> 16;
    for (std::size_t i = first; i < words[at] >> 16; ++i) operands.push_back(at + i);
  }
  std::minstd_rand random(1);
  for (int run = 0; run < 2000; ++run) {
    Words damaged = words;
    for (int i = 0; i < 4; ++i)
      damaged[operands[random() % operands.size()]] =
          random() % 8 == 0 ? static_cast<std::uint32_t>(random()) : static_cast<std::uint32_t>(random() % words[3]);
    const base::Result<ir::Function> function = translate(damaged, options_for(kCompute), {.blocks = run % 2 == 0});
    ASSERT_TRUE(function) << function.message();
    expect_whole(*function.value().sources);
  }
}

}  // namespace
}  // namespace vitrine::spirv::test

// Sessions of the debugger by script: compute shaders.
#include <spirv-tools/libspirv.hpp>

#include "tests/glass/debug/sessions.h"

namespace vitrine::glass::debug::test {
namespace {

constexpr char kShader[] = R"(#version 450
layout(local_size_x = 8) in;
struct Pair { float first; vec3 rest; };
layout(std430, set = 0, binding = 0) buffer Data { uint data[]; };
shared uint cache[8];
float twice(float x, int n) {
  float r = x;
  for (int i = 0; i < n; ++i) {
    r += x;
  }
  return r;
}
void main() {
  uint i = gl_GlobalInvocationID.x;
  Pair p;
  p.first = float(data[i]);
  p.rest = vec3(1.0, 2.0, float(i));
  p.rest.y = 5.0;
  cache[gl_LocalInvocationID.x] = data[i];
  barrier();
  float values[4];
  for (int k = 0; k < 4; ++k) values[k] = float(k) * p.first;
  if (i > 3u) {
    p.first = twice(p.first, 2);
  }
  data[i] = uint(p.first + values[i & 3u]) + cache[7u - i % 8u];
}
)";

using test::session;
Session session(Lines lines) { return session(std::move(lines), kShader); }

TEST(Debugger, StopsAtALineAndShowsVariables) {
  const Session s = session({"break shader.glsl:19", "run", "print i", "print p.first", "print p", "print p.rest.zx",
                             "print i * 2u + 1u", "continue"});
  expect_in_order(s.text, {"breakpoint 1: shader.glsl:19", "breakpoint 1\ninvocation (0, 0, 0)",
                           "main at shader.glsl:19", "i = 0", "p.first = 10.0",
                           "p = {first = 10.0, rest = (1.0, 5.0, 0.0)}", "p.rest.zx = (0.0, 1.0)", "i * 2u + 1u = 1"});
}

TEST(Debugger, ChangesNoResult) {
  for (const DebugInfo info : {DebugInfo::kNone, DebugInfo::kLines, DebugInfo::kNonSemantic}) {
    const Session plain = session({}, kShader, info, 2);
    const Session stopped =
        session({"break main", "run", "step", "step", "step", "back", "back", "next", "continue"}, kShader, info, 2);
    EXPECT_EQ(plain.words, stopped.words);
  }
}

/// pow(x, 2.0) is a product in the shader that always runs alone.
constexpr char kPowers[] = R"(#version 450
layout(local_size_x = 8) in;
layout(std430, set = 0, binding = 0) buffer Data { uint data[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  float power = pow(float(data[i]) * 1.1, 2.0);
  data[i] = floatBitsToUint(power);
}
)";

TEST(Debugger, SaysWhatTheShaderComputesOtherwise) {
  const Session plain = session({}, kPowers);
  const Session shown = session({"break 7", "run", "print power", "continue"}, kPowers);
  EXPECT_EQ(plain.words, shown.words);
  expect_in_order(shown.text, {"power = ", "note: main as it always runs computes 0x",
                               "words of the wave of invocation "
                               "(0, 0, 0)"});
  const Session exact =
      session({"break 7", "run", "print power", "continue"}, kPowers, DebugInfo::kNonSemantic, 1, Shown::kExact);
  EXPECT_EQ(plain.words, exact.words);
  EXPECT_EQ(exact.text.find("note:"), std::string::npos) << exact.text;
  expect_in_order(exact.text, {"power = " + to_text(Scalar{'F', 32, plain.words[0]})});
}

TEST(Debugger, ShowsMemoryAsItWas) {
  // finish: newer compilers have a line for the return at the end.
  const Session s =
      session({"tbreak 26", "run", "print data[1]", "print cache[2]", "finish", "print data[1]", "tbreak 26",
               "reverse-continue", "print data[1]", "back", "back", "back", "print cache[2]", "tbreak 26", "continue"});
  expect_in_order(s.text, {"data[1] = 11", "cache[2] = 12", "has ended", "data[1] = 38", "main at shader.glsl:26",
                           "data[1] = 11", "cache[2] = 12"});
}

TEST(Debugger, ShowsMemoryOfEarlierWorkgroups) {
  const Session s = session(
      {"tbreak 19 if i == 8u", "run", "print cache[0]", "tbreak 26 if i == 0u", "reverse-continue", "print cache[0]",
       "print data[0]", "tbreak 20 if i == 8u", "continue", "print cache[0]", "print data[0]"},
      kShader, DebugInfo::kNonSemantic, 2);
  const Session plain = session({}, kShader, DebugInfo::kNonSemantic, 2);
  EXPECT_EQ(plain.words, s.words);
  expect_in_order(s.text, {"invocation (8, 0, 0)", "cache[0] = 0", "invocation (0, 0, 0)", "cache[0] = 10",
                           "data[0] = 10", "invocation (8, 0, 0)", "cache[0] = 18", "data[0] = 27"});
}

TEST(Debugger, StopsWhereAConditionHolds) {
  const Session s =
      session({"break 25 if i == 5u && p.first > 40.0", "run", "print i", "print p.first", "info breakpoints"});
  expect_in_order(s.text, {"invocation (5, 0, 0)", "i = 5", "p.first = 45.0", "hits: 1"});
}

TEST(Debugger, LeavesOutOperandsThatDecideNothing) {
  const Session s = session({"break 17", "run", "print i > 100u && p.rest.y > 1.0", "print i < 100u || p.rest.y > 1.0",
                             "print i < 100u && p.rest.y > 1.0", "print i < 100u && i < 99u"});
  expect_in_order(
      s.text, {"p.rest.y > 1.0 = false", "p.rest.y > 1.0 = true", "a value that nobody has written", "i < 99u = true"});
}

TEST(Debugger, StepsIntoOverAndOut) {
  const Session s = session({"break 24 if i == 6u", "run", "step", "print x", "backtrace", "next", "next", "next",
                             "print r", "finish", "step", "print p.first"});
  expect_in_order(s.text, {"main at shader.glsl:24", "twice at shader.glsl:7", "x = 16.0", "#0 twice at shader.glsl:7",
                           "#1 main at shader.glsl:24", "twice at shader.glsl:8", "twice at shader.glsl:9",
                           "twice at shader.glsl:8", "r = 32.0", "main at shader.glsl:24", "main at shader.glsl:26",
                           "p.first = 48.0"});
}

TEST(Debugger, GoesOverFunctions) {
  const Session s = session({"break 24 if i == 6u", "run", "next"});
  expect_in_order(s.text, {"main at shader.glsl:24", "main at shader.glsl:26"});
}

TEST(Debugger, GoesBack) {
  const Session s = session({"break 18", "break 26", "run", "print p.rest.y", "next", "print p.rest.y", "back",
                             "print p.rest.y", "back", "print p.rest", "reverse-continue", "continue", "continue"});
  expect_in_order(s.text,
                  {"main at shader.glsl:18", "p.rest.y = 2.0", "main at shader.glsl:19", "p.rest.y = 5.0",
                   "main at shader.glsl:18", "p.rest.y = 2.0", "main at shader.glsl:17", "<no value>", "not recorded",
                   "breakpoint 1", "main at shader.glsl:18", "breakpoint 2", "main at shader.glsl:26"});
}

TEST(Debugger, ShowsAllLanes) {
  const Session s = session({"break 26", "run", "print p.first @lanes", "info lanes", "lane 7", "print p.first"});
  expect_in_order(s.text, {"lane  invocation", "0     invocation (0, 0, 0)", "10.0", "7     invocation (7, 0, 0)",
                           "51.0", "* 0", "main at shader.glsl:26", "invocation (7, 0, 0), lane 7", "p.first = 51.0"});
}

TEST(Debugger, LooksAtMemory) {
  const Session s = session({"break 26", "run", "print data[3]", "print cache", "print values", "print data[99]"});
  expect_in_order(s.text, {"data[3] = 13", "cache = {10, 11, 12, 13, 14, 15, 16, 17}",
                           "values = {0.0, 10.0, 20.0, 30.0}", "index 99 is out of range: there are 64"});
}

TEST(Debugger, WatchesAndTellsWhoWrote) {
  const Session s = session({"break invocation 5,0,0", "run", "watch p.first", "continue", "continue", "print p.first",
                             "whowrote p.first", "whowrote p.rest.y"});
  expect_in_order(s.text,
                  {"breakpoint 1: invocation 5,0,0", "invocation (5, 0, 0)", "watch 2: p.first of invocation (5, 0, 0)",
                   "watch 2: p.first has changed", "watch 2: p.first has changed", "p.first = 45.0",
                   "p.first was written at shader.glsl:24", "p.rest.y was written at shader.glsl:18"});
}

TEST(Debugger, ShowsIdsWhereNothingIsNamed) {
  const std::string module = R"(OpCapability Shader
OpMemoryModel Logical GLSL450
OpEntryPoint GLCompute %1 "main"
OpExecutionMode %1 LocalSize 1 1 1
OpDecorate %8 BufferBlock
OpMemberDecorate %8 0 Offset 0
OpDecorate %9 DescriptorSet 0
OpDecorate %9 Binding 0
%2 = OpTypeVoid
%3 = OpTypeFunction %2
%4 = OpTypeInt 32 0
%5 = OpConstant %4 0
%6 = OpConstant %4 3
%8 = OpTypeStruct %4
%10 = OpTypePointer Uniform %8
%11 = OpTypePointer Uniform %4
%9 = OpVariable %10 Uniform
%1 = OpFunction %2 None %3
%12 = OpLabel
%13 = OpAccessChain %11 %9 %5
%14 = OpLoad %4 %13
%15 = OpIMul %4 %14 %6
OpStore %13 %15
OpReturn
OpFunctionEnd
)";
  ScriptedDebugger debugger(
      {"break main", "run", "step", "step", "print %14", "step", "print %15 + 1u", "back", "print %15"});
  std::vector<std::uint32_t> words{7, 0, 0, 0};
  std::vector<std::uint32_t> code;
  ASSERT_TRUE(spvtools::SpirvTools(SPV_ENV_UNIVERSAL_1_3)
                  .Assemble(module, &code, SPV_TEXT_TO_BINARY_OPTION_PRESERVE_NUMERIC_IDS));
  glass::test::run_observed(debugger.tool.get(), code, words, 1);
  EXPECT_EQ(words[0], 21u);
  expect_in_order(debugger.script.text(), {"main.spvasm:", "OpAccessChain", "OpLoad", "OpIMul", "%14 = 7", "OpStore",
                                           "%15 + 1u = 22", "OpIMul", "<no value>"});
}

TEST(Debugger, StopsAtDebugBreak) {
  const std::string module = R"(OpCapability Shader
OpExtension "SPV_KHR_non_semantic_info"
%20 = OpExtInstImport "NonSemantic.DebugBreak"
OpMemoryModel Logical GLSL450
OpEntryPoint GLCompute %1 "main"
OpExecutionMode %1 LocalSize 4 1 1
OpDecorate %8 BufferBlock
OpMemberDecorate %8 0 Offset 0
OpDecorate %9 DescriptorSet 0
OpDecorate %9 Binding 0
%2 = OpTypeVoid
%3 = OpTypeFunction %2
%4 = OpTypeInt 32 0
%5 = OpConstant %4 0
%6 = OpConstant %4 3
%8 = OpTypeStruct %4
%10 = OpTypePointer Uniform %8
%11 = OpTypePointer Uniform %4
%9 = OpVariable %10 Uniform
%1 = OpFunction %2 None %3
%12 = OpLabel
%13 = OpAccessChain %11 %9 %5
%14 = OpLoad %4 %13
%21 = OpExtInst %2 %20 1
%15 = OpIMul %4 %14 %6
OpStore %13 %15
OpReturn
OpFunctionEnd
)";
  ScriptedDebugger debugger({"run", "print %14", "print %15", "step", "step", "print %15", "reverse-continue"});
  std::vector<std::uint32_t> words{7, 0, 0, 0}, code;
  ASSERT_TRUE(spvtools::SpirvTools(SPV_ENV_UNIVERSAL_1_3)
                  .Assemble(module, &code, SPV_TEXT_TO_BINARY_OPTION_PRESERVE_NUMERIC_IDS));
  glass::test::run_observed(debugger.tool.get(), code, words, 1);
  EXPECT_EQ(words[0], 21u);
  expect_in_order(debugger.script.text(),
                  {"DebugBreak\n", "invocation (0, 0, 0)", "%14 = 7", "<no value>", "%15 = 21", "DebugBreak\n"});
}

TEST(Debugger, StopsInBranchesThatComputeNothing) {
  const Session s = session({"break 9", "run", "step", "print v", "step", "step", "print v"}, R"(#version 450
layout(local_size_x = 8) in;
layout(std430, set = 0, binding = 0) buffer Data { uint data[]; };
void main() {
  uint id = gl_LocalInvocationID.x;
  int v = 1;
  if (data[8] > 9u) {
    v = 2;
    if (data[8] > 9u && (id == id)) {
      v = 3;
    } else {
      v = int(id) + 2;
    }
    v = v + 5;
  }
  data[id] = 3;
}
)");
  expect_in_order(s.text, {"main at shader.glsl:9", "main at shader.glsl:10", "v = 2", "main at shader.glsl:14",
                           "main at shader.glsl:16", "v = 8"});
}

TEST(Debugger, KnowsWhoCallsBehindAChoice) {
  for (const DebugInfo info : {DebugInfo::kLines, DebugInfo::kNonSemantic}) {
    const Session s = session({"break 6 if x > 30u", "run", "backtrace"}, R"(#version 450
layout(local_size_x = 8) in;
layout(std430, set = 0, binding = 0) buffer Data { uint data[]; };
uint last;
uint keep(uint x) {
  last = x;
  return x + 1u;
}
void main() {
  uint i = gl_LocalInvocationID.x;
  uint v = keep(i > 3u ? data[i] * 3u : data[i + 1u] * 2u);
  data[i] = v + last;
}
)",
                              info);
    expect_in_order(s.text, {"#0 keep at shader.glsl:6", "#1 main at shader.glsl:11"});
  }
}

TEST(Debugger, KnowsWhatLoopsLeaveBehind) {
  const Session s = session({"break 12", "run", "print sum", "print last", "print early"}, R"(#version 450
layout(local_size_x = 1) in;
layout(std430, set = 0, binding = 0) buffer Data { uint data[]; };
void main() {
  uint sum = 0u, last = 9u, early = 0u;
  for (uint i = 0u; i < 4u; ++i) {
    last = i * 2u;
    if (i == 2u) early = sum + 100u;
    sum += data[i];
  }
  uint kept = sum;
  data[0] = kept;
}
)");
  expect_in_order(s.text, {"main at shader.glsl:12", "sum = 46", "last = 6", "early = 121"});
}

TEST(Debugger, StopsAtMessages) {
  const Session s = session({"catch printf", "info breakpoints", "run", "print i", "back", "continue", "catch nothing"},
                            R"(#version 450
#extension GL_EXT_debug_printf : require
layout(local_size_x = 8) in;
layout(std430, set = 0, binding = 0) buffer Data { uint data[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i > 2u && i < 5u)
    debugPrintfEXT("i is %u", i);
  data[i] = i;
}
)");
  expect_in_order(s.text, {"caught: printf", "catch printf", "printf: i is 3", "invocation (3, 0, 0)",
                           "main at shader.glsl:8", "i = 3", "main at shader.glsl:7"});
  EXPECT_EQ(s.words[3], 3u);
}

TEST(Debugger, StopsWhereNaNsAreMade) {
  const Session s = session({"catch nan", "run", "print x", "catch nothing", "next", "print y"}, R"(#version 450
layout(local_size_x = 8) in;
layout(std430, set = 0, binding = 0) buffer Data { uint data[]; };
void main() {
  float x = uintBitsToFloat(data[gl_LocalInvocationID.x] / 15u);
  float y = uintBitsToFloat(0x7fc00000u) + 1.0;
  y = x * (1.0 / x);
  data[gl_LocalInvocationID.x] = floatBitsToUint(y);
}
)");
  expect_in_order(s.text, {"caught: nan", "nan: NaN made of 0", "invocation (0, 0, 0)", "main at shader.glsl:7",
                           "x = 0.0", "nothing is caught", "y = -nan"});
}

TEST(Debugger, ForgetsWhatIsTooOld) {
  const Session s =
      session({"break 12", "run", "print sum", "reverse-continue", "print sum", "step", "step"}, R"(#version 450
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) buffer Data { uint data[]; };
void main() {
  uint sum = 0u;
  uint i = 0u;
  while (i < 200000u + data[0]) {
    sum += i;
    ++i;
  }
  uint kept = sum;
  data[gl_LocalInvocationID.x] = kept;
}
)");
  expect_in_order(s.text, {"main at shader.glsl:12", "sum = ", "what was before is not recorded",
                           "sum = ", "main at shader.glsl:"});
}

TEST(Debugger, GoesBackOverAMillionInvocations) {
  const Session s = session({"break 8 if i == 0u", "break 8 if i == 999999u", "run", "continue", "print b",
                             "reverse-continue", "print i", "print b", "print a"},
                            R"(#version 450
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) buffer Data { uint data[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  float a = float(i) * 0.5;
  vec4 b = vec4(a, a + 1.0, a * a, 2.0);
  data[i & 63u] = uint(b.x);
}
)",
                            DebugInfo::kNonSemantic, 15625);
  expect_in_order(s.text, {"breakpoint 1", "breakpoint 2", "invocation (999999, 0, 0)", "b = (499999.5", "breakpoint 1",
                           "invocation (0, 0, 0)", "i = 0", "b = (0.0, 1.0, 0.0, 2.0)", "a = 0.0"});
  EXPECT_EQ(s.words[63], 499999u);
}

TEST(WordLog, HoldsWhatItWasGiven) {
  std::vector<std::uint32_t> words;
  for (std::uint32_t i = 0; i < 300; ++i) {
    words.insert(words.end(), i % 7, i);
    words.push_back(words.size() % 3 == 0 ? 1 : i * i);
  }
  const std::vector<std::uint32_t> packed = pack_words(words);
  EXPECT_LT(packed.size(), words.size());
  EXPECT_EQ(unpack_words(packed), words);
  EXPECT_TRUE(pack_words({}).empty() && unpack_words({}).empty());
  WordLog log;
  log.append(1000, 5);
  const std::size_t before = log.bytes();
  log.pack();
  EXPECT_LT(log.bytes(), before / 100);
  log.push_back(6);
  EXPECT_EQ(log[999], 5u);
  EXPECT_EQ(log[1000], 6u);
  log.pack();
  log.clear();
  EXPECT_EQ(log.size(), 0u);
}

TEST(Debugger, BadCommandsAreAnswered) {
  const Session s = session({"nonsense", "break",     "break pixel 1", "print x",       "back",      "step",
                             "print",    "print )",   "print i +",     "print nobody",  "print 1/0", "lane 99",
                             "frame 7",  "up",        "down",          "delete 9",      "watch 3",   "whowrote data[0]",
                             "list x",   "info what", "print i[3]",    "print p.nobody"});
  expect_in_order(s.text, {"is no command", "where?", "numbers are wanted", "nothing has run yet",
                           "nothing has run yet", "is missing", "no variable 'nobody'", "not defined", "no lane '99'",
                           "no frame", "no breakpoint '9'", "is no variable and no memory"});
}

}  // namespace
}  // namespace vitrine::glass::debug::test

// What a person changes in a stopped shader, memory that is watched, and what other tools find.
#include "tests/glass/debug/sessions.h"

namespace vitrine::glass::debug::test {
namespace {

constexpr char kSums[] = R"(#version 450
layout(local_size_x = 8) in;
layout(std430, set = 0, binding = 0) buffer Data { uint data[]; };
shared uint cache[8];
struct Pair { float first; uvec3 rest; };
uint twice(uint x) {
  uint y = x;
  y += x;
  return y;
}
void main() {
  uint i = gl_GlobalInvocationID.x;
  uint sum = data[i];
  Pair p;
  p.first = 1.5;
  p.rest = uvec3(1u, 2u, i);
  cache[gl_LocalInvocationID.x] = sum;
  barrier();
  for (uint k = 0u; k < 3u; ++k) {
    sum += k;
  }
  uint t = twice(sum);
  data[i] = t + cache[7u - gl_LocalInvocationID.x] + p.rest.y;
}
)";

TEST(DebuggerChanges, GoOnWithAnotherValue) {
  const Session plain = session({}, kSums);
  const Session changed = session({"break 20 if i == 3u && k == 1u", "run", "set sum = 1000", "print sum", "delete",
                                   "break 8 if x == 1003u", "continue", "print x", "delete", "continue"},
                                  kSums);
  expect_in_order(changed.text,
                  {"invocation (3, 0, 0)", "sum = 1000", "this run is another one", "sum = 1000", "x = 1003"});
  for (std::size_t i = 0; i < plain.words.size(); ++i) {
    if (i == 3)
      EXPECT_EQ(changed.words[i], 2 * 1003u + 14 + 2);
    else
      EXPECT_EQ(changed.words[i], plain.words[i]) << i;
  }
}

TEST(DebuggerChanges, AreTakenBackAndDoneAgain) {
  const Session s = session({"tbreak 20 if i == 3u", "run", "set sum = 1000", "step", "back", "back", "print sum",
                             "set sum = 5", "step", "step", "print sum", "whowrote p.first", "whowrote t"},
                            kSums);
  expect_in_order(s.text, {"sum = 1000", "main at shader.glsl:19", "sum = 13", "this has been done already",
                           "sum = 1000", "p.first was written at shader.glsl:15", "nothing that is recorded"});
}

TEST(DebuggerChanges, OfPartsControlFlowAndMemory) {
  const Session s =
      session({"tbreak 19 if i == 2u", "run", "set p.rest.y = 50u", "set p.rest.xz = 1", "set p.rest = uvec3(7, 60, 9)",
               "print p.rest", "set cache[5] = 400", "print cache[5]", "whowrote cache[5]", "whowrote cache[4]",
               "set data[2] = 9", "print data[2]", "tbreak 20 if i == 2u", "continue", "set k = 7", "continue"},
              kSums);
  expect_in_order(s.text, {"p.rest.y = 50", "is no variable and no memory", "p.rest = (7, 60, 9)", "cache[5] = 400",
                           "cache[5] = 400", "cache[5] was set at the prompt",
                           "cache[4] was written at shader.glsl:17 by invocation (4, 0, 0)", "data[2] = 9", "k = 7"});
  // k = 7 ends the loop behind the first turn.
  EXPECT_EQ(s.words[2], 2 * (12u + 7) + 400 + 60);
  EXPECT_EQ(s.words[3], 2 * (13u + 3) + 14 + 2);
}

TEST(DebuggerChanges, AreRefusedWithAReason) {
  const Session s =
      session({"set i = 3", "break 14", "run", "set nobody = 3", "set sum", "set sum == 3", "set sum + 1 = 3",
               "set p = 3", "set sum = uvec2(1)", "set sum = t", "set gl_GlobalInvocationID = uvec3(0)"},
              kSums);
  expect_in_order(
      s.text, {"nothing has run yet", "no variable 'nobody'", "set VARIABLE = EXPRESSION", "set VARIABLE = EXPRESSION",
               "is no variable and no memory", "can be set", "can be set", "nobody has written", "inputs"});
  const Session exact =
      session({"break 14", "run", "set sum = 3", "watch data[3]"}, kSums, DebugInfo::kNonSemantic, 1, Shown::kExact);
  expect_in_order(exact.text, {"as it always runs: its variables cannot be changed", "--exact"});
}

/// A person's change reaches all that follows: other waves, other workgroups.
TEST(DebuggerChanges, ReachOtherInvocationsThroughMemory) {
  const std::string shader = R"(#version 450
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) buffer Data { uint data[]; };
void main() {
  uint g = gl_WorkGroupID.x;
  if (gl_LocalInvocationID.x == 0u)
    data[g + 1u] = data[g] + 1u;
})";
  EXPECT_EQ(session({}, shader, DebugInfo::kNonSemantic, 4).words[4], 14u);
  EXPECT_EQ(session({"tbreak 7 if g == 1u", "run", "set data[1] = 100", "continue"}, shader, DebugInfo::kNonSemantic, 4)
                .words[4],
            103u);
}

constexpr char kWhole[] = R"(#version 450
layout(local_size_x = 8) in;
struct Pair { float first; uvec3 rest; };
struct Both { Pair pair[2]; mat2 m; bool flag; };
layout(std430, set = 0, binding = 0) buffer Data { uint data[8]; Pair pairs[2]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  uint list[4] = uint[4](1u, 2u, 3u, i);
  Both both;
  both.pair[0] = Pair(1.5, uvec3(1u, 2u, i));
  both.pair[1] = Pair(2.5, uvec3(4u, 5u, 6u));
  both.m = mat2(1.0, 2.0, 3.0, 4.0);
  both.flag = false;
  Pair other = Pair(7.0, uvec3(7u, 8u, 9u));
  data[i] = list[0] + list[3] * 10u + both.pair[1].rest.z * 100u + uint(both.m[1].y) * 1000u;
  if (both.flag) data[i] += 100000u;
  if (i == 2u) data[7] = other.rest.x + uint(other.first) * 10u;
}
)";

TEST(DebuggerChanges, OfWholeArraysStructuresAndMatrices) {
  const Session s = session({"tbreak 15 if i == 2u",
                             "run",
                             "set list = {9, 8, 7, 6}",
                             "set both.m = {{5, 6}, {7, 8}}",
                             "set both.m = {1, 2, 3, 9}",
                             "print both.m[1].y",
                             "set both.pair[1] = {4.25, {10, 11, 12}}",
                             "set both.pair[0] = both.pair[1]",
                             "set both.pair = {{first = 3}, {rest = (7, 7, 3), first = 1}}",
                             "print both.pair",
                             "set other = both.pair[1]",
                             "set both.flag = true",
                             "set pairs[1] = other",
                             "set pairs = {{1, {1, 1, 1}}, pairs[1]}",
                             "print pairs",
                             "set data = data",
                             "print {1, list}",
                             "back",
                             "print list",
                             "next",
                             "print list",
                             "continue"},
                            kWhole);
  expect_in_order(
      s.text,
      {"list = {9, 8, 7, 6}", "both.m = {(5.0, 6.0), (7.0, 8.0)}", "both.m = {(1.0, 2.0), (3.0, 9.0)}",
       "both.m[1].y = 9.0", "both.pair[1] = {first = 4.25, rest = (10, 11, 12)}",
       "both.pair[0] = {first = 4.25, rest = (10, 11, 12)}",
       "both.pair = {{first = 3.0, rest = (10, 11, 12)}, {first = 1.0, rest = (7, 7, 3)}}",
       "other = {first = 1.0, rest = (7, 7, 3)}", "both.flag = true", "pairs[1] = {first = 1.0, rest = (7, 7, 3)}",
       "pairs = {{first = 1.0, rest = (1, 1, 1)}, {first = 1.0, rest = (7, 7, 3)}}", "data = {",
       "{1, list} = {1, {9, 8, 7, 6}}", "list = {1, 2, 3, 2}", "list = {9, 8, 7, 6}"});
  EXPECT_EQ(s.words[2], 9 + 6 * 10 + 3 * 100 + 9 * 1000 + 100000u);
  EXPECT_EQ(s.words[7], 7 + 10u);
  EXPECT_EQ(s.words[3], 1 + 3 * 10 + 6 * 100 + 4 * 1000u);
  // pairs[1], at 8 words and two vectors.
  EXPECT_EQ(s.words[20], 7u);
}

TEST(DebuggerChanges, OfWholesAreRefusedWithAReason) {
  const Session s =
      session({"tbreak 15 if i == 2u", "run", "set list = {1, 2}", "set list = 3", "set list = other", "set both = {1}",
               "set both = {{1, 2}, 2}", "set other = {second = 1}", "set other = {first = 1, 2}",
               "set other = {1, {2, 3}}", "set other = {1, 2", "set other = both.pair", "print list", "print other"},
              kWhole);
  expect_in_order(s.text, {"can be set to {a, b} with what its parts get, or to 4 numbers", "or to 4 numbers",
                           "can be set to what has the same parts", "or to 13 numbers", "Both has 3 parts, not 2",
                           "there is no member 'second'", "some members have no names", "as many numbers or to one",
                           "'}' is missing", "can be set to what has the same parts", "list = {1, 2, 3, 2}",
                           "other = {first = 7.0, rest = (7, 8, 9)}"});
}

constexpr char kWidths[] = R"(#version 450
#extension GL_EXT_shader_explicit_arithmetic_types : require
layout(local_size_x = 4) in;
layout(std430, set = 0, binding = 0) buffer Data {
  uint data[8];
  uint8_t bytes[8];
  int16_t shorts[4];
  f16vec2 halves[2];
  int64_t longs[2];
  double real;
};
void main() {
  uint i = gl_GlobalInvocationID.x;
  int8_t a = int8_t(-3);
  uint16_t b = uint16_t(65535u);
  float16_t c = float16_t(1.5);
  uint64_t d = 0x123456789abcdef0ul;
  double e = 0.1lf;
  dvec3 f = dvec3(1.0lf, 2.0lf, 3.0lf);
  i64vec2 g = i64vec2(-1l, 5l);
  u8vec4 h = u8vec4(1, 2, 3, 255);
  bool k = i > 1u;
  bytes[i] = uint8_t(h.w);
  shorts[i] = int16_t(a);
  if (i < 2u) longs[i] = g.x + int64_t(d >> 8);
  if (i == 0u) halves[1] = f16vec2(c, c);
  if (i == 3u) real = e + f.y + f.z;
  data[i] = k ? uint(b) : 7u;
})";

TEST(DebuggerWidths, AreShownSetAndWatched) {
  const Session s = session({"tbreak 23 if i == 0u",
                             "run",
                             "print a",
                             "print b",
                             "print c",
                             "print d",
                             "print e",
                             "print f",
                             "print g",
                             "print h",
                             "print a + 1",
                             "print d >> 60",
                             "watch bytes[2]",
                             "watch shorts[3]",
                             "watch longs[1]",
                             "watch halves[1]",
                             "watch real",
                             "set g.x = -256",
                             "print g",
                             "lane 3",
                             "set f.z = 30.25",
                             "set e = 0.5",
                             "print f",
                             "set h.w = 200",
                             "set h.x = 300",
                             "print h",
                             "set a = 300",
                             "print a",
                             "set k = false",
                             "print k",
                             "set b = 70000",
                             "print b",
                             "set c = 0.1",
                             "print c",
                             "set d = 1",
                             "continue",
                             "print bytes[2]",
                             "whowrote bytes[2]",
                             "continue",
                             "continue",
                             "continue",
                             "print halves",
                             "continue",
                             "print real",
                             "whowrote real",
                             "set real = -1.25",
                             "print real"},
                            kWidths);
  expect_in_order(s.text, {"a = -3\n",
                           "b = 65535\n",
                           "c = 1.5\n",
                           "d = 1311768467463790320\n",
                           "e = 0.1\n",
                           "f = (1.0, 2.0, 3.0)\n",
                           "g = (-1, 5)\n",
                           "h = (1, 2, 3, 255)\n",
                           "a + 1 = -2\n",
                           "d >> 60 = 1\n",
                           "watch 2: bytes[2]",
                           "g = (-256, 5)",
                           "f = (1.0, 2.0, 30.25)",
                           "h = (44, 2, 3, 200)",
                           "a = 44",
                           "k = false",
                           "b = 4464",
                           "c = 0.0999755",
                           "watch 2: bytes[2] has changed",
                           "-> 255",
                           "bytes[2] = 255",
                           "bytes[2] was written at shader.glsl:23 by invocation (2, 0, 0)",
                           "watch 3: shorts[3] has changed",
                           "-> 44",
                           "watch 4: longs[1] has changed",
                           "watch 5: halves[1] has changed",
                           "halves = {",
                           "(1.5, 1.5)}",
                           "watch 6: real has changed",
                           "-> 32.75",
                           "real = 32.75",
                           "real was written at shader.glsl:27 by invocation (3, 0, 0)",
                           "real = -1.25"});
  // Lane 3: k is false, the seventh word is that of the real number behind all.
  EXPECT_EQ(s.words[3], 7u);
}

TEST(DebuggerMemory, StopsWhereItChanges) {
  const Session s = session(
      {"break 13 if i == 0u", "run", "delete", "watch data[3]", "watch cache[2]", "watch data[60]", "info breakpoints",
       "continue", "print cache[2]", "continue", "print data[3]", "whowrote data[3]", "reverse-continue",
       "print cache[2]", "print data[3]", "reverse-continue", "continue", "continue", "continue"},
      kSums);
  expect_in_order(
      s.text,
      {"watch 2: data[3]\n", "watch 3: cache[2]\n", "watch 4: data[60]", "watch cache[2]",
       "watch 3: cache[2] has changed: 0 -> 12", "invocation (2, 0, 0), lane 2", "main at shader.glsl:17",
       "cache[2] = 12", "watch 2: data[3] has changed: 13 -> 48", "invocation (3, 0, 0), lane 3",
       "main at shader.glsl:23", "data[3] = 48", "data[3] was written at shader.glsl:23 by invocation (3, 0, 0)",
       "watch 3: cache[2] has changed", "cache[2] = 12", "data[3] = 13", "not recorded", "watch 3", "watch 2"});
}

/// Whatever the host or a command writes between shaders, and behind the last one.
TEST(DebuggerMemory, IsChangedByOthersThanShaders) {
  std::string log;
  const auto module = vitrine::test::compile_glsl(VK_SHADER_STAGE_COMPUTE_BIT, kSums, vitrine::test::VulkanVersion::k12,
                                                  log, DebugInfo::kNonSemantic);
  ScriptedDebugger debugger({"break 13 if i == 0u", "run", "delete", "watch data[60]", "continue", "continue"});
  std::vector<std::uint32_t> words(64, 10);
  glass::test::run_observed(debugger.tool.get(), module, words, 1);
  debugger.tool->commands_done(nullptr);
  EXPECT_EQ(debugger.script.text().find("has changed"), std::string::npos) << debugger.script.text();
  words[60] = 77;
  glass::test::run_observed(debugger.tool.get(), module, words, 1);
  debugger.tool->commands_done(nullptr);
  expect_in_order(debugger.script.text(),
                  {"watch 2: data[60]", "watch 2: data[60] has changed, by no shader", "invocation (0, 0, 0), lane 0"});
  const std::size_t said = debugger.script.text().size();
  words[60] = 78;
  debugger.tool->commands_done(nullptr);
  expect_in_order(debugger.script.text().substr(said), {"watch 2: data[60] has changed, by no shader"});
}

TEST(DebuggerMemory, SeesWorkgroups) {
  const Session s = session({"break 19 if i == 8u", "run", "whowrote cache[1]", "whowrote data[2]", "whowrote data[9]",
                             "delete", "watch cache[0]", "continue"},
                            kSums, DebugInfo::kNonSemantic, 3);
  expect_in_order(s.text, {"cache[1] was written at shader.glsl:17 by invocation (9, 0, 0)",
                           "data[2] was written at shader.glsl:23 by invocation (2, 0, 0)",
                           "nothing that is recorded has written data[9]", "watch 2: cache[0]",
                           "watch 2: cache[0] has changed", "invocation (16, 0, 0)"});
}

TEST(DebuggerFindings, StopAtTheLine) {
  const Session s = session({"catch finding", "run", "print j", "info locals", "back", "continue"}, R"(#version 450
layout(local_size_x = 8) in;
layout(std430, set = 0, binding = 0) buffer Data { uint data[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  uint j = i * 20u;
  uint shift = i + 26u;
  data[i] = data[j];
  data[i] += 1u << shift;
})");
  expect_in_order(s.text, {"caught: finding", "finding: ", "[vitrine/shift-too-far]", "invocation (6, 0, 0), lane 6",
                           "main at shader.glsl:9"});
}

TEST(DebuggerFindings, AreRacesToo) {
  const Session s = session({"catch findings", "run", "print l", "print cache[1]", "back", "continue"}, R"(#version 450
layout(local_size_x = 8) in;
layout(std430, set = 0, binding = 0) buffer Data { uint data[]; };
shared uint cache[8];
void main() {
  uint l = gl_LocalInvocationID.x;
  cache[l] = data[l];
  uint other = cache[(l + 1u) % 8u];
  data[l] = other;
})");
  expect_in_order(s.text, {"finding: ", "[vitrine/race-shared]", "missing: barrier();", "main at shader.glsl:8",
                           "l = ", "cache[1] = 11", "main at shader.glsl:7"});
}

TEST(DebuggerFindings, NothingIsFoundInRightShaders) {
  const Session s = session({"catch finding", "run"}, kSums, DebugInfo::kNonSemantic, 3);
  EXPECT_EQ(s.text.find("finding: "), std::string::npos) << s.text;
  EXPECT_EQ(s.words, session({}, kSums, DebugInfo::kNonSemantic, 3).words);
}

/// Thirteen thousand values: too many for a rehearsal, not for the shader itself.
TEST(Debugger, ShowsTheShaderThatAlwaysRunsWhereLinesTakeTooMuch) {
  const Session s = session({"break 10", "run", "print i", "set i = 3", "continue"}, R"(#version 450
layout(local_size_x = 2) in;
layout(std430, set = 0, binding = 0) buffer Data { uint data[64]; uint x[2][4500]; uint y[2][4500]; uint z[2][4500]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  uint l = gl_LocalInvocationID.x & 1u;
  uint a[4500] = x[l], b[4500] = y[l], c[4500] = z[l];

  x[l] = b; y[l] = c; z[l] = a;
  data[i] = 5u;
})");
  expect_in_order(s.text,
                  {"note: main is shown as it always runs: line by line it keeps more values than there is room for",
                   "main at shader.glsl:10", "i = 0", "as it always runs: its variables cannot be changed"});
  EXPECT_EQ(s.words[0], 5u);
}

}  // namespace
}  // namespace vitrine::glass::debug::test

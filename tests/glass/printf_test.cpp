// What shaders say with debugPrintfEXT.
#include <filesystem>
#include <fstream>

#include "glass/printf_output.h"
#include "tests/glass/observed.h"

namespace vitrine::glass::test {
namespace {

std::vector<std::string> said(const std::string& body, std::uint32_t groups = 1, std::uint32_t size = 4) {
  const auto tool = make_printf();
  std::vector<std::uint32_t> words(256);
  for (std::uint32_t i = 0; i < words.size(); ++i) words[i] = i;
  run_observed(tool.get(),
               R"(#version 460
#extension GL_EXT_debug_printf : require
layout(local_size_x = )" +
                   std::to_string(size) + R"() in;
layout(set = 0, binding = 0) buffer B { uint v[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
)" + body + "}\n",
               words, groups);
  std::vector<std::string> texts;
  for (const Finding& finding : tool->take_findings()) texts.push_back(finding.message);
  return texts;
}

using Texts = std::vector<std::string>;

TEST(Printf, SaysEveryKindOfNumber) {
  EXPECT_EQ(
      said("if (i == 2) debugPrintfEXT(\"i %u x %x f %1.2f d %d %% e\", i, v[i] + 253u, float(i) * 1.25, -int(i));"),
      Texts{"i 2 x ff f 2.50 d -2 % e"});
}

TEST(Printf, SaysVectors) {
  EXPECT_EQ(said("if (i == 1) debugPrintfEXT(\"%1.1v3f|%v2d|%v4u\", vec3(i, 2, 3.5), ivec2(-1, i), uvec4(i));"),
            Texts{"1.0, 2.0, 3.5|-1, 1|1, 1, 1, 1"});
}

TEST(Printf, SaysInTheOrderOfInvocations) {
  EXPECT_EQ(said("debugPrintfEXT(\"a%u\", i); debugPrintfEXT(\"b%u\", i);", 2, 2),
            (Texts{"a0", "b0", "a1", "b1", "a2", "b2", "a3", "b3"}));
}

TEST(Printf, SaysWhatOnlyTheMessageComputes) {
  EXPECT_EQ(said("if (i == 3) debugPrintfEXT(\"%f\", dot(vec3(i, 1, 2), vec3(v[i])));"), Texts{"18.000000"});
}

TEST(Printf, SaysInBranchesThatBecomeSelections) {
  EXPECT_EQ(said("uint x = 7u; if (i < 2u) { x = i; debugPrintfEXT(\"low %u\", x); } else { debugPrintfEXT(\"high "
                 "%u\", i); }\n"
                 "v[i] = x;"),
            (Texts{"low 0", "low 1", "high 2", "high 3"}));
}

TEST(Printf, SaysInUnrolledLoops) {
  EXPECT_EQ(said("for (uint k = 0u; k < 3u; ++k) if (i == k) debugPrintfEXT(\"%u of %u\", k, i);"),
            (Texts{"0 of 0", "1 of 1", "2 of 2"}));
}

TEST(Printf, SaysWhatUnrolledLoopsLeaveBehind) {
  EXPECT_EQ(
      said("uint r = v[i]; if (i > 2u) { for (uint k = 0u; k < 2u; ++k) r += v[i]; debugPrintfEXT(\"r %u\", r); }\n"
           "v[i] = r;"),
      Texts{"r 9"});
}

TEST(Printf, SaysInLoopsThatStay) {
  EXPECT_EQ(said("for (uint k = 0u; k < v[i]; ++k) debugPrintfEXT(\"%u/%u\", k, i);", 1, 3),
            (Texts{"0/1", "0/2", "1/2"}));
}

TEST(Printf, SaysInFunctionsThatLeaveEarly) {
  EXPECT_EQ(
      said("for (uint k = 0u; k < 100u; ++k) { if (v[i] + k > 4u) { debugPrintfEXT(\"out %u %u\", i, k); break; } }", 1,
           2),
      (Texts{"out 0 5", "out 1 4"}));
}

TEST(Printf, AssertionsAreErrors) {
  const auto tool = make_printf();
  std::vector<std::uint32_t> words(64);
  run_observed(tool.get(), R"(#version 460
#extension GL_EXT_debug_printf : require
layout(local_size_x = 4) in;
layout(set = 0, binding = 0) buffer B { uint v[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  debugPrintfEXT("no assertion failed");
  if (i > 2u) debugPrintfEXT("assertion failed: %u is small", i);
  v[i] = 3u;
})",
               words, 1);
  const std::vector<Finding> findings = tool->take_findings();
  ASSERT_EQ(findings.size(), 5u);
  EXPECT_EQ(findings[0].rule, &rule("printf"));
  EXPECT_EQ(findings[4].rule, &rule("assertion"));
  EXPECT_EQ(findings[4].message, "assertion failed: 3 is small");
  EXPECT_EQ(words[3], 3u) << "the shader goes on";
}

TEST(Printf, FilterNamesInvocations) {
  const PrintfFilter all(""), some("compute:5,0,0;vertex:3 fragment:1,2;vertex:4,1"), nobody("compute:x");
  EXPECT_TRUE(all.wants(VK_SHADER_STAGE_GEOMETRY_BIT, {1, 2, 3}));
  EXPECT_TRUE(some.wants(VK_SHADER_STAGE_COMPUTE_BIT, {5, 0, 0}));
  EXPECT_FALSE(some.wants(VK_SHADER_STAGE_COMPUTE_BIT, {5, 1, 0}));
  EXPECT_TRUE(some.wants(VK_SHADER_STAGE_VERTEX_BIT, {3, 7})) << "any instance";
  EXPECT_TRUE(some.wants(VK_SHADER_STAGE_VERTEX_BIT, {4, 1}));
  EXPECT_FALSE(some.wants(VK_SHADER_STAGE_VERTEX_BIT, {4, 0}));
  EXPECT_TRUE(some.wants(VK_SHADER_STAGE_FRAGMENT_BIT, {1, 2}));
  EXPECT_FALSE(some.wants(VK_SHADER_STAGE_GEOMETRY_BIT, {5, 0, 0}));
  EXPECT_FALSE(nobody.wants(VK_SHADER_STAGE_COMPUTE_BIT, {0, 0, 0}));
}

TEST(Printf, OutputHasALineAMessage) {
  const std::string name = testing::TempDir() + "vitrine_printf_output_test.txt";
  std::filesystem::remove(name);
  std::vector<Finding> messages(2);
  messages[0].message = "one";
  messages[1].message = "two\n";
  PrintfOutput output(name);
  output.write(messages);
  output.write(messages);
  std::ifstream file(name);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), "one\ntwo\none\ntwo\n");
  PrintfOutput nowhere("/no/such/folder/messages");
  nowhere.write(messages);
  std::filesystem::remove(name);
}

}  // namespace
}  // namespace vitrine::glass::test

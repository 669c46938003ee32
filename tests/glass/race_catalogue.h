// The catalogue of planted races: what it takes to run one and its correct twin. A race is found alone, with the lines
// of both accesses.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "tests/glass/scene.h"

namespace vitrine::glass::test {

using vitrine::test::DebugInfo;
using vitrine::test::Language;

struct PlantedRace {
  const char* name;
  const char* rule;
  std::uint32_t size, groups;  ///< invocations of a workgroup, workgroups
  const char* declarations;    ///< lines in front of main()
  const char* fault;           ///< lines of main(); '@' in front of the line of the later access, '#' of the other
  const char* twin;
};
// In bodies: i is gl_LocalInvocationIndex, g gl_WorkGroupID.x, v 64 words, o 64 others, img an image of 4 x 4 words,
// texels a buffer of 8. OUT writes a word of v for the first 64 invocations of workgroup 0.

inline constexpr char kRaceGlsl[] = R"(
layout(set = 0, binding = 0) coherent buffer B { uint v[]; };
layout(set = 0, binding = 7) coherent buffer O { uint word[]; } os[4];
layout(set = 0, binding = 2, r32ui) coherent uniform uimage2D img;
layout(set = 0, binding = 4, r32ui) coherent uniform uimageBuffer texels;
#define o os[0].word
#define i gl_LocalInvocationIndex
#define g gl_WorkGroupID.x
#define OUT(x) if (g == 0u && i < 64u) v[i] = (x)
)";

inline constexpr char kRaceHead[] = R"(#version 460
#extension GL_KHR_memory_scope_semantics : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_shader_8bit_storage : require
#extension GL_EXT_shader_explicit_arithmetic_types : require
)";

inline constexpr char kRaceHlsl[] = R"(
#define OUT(x) if (g == 0 && i < 64) v[i] = (x)
[[vk::binding(0, 0)]] RWStructuredBuffer<uint> v : register(u0);
[[vk::binding(2, 0)]] [[vk::image_format("r32ui")]] RWTexture2D<uint> img : register(u2);
)";

/// A text without its marks, and the lines that they stood in; 0: no such mark.
struct Marked {
  std::string text;
  std::uint32_t later = 0, other = 0;
};

inline Marked without_marks(std::string text) {
  Marked marked;
  std::uint32_t line = 1;
  bool start = true;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    const bool hash = c == '#' && start && text.compare(at, 7, "#define") != 0 &&
                      text.compare(at, 8, "#version") != 0 && text.compare(at, 10, "#extension") != 0 &&
                      text.compare(at, 7, "#pragma") != 0;
    if (c == '@') {
      marked.later = line;
    } else if (hash) {
      marked.other = line;
    } else {
      marked.text += c;
      line += c == '\n';
      start = c == '\n';
    }
  }
  if (marked.other == 0) marked.other = marked.later;
  if (marked.later == 0) marked.later = marked.other;
  return marked;
}

/// "rule, line 12 behind line 11" of each finding.
inline std::vector<std::string> races_in(Tool& tool) {
  std::vector<std::string> texts;
  const auto line_of = [](const Address& address) {
    return std::to_string(address.frames.empty() ? 0 : address.frames[0].line);
  };
  for (const Finding& finding : tool.take_findings()) {
    EXPECT_EQ(finding.related.size(), 1u);
    EXPECT_NE(finding.remedy, "");
    texts.push_back(std::string(finding.rule->id) + ", line " + line_of(finding.address) + " behind line " +
                    (finding.related.empty() ? "?" : line_of(finding.related[0].address)));
  }
  // The load and the store of `v[0] += 1` are two pairs of one line.
  std::sort(texts.begin(), texts.end());
  texts.erase(std::unique(texts.begin(), texts.end()), texts.end());
  return texts;
}

inline std::vector<std::string> races_of(VkShaderStageFlagBits stage, const std::vector<std::uint32_t>& module,
                                         std::uint32_t groups) {
  const auto tool = make_race();
  Scene scene;
  scene.groups = groups;
  scene.run(*tool, stage, module);
  std::vector<std::string> races = races_in(*tool);
  keep_case("race", stage, groups, module, races);
  return races;
}

inline std::vector<std::string> expected_race(const char* rule, const Marked& source) {
  return {std::string(rule) + ", line " + std::to_string(source.later) + " behind line " +
          std::to_string(source.other)};
}

inline std::vector<std::uint32_t> race_module(VkShaderStageFlagBits stage, const std::string& text, Language language,
                                              DebugInfo debug, bool optimized) {
  const auto version =
      language == Language::kHlsl ? vitrine::test::VulkanVersion::k11 : vitrine::test::VulkanVersion::k12;
  std::string log;
  std::vector<std::uint32_t> module = vitrine::test::compile_glsl(stage, text, version, log, debug, language);
  EXPECT_FALSE(module.empty()) << log << text;
  return optimized ? vitrine::test::optimize(module) : module;
}

inline std::string text_of(const PlantedRace& planted, const char* body) {
  return kRaceHead + ("layout(local_size_x = " + std::to_string(planted.size)) + ") in;\n" + kRaceGlsl +
         planted.declarations + "\nvoid main() {\n" + body + "\n}\n";
}

/// As the compiler writes it and behind spirv-opt -O.
inline void expect_race(const PlantedRace& planted) {
  const Marked source = without_marks(text_of(planted, planted.fault));
  for (const bool optimized : {false, true}) {
    const auto module = race_module(VK_SHADER_STAGE_COMPUTE_BIT, source.text, Language::kGlsl,
                                    optimized ? DebugInfo::kLines : DebugInfo::kNonSemantic, optimized);
    EXPECT_EQ(races_of(VK_SHADER_STAGE_COMPUTE_BIT, module, planted.groups), expected_race(planted.rule, source))
        << (optimized ? "optimized\n" : "") << source.text;
  }
}

inline void expect_no_race(const PlantedRace& planted) {
  const Marked source = without_marks(text_of(planted, planted.twin));
  for (const bool optimized : {false, true}) {
    const auto module = race_module(VK_SHADER_STAGE_COMPUTE_BIT, source.text, Language::kGlsl,
                                    optimized ? DebugInfo::kLines : DebugInfo::kNonSemantic, optimized);
    EXPECT_EQ(races_of(VK_SHADER_STAGE_COMPUTE_BIT, module, planted.groups), std::vector<std::string>{})
        << (optimized ? "optimized\n" : "") << source.text;
  }
}

inline std::string race_name(const testing::TestParamInfo<PlantedRace>& info) { return info.param.name; }
inline void PrintTo(const PlantedRace& planted, std::ostream* to) { *to << planted.name; }

}  // namespace vitrine::glass::test

// The catalogue of planted faults: what it takes to run a fault and its correct twin as a shader of every stage, in
// GLSL and HLSL, as the compiler writes it and behind spirv-opt -O. A fault must be found alone, on its line.
#pragma once

#include <algorithm>
#include <ostream>
#include <set>
#include <span>
#include <tuple>

#include "tests/glass/scene.h"

namespace vitrine::glass::test {

using vitrine::test::DebugInfo;
using vitrine::test::Language;

/// Where a fault can be planted.
enum class Where : std::uint8_t {
  kAnywhere,
  kGlsl,         ///< HLSL cannot say it, or says it differently
  kCompute,      ///< shared memory, barriers
  kComputeGlsl,  ///< of those in GLSL
  kFragment,     ///< quads; GLSL
};

struct Planted {
  const char* name;
  const char* rule;
  const char* declarations;  ///< lines in front of main()
  const char* fault;         ///< lines of main(): `i` is the invocation, `v` 64 words that hold their numbers
  const char* twin;          ///< the same without the fault
  Where where = Where::kAnywhere;
};
// An '@' in `declarations` or `fault` stands in front of the line where the fault is; none: it is in the body's first.

struct Variant {
  const char* name;
  VkShaderStageFlagBits stage;
  Language language;
  bool optimized;
  DebugInfo debug;
};

inline constexpr Variant kVariants[] = {
    {"compute", VK_SHADER_STAGE_COMPUTE_BIT, Language::kGlsl, false, DebugInfo::kNonSemantic},
    {"compute_optimized", VK_SHADER_STAGE_COMPUTE_BIT, Language::kGlsl, true, DebugInfo::kLines},
    {"compute_hlsl", VK_SHADER_STAGE_COMPUTE_BIT, Language::kHlsl, false, DebugInfo::kLines},
    {"compute_hlsl_optimized", VK_SHADER_STAGE_COMPUTE_BIT, Language::kHlsl, true, DebugInfo::kLines},
    {"vertex", VK_SHADER_STAGE_VERTEX_BIT, Language::kGlsl, true, DebugInfo::kLines},
    {"vertex_hlsl", VK_SHADER_STAGE_VERTEX_BIT, Language::kHlsl, false, DebugInfo::kLines},
    {"control", VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, Language::kGlsl, false, DebugInfo::kNonSemantic},
    {"evaluation", VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, Language::kGlsl, true, DebugInfo::kLines},
    {"geometry", VK_SHADER_STAGE_GEOMETRY_BIT, Language::kGlsl, false, DebugInfo::kLines},
    {"fragment", VK_SHADER_STAGE_FRAGMENT_BIT, Language::kGlsl, false, DebugInfo::kNonSemantic},
    {"fragment_optimized", VK_SHADER_STAGE_FRAGMENT_BIT, Language::kGlsl, true, DebugInfo::kLines},
    {"fragment_hlsl", VK_SHADER_STAGE_FRAGMENT_BIT, Language::kHlsl, true, DebugInfo::kLines},
};

inline constexpr char kGlsl[] = R"(#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#define bits floatBitsToUint
#define fmod mod
layout(set = 0, binding = 0) buffer B { uint v[]; };
)";

inline constexpr char kHlsl[] = R"(
#define bits asuint
#define inversesqrt rsqrt
#define uvec2 uint2
#define uvec3 uint3
#define uvec4 uint4
#define vec3 float3
#define shared groupshared
#define barrier GroupMemoryBarrierWithGroupSync
#define atomicAdd InterlockedAdd
[[vk::binding(0, 0)]] RWStructuredBuffer<uint> v : register(u0);
)";

/// What stands around the body: in front of main() and behind its beginning, at its end.
struct Frames {
  const char *head, *begin, *end;
};

inline Frames frames_of(VkShaderStageFlagBits stage, Language language) {
  const bool hlsl = language == Language::kHlsl;
  switch (stage) {
    case VK_SHADER_STAGE_VERTEX_BIT:
      if (hlsl)
        return {"", "float4 main(uint id : SV_VertexID) : SV_Position { uint i = id;", "return float4(0, 0, 0, 1); }"};
      return {"", "void main() { uint i = uint(gl_VertexIndex);",
              "gl_Position = vec4(0.0, 0.0, 0.0, 1.0); gl_PointSize = 1.0; }"};
    case VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT:
      return {"layout(vertices = 8) out;\n", "void main() { uint i = uint(gl_InvocationID);",
              "gl_out[gl_InvocationID].gl_Position = vec4(1.0); gl_TessLevelOuter[0] = gl_TessLevelOuter[1] = 1.0; }"};
    case VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT:
      return {"layout(isolines) in;\n", "void main() { uint i = uint(gl_TessCoord.x * 7.0 + 0.5);",
              "gl_Position = vec4(0.0, 0.0, 0.0, 1.0); }"};
    case VK_SHADER_STAGE_GEOMETRY_BIT:
      return {"layout(points) in;\nlayout(points, max_vertices = 1) out;\n",
              "void main() { uint i = uint(gl_PrimitiveIDIn);",
              "gl_Position = vec4(0.0, 0.0, 0.0, 1.0); EmitVertex(); }"};
    case VK_SHADER_STAGE_FRAGMENT_BIT:
      if (hlsl)
        return {"", "float4 main(float4 at : SV_Position) : SV_Target { uint i = uint(at.x);",
                "return float4(1, 1, 1, 1); }"};
      return {"layout(location = 0) out vec4 color;\n", "void main() { uint i = uint(gl_FragCoord.x);",
              "color = vec4(1.0); }"};
    default:
      if (hlsl) return {"", "[numthreads(8, 1, 1)] void main(uint3 id : SV_DispatchThreadID) { uint i = id.x;", "}"};
      return {"layout(local_size_x = 8) in;\n", "void main() { uint i = gl_GlobalInvocationID.x;", "}"};
  }
}

struct Source {
  std::string text;
  std::uint32_t line = 0;  ///< where the fault is
};

/// The number of the line that `text` ends in.
inline std::uint32_t lines_of(const std::string& text) {
  return static_cast<std::uint32_t>(std::count(text.begin(), text.end(), '\n')) + 1;
}

/// The body has lines around it that are right.
inline Source source_of(const Planted& planted, const Variant& variant, const char* body) {
  const Frames frames = frames_of(variant.stage, variant.language);
  Source source;
  source.text = std::string(variant.language == Language::kHlsl ? kHlsl : kGlsl) + frames.head + planted.declarations +
                "\n" + frames.begin + "\nuint around = v[i + 8u];\n";
  source.line = lines_of(source.text);
  source.text += std::string(body) + "\nv[i + 8u] = around;\n" + frames.end + "\n";
  if (const std::size_t marked = source.text.find('@'); marked != std::string::npos) {
    source.line = lines_of(source.text.substr(0, marked));
    source.text.erase(marked, 1);
  }
  return source;
}

inline std::vector<std::uint32_t> module_of(const Source& source, const Variant& variant) {
  // glslang's HLSL uses forms that end with SPIR-V 1.3.
  const auto version =
      variant.language == Language::kHlsl ? vitrine::test::VulkanVersion::k11 : vitrine::test::VulkanVersion::k12;
  std::string log;
  std::vector<std::uint32_t> module =
      vitrine::test::compile_glsl(variant.stage, source.text, version, log, variant.debug, variant.language);
  EXPECT_FALSE(module.empty()) << log << source.text;
  return variant.optimized ? vitrine::test::optimize(module) : module;
}

inline bool is_of_numbers(std::string_view rule) { return rule == "infinity" || rule == "not-a-number"; }

/// "rule, line" of each finding of the tool.
inline std::vector<std::string> found_by(Tool& tool, VkShaderStageFlagBits stage,
                                         const std::vector<std::uint32_t>& module) {
  Scene().run(tool, stage, module);
  std::vector<std::string> texts;
  for (const Finding& finding : tool.take_findings()) {
    const std::vector<Frame>& frames = finding.address.frames;
    texts.push_back(std::string(finding.rule->id) + ", line " + std::to_string(frames.empty() ? 0 : frames[0].line));
  }
  keep_case(!texts.empty() && is_of_numbers(texts[0].substr(0, texts[0].find(','))) ? "numbers" : "sanitize", stage, 1,
            module, texts);
  return texts;
}

using Texts = std::vector<std::string>;

/// The fault is found on its line, and nothing else. A NaN that a root of a negative number makes is two tools' word on
/// one fault: each speaks of its own rules.
inline void expect_found(const Planted& planted, const Variant& variant) {
  const Source source = source_of(planted, variant, planted.fault);
  const auto tool = is_of_numbers(planted.rule) ? make_numbers() : make_sanitize();
  EXPECT_EQ(found_by(*tool, variant.stage, module_of(source, variant)),
            Texts{std::string(planted.rule) + ", line " + std::to_string(source.line)})
      << source.text;
}

inline void expect_silence(const Planted& planted, const Variant& variant) {
  const Source source = source_of(planted, variant, planted.twin);
  const auto module = module_of(source, variant);
  for (const auto& make : {make_sanitize, make_numbers})
    EXPECT_EQ(found_by(*make(), variant.stage, module), Texts{}) << source.text;
}

inline bool fits(Where where, const Variant& variant) {
  const bool glsl = variant.language == Language::kGlsl;
  switch (where) {
    case Where::kGlsl:
      return glsl;
    case Where::kCompute:
      return variant.stage == VK_SHADER_STAGE_COMPUTE_BIT;
    case Where::kComputeGlsl:
      return glsl && variant.stage == VK_SHADER_STAGE_COMPUTE_BIT;
    case Where::kFragment:
      return glsl && variant.stage == VK_SHADER_STAGE_FRAGMENT_BIT;
    default:
      return true;
  }
}

struct Case {
  const Planted* planted;
  const Variant* variant;
};

inline void PrintTo(const Case& one, std::ostream* to) { *to << one.planted->name << " " << one.variant->name; }
inline std::string name_of(const testing::TestParamInfo<Case>& info) {
  return std::string(info.param.planted->name) + "_" + info.param.variant->name;
}

inline std::vector<Case> cases_of(std::span<const Planted> all) {
  std::vector<Case> cases;
  for (const Planted& planted : all)
    for (const Variant& variant : kVariants)
      if (fits(planted.where, variant)) cases.push_back({&planted, &variant});
  return cases;
}

/// How many faults there are that differ, counting a fault once for each stage and language.
inline std::size_t faults_in(std::span<const Planted> all) {
  std::set<std::tuple<std::string_view, VkShaderStageFlagBits, Language>> faults;
  for (const Case& one : cases_of(all)) faults.emplace(one.planted->name, one.variant->stage, one.variant->language);
  return faults.size();
}

/// Modules that the optimizer leaves as they are: they would try nothing new.
inline std::size_t unchanged_by_optimizer(std::span<const Planted> all) {
  std::size_t unchanged = 0;
  for (const Case& one : cases_of(all)) {
    if (!one.variant->optimized) continue;
    Variant plain = *one.variant;
    plain.optimized = false;
    const Source source = source_of(*one.planted, plain, one.planted->fault);
    unchanged += module_of(source, plain) == module_of(source, *one.variant);
  }
  return unchanged;
}

class Catalogue : public testing::TestWithParam<Case> {};

}  // namespace vitrine::glass::test

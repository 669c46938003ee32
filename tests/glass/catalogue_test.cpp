// Planted faults and their correct twins: what sanitize and numbers must find, on which line, and where they must be
// silent. Each in GLSL and HLSL, as the compiler writes it and behind spirv-opt -O.
#include <algorithm>
#include <ostream>

#include "tests/glass/observed.h"

namespace vitrine::glass::test {
namespace {

using vitrine::test::Language;

struct Planted {
  const char* name;
  const char* rule;
  const char* declarations;  ///< a line in front of main()
  const char* fault;         ///< a line of main(): `i` is the invocation, `v` 64 words that hold their numbers
  const char* twin;          ///< the same without the fault
};

constexpr Planted kPlanted[] = {
    {"unsigned_division", "division-by-zero", "", "v[i] = 100u / v[i];", "v[i] = 100u / (v[i] + 1u);"},
    {"unsigned_remainder", "division-by-zero", "", "v[i] = 100u % v[i];", "v[i] = 100u % (v[i] + 1u);"},
    {"signed_division", "division-by-zero", "", "v[i] = uint(100 / int(v[i]));", "v[i] = uint(100 / (int(v[i]) - 9));"},
    {"signed_remainder", "division-by-zero", "", "v[i] = uint(100 % int(v[i]));",
     "v[i] = uint(100 % (int(v[i]) + 1));"},
    {"smallest_number_divided", "division-by-zero", "", "v[i] = uint(int(v[i] + 0x80000000u) / (int(v[i]) - 1));",
     "v[i] = uint(int(v[i] + 0x80000000u) / (int(v[i]) + 1));"},
    {"division_of_vectors", "division-by-zero", "",
     "uvec2 q = uvec2(100u, 7u) / uvec2(v[i], v[i] + 1u); v[i] = q.x + q.y;",
     "uvec2 q = uvec2(100u, 7u) / uvec2(v[i] + 2u, v[i] + 1u); v[i] = q.x + q.y;"},
    {"division_in_a_loop", "division-by-zero", "",
     "uint s = 0u; for (uint k = 0u; k < v[4]; ++k) s += v[i] / (3u - k); v[i] = s;",
     "uint s = 0u; for (uint k = 0u; k < v[4]; ++k) s += v[i] / (4u - k); v[i] = s;"},
    {"division_in_an_unrolled_loop", "division-by-zero", "",
     "uint s = 0u; for (uint k = 0u; k < 4u; ++k) s += v[i] / (v[3] - k); v[i] = s;",
     "uint s = 0u; for (uint k = 0u; k < 3u; ++k) s += v[i] / (v[3] - k); v[i] = s;"},
    {"division_in_a_branch", "division-by-zero", "", "if (v[i] < 3u) v[i] = 9u / v[i];",
     "if (v[i] > 3u) v[i] = 9u / v[i];"},
    {"division_in_a_function", "division-by-zero", "uint f(uint x) { return 10u / x; }", "v[i] = f(v[i]);",
     "v[i] = f(v[i] + 1u);"},
    {"shift_left", "shift-too-far", "", "v[i] = 1u << (v[i] + 30u);", "v[i] = 1u << (v[i] + 20u);"},
    {"shift_right", "shift-too-far", "", "v[i] = 0x80000000u >> (v[i] * 8u);", "v[i] = 0x80000000u >> (v[i] * 4u);"},
    {"signed_shift_right", "shift-too-far", "", "v[i] = uint(int(v[i]) >> int(v[i] + 28u));",
     "v[i] = uint(int(v[i]) >> int(v[i] + 20u));"},
    {"negative_to_unsigned", "conversion-out-of-range", "", "v[i] = uint(float(v[i]) - 2.5);",
     "v[i] = uint(float(v[i]) - 0.5);"},
    {"large_to_signed", "conversion-out-of-range", "", "v[i] = uint(int(float(v[i]) * 1e9));",
     "v[i] = uint(int(float(v[i]) * 1e8));"},
    {"large_to_unsigned", "conversion-out-of-range", "", "v[i] = uint(float(v[i]) * 1e9);",
     "v[i] = uint(float(v[i]) * 5e8);"},
    {"square_root", "undefined-math", "", "v[i] = bits(sqrt(float(v[i]) - 1.0));", "v[i] = bits(sqrt(float(v[i])));"},
    {"inverse_square_root", "undefined-math", "", "v[i] = bits(inversesqrt(float(v[i])));",
     "v[i] = bits(inversesqrt(float(v[i]) + 1.0));"},
    {"logarithm", "undefined-math", "", "v[i] = bits(log(float(v[i])));", "v[i] = bits(log(float(v[i]) + 1.0));"},
    {"binary_logarithm", "undefined-math", "", "v[i] = bits(log2(float(v[i])));",
     "v[i] = bits(log2(float(v[i]) + 1.0));"},
    {"arc_sine", "undefined-math", "", "v[i] = bits(asin(float(v[i]) / 3.0));",
     "v[i] = bits(asin(float(v[i]) / 8.0));"},
    {"arc_cosine", "undefined-math", "", "v[i] = bits(acos(float(v[i]) / 3.0));",
     "v[i] = bits(acos(float(v[i]) / 8.0));"},
    {"power", "undefined-math", "", "v[i] = bits(pow(float(v[i]) - 2.0, 3.0));",
     "v[i] = bits(pow(float(v[i]) + 2.0, 3.0));"},
    {"power_of_zero", "undefined-math", "", "v[i] = bits(pow(float(v[i]), float(v[i]) - 1.0));",
     "v[i] = bits(pow(float(v[i]), float(v[i]) + 1.0));"},
    {"clamp_of_integers", "undefined-math", "", "v[i] = clamp(3u, v[i], 5u);", "v[i] = clamp(3u, v[i], 8u);"},
    {"clamp_of_numbers", "undefined-math", "", "v[i] = bits(clamp(float(v[i + 8u]), float(v[i]), 5.0));",
     "v[i] = bits(clamp(float(v[i + 8u]), float(v[i]), 8.0));"},
    {"smoothstep", "undefined-math", "", "v[i] = bits(smoothstep(float(v[i]), 6.0, 1.0));",
     "v[i] = bits(smoothstep(float(v[i]), 8.0, 1.0));"},
    {"remainder_of_numbers", "undefined-math", "", "v[i] = bits(fmod(5.0, float(v[i])));",
     "v[i] = bits(fmod(5.0, float(v[i]) + 1.0));"},
    {"load", "out-of-bounds-load", "", "v[0] = v[i + 60u];", "v[0] = v[i + 56u];"},
    {"load_by_all", "out-of-bounds-load", "", "v[i] = v[v[63] + 1u];", "v[i] = v[v[62] + 1u];"},
    {"load_that_wraps", "out-of-bounds-load", "", "v[i] = v[i - 1u];", "v[i] = v[i + 1u];"},
    {"load_in_a_function", "out-of-bounds-load", "uint f(uint x) { return v[x + 60u]; }", "v[i] = f(i);",
     "v[i] = f(i / 2u);"},
    {"store", "out-of-bounds-store", "", "v[i + 61u] = 1u;", "v[i + 56u] = 1u;"},
    {"store_in_a_loop", "out-of-bounds-store", "", "for (uint k = 0u; k < v[4]; ++k) v[60u + i + k] = k;",
     "for (uint k = 0u; k < v[4]; ++k) v[10u + i + k] = k;"},
    {"store_in_a_branch", "out-of-bounds-store", "", "if (v[i] == 3u) v[v[i] * 22u] = 7u;",
     "if (v[i] == 3u) v[v[i] * 20u] = 7u;"},
    {"atomic_operation", "out-of-bounds-atomic", "", "atomicAdd(v[i * 10u], 1u);", "atomicAdd(v[i * 9u], 1u);"},
    {"shared_store", "out-of-bounds-shared", "shared uint s[12];", "s[i] = i; s[i + 8u] = i; barrier(); v[i] = s[i];",
     "s[i] = i; s[i + 4u] = i; barrier(); v[i] = s[i];"},
    {"array_load", "out-of-bounds-array", "", "uint a[5]; for (uint k = 0u; k < 5u; ++k) a[k] = v[k]; v[i] = a[v[i]];",
     "uint a[5]; for (uint k = 0u; k < 5u; ++k) a[k] = v[k]; v[i] = a[v[i] % 5u];"},
    {"array_store", "out-of-bounds-array", "",
     "uint a[5]; for (uint k = 0u; k < 5u; ++k) a[k] = v[k]; a[v[i]] = 1u; v[i] = a[v[1]];",
     "uint a[5]; for (uint k = 0u; k < 5u; ++k) a[k] = v[k]; a[v[i] / 2u] = 1u; v[i] = a[v[1]];"},
    {"shared_hole", "uninitialized-shared", "shared uint s[8];", "if (i != 3u) s[i] = i; barrier(); v[i] = s[7u - i];",
     "s[i] = i; barrier(); v[i] = s[7u - i];"},
    {"shared_counter", "uninitialized-shared", "shared uint n;", "atomicAdd(n, i); barrier(); v[i] = n;",
     "if (i == 0u) n = 0u; barrier(); atomicAdd(n, i); barrier(); v[i] = n;"},
    {"variable_of_one_branch", "uninitialized-variable", "", "uint x; if (i < 5u) x = i; v[i] = x;",
     "uint x; if (i < 5u) x = i; else x = 2u; v[i] = x;"},
    {"accumulator", "uninitialized-variable", "", "uint s; for (uint k = 0u; k < v[4]; ++k) s += k; v[i] = s;",
     "uint s = 0u; for (uint k = 0u; k < v[4]; ++k) s += k; v[i] = s;"},
    {"component", "uninitialized-variable", "", "uvec4 x; x.xyz = uvec3(i, i, i); uvec4 y = x * 2u; v[i] = y.x + y.w;",
     "uvec4 x; x.xyz = uvec3(i, i, i); uvec4 y = x * 2u; v[i] = y.x + y.z;"},
    {"element", "uninitialized-variable", "", "uint a[8]; for (uint k = 0u; k < v[7]; ++k) a[k] = k; v[i] = a[i];",
     "uint a[8]; for (uint k = 0u; k < v[8]; ++k) a[k] = k; v[i] = a[i];"},
    {"branch_on_a_variable", "uninitialized-variable", "", "uint x; if (i < 5u) x = i; if (x == 3u) v[i] = 1u;",
     "uint x = 7u; if (i < 5u) x = i; if (x == 3u) v[i] = 1u;"},
    {"index", "uninitialized-variable", "", "uint x; if (i < 5u) x = i; v[x & 7u] = i;",
     "uint x = 7u; if (i < 5u) x = i; v[x & 7u] = i;"},
    {"barrier_in_a_branch", "divergent-barrier", "shared uint s;", "if (i < 3u) { s = i; barrier(); } v[i] = i;",
     "if (v[10] == 10u) { s = i; barrier(); } v[i] = i;"},
    {"barrier_behind_a_return", "divergent-barrier", "shared uint s[8];",
     "if (i >= 6u) return; s[i] = i; barrier(); v[i] = s[i];",
     "s[i] = i; barrier(); if (i >= 6u) return; v[i] = s[i];"},
    {"reciprocal_of_zero", "infinity", "", "v[i] = bits(1.0 / float(v[i]));",
     "v[i] = bits(1.0 / (float(v[i]) + 1.0));"},
    {"exponential", "infinity", "", "v[i] = bits(exp(float(v[i]) * 20.0));", "v[i] = bits(exp(float(v[i]) * 10.0));"},
    {"product", "infinity", "", "v[i] = bits(float(v[i]) * 1e38 * float(v[i + 1u]));",
     "v[i] = bits(float(v[i]) * 1e36 * float(v[i + 1u]));"},
    {"zero_by_zero", "not-a-number", "", "float x = float(v[i]); v[i] = bits(x / (x * 2.0) + 1.0);",
     "float x = float(v[i]) + 1.0; v[i] = bits(x / (x * 2.0) + 1.0);"},
    {"normalize_of_zero", "not-a-number", "", "vec3 n = normalize(vec3(v[i], v[i], v[i])); v[i] = bits(n.x + n.y);",
     "vec3 n = normalize(vec3(v[i] + 1u, v[i], v[i])); v[i] = bits(n.x + n.y);"},
    {"root_of_a_negative_number", "not-a-number", "", "v[i] = bits(sqrt(float(v[i]) - 1.0) + 1.0);",
     "v[i] = bits(sqrt(float(v[i])) + 1.0);"},
};

constexpr char kGlsl[] = R"(#version 460
#define bits floatBitsToUint
#define fmod mod
layout(local_size_x = 8) in;
layout(set = 0, binding = 0) buffer B { uint v[]; };
)";
constexpr char kGlslMain[] = "void main() { uint i = gl_GlobalInvocationID.x;\n";

constexpr char kHlsl[] = R"(
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
constexpr char kHlslMain[] = "[numthreads(8, 1, 1)] void main(uint3 id : SV_DispatchThreadID) { uint i = id.x;\n";

struct Variant {
  const char* name;
  Language language;
  bool optimized;
  vitrine::test::DebugInfo debug;
};

void PrintTo(const Planted& planted, std::ostream* to) { *to << planted.name; }
void PrintTo(const Variant& variant, std::ostream* to) { *to << variant.name; }

constexpr Variant kVariants[] = {
    {"glsl", Language::kGlsl, false, vitrine::test::DebugInfo::kNonSemantic},
    {"glsl_optimized", Language::kGlsl, true, vitrine::test::DebugInfo::kLines},
    {"hlsl", Language::kHlsl, false, vitrine::test::DebugInfo::kLines},
    {"hlsl_optimized", Language::kHlsl, true, vitrine::test::DebugInfo::kLines},
};

/// The number of the line behind `text`.
std::uint32_t line_behind(const std::string& text) {
  return static_cast<std::uint32_t>(std::count(text.begin(), text.end(), '\n')) + 1;
}

struct Source {
  std::string text;
  std::uint32_t declared = 0, line = 0;  ///< lines of the declarations, of the body
};

Source source_of(const Planted& planted, Language language, const char* body) {
  const bool hlsl = language == Language::kHlsl;
  Source source;
  source.text = hlsl ? kHlsl : kGlsl;
  source.declared = line_behind(source.text);
  source.text += std::string(planted.declarations) + "\n" + (hlsl ? kHlslMain : kGlslMain);
  source.line = line_behind(source.text);
  source.text += std::string(body) + "\n}\n";
  return source;
}

/// "rule, line" of each finding.
std::vector<std::string> found(const Source& source, const Variant& variant) {
  // glslang's HLSL uses forms that end with SPIR-V 1.3.
  const auto version =
      variant.language == Language::kHlsl ? vitrine::test::VulkanVersion::k11 : vitrine::test::VulkanVersion::k12;
  std::string log;
  std::vector<std::uint32_t> module = vitrine::test::compile_glsl(VK_SHADER_STAGE_COMPUTE_BIT, source.text, version,
                                                                  log, variant.debug, variant.language);
  EXPECT_FALSE(module.empty()) << log;
  if (variant.optimized) module = vitrine::test::optimize(module);
  std::vector<std::string> texts;
  for (const auto& make : {make_sanitize, make_numbers}) {
    const auto tool = make();
    std::vector<std::uint32_t> words(64);
    for (std::uint32_t i = 0; i < words.size(); ++i) words[i] = i;
    run_observed(tool.get(), module, words, 1);
    for (const Finding& finding : tool->take_findings()) {
      const std::vector<Frame>& frames = finding.address.frames;
      texts.push_back(std::string(finding.rule->id) + ", line " + std::to_string(frames.empty() ? 0 : frames[0].line));
    }
  }
  return texts;
}

class Catalogue : public testing::TestWithParam<std::tuple<Planted, Variant>> {};

TEST_P(Catalogue, FaultIsFoundOnItsLine) {
  const auto& [planted, variant] = GetParam();
  const Source source = source_of(planted, variant.language, planted.fault);
  const std::vector<std::string> texts = found(source, variant);
  const bool in_function = std::string_view(planted.declarations).find('(') != std::string_view::npos;
  const std::string expected =
      std::string(planted.rule) + ", line " + std::to_string(in_function ? source.declared : source.line);
  EXPECT_NE(std::find(texts.begin(), texts.end(), expected), texts.end())
      << "wanted " << expected << ", found " << testing::PrintToString(texts);
}

/// What is not the planted rule's is another rule's word on the same fault (a NaN that is a root of a negative number).
TEST_P(Catalogue, TwinIsSilent) {
  const auto& [planted, variant] = GetParam();
  EXPECT_EQ(found(source_of(planted, variant.language, planted.twin), variant), std::vector<std::string>{});
}

INSTANTIATE_TEST_SUITE_P(Compute, Catalogue,
                         testing::Combine(testing::ValuesIn(kPlanted), testing::ValuesIn(kVariants)),
                         [](const auto& info) {
                           return std::string(std::get<0>(info.param).name) + "_" + std::get<1>(info.param).name;
                         });

}  // namespace
}  // namespace vitrine::glass::test

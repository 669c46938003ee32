// Planted races of draws, in HLSL, and in hand-written SPIR-V.
#include "tests/glass/assembly.h"
#include "tests/glass/race_catalogue.h"

namespace vitrine::glass::test {
namespace {

// ---- draws
struct Drawn {
  const char* name;
  const char* rule;
  VkShaderStageFlagBits stage;
  const char *declarations, *fault, *twin;  ///< of main(); n: the number of the vertex, or x of the pixel
};

constexpr auto kVertex = VK_SHADER_STAGE_VERTEX_BIT, kFragment = VK_SHADER_STAGE_FRAGMENT_BIT;

constexpr Drawn kDrawn[] = {
    {"fragments_write_a_word", "race-buffer", kFragment, "", "@v[0] = n;", "v[n] = n;"},
    {"fragments_write_a_value", "race-buffer", kFragment, "", "@v[0] = 5u;", "if (n == 3u) v[0] = 5u;"},
    {"fragments_count", "race-buffer", kFragment, "", "@v[0] += 1u;", "atomicAdd(v[0], 1u);"},
    {"fragment_reads_another", "race-buffer", kFragment, "", "#v[n] = n;\n@o[n] = v[n ^ 1u];",
     "v[n] = n;\no[n] = v[n];"},
    {"fragments_with_a_memory_barrier", "race-buffer", kFragment, "",
     "#v[n] = n;\nmemoryBarrierBuffer();\n@o[n] = v[n ^ 1u];", "v[n] = n;\nmemoryBarrierBuffer();\no[n] = v[n];"},
    {"fragments_write_a_texel", "race-image", kFragment, "", "@imageStore(img, ivec2(n / 2u, 1), uvec4(n));",
     "imageStore(img, ivec2(n & 3u, n / 4u), uvec4(n));"},
    {"fragments_add_to_a_texel", "race-image", kFragment, "",
     "@imageStore(img, ivec2(0), imageLoad(img, ivec2(0)) + 1u);", "imageAtomicAdd(img, ivec2(0), 1u);"},
    {"fragments_fence_behind_the_flag", "race-buffer", kFragment, "",
     "#v[n] = n;\natomicStore(o[n], 1u, gl_ScopeSubgroup, 0, 0);\n"
     "memoryBarrier(gl_ScopeSubgroup, gl_StorageSemanticsBuffer, gl_SemanticsRelease);\n"
     "if (atomicLoad(o[n ^ 1u], gl_ScopeSubgroup, gl_StorageSemanticsBuffer, gl_SemanticsAcquire) == 1u)\n"
     "@imageStore(img, ivec2(n & 3u, n / 4u), uvec4(v[n ^ 1u]));",
     "v[n] = n;\nmemoryBarrier(gl_ScopeSubgroup, gl_StorageSemanticsBuffer, gl_SemanticsRelease);\n"
     "atomicStore(o[n], 1u, gl_ScopeSubgroup, 0, 0);\n"
     "if (atomicLoad(o[n ^ 1u], gl_ScopeSubgroup, gl_StorageSemanticsBuffer, gl_SemanticsAcquire) == 1u)\n"
     "imageStore(img, ivec2(n & 3u, n / 4u), uvec4(v[n ^ 1u]));"},
    {"interlock_of_other_pixels", "race-buffer", kFragment, "layout(pixel_interlock_ordered) in;",
     "beginInvocationInterlockARB();\n@v[0] += 1u;\nendInvocationInterlockARB();",
     "beginInvocationInterlockARB();\nv[n] += 1u;\nendInvocationInterlockARB();"},
    {"vertices_write_a_word", "race-buffer", kVertex, "", "@v[0] = n;", "v[n] = n;"},
    {"vertices_count", "race-buffer", kVertex, "", "@v[0] += 1u;", "atomicAdd(v[0], 1u);"},
    {"vertex_reads_another", "race-buffer", kVertex, "", "#v[n] = n;\n@o[n] = v[n ^ 1u];", "v[n] = n;\no[n] = v[n];"},
    {"vertices_write_a_texel", "race-image", kVertex, "", "@imageStore(img, ivec2(0), uvec4(n));",
     "imageStore(img, ivec2(n & 3u, n / 4u), uvec4(n));"},
};

Marked source_of(const Drawn& drawn, const char* body) {
  const bool fragments = drawn.stage == kFragment;
  return without_marks(
      std::string(kRaceHead) + "#extension GL_ARB_fragment_shader_interlock : enable\n" + kRaceGlsl +
      (fragments ? "layout(location = 0) out vec4 color;\n" : "") + drawn.declarations +
      "\nvoid main() {\nuint n = uint(" + (fragments ? "gl_FragCoord.x" : "gl_VertexIndex") + ");\n" + body + "\n" +
      (fragments ? "color = vec4(1.0);\n}\n" : "gl_Position = vec4(0.0, 0.0, 0.0, 1.0); gl_PointSize = 1.0;\n}\n"));
}

class RaceDrawn : public testing::TestWithParam<Drawn> {};

TEST_P(RaceDrawn, IsFoundWithBothLines) {
  const Marked source = source_of(GetParam(), GetParam().fault);
  const auto module = race_module(GetParam().stage, source.text, Language::kGlsl, DebugInfo::kLines, false);
  EXPECT_EQ(races_of(GetParam().stage, module, 1), expected_race(GetParam().rule, source)) << source.text;
}

TEST_P(RaceDrawn, TwinIsSilent) {
  const Marked source = source_of(GetParam(), GetParam().twin);
  const auto module = race_module(GetParam().stage, source.text, Language::kGlsl, DebugInfo::kLines, false);
  EXPECT_EQ(races_of(GetParam().stage, module, 1), std::vector<std::string>{}) << source.text;
}

INSTANTIATE_TEST_SUITE_P(Catalogue, RaceDrawn, testing::ValuesIn(kDrawn),
                         [](const auto& info) { return std::string(info.param.name); });

// ---- HLSL
constexpr PlantedRace kHlslPlanted[] = {
    {"no_barrier", "race-shared", 64, 1, "groupshared uint s[64];", "#s[i] = i;\n@OUT(s[63 - i]);",
     "s[i] = i;\nGroupMemoryBarrierWithGroupSync();\nOUT(s[63 - i]);"},
    {"memory_barrier_alone", "race-shared", 64, 1, "groupshared uint s[64];",
     "#s[i] = i;\nGroupMemoryBarrier();\n@OUT(s[63 - i]);",
     "s[i] = i;\nAllMemoryBarrierWithGroupSync();\nOUT(s[63 - i]);"},
    {"all_memory_barrier_alone", "race-shared", 128, 1, "groupshared uint s[128];",
     "@s[i] = i;\nAllMemoryBarrier();\n#OUT(s[127 - i]);",
     "s[i] = i;\nGroupMemoryBarrierWithGroupSync();\nOUT(s[127 - i]);"},
    {"one_word", "race-shared", 64, 1, "groupshared uint s[64];", "@s[i / 2] = i;", "s[i] = i;"},
    {"store_and_interlocked", "race-shared", 64, 1, "groupshared uint s;",
     "if (i == 0)\n#s = 0;\n@InterlockedAdd(s, 1);",
     "if (i == 0)\ns = 0;\nGroupMemoryBarrierWithGroupSync();\nInterlockedAdd(s, 1);"},
    {"buffer", "race-buffer", 64, 1, "", "#v[i] = i;\n@uint x = v[i ^ 1];\nif (i < 16) img[uint2(i % 4, i / 4)] = x;",
     "v[i] = i;\nDeviceMemoryBarrierWithGroupSync();\nif (i < 16) img[uint2(i % 4, i / 4)] = v[i ^ 1];"},
    {"groups", "race-buffer", 8, 4, "", "@v[i] = g;", "v[g * 8 + i] = g;"},
    {"image", "race-image", 16, 1, "", "#img[uint2(i % 4, i / 4)] = i;\n@v[i] = img[uint2(i / 4, i % 4)];",
     "img[uint2(i % 4, i / 4)] = i;\nDeviceMemoryBarrierWithGroupSync();\nv[i] = img[uint2(i / 4, i % 4)];"},
};

Marked hlsl_of(const PlantedRace& planted, const char* body) {
  return without_marks(std::string(kRaceHlsl) + planted.declarations + "\n[numthreads(" + std::to_string(planted.size) +
                       ", 1, 1)] void main(uint i : SV_GroupIndex, uint3 group : SV_GroupID) {\nuint g = group.x;\n" +
                       body + "\n}\n");
}

class RaceHlsl : public testing::TestWithParam<PlantedRace> {};

TEST_P(RaceHlsl, IsFoundWithBothLines) {
  const Marked source = hlsl_of(GetParam(), GetParam().fault);
  const auto module = race_module(VK_SHADER_STAGE_COMPUTE_BIT, source.text, Language::kHlsl, DebugInfo::kLines, false);
  const auto found = races_of(VK_SHADER_STAGE_COMPUTE_BIT, module, GetParam().groups);
  EXPECT_EQ(found.empty() ? "" : found[0], expected_race(GetParam().rule, source)[0]) << source.text;
}

TEST_P(RaceHlsl, TwinIsSilent) {
  const Marked source = hlsl_of(GetParam(), GetParam().twin);
  const auto module = race_module(VK_SHADER_STAGE_COMPUTE_BIT, source.text, Language::kHlsl, DebugInfo::kLines, false);
  EXPECT_EQ(races_of(VK_SHADER_STAGE_COMPUTE_BIT, module, GetParam().groups), std::vector<std::string>{})
      << source.text;
}

INSTANTIATE_TEST_SUITE_P(Catalogue, RaceHlsl, testing::ValuesIn(kHlslPlanted), race_name);

// ---- SPIR-V: 8 invocations share %s; `between` stands between the store of one's word and the load of another's
struct Written {
  const char* name;
  const char *fault, *twin;
};

/// Scope Workgroup is %u2; AcquireRelease | WorkgroupMemory is %u264.
constexpr Written kWritten[] = {
    {"nothing", "", "OpControlBarrier %u2 %u2 %u264\n"},
    {"control_without_semantics", "OpControlBarrier %u2 %u2 %u0\n", "OpControlBarrier %u2 %u2 %u264\n"},
    {"control_that_acquires", "OpControlBarrier %u2 %u2 %acquire\n", "OpControlBarrier %u2 %u2 %u264\n"},
    {"control_that_releases", "OpControlBarrier %u2 %u2 %release\n", "OpControlBarrier %u2 %u2 %u264\n"},
    {"control_of_buffers", "OpControlBarrier %u2 %u2 %buffers\n", "OpControlBarrier %u2 %u2 %all\n"},
    {"memory_barrier", "OpMemoryBarrier %u2 %u264\n", "OpMemoryBarrier %u2 %u264\nOpControlBarrier %u2 %u2 %u0\n"},
    {"memory_barrier_of_buffers", "OpMemoryBarrier %u1 %buffers\nOpControlBarrier %u2 %u2 %u0\n",
     "OpMemoryBarrier %u1 %all\nOpControlBarrier %u2 %u2 %u0\n"},
};

std::vector<std::uint32_t> written_module(const char* between, std::uint32_t& line) {
  Assembly frame;
  frame.declarations =
      "%eight = OpTypeArray %uint %u8\n%shared_pointer = OpTypePointer Workgroup %eight\n"
      "%shared_word = OpTypePointer Workgroup %uint\n%s = OpVariable %shared_pointer Workgroup\n"
      "%acquire = OpConstant %uint 258\n%release = OpConstant %uint 260\n%buffers = OpConstant %uint 72\n"
      "%all = OpConstant %uint 328\n";
  frame.interface = "%s";
  frame.body = "%own = OpAccessChain %shared_word %s %i\nOpStore %own %x\n" + std::string(between) +
               "%j = OpBitwiseXor %uint %i %u1\n%other = OpAccessChain %shared_word %s %j\n@%y = OpLoad %uint %other\n"
               "OpStore %at %y\n";
  return frame.words(line);
}

class RaceWritten : public testing::TestWithParam<Written> {};

TEST_P(RaceWritten, IsFoundOnItsLine) {
  std::uint32_t line = 0;
  const auto module = written_module(GetParam().fault, line);
  const auto found = races_of(VK_SHADER_STAGE_COMPUTE_BIT, module, 1);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].substr(0, found[0].find(" behind")), "race-shared, line " + std::to_string(line));
}

TEST_P(RaceWritten, TwinIsSilent) {
  std::uint32_t line = 0;
  EXPECT_EQ(races_of(VK_SHADER_STAGE_COMPUTE_BIT, written_module(GetParam().twin, line), 1),
            std::vector<std::string>{});
}

INSTANTIATE_TEST_SUITE_P(Catalogue, RaceWritten, testing::ValuesIn(kWritten),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace vitrine::glass::test

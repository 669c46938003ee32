// Planted races of buffers, device addresses, images and texel buffers, inside of workgroups and between them.
#include <cstdlib>

#include "tests/glass/race_catalogue.h"
#include "tests/sanitized.h"

namespace vitrine::glass::test {
namespace {

constexpr char kAddress[] =
    "layout(buffer_reference, buffer_reference_align = 4) buffer P { uint p[]; };\n"
    "layout(push_constant) uniform C { uvec2 at; };\n";
constexpr char kPlainBuffer[] = "layout(set = 0, binding = 9) buffer W { uint w[]; };";
constexpr char kPlainImage[] = "layout(set = 0, binding = 10, r32ui) uniform uimage2D plain;";
constexpr char kBytes[] = "layout(set = 0, binding = 9) coherent buffer W { uint8_t w[]; };";

constexpr char kVulkanModel[] =
    "#pragma use_vulkan_memory_model\nlayout(set = 0, binding = 9) nonprivate buffer W { uint w[]; };\n"
    "layout(set = 0, binding = 9) buffer X { uint x[]; };";
constexpr char kCoherentModel[] =
    "#pragma use_vulkan_memory_model\nlayout(set = 0, binding = 9) nonprivate buffer W { uint w[]; };\n"
    "layout(set = 0, binding = 9) workgroupcoherent buffer Y { uint y[]; };";
#define RACE_BARRIER(semantics) \
  "controlBarrier(gl_ScopeWorkgroup, gl_ScopeWorkgroup, gl_StorageSemanticsBuffer, " semantics ");\n"
constexpr char kAvailable[] = "w[i] = i;\n" RACE_BARRIER(
    "gl_SemanticsAcquireRelease | gl_SemanticsMakeAvailable | gl_SemanticsMakeVisible") "v[i] = w[i ^ 1u];";

constexpr PlantedRace kPlanted[] = {
    // ---- buffers in a workgroup
    {"buffer_neighbour", "race-buffer", 64, 1, "", "#v[i] = i;\n@o[i] = v[i ^ 1u];",
     "v[i] = i;\nmemoryBarrierBuffer();\nbarrier();\no[i] = v[i ^ 1u];"},
    {"buffer_with_a_barrier_of_shared_memory", "race-buffer", 64, 1, "", "#v[i] = i;\nbarrier();\n@o[i] = v[i ^ 1u];",
     "v[i] = i;\nmemoryBarrier();\nbarrier();\no[i] = v[i ^ 1u];"},
    {"buffer_with_a_memory_barrier_alone", "race-buffer", 64, 1, "",
     "#v[i] = i;\nmemoryBarrierBuffer();\n@o[i] = v[i ^ 1u];",
     "v[i] = i;\ngroupMemoryBarrier();\nbarrier();\no[i] = v[i ^ 1u];"},
    {"buffer_with_a_barrier_of_images", "race-buffer", 64, 1, "",
     "#v[i] = i;\nmemoryBarrierImage();\nbarrier();\n@o[i] = v[i ^ 1u];",
     "v[i] = i;\nmemoryBarrierBuffer();\nbarrier();\no[i] = v[i ^ 1u];"},
    {"buffer_written_behind_a_read", "race-buffer", 64, 1, "", "#uint x = v[i ^ 1u];\n@v[i] = x;",
     "uint x = v[i ^ 1u];\nmemoryBarrierBuffer();\nbarrier();\nv[i] = x;"},
    {"buffer_of_two_waves", "race-buffer", 128, 1, "", "if (i >= 64u)\n@v[i - 64u] = i;\nelse\n#o[i] = v[i];",
     "if (i >= 64u) v[i - 64u] = i;\nmemoryBarrierBuffer();\nbarrier();\nif (i < 64u) o[i] = v[i];"},
    {"buffer_two_write_a_word", "race-buffer", 64, 1, "", "@v[i / 2u] = i;", "v[i] = i;"},
    {"buffer_all_write_a_value", "race-buffer", 64, 1, "", "@v[5] = 7u;", "if (i == 5u) v[5] = 7u;"},
    {"buffer_two_bindings_of_one", "race-buffer", 64, 1, "", "#os[1].word[i] = i;\n@v[i] = os[2].word[i ^ 1u];",
     "os[1].word[i] = i;\nmemoryBarrierBuffer();\nbarrier();\nv[i] = os[2].word[i ^ 1u];"},
    {"buffer_atomic_and_load", "race-buffer", 64, 1, "", "#atomicAdd(o[0], 1u);\n@v[i] = o[0];",
     "atomicAdd(o[0], 1u);\nv[i] = atomicOr(o[0], 0u);"},
    {"buffer_subgroup", "race-buffer", 64, 1, "", "#v[i] = i;\n@o[i] = v[i ^ 1u];",
     "v[i] = i;\nsubgroupBarrier();\no[i] = v[i ^ 1u];"},
    {"buffer_subgroup_barrier_of_shared_memory", "race-buffer", 64, 1, "",
     "#v[i] = i;\nsubgroupMemoryBarrierShared();\n@o[i] = v[i ^ 1u];",
     "v[i] = i;\nsubgroupBarrier();\no[i] = v[i ^ 1u];"},
    {"bytes_of_a_word", "race-buffer", 64, 1, kBytes, "@w[i / 2u] = uint8_t(i);", "w[i] = uint8_t(i);"},
    {"word_and_its_bytes", "race-buffer", 8, 1, kBytes, "#w[i] = uint8_t(i);\n@v[i] = uint(w[i ^ 1u]);",
     "w[i] = uint8_t(i);\nv[i] = uint(w[i]);"},
    {"address_neighbour", "race-buffer", 64, 1, kAddress, "#P(at).p[i] = i;\n@v[i] = P(at).p[i ^ 1u];",
     "P(at).p[i] = i;\nmemoryBarrierBuffer();\nbarrier();\nv[i] = P(at).p[i ^ 1u];"},
    {"address_between_workgroups", "race-buffer", 8, 4, kAddress, "@P(at).p[i] = g;", "P(at).p[g * 8u + i] = g;"},
    {"not_coherent", "race-visibility", 64, 1, kPlainBuffer,
     "#w[i] = i;\nmemoryBarrierBuffer();\nbarrier();\n@v[i] = w[i ^ 1u];", "w[i] = i;\nv[i] = w[i];"},
    // ---- the Vulkan memory model
    {"write_that_is_available_but_not_visible", "race-visibility", 64, 1, kCoherentModel,
     "#y[i] = i;\n" RACE_BARRIER("gl_SemanticsAcquireRelease") "@v[i] = w[i ^ 1u];",
     "y[i] = i;\n" RACE_BARRIER("gl_SemanticsAcquireRelease") "v[i] = y[i ^ 1u];"},
    {"write_that_is_visible_but_not_available", "race-visibility", 64, 1, kCoherentModel,
     "#w[i] = i;\n" RACE_BARRIER("gl_SemanticsAcquireRelease") "@v[i] = y[i ^ 1u];",
     "w[i] = i;\n" RACE_BARRIER("gl_SemanticsAcquireRelease | gl_SemanticsMakeAvailable") "v[i] = y[i ^ 1u];"},
    {"model_nothing_made_available", "race-visibility", 64, 1, kVulkanModel,
     "#w[i] = i;\n" RACE_BARRIER("gl_SemanticsAcquireRelease") "@v[i] = w[i ^ 1u];", kAvailable},
    {"model_nothing_made_visible", "race-visibility", 64, 1, kVulkanModel,
     "#w[i] = i;\n" RACE_BARRIER("gl_SemanticsAcquireRelease | gl_SemanticsMakeAvailable") "@v[i] = w[i ^ 1u];",
     kAvailable},
    {"model_private_store", "race-visibility", 64, 1, kVulkanModel,
     "#x[i] = i;\n" RACE_BARRIER(
         "gl_SemanticsAcquireRelease | gl_SemanticsMakeAvailable | gl_SemanticsMakeVisible") "@v[i] = w[i ^ 1u];",
     kAvailable},
    {"model_private_load", "race-visibility", 64, 1, kVulkanModel,
     "#w[i] = i;\n" RACE_BARRIER(
         "gl_SemanticsAcquireRelease | gl_SemanticsMakeAvailable | gl_SemanticsMakeVisible") "@v[i] = x[i ^ 1u];",
     kAvailable},
    {"model_no_barrier", "race-buffer", 64, 1, kVulkanModel, "#w[i] = i;\n@v[i] = w[i ^ 1u];", kAvailable},
    // ---- between workgroups
    {"groups_write_a_word", "race-buffer", 8, 4, "", "@v[i] = g;", "v[g * 8u + i] = g;"},
    {"small_groups_write_a_word", "race-buffer", 1, 4, "", "@v[0] = g;", "v[g] = g;"},
    {"large_groups_write_a_word", "race-buffer", 64, 3, "", "@v[i] = g;", "if (g == 1u) v[i] = g;"},
    {"groups_write_one_value", "race-buffer", 8, 4, "", "@v[i] = 5u;", "if (g == 3u) v[i] = 5u;"},
    {"group_reads_another", "race-buffer", 8, 4, "",
     "#v[g * 8u + i] = g;\n@o[g * 8u + i] = v[(g * 8u + i + 1u) & 31u];",
     "v[g * 8u + i] = g;\no[g * 8u + i] = v[g * 8u + i];"},
    {"group_reads_another_behind_barriers", "race-buffer", 8, 4, "",
     "#v[g * 8u + i] = g;\nmemoryBarrierBuffer();\nbarrier();\n@o[g * 8u + i] = v[(g * 8u + i + 24u) & 31u];",
     "v[g * 8u + i] = g;\nmemoryBarrierBuffer();\nbarrier();\no[g * 8u + i] = v[g * 8u + (i ^ 1u)];"},
    {"counter_without_atomics", "race-buffer", 1, 4, "", "@v[0] += 1u;", "atomicAdd(v[0], 1u);"},
    {"minimum_without_atomics", "race-buffer", 1, 4, "", "uint x = v[0];\n@if (o[0] >= g) o[0] = g + x;",
     "uint x = v[0];\natomicMin(o[0], g + x);"},
    {"plain_load_of_a_counter", "race-buffer", 1, 4, "", "#atomicAdd(v[0], 1u);\n@o[g] = v[0];",
     "o[g] = atomicAdd(v[0], 1u);"},
    {"reset_of_a_counter", "race-buffer", 1, 4, "", "if (g == 0u)\n#v[0] = 0u;\n@atomicAdd(v[0], 1u);",
     "if (g == 0u) v[1] = 0u;\natomicAdd(v[0], 1u);"},
    {"atomics_of_a_workgroup", "race-scope", 1, 4, "", "@atomicAdd(v[0], 1u, gl_ScopeWorkgroup, 0, 0);",
     "atomicAdd(v[0], 1u, gl_ScopeDevice, 0, 0);"},
    {"last_group_without_a_fence", "race-buffer", 1, 4, "",
     "#o[g] = g;\nuint old = atomicAdd(v[0], 1u);\nif (old == 3u)\n@v[1] = o[0];",
     "o[g] = g;\nmemoryBarrierBuffer();\nuint old = atomicAdd(v[0], 1u);\nif (old == 3u) {\nmemoryBarrierBuffer();\n"
     "v[1] = o[0] + o[1] + o[2] + o[3];\n}"},
    {"last_group_without_its_own_fence", "race-buffer", 1, 4, "",
     "#o[g] = g;\nmemoryBarrierBuffer();\nuint old = atomicAdd(v[0], 1u);\nif (old == 3u)\n@v[1] = o[0];",
     "o[g] = g;\nmemoryBarrierBuffer();\nuint old = atomicAdd(v[0], 1u);\nmemoryBarrierBuffer();\n"
     "if (old == 3u) v[1] = o[0];"},
    {"last_group_without_a_barrier", "race-buffer", 8, 4, "shared uint last;",
     "#o[g * 8u + i] = g;\nmemoryBarrierBuffer();\nif (i == 0u) last = atomicAdd(v[0], 1u);\nmemoryBarrierBuffer();\n"
     "barrier();\nif (last == 3u)\n@v[1 + i] = o[i];",
     "o[g * 8u + i] = g;\nmemoryBarrierBuffer();\nbarrier();\nif (i == 0u) last = atomicAdd(v[0], 1u);\n"
     "barrier();\nmemoryBarrierBuffer();\nif (last == 3u) v[1 + i] = o[i] + o[i + 24u];"},
    {"flag_relaxed", "race-buffer", 1, 2, "",
     "if (g == 0u) {\n#o[0] = 5u;\natomicExchange(v[0], 99u);\n} else if (atomicOr(v[0], 0u) == 99u) {\n@v[2] = "
     "o[0];\n}",
     "if (g == 0u) {\no[0] = 5u;\n"
     "atomicStore(v[0], 99u, gl_ScopeDevice, gl_StorageSemanticsBuffer, gl_SemanticsRelease);\n"
     "} else if (atomicLoad(v[0], gl_ScopeDevice, gl_StorageSemanticsBuffer, gl_SemanticsAcquire) == 99u) {\n"
     "v[2] = o[0];\n}"},
    {"flag_of_the_wrong_memory", "race-buffer", 1, 2, "",
     "if (g == 0u) {\n#o[0] = 5u;\n"
     "atomicStore(v[0], 99u, gl_ScopeDevice, gl_StorageSemanticsImage, gl_SemanticsRelease);\n"
     "} else if (atomicLoad(v[0], gl_ScopeDevice, gl_StorageSemanticsBuffer, gl_SemanticsAcquire) == 99u) {\n"
     "@v[2] = o[0];\n}",
     "if (g == 0u) {\no[0] = 5u;\n"
     "atomicStore(v[0], 99u, gl_ScopeDevice, gl_StorageSemanticsBuffer, gl_SemanticsRelease);\n"
     "} else if (atomicLoad(v[0], gl_ScopeDevice, gl_StorageSemanticsBuffer, gl_SemanticsAcquire) == 99u) {\n"
     "v[2] = o[0];\n}"},
    {"lock_without_release", "race-buffer", 1, 4, "",
     "bool done = false;\nfor (uint k = 0u; k < 9u && !done; ++k) {\nif (atomicCompSwap(v[0], 0u, 1u, gl_ScopeDevice, "
     "gl_StorageSemanticsBuffer, gl_SemanticsAcquire, 0, 0) == 0u) {\n@o[0] += 1u;\natomicExchange(v[0], 0u);\ndone = "
     "true;\n}\n}",
     "bool done = false;\nfor (uint k = 0u; k < 9u && !done; ++k) {\nif (atomicCompSwap(v[0], 0u, 1u, gl_ScopeDevice, "
     "gl_StorageSemanticsBuffer, gl_SemanticsAcquire, 0, 0) == 0u) {\no[0] += 1u;\natomicStore(v[0], 0u, "
     "gl_ScopeDevice, "
     "gl_StorageSemanticsBuffer, gl_SemanticsRelease);\ndone = true;\n}\n}"},
    // ---- images
    {"image_neighbour", "race-image", 16, 1, "",
     "#imageStore(img, ivec2(i % 4u, i / 4u), uvec4(i));\n@v[i] = imageLoad(img, ivec2(i / 4u, i % 4u)).x;",
     "imageStore(img, ivec2(i % 4u, i / 4u), uvec4(i));\nmemoryBarrierImage();\nbarrier();\n"
     "v[i] = imageLoad(img, ivec2(i / 4u, i % 4u)).x;"},
    {"image_with_a_barrier_of_shared_memory", "race-image", 16, 1, "",
     "#imageStore(img, ivec2(i % 4u, i / 4u), uvec4(i));\nbarrier();\n@v[i] = imageLoad(img, ivec2(i / 4u, i % 4u)).x;",
     "imageStore(img, ivec2(i % 4u, i / 4u), uvec4(i));\nmemoryBarrier();\nbarrier();\n"
     "v[i] = imageLoad(img, ivec2(i / 4u, i % 4u)).x;"},
    {"image_with_a_barrier_of_buffers", "race-image", 16, 1, "",
     "#imageStore(img, ivec2(i % 4u, i / 4u), uvec4(i));\nmemoryBarrierBuffer();\nbarrier();\n"
     "@v[i] = imageLoad(img, ivec2(i / 4u, i % 4u)).x;",
     "imageStore(img, ivec2(i % 4u, i / 4u), uvec4(i));\nmemoryBarrierImage();\nbarrier();\n"
     "v[i] = imageLoad(img, ivec2(i / 4u, i % 4u)).x;"},
    {"image_one_texel", "race-image", 16, 1, "", "@imageStore(img, ivec2(1, 2), uvec4(i));",
     "imageStore(img, ivec2(i % 4u, i / 4u), uvec4(i));"},
    {"image_between_workgroups", "race-image", 1, 4, "", "@imageStore(img, ivec2(g / 2u, 0), uvec4(g));",
     "imageStore(img, ivec2(g, 0), uvec4(g));"},
    {"image_sum_without_atomics", "race-image", 1, 4, "", "@imageStore(img, ivec2(0), imageLoad(img, ivec2(0)) + 1u);",
     "imageAtomicAdd(img, ivec2(0), 1u);"},
    {"image_atomic_and_load", "race-image", 1, 4, "",
     "#imageAtomicAdd(img, ivec2(0), 1u);\n@v[g] = imageLoad(img, ivec2(0)).x;",
     "v[g] = imageAtomicAdd(img, ivec2(0), 1u);"},
    {"image_not_coherent", "race-visibility", 16, 1, kPlainImage,
     "#imageStore(plain, ivec2(i % 4u, i / 4u), uvec4(i));\nmemoryBarrierImage();\nbarrier();\n"
     "@v[i] = imageLoad(plain, ivec2(i / 4u, i % 4u)).x;",
     "imageStore(plain, ivec2(i % 4u, i / 4u), uvec4(i));\nv[i] = imageLoad(plain, ivec2(i % 4u, i / 4u)).x;"},
    {"texel_buffer_neighbour", "race-image", 8, 1, "",
     "#imageStore(texels, int(i), uvec4(i));\n@v[i] = imageLoad(texels, int(i ^ 1u)).x;",
     "imageStore(texels, int(i), uvec4(i));\nmemoryBarrierImage();\nbarrier();\nv[i] = imageLoad(texels, int(i ^ "
     "1u)).x;"},
    {"texel_buffer_between_workgroups", "race-image", 1, 8, "", "@imageStore(texels, int(g / 2u), uvec4(g));",
     "imageStore(texels, int(g), uvec4(g));"},
};

class RaceDevice : public testing::TestWithParam<PlantedRace> {};

TEST_P(RaceDevice, IsFoundWithBothLines) { expect_race(GetParam()); }

TEST_P(RaceDevice, TwinIsSilent) { expect_no_race(GetParam()); }

INSTANTIATE_TEST_SUITE_P(Catalogue, RaceDevice, testing::ValuesIn(kPlanted), race_name);

TEST(Race, IsTheSameWhateverThreadsRunTheWorkgroups) {
  if constexpr (vitrine::test::kRacesAreFound) GTEST_SKIP() << "the race is there, between the threads of the device";
  const PlantedRace many{"",
                         "",
                         128,
                         900,
                         "shared uint s[64];",
                         "s[i & 63u] = g;\nfor (uint k = 0u; k < 9u; ++k) v[(i + k) & 63u] = g + k;\n"
                         "o[(i ^ g) & 63u] = s[63u - (i & 63u)];",
                         ""};
  const auto module =
      race_module(VK_SHADER_STAGE_COMPUTE_BIT, text_of(many, many.fault), Language::kGlsl, DebugInfo::kLines, false);
  std::vector<std::string> first;
  for (int round = 0; round < 8; ++round) {
    const auto tool = make_race();
    Scene scene;
    scene.groups = many.groups;
    scene.run(*tool, VK_SHADER_STAGE_COMPUTE_BIT, module);
    const std::vector<std::string> found = texts_of(*tool);
    EXPECT_GE(found.size(), 4u);
    if (round == 0) first = found;
    EXPECT_EQ(found, first);
  }
}

/// Of every third workgroup's invocations, and of them alone.
TEST(Race, SampledWorkgroupsAreThoseWhoseIndicesSayIt) {
  const auto found_of = [](const char* body) {
    const PlantedRace planted{"", "", 64, 7, "", body, ""};
    return races_of(VK_SHADER_STAGE_COMPUTE_BIT,
                    race_module(VK_SHADER_STAGE_COMPUTE_BIT, text_of(planted, body), Language::kGlsl, DebugInfo::kLines,
                                false),
                    planted.groups)
        .size();
  };
  ASSERT_EQ(setenv("VITRINE_RACE_SAMPLE", "3", 1), 0);
  EXPECT_EQ(found_of("if (g == 3u) { v[i] = i; o[i] = v[i ^ 1u]; }"), 1u);
  EXPECT_EQ(found_of("if (g == 4u) { v[i] = i; o[i] = v[i ^ 1u]; }"), 0u);
  EXPECT_EQ(found_of("if (i == 0u && (g == 3u || g == 6u)) v[5] = g;"), 1u) << "between two of them";
  EXPECT_EQ(found_of("if (i == 0u && (g == 3u || g == 5u)) v[5] = g;"), 0u);
  ASSERT_EQ(unsetenv("VITRINE_RACE_SAMPLE"), 0);
}

}  // namespace
}  // namespace vitrine::glass::test

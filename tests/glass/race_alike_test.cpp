// Which shaders do the same to shared memory in all workgroups: of those the tool race looks at one that does not race.
#include "glass/race/conflict.h"
#include "tests/glass/race_catalogue.h"

namespace vitrine::glass::test {
namespace {

/// Keeps what the tool knows of the program.
struct Catcher : Tool {
  spirv::exec::Interest interest() const override { return {.accesses = true, .order = true}; }
  std::shared_ptr<ProgramTool> attach(const ShaderIdentity& shader, const spirv::Program& program) override {
    told = std::make_unique<race::Told>(shader, program);
    return nullptr;
  }
  std::unique_ptr<race::Told> told;
};

enum class Alike { kNo, kIfGiven, kAlways };
void PrintTo(Alike alike, std::ostream* to) {
  *to << (alike == Alike::kNo ? "no" : alike == Alike::kAlways ? "always" : "if given");
}

struct Case {
  const char* name;
  Alike expected;
  const char* body;  ///< as those of race_catalogue.h: s 256 words, n of a buffer that nothing writes; what they do to
                     ///< buffers does not matter
};

void PrintTo(const Case& one, std::ostream* to) { *to << one.body; }

constexpr Case kCases[] = {
    {"offsets_of_invocations", Alike::kAlways, "s[i] = v[g];\nbarrier();\no[i & 63u] = (s[i ^ 1u]);"},
    {"a_tree", Alike::kAlways,
     "s[i] = v[g];\nbarrier();\nfor (uint k = 32u; k > 0u; k /= 2u) {\nif (i < k) s[i] += s[i + "
     "k];\nbarrier();\n}\no[i & 63u] = (s[0]);"},
    {"a_bound_around_other_things", Alike::kAlways,
     "uint x = 0u;\nif (g < 3u) x = v[g];\ns[i] = x;\nbarrier();\no[i & 63u] = (s[i ^ 1u]);"},
    {"a_loop_around_other_things", Alike::kAlways,
     "uint x = 0u;\nfor (uint k = 0u; k < g; ++k) x += k;\ns[i] = x;\nbarrier();\no[i & 63u] = (s[i ^ 1u]);"},
    {"counts_without_an_order", Alike::kAlways, "atomicAdd(s[i / 2u], g);\nbarrier();\no[i & 63u] = (s[i]);"},
    {"subgroups", Alike::kAlways, "s[i ^ subgroupBallot(i < 5u).x] = g;\nbarrier();\no[i & 63u] = (s[i]);"},
    {"offset_by_a_parameter", Alike::kIfGiven, "s[i ^ n] = g;\nbarrier();\no[i & 63u] = (s[i]);"},
    {"turns_by_a_parameter", Alike::kIfGiven,
     "for (uint k = 0u; k < n; ++k) {\ns[i] = g;\nbarrier();\n}\no[i & 63u] = (s[i]);"},
    {"bound_by_the_number_of_workgroups", Alike::kIfGiven,
     "if (i < gl_NumWorkGroups.x) s[i] = g;\nbarrier();\no[i & 63u] = (s[i]);"},
    {"offset_by_the_workgroup", Alike::kNo, "s[i ^ g] = i;\nbarrier();\no[i & 63u] = (s[i]);"},
    {"bound_by_the_workgroup", Alike::kNo, "if (g < 8u) s[i] = i;\nbarrier();\no[i & 63u] = (s[i]);"},
    {"end_by_the_workgroup", Alike::kNo, "if (g > 8u) return;\ns[i] = i;\nbarrier();\no[i & 63u] = (s[i]);"},
    {"offset_by_data", Alike::kNo, "s[v[i + g] & 255u] = i;\nbarrier();\no[i & 63u] = (s[i]);"},
    {"offset_by_what_is_shared", Alike::kNo, "s[i] = i;\nbarrier();\no[i & 63u] = (s[s[i]]);"},
    {"offset_by_a_count", Alike::kNo,
     "uint at = atomicAdd(s[255], 1u);\nbarrier();\ns[at] = i;\nbarrier();\no[i & 63u] = (s[i]);"},
    {"an_order_of_atomic_operations", Alike::kNo,
     "if (i == 0u) { s[0] = 1u;\nmemoryBarrierShared();\natomicExchange(s[1], 1u); }\nbarrier();\no[i & 63u] = "
     "(s[i]);"},
    {"barrier_by_data", Alike::kNo, "s[i] = i;\nif (v[g] == 3u) barrier();\no[i & 63u] = (s[i]);"},
};

class RaceAlike : public testing::TestWithParam<Case> {};

TEST_P(RaceAlike, IsKnownOfTheProgram) {
  const std::string declarations = "shared uint s[256];\nlayout(set = 0, binding = 9) readonly buffer N { uint n; };";
  const PlantedRace planted{"", "", 64, 1, declarations.c_str(), GetParam().body, ""};
  for (const bool optimized : {false, true}) {
    const auto module = race_module(VK_SHADER_STAGE_COMPUTE_BIT, text_of(planted, planted.fault), Language::kGlsl,
                                    DebugInfo::kNone, optimized);
    Catcher catcher;
    Scene scene;
    scene.run(catcher, VK_SHADER_STAGE_COMPUTE_BIT, module);
    ASSERT_NE(catcher.told, nullptr);
    const race::Sites& sites = catcher.told->sites;
    const Alike found = !sites.alike ? Alike::kNo : sites.alike_if_given ? Alike::kIfGiven : Alike::kAlways;
    EXPECT_EQ(found, GetParam().expected);
  }
}

INSTANTIATE_TEST_SUITE_P(Shaders, RaceAlike, testing::ValuesIn(kCases),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace vitrine::glass::test

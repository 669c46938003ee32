// Planted faults of variables and shared memory that nothing has written, and of what needs invocations together.
#include "tests/glass/catalogue.h"

namespace vitrine::glass::test {
namespace {

constexpr char kSampler[] = "layout(set = 0, binding = 8) uniform sampler2D s;";

constexpr Planted kPlanted[] = {
    {"shared_hole", "uninitialized-shared", "shared uint s[8];",
     "if (i != 3u)\ns[i] = i;\nbarrier();\n@v[i] = s[7u - i];", "s[i] = i;\nbarrier();\nv[i] = s[7u - i];",
     Where::kCompute},
    {"shared_counter", "uninitialized-shared", "shared uint n;", "@atomicAdd(n, i);\nbarrier();\nv[i] = n;",
     "if (i == 0u) n = 0u;\nbarrier();\natomicAdd(n, i);\nbarrier();\nv[i] = n;", Where::kCompute},
    {"variable_of_one_branch", "uninitialized-variable", "", "uint x;\nif (i < 5u)\nx = i;\n@v[i] = x;",
     "uint x;\nif (i < 5u)\nx = i;\nelse\nx = 2u;\nv[i] = x;"},
    {"accumulator", "uninitialized-variable", "", "uint s;\nfor (uint k = 0u; k < v[4]; ++k)\ns += k;\n@v[i] = s;",
     "uint s = 0u;\nfor (uint k = 0u; k < v[4]; ++k)\ns += k;\nv[i] = s;"},
    {"component", "uninitialized-variable", "",
     "uvec4 x;\nx.xyz = uvec3(i, i, i);\nuvec4 y = x * 2u;\n@v[i] = y.x + y.w;",
     "uvec4 x;\nx.xyz = uvec3(i, i, i);\nuvec4 y = x * 2u;\nv[i] = y.x + y.z;"},
    {"element", "uninitialized-variable", "", "uint a[8];\nfor (uint k = 0u; k < v[7]; ++k)\na[k] = k;\n@v[i] = a[i];",
     "uint a[8];\nfor (uint k = 0u; k < v[8]; ++k)\na[k] = k;\nv[i] = a[i];"},
    {"branch_on_a_variable", "uninitialized-variable", "", "uint x;\nif (i < 5u)\nx = i;\n@if (x == 3u)\nv[i] = 1u;",
     "uint x = 7u;\nif (i < 5u)\nx = i;\nif (x == 3u)\nv[i] = 1u;"},
    {"index", "uninitialized-variable", "", "uint x;\nif (i < 5u)\nx = i;\n@v[x & 7u] = i;",
     "uint x = 7u;\nif (i < 5u)\nx = i;\nv[x & 7u] = i;"},
    {"barrier_in_a_branch", "divergent-barrier", "shared uint s;", "if (i < 3u) {\ns = i;\n@barrier();\n}\nv[i] = i;",
     "if (v[10] == 10u) {\ns = i;\nbarrier();\n}\nv[i] = i;", Where::kCompute},
    {"barrier_behind_a_return", "divergent-barrier", "shared uint s[8];",
     "if (i >= 6u) return;\ns[i] = i;\n@barrier();\nv[i] = s[i];",
     "s[i] = i;\nbarrier();\nif (i >= 6u) return;\nv[i] = s[i];", Where::kCompute},
    {"derivative_in_a_branch", "divergent-derivative", "", "if (i < 3u)\n@v[i] = bits(dFdx(float(v[i])));",
     "if (i < 4u)\nv[i] = bits(dFdx(float(v[i])));", Where::kFragment},
    {"derivative_in_a_loop", "divergent-derivative", "",
     "for (uint k = 0u; k < v[i]; ++k)\n@v[i + 16u] = bits(fwidth(float(v[i] + k)));",
     "for (uint k = 0u; k < v[40] / 20u; ++k)\nv[i + 16u] = bits(fwidth(float(v[i] + k)));", Where::kFragment},
    {"fine_derivative_behind_a_return", "divergent-derivative", "",
     "if (i == 5u) return;\n@v[i] = bits(dFdyFine(float(v[i])));",
     "if (i == 5u) discard;\nv[i] = bits(dFdyFine(float(v[i])));", Where::kFragment},
    {"derivative_in_a_function", "divergent-derivative", "float f(float x) {\n@return dFdxCoarse(x * 2.0);\n}",
     "if (i != 1u)\nv[i] = bits(f(float(i)));", "if (i != 9u)\nv[i] = bits(f(float(i)));", Where::kFragment},
    {"lookup_in_a_branch", "divergent-implicit-lookup", kSampler,
     "if (i < 3u)\n@v[i] = bits(texture(s, vec2(float(i), 0.0)).x);",
     "if (i < 3u)\nv[i] = bits(textureLod(s, vec2(float(i), 0.0), 0.0).x);", Where::kFragment},
    {"lookup_with_bias_in_a_switch", "divergent-implicit-lookup", kSampler,
     "switch (i) {\ncase 0u:\n@v[i] = bits(texture(s, vec2(float(i), 0.0), 1.0).x);\nbreak;\ndefault:\nbreak;\n}",
     "switch (i) {\ncase 0u:\nv[i] = bits(textureGrad(s, vec2(float(i), 0.0), vec2(0.0), "
     "vec2(0.0)).x);\nbreak;\ndefault:\nbreak;\n}",
     Where::kFragment},
    {"lookup_behind_a_return", "divergent-implicit-lookup", kSampler,
     "if (v[i] > 4u) return;\n@v[i] = bits(texture(s, vec2(float(i), 0.0)).x);",
     "if (v[i] > 4u) discard;\nv[i] = bits(texture(s, vec2(float(i), 0.0)).x);", Where::kFragment},
    {"level_in_a_branch", "divergent-implicit-lookup", kSampler,
     "if (i > 2u)\n@v[i] = bits(textureQueryLod(s, vec2(float(i), 0.0)).x);",
     "if (i > 3u)\nv[i] = bits(textureQueryLod(s, vec2(float(i), 0.0)).x);", Where::kFragment},
};

class CatalogueFlow : public Catalogue {};

TEST_P(CatalogueFlow, FaultIsFoundAloneOnItsLine) { expect_found(*GetParam().planted, *GetParam().variant); }

TEST_P(CatalogueFlow, TwinIsSilent) { expect_silence(*GetParam().planted, *GetParam().variant); }

INSTANTIATE_TEST_SUITE_P(Catalogue, CatalogueFlow, testing::ValuesIn(cases_of(kPlanted)), name_of);

TEST(CatalogueFlowCount, IsNotLess) {
  EXPECT_GE(faults_in(kPlanted), 65u);
  EXPECT_EQ(unchanged_by_optimizer(kPlanted), 0u);
}

}  // namespace
}  // namespace vitrine::glass::test

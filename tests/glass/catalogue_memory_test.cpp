// Planted faults of accesses: outside of buffers, shared memory and arrays.
#include "tests/glass/catalogue.h"

namespace vitrine::glass::test {
namespace {

constexpr Planted kPlanted[] = {
    {"load", "out-of-bounds-load", "", "v[0] = v[i + 60u];", "v[0] = v[i + 56u];"},
    {"load_by_all", "out-of-bounds-load", "", "v[i] = v[v[63] + 1u];", "v[i] = v[v[62] + 1u];"},
    {"load_that_wraps", "out-of-bounds-load", "", "v[i] = v[i - 1u];", "v[i] = v[i + 1u];"},
    {"load_in_a_function", "out-of-bounds-load", "uint f(uint x) {\n@return v[x + 60u];\n}", "v[i] = f(i);",
     "v[i] = f(i / 2u);"},
    {"store", "out-of-bounds-store", "", "v[i + 61u] = 1u;", "v[i + 56u] = 1u;"},
    {"store_in_a_loop", "out-of-bounds-store", "", "for (uint k = 0u; k < v[4]; ++k)\n@v[60u + i + k] = k;",
     "for (uint k = 0u; k < v[4]; ++k)\nv[10u + i + k] = k;"},
    {"store_in_a_branch", "out-of-bounds-store", "", "if (v[i] == 3u)\n@v[v[i] * 22u] = 7u;",
     "if (v[i] == 3u)\nv[v[i] * 20u] = 7u;"},
    {"atomic_operation", "out-of-bounds-atomic", "", "atomicAdd(v[i * 10u], 1u);", "atomicAdd(v[i * 9u], 1u);"},
    {"shared_store", "out-of-bounds-shared", "shared uint s[12];",
     "s[i] = i;\n@s[i + 8u] = i;\nbarrier();\nv[i] = s[i];", "s[i] = i;\ns[i + 4u] = i;\nbarrier();\nv[i] = s[i];",
     Where::kCompute},
    {"array_load", "out-of-bounds-array", "",
     "uint a[5];\nfor (uint k = 0u; k < 5u; ++k)\na[k] = v[k];\n@v[i] = a[v[i]];",
     "uint a[5];\nfor (uint k = 0u; k < 5u; ++k)\na[k] = v[k];\nv[i] = a[v[i] % 5u];"},
    {"array_store", "out-of-bounds-array", "",
     "uint a[5];\nfor (uint k = 0u; k < 5u; ++k)\na[k] = v[k];\n@a[v[i]] = 1u;\nv[i] = a[v[1]];",
     "uint a[5];\nfor (uint k = 0u; k < 5u; ++k)\na[k] = v[k];\na[v[i] / 2u] = 1u;\nv[i] = a[v[1]];"},
};

class CatalogueMemory : public Catalogue {};

TEST_P(CatalogueMemory, FaultIsFoundAloneOnItsLine) { expect_found(*GetParam().planted, *GetParam().variant); }

TEST_P(CatalogueMemory, TwinIsSilent) { expect_silence(*GetParam().planted, *GetParam().variant); }

INSTANTIATE_TEST_SUITE_P(Catalogue, CatalogueMemory, testing::ValuesIn(cases_of(kPlanted)), name_of);

TEST(CatalogueMemoryCount, IsNotLess) {
  EXPECT_GE(faults_in(kPlanted), 70u);
  EXPECT_EQ(unchanged_by_optimizer(kPlanted), 0u);
}

}  // namespace
}  // namespace vitrine::glass::test

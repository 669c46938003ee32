// Planted faults of memory and images that nothing has written, and of what is gone.
#include "tests/glass/catalogue.h"

namespace vitrine::glass::test {
namespace {

/// Resources of the scene in GLSL.
constexpr char kWords[] = "layout(set = 0, binding = 9) buffer F { uint fresh[]; };";
constexpr char kImage[] = "layout(set = 0, binding = 10, r32ui) uniform uimage2D m;";
constexpr char kTexture[] = "layout(set = 0, binding = 11) uniform utexture2D t;";
constexpr char kGone[] = "layout(set = 0, binding = 12) buffer G { uint gone[]; };";
constexpr char kPointer[] =
    "layout(push_constant) uniform P { uvec2 address; };\n"
    "layout(buffer_reference, std430, buffer_reference_align = 4) buffer W { uint x[]; };";

constexpr Planted kPlanted[] = {
    {"load", "uninitialized-memory", kWords, "v[i] = fresh[i + 28u];", "v[i] = fresh[i + 24u];", Where::kGlsl},
    {"load_of_all", "uninitialized-memory", kWords, "v[i] = fresh[v[40]];", "v[i] = fresh[v[20]];", Where::kGlsl},
    {"load_in_a_branch", "uninitialized-memory", kWords, "if (i > 3u)\n@v[i] = fresh[i + 28u];",
     "if (i < 4u)\nv[i] = fresh[i + 28u];", Where::kGlsl},
    {"sum", "uninitialized-memory", kWords, "fresh[i + 40u] += 1u;", "fresh[i + 40u] = 1u;", Where::kGlsl},
    {"counter", "uninitialized-memory", kWords, "atomicAdd(fresh[i + 40u], 1u);", "atomicAdd(fresh[i + 24u], 1u);",
     Where::kGlsl},
    {"load_before_the_store", "uninitialized-memory", kWords, "@v[i] = fresh[i + 40u];\nfresh[i + 40u] = 3u;",
     "fresh[i + 40u] = 3u;\nv[i] = fresh[i + 40u];", Where::kGlsl},
    {"texel", "uninitialized-image", kImage, "v[i] = imageLoad(m, ivec2(i % 4u, i / 4u)).x;",
     "v[i] = imageLoad(m, ivec2(i % 4u, 0)).x;", Where::kGlsl},
    {"atomic_on_a_texel", "uninitialized-image", kImage, "imageAtomicAdd(m, ivec2(i % 4u, 2), 1u);",
     "imageAtomicAdd(m, ivec2(i % 4u, 0), 1u);", Where::kGlsl},
    {"fetch", "uninitialized-image", kTexture, "v[i] = texelFetch(t, ivec2(i % 4u, i / 4u), 0).x;",
     "v[i] = texelFetch(t, ivec2(i % 4u, 0), 0).x;", Where::kGlsl},
    {"buffer_that_is_gone", "destroyed-descriptor", kGone, "v[i] = gone[i];", "if (v[i] > 100u)\nv[i] = gone[i];",
     Where::kGlsl},
    {"store_to_a_buffer_that_is_gone", "destroyed-descriptor", kGone, "gone[i] = 7u;",
     "if (v[i] > 100u)\ngone[i] = 7u;", Where::kGlsl},
    {"address_of_a_buffer_that_is_gone", "freed-device-address", kPointer,
     "v[i] = W(address + uvec2(i / 7u * 512u, 0u)).x[0];", "v[i] = W(address + uvec2(i / 7u * 64u, 0u)).x[0];",
     Where::kGlsl},
    {"store_at_an_address_that_is_gone", "freed-device-address", kPointer, "W(address).x[i / 7u * 130u] = 1u;",
     "W(address).x[i / 7u * 13u] = 1u;", Where::kGlsl},
};

class CatalogueUnwritten : public Catalogue {};

TEST_P(CatalogueUnwritten, FaultIsFoundAloneOnItsLine) { expect_found(*GetParam().planted, *GetParam().variant); }

TEST_P(CatalogueUnwritten, TwinIsSilent) { expect_silence(*GetParam().planted, *GetParam().variant); }

INSTANTIATE_TEST_SUITE_P(Catalogue, CatalogueUnwritten, testing::ValuesIn(cases_of(kPlanted)), name_of);

TEST(CatalogueUnwrittenCount, IsNotLess) {
  EXPECT_GE(faults_in(kPlanted), 78u);
  EXPECT_EQ(unchanged_by_optimizer(kPlanted), 0u);
}

}  // namespace
}  // namespace vitrine::glass::test

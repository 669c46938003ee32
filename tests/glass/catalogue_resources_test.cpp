// Planted faults of images, texel buffers, descriptors, push constants and device addresses.
#include "tests/glass/catalogue.h"

namespace vitrine::glass::test {
namespace {

/// Resources of the scene in GLSL.
constexpr char kTexture[] = "layout(set = 0, binding = 1) uniform utexture2D t;";
constexpr char kImage[] = "layout(set = 0, binding = 2, r32ui) uniform uimage2D m;";
constexpr char kLayers[] = "layout(set = 0, binding = 3, r32ui) uniform uimage2DArray layers;";
constexpr char kTexels[] = "layout(set = 0, binding = 4, r32ui) uniform uimageBuffer texels;";
constexpr char kNothing[] = "layout(set = 0, binding = 5) buffer N { uint nothing[]; };";
constexpr char kMany[] = "layout(set = 0, binding = 6, r32ui) uniform uimage2D many[3];";
constexpr char kFour[] = "layout(set = 0, binding = 7) buffer O { uint w[]; } four[4];";
constexpr char kPush[] = "layout(push_constant) uniform P { uvec2 address; uint n[4]; };";
constexpr char kPointers[] =
    "layout(push_constant) uniform P { uvec2 address; };\n"
    "layout(buffer_reference, std430, buffer_reference_align = 16) buffer R { uvec4 x; };\n"
    "layout(buffer_reference, std430, buffer_reference_align = 4) buffer W { uint x[]; };";

constexpr Planted kPlanted[] = {
    {"fetch", "out-of-bounds-image", kTexture, "v[i] = texelFetch(t, ivec2(i, 0), 0).x;",
     "v[i] = texelFetch(t, ivec2(i % 4u, i / 4u), 0).x;", Where::kGlsl},
    {"fetch_of_a_level", "out-of-bounds-image", kTexture, "v[i] = texelFetch(t, ivec2(i / 4u), int(i % 3u)).x;",
     "v[i] = texelFetch(t, ivec2(i / 4u), int(i % 2u)).x;", Where::kGlsl},
    {"image_load", "out-of-bounds-image", kImage, "v[i] = imageLoad(m, ivec2(int(i) - 1, 0)).x;",
     "v[i] = imageLoad(m, ivec2(i / 2u, 0)).x;", Where::kGlsl},
    {"image_store", "out-of-bounds-image", kImage, "imageStore(m, ivec2(0, i), uvec4(1u));",
     "imageStore(m, ivec2(0, i / 2u), uvec4(1u));", Where::kGlsl},
    {"image_store_in_a_branch", "out-of-bounds-image", kImage,
     "if (i == 3u)\n@imageStore(m, ivec2(i + 1u), uvec4(1u));", "if (i == 3u)\nimageStore(m, ivec2(i), uvec4(1u));",
     Where::kGlsl},
    {"image_atomic", "out-of-bounds-image", kImage, "v[i] = imageAtomicAdd(m, ivec2(i), 1u);",
     "v[i] = imageAtomicAdd(m, ivec2(i / 2u), 1u);", Where::kGlsl},
    {"image_layer", "out-of-bounds-image", kLayers, "v[i] = imageLoad(layers, ivec3(0, 0, i / 3u)).x;",
     "v[i] = imageLoad(layers, ivec3(0, 0, i / 4u)).x;", Where::kGlsl},
    {"texel_load", "out-of-bounds-texel-buffer", kTexels, "v[i] = imageLoad(texels, int(i + 3u)).x;",
     "v[i] = imageLoad(texels, int(i)).x;", Where::kGlsl},
    {"texel_store", "out-of-bounds-texel-buffer", kTexels, "imageStore(texels, int(i) - 2, uvec4(1u));",
     "imageStore(texels, int(i), uvec4(1u));", Where::kGlsl},
    {"texel_atomic", "out-of-bounds-texel-buffer", kTexels, "imageAtomicMax(texels, int(i * 2u), 1u);",
     "imageAtomicMax(texels, int(i), 1u);", Where::kGlsl},
    {"unwritten_buffer", "unwritten-descriptor", kNothing, "nothing[i] = 1u;", "if (v[i] > 100u)\nnothing[i] = 1u;",
     Where::kGlsl},
    {"unwritten_image", "unwritten-descriptor", kMany, "v[i] = imageLoad(many[nonuniformEXT(i % 3u)], ivec2(0)).x;",
     "v[i] = imageLoad(many[nonuniformEXT(i % 2u)], ivec2(0)).x;", Where::kGlsl},
    {"descriptor_past_the_end", "out-of-range-descriptor", kFour, "v[i] = four[nonuniformEXT(i)].w[i];",
     "v[i] = four[nonuniformEXT(i / 2u)].w[i];", Where::kGlsl},
    {"descriptor_past_the_end_by_all", "out-of-range-descriptor", kFour, "four[v[40] / 10u].w[i] = 3u;",
     "four[v[40] / 20u].w[i] = 3u;", Where::kGlsl},
    {"buffer_load_by_a_varying_index", "non-uniform-index", kFour, "v[i] = four[i / 2u].w[i];",
     "v[i] = four[nonuniformEXT(i / 2u)].w[i];", Where::kGlsl},
    {"buffer_store_by_a_varying_index", "non-uniform-index", kFour, "four[i / 2u].w[i] = 7u;",
     "four[v[41] - 40u].w[i] = 7u;", Where::kGlsl},
    {"atomic_by_a_varying_index", "non-uniform-index", kFour, "atomicAdd(four[v[i] & 1u].w[i], 7u);",
     "atomicAdd(four[nonuniformEXT(v[i] & 1u)].w[i], 7u);", Where::kGlsl},
    {"image_load_by_a_varying_index", "non-uniform-index", kMany, "v[i] = imageLoad(many[i & 1u], ivec2(0)).x;",
     "v[i] = imageLoad(many[nonuniformEXT(i & 1u)], ivec2(0)).x;", Where::kGlsl},
    {"image_store_by_a_varying_index", "non-uniform-index", kMany, "imageStore(many[i & 1u], ivec2(0), uvec4(1u));",
     "if (i < 3u)\nimageStore(many[i / 3u], ivec2(0), uvec4(1u));", Where::kGlsl},
    {"image_atomic_by_a_varying_index", "non-uniform-index", kMany, "imageAtomicAdd(many[i & 1u], ivec2(0), 1u);",
     "imageAtomicAdd(many[nonuniformEXT(i & 1u)], ivec2(0), 1u);", Where::kGlsl},
    {"push_constant_past_the_block", "out-of-bounds-push-constant", kPush, "v[i] = n[i / 7u * 4u];",
     "v[i] = n[i / 7u];", Where::kGlsl},
    {"push_constant_past_the_layout", "out-of-bounds-push-constant", kPush, "v[i] = n[i / 7u * 3u];",
     "v[i] = n[i / 4u];", Where::kGlsl},
    {"push_constant_of_all_past_the_layout", "out-of-bounds-push-constant", kPush, "v[i] = n[3];", "v[i] = n[1];",
     Where::kGlsl},
    {"push_constant_that_was_not_set", "uninitialized-push-constant", kPush, "v[i] = n[2];", "v[i] = n[0] + address.x;",
     Where::kGlsl},
    {"push_constant_that_one_reads", "uninitialized-push-constant", kPush, "v[i] = n[i / 7u * 2u];",
     "v[i] = n[i / 7u];", Where::kGlsl},
    {"vector_that_is_not_aligned", "misaligned-access", kPointers,
     "@uvec4 q = R(address + uvec2(i * 4u, 0u)).x;\nv[i] = q.x + q.w;",
     "uvec4 q = R(address + uvec2(i * 16u, 0u)).x;\nv[i] = q.x + q.w;", Where::kGlsl},
    {"store_that_is_not_aligned", "misaligned-access", kPointers, "R(address + uvec2(i * 8u, 0u)).x = uvec4(i);",
     "R(address + uvec2(i * 16u, 0u)).x = uvec4(i);", Where::kGlsl},
    {"scalar_that_is_not_aligned", "misaligned-access", kPointers, "v[i] = W(address + uvec2(i * 2u, 0u)).x[i];",
     "v[i] = W(address + uvec2(i * 4u, 0u)).x[i];", Where::kGlsl},
    {"atomic_that_is_not_aligned", "misaligned-access", kPointers, "atomicAdd(W(address + uvec2(i, 0u)).x[2], 1u);",
     "atomicAdd(W(address + uvec2(i * 8u, 0u)).x[2], 1u);", Where::kGlsl},
    {"address_past_the_end", "bad-device-address", kPointers, "v[i] = W(address + uvec2(i * 40u, 0u)).x[0];",
     "v[i] = W(address + uvec2(i * 36u, 0u)).x[0];", Where::kGlsl},
    {"element_past_the_end", "bad-device-address", kPointers, "W(address).x[i * 10u] = 1u;",
     "W(address).x[i * 9u] = 1u;", Where::kGlsl},
    {"vector_past_the_end", "bad-device-address", kPointers, "R(address + uvec2(i / 7u * 256u, 0u)).x = uvec4(i);",
     "R(address + uvec2(i / 7u * 240u, 0u)).x = uvec4(i);", Where::kGlsl},
};

class CatalogueResources : public Catalogue {};

TEST_P(CatalogueResources, FaultIsFoundAloneOnItsLine) { expect_found(*GetParam().planted, *GetParam().variant); }

TEST_P(CatalogueResources, TwinIsSilent) { expect_silence(*GetParam().planted, *GetParam().variant); }

INSTANTIATE_TEST_SUITE_P(Catalogue, CatalogueResources, testing::ValuesIn(cases_of(kPlanted)), name_of);

TEST(CatalogueResourcesCount, IsNotLess) {
  EXPECT_GE(faults_in(kPlanted), 180u);
  EXPECT_EQ(unchanged_by_optimizer(kPlanted), 0u);
}

}  // namespace
}  // namespace vitrine::glass::test

// What findings say of push constants, device addresses and indices of descriptors.
#include "tests/glass/scene.h"

namespace vitrine::glass::test {
namespace {

/// As texts_of(), of a compute shader with workgroups of four.
std::vector<std::string> found(const std::string& declarations, const std::string& body, std::uint32_t groups = 2) {
  std::string log;
  const auto module = vitrine::test::compile_glsl(VK_SHADER_STAGE_COMPUTE_BIT, R"(#version 460
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
layout(local_size_x = 4) in;
layout(set = 0, binding = 0) buffer B { uint v[]; };
)" + declarations + R"(
void main() {
  uint i = gl_GlobalInvocationID.x;
)" + body + "}\n",
                                                  vitrine::test::VulkanVersion::k12, log);
  EXPECT_FALSE(module.empty()) << log;
  const auto tool = make_sanitize();
  Scene scene;
  scene.groups = groups;
  scene.run(*tool, VK_SHADER_STAGE_COMPUTE_BIT, module);
  return texts_of(*tool);
}

using Texts = std::vector<std::string>;

TEST(SanitizePushConstants, AreOfTheBlockTheLayoutAndSet) {
  const std::string block = "layout(push_constant) uniform P { uvec2 address; uint n[4]; };";
  EXPECT_EQ(found(block, "v[i] = n[i / 7u * 5u];"),
            Texts{"out-of-bounds-push-constant x1 at 7: load of 4 bytes at offset 28, outside of the block of push "
                  "constants (24 bytes)"});
  EXPECT_EQ(
      found(block, "v[i] = n[3];"),
      Texts{"out-of-bounds-push-constant x8 at 0: load of 4 bytes at offset 20, which no range of push constants in "
            "the pipeline layout has"});
  EXPECT_EQ(
      found(block, "if (i > 4u) v[i] = n[2];"),
      Texts{"uninitialized-push-constant x3 at 5: load of 4 bytes at offset 16 of push constants that were not set"});
  EXPECT_EQ(found(block, "v[i] = n[i / 4u] + address.y;"), Texts{});
  EXPECT_EQ(found(block, "if (i > 8u) v[i] = n[2];"), Texts{});
}

TEST(SanitizeAddresses, AreMultiplesOfWhatIsPromised) {
  const std::string pointers =
      "layout(push_constant) uniform P { uvec2 address; };\n"
      "layout(buffer_reference, std430, buffer_reference_align = 16) buffer R { uvec4 x; };";
  EXPECT_EQ(found(pointers, "R(address + uvec2(i * 4u, 0u)).x = uvec4(1u);"),
            Texts{"misaligned-access x6 at 1: store at an address that is 4 more than a multiple of 16"});
  EXPECT_EQ(found(pointers, "uvec4 q = R(address + uvec2(i * 8u, 0u)).x; v[i] = q.x + q.y + q.z + q.w;"),
            Texts{"misaligned-access x4 at 1: load at an address that is 8 more than a multiple of 16"});
  EXPECT_EQ(found(pointers, "R(address + uvec2(i * 16u, 0u)).x = uvec4(1u);"), Texts{});
  EXPECT_EQ(found(pointers, "if (i > 8u) R(address + uvec2(i * 4u, 0u)).x = uvec4(1u);"), Texts{});
}

TEST(SanitizeIndices, AgreeInAWorkgroup) {
  const std::string four = "layout(set = 0, binding = 7) buffer O { uint w[]; } four[4];";
  EXPECT_EQ(
      found(four, "four[i / 2u].w[i] = 1u;"),
      Texts{"non-uniform-index x4 at 2: descriptor 1 where other invocations choose another, with an index that is "
            "not NonUniform"});
  EXPECT_EQ(found(four, "four[nonuniformEXT(i / 2u)].w[i] = 1u;"), Texts{});
  EXPECT_EQ(found(four, "four[gl_WorkGroupID.x].w[i] = 1u;", 4), Texts{}) << "waves have several workgroups";
  EXPECT_EQ(found(four, "four[i / 4u].w[i] = 1u;", 4), Texts{});
  EXPECT_EQ(found(four, "for (uint k = 0u; k < 4u; ++k) if (k == i / 2u) four[k].w[i] = 1u;"), Texts{})
      << "one after the other";
}

}  // namespace
}  // namespace vitrine::glass::test

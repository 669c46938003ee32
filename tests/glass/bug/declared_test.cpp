// The descriptors that modules declare, and what bindings hold.
#include "glass/bug/declared.h"

#include <gtest/gtest.h>

#include "glass/bug/contents.h"
#include "tests/glass/bug/bugs.h"
#include "tests/spirv/front/glsl.h"

namespace vitrine::glass::bug {
namespace {

constexpr std::uint32_t bits(std::initializer_list<VkDescriptorType> types) {
  std::uint32_t out = 0;
  for (const VkDescriptorType type : types) out |= 1u << type;
  return out;
}

TEST(Declared, AreTheTypesOfVariables) {
  const spirv::test::Words words = spirv::test::compile_glsl(VK_SHADER_STAGE_COMPUTE_BIT, R"(
layout(binding = 0) uniform U { uint u; };
layout(binding = 1) buffer S { uint s; } storage[2][3];
layout(binding = 2) uniform texture2D image[4];
layout(binding = 3, r32ui) uniform uimage2D stored;
layout(set = 1, binding = 4) uniform usamplerBuffer texels;
layout(set = 1, binding = 5, r32ui) uniform uimageBuffer more_texels;
layout(set = 1, binding = 6) uniform sampler filtering;
layout(set = 1, binding = 7) uniform sampler2D both;
layout(set = 1, binding = 7) uniform V { uint v; };
void main() {
  storage[1][1].s = u + v + imageLoad(stored, ivec2(0)).x + texelFetch(texels, 0).x + imageLoad(more_texels, 0).x;
  vec4 color = textureLod(sampler2D(image[1], filtering), vec2(0), 0.0) + textureLod(both, vec2(0), 0.0);
  storage[1][2].s = uint(color.x);
})");
  Declared declared;
  add_declared(words, declared);
  const std::uint32_t uniform = bits({VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC});
  const std::uint32_t combined = bits({VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER});
  const Declared expected = {
      {{0, 0}, uniform},
      {{0, 1}, bits({VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC})},
      {{0, 2}, bits({VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE}) | combined},
      {{0, 3}, bits({VK_DESCRIPTOR_TYPE_STORAGE_IMAGE})},
      {{1, 4}, bits({VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER})},
      {{1, 5}, bits({VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER})},
      {{1, 6}, bits({VK_DESCRIPTOR_TYPE_SAMPLER}) | combined},
      {{1, 7}, combined | uniform}};
  EXPECT_EQ(declared, expected);
}

TEST(Declared, OfAnyWordsAreSomething) {
  spirv::test::Words words = {
      0x07230203, 0x00010300, 0, 20, 0,          0x0004001c, 1, 1, 3,  // an array of itself
      0x00040020, 2,          2, 1,  0x0004003b, 2,          4, 2, 0x00040047, 4, 33, 9, 0x00040047, 5, 34, 8};
  Declared declared;
  add_declared(words, declared);
  EXPECT_EQ(declared, (Declared{{{0, 9}, 0}, {{8, 0}, 0}}));
  words.push_back(0x00090019);  // ends behind the module
  add_declared(words, declared);
  add_declared({}, declared);
  EXPECT_EQ(declared.size(), 2u);
}

TEST(Declared, MutableBindingsAreOfOneTypeWhereTheirDescriptorsAre) {
  Bug bug = small_bug();
  Binding& binding = bug.sets[0].bindings[0];
  EXPECT_EQ(plain_type(bug, 0, binding), VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
  binding.type = VK_DESCRIPTOR_TYPE_MUTABLE_EXT;
  binding.types = {VK_DESCRIPTOR_TYPE_SAMPLER, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER};
  bug.descriptors[0].type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  EXPECT_EQ(plain_type(bug, 0, binding), VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER);
  bug.descriptors.push_back(bug.descriptors[0]);
  EXPECT_EQ(plain_type(bug, 0, binding), VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER);
  bug.descriptors[1].type = VK_DESCRIPTOR_TYPE_SAMPLER;
  EXPECT_EQ(plain_type(bug, 0, binding), VK_DESCRIPTOR_TYPE_MUTABLE_EXT);
  bug.descriptors.clear();
  EXPECT_EQ(plain_type(bug, 0, binding), VK_DESCRIPTOR_TYPE_SAMPLER);
}

}  // namespace
}  // namespace vitrine::glass::bug

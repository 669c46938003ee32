// Every kind of resource variable against every descriptor type that the pipeline layout may have for its binding.
#include <algorithm>
#include <string>
#include <vector>

#include "tests/spirv/front/glsl.h"

namespace vitrine::spirv::test {
namespace {

struct Kind {
  const char* name;
  const char* declaration;  ///< of `r` at set 1, binding 3
  const char* use;          ///< a float
  std::vector<VkDescriptorType> fitting;
};

const Kind kKinds[] = {
    {"uniform buffer",
     "layout(set=1,binding=3) uniform R { float r; };",
     "r",
     {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC,
      VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK}},
    {"storage buffer",
     "layout(set=1,binding=3) buffer R { float r; };",
     "r",
     {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC}},
    {"storage buffer",
     "layout(set=1,binding=3) buffer R { float r; } b[2];",
     "b[1].r",
     {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC}},
    {"sampler",
     "layout(set=1,binding=3) uniform sampler r; layout(set=0,binding=0) uniform texture2D t;",
     "texture(sampler2D(t, r), vec2(0)).x",
     {VK_DESCRIPTOR_TYPE_SAMPLER, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}},
    {"combined image sampler",
     "layout(set=1,binding=3) uniform sampler2D r;",
     "texture(r, vec2(0)).x",
     {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}},
    {"combined image sampler",
     "layout(set=1,binding=3) uniform sampler2D r[2];",
     "texture(r[1], vec2(0)).x",
     {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}},
    {"sampled image",
     "layout(set=1,binding=3) uniform texture2D r; layout(set=0,binding=0) uniform sampler s;",
     "texture(sampler2D(r, s), vec2(0)).x",
     {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}},
    {"storage image",
     "layout(set=1,binding=3,r32f) uniform image2D r;",
     "imageLoad(r, ivec2(0)).x",
     {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}},
    {"input attachment",
     "layout(set=1,binding=3,input_attachment_index=0) uniform subpassInput r;",
     "subpassLoad(r).x",
     {VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT}},
    {"uniform texel buffer",
     "layout(set=1,binding=3) uniform samplerBuffer r;",
     "texelFetch(r, 0).x",
     {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER}},
    {"storage texel buffer",
     "layout(set=1,binding=3,r32f) uniform imageBuffer r;",
     "imageLoad(r, 0).x",
     {VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER}},
};

constexpr VkDescriptorType kTypes[] = {
    VK_DESCRIPTOR_TYPE_SAMPLER,
    VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
    VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
    VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
    VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,
    VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER,
    VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
    VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
    VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC,
    VK_DESCRIPTOR_TYPE_STORAGE_BUFFER_DYNAMIC,
    VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT,
    VK_DESCRIPTOR_TYPE_INLINE_UNIFORM_BLOCK,
    VK_DESCRIPTOR_TYPE_MUTABLE_EXT,
};

Words words_of(const Kind& kind) {
  const std::string text = std::string(kind.declaration) +
                           "\nlayout(location=0) out vec4 color;\nvoid main() { color = vec4(" + kind.use + "); }\n";
  return compile_glsl(VK_SHADER_STAGE_FRAGMENT_BIT, text);
}

TEST(Bindings, KindsAndDescriptorTypesMustFit) {
  for (const Kind& kind : kKinds) {
    const Words words = words_of(kind);
    for (const VkDescriptorType type : kTypes) {
      CompileOptions options = options_for(VK_SHADER_STAGE_FRAGMENT_BIT);
      options.sets[1].bindings[3].type = type;
      const bool fits = type == VK_DESCRIPTOR_TYPE_MUTABLE_EXT ||
                        std::find(kind.fitting.begin(), kind.fitting.end(), type) != kind.fitting.end();
      const auto shader = compile(words, options);
      EXPECT_EQ(static_cast<bool>(shader), fits) << kind.name << ", " << type;
      if (fits || shader) continue;
      const std::string& why = shader.message();
      const std::string where = "descriptor set 1, binding 3 is a " + std::string(kind.name) + " in the shader, but a ";
      EXPECT_NE(why.find(where), std::string::npos) << why;
      EXPECT_EQ(why.find("unknown"), std::string::npos) << why;
    }
  }
}

TEST(Bindings, MissingOnesAreNamed) {
  for (const Kind& kind : kKinds) {
    CompileOptions options = options_for(VK_SHADER_STAGE_FRAGMENT_BIT);
    options.sets[1].bindings.erase(options.sets[1].bindings.begin() + 3);
    const auto shader = compile(words_of(kind), options);
    ASSERT_FALSE(static_cast<bool>(shader)) << kind.name;
    EXPECT_NE(shader.message().find("descriptor set 1, binding 3"), std::string::npos) << shader.message();
    options.sets.clear();
    EXPECT_FALSE(static_cast<bool>(compile(words_of(kind), options))) << kind.name;
  }
}

TEST(Bindings, VariablesThatAreNotUsedDoNotMatterAndAliasesShareOne) {
  CompileOptions options = options_for(VK_SHADER_STAGE_FRAGMENT_BIT);
  options.sets[1].bindings[3].type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  const Words words = compile_glsl(VK_SHADER_STAGE_FRAGMENT_BIT, R"(
layout(set=1,binding=3) buffer A { float a; };
layout(set=1,binding=3) buffer B { uint b[]; };
layout(set=1,binding=3) uniform sampler2D unused;
layout(location=0) out vec4 color;
void main() { color = vec4(a, float(b[1]), 0, 0); }
)");
  const auto shader = compile(words, options);
  EXPECT_TRUE(static_cast<bool>(shader)) << (shader ? "" : shader.message());
}

}  // namespace
}  // namespace vitrine::spirv::test

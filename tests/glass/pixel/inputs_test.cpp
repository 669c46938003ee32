// What the tool pixel calls the inputs of fragment shaders, and what it says that they hold.
#include "glass/pixel/inputs.h"

#include <algorithm>
#include <bit>

#include "spirv/source_info.h"
#include "tests/glass/scene.h"

namespace vitrine::glass::pixel {
namespace {

using spirv::InterfaceSlot;
using Texts = std::vector<std::pair<std::string, std::string>>;

/// What a component of a location holds in these tests: its location and its number. Of built-ins its number.
std::uint32_t word_of(const InterfaceSlot& slot) {
  if (slot.built_in == spirv::BuiltIn::kFrontFacing) return ~0u;
  const std::uint32_t number = slot.location * 10u + slot.component;
  return slot.type == spirv::BaseType::kFloat ? std::bit_cast<std::uint32_t>(static_cast<float>(number)) : number;
}

struct Catcher : Tool {
  spirv::exec::Interest interest() const override { return {.images = true, .discards = true, .printf = true}; }
  std::shared_ptr<ProgramTool> attach(const ShaderIdentity&, const spirv::Program& program) override {
    const spirv::ShaderInterface& interface = program.observation->interface;
    texts = inputs_text(interface, program, [&](std::uint32_t reg) -> std::optional<std::uint32_t> {
      const auto slot = std::ranges::find(interface.inputs, reg, &InterfaceSlot::reg);
      return slot->built_in == unknown ? std::nullopt : std::optional(word_of(*slot));
    });
    return nullptr;
  }
  spirv::BuiltIn unknown = spirv::BuiltIn::kViewIndex;
  Texts texts;
};

/// Without what some instructions say.
std::vector<std::uint32_t> without(const std::vector<std::uint32_t>& words, std::initializer_list<std::uint32_t> ops) {
  std::vector<std::uint32_t> kept(words.begin(), words.begin() + 5);
  for (std::size_t at = 5; at < words.size(); at += words[at] >> 16)
    if (std::ranges::find(ops, words[at] & 0xffff) == ops.end())
      kept.insert(kept.end(), words.begin() + static_cast<std::ptrdiff_t>(at),
                  words.begin() + static_cast<std::ptrdiff_t>(at + (words[at] >> 16)));
  return kept;
}
constexpr std::initializer_list<std::uint32_t> kNames = {5, 6};  // OpName, OpMemberName

Texts inputs_of(const std::string& declarations, const std::string& body, bool stripped = false,
                vitrine::test::DebugInfo debug = vitrine::test::DebugInfo::kNone) {
  const std::string text = "#version 460\n#extension GL_EXT_fragment_shader_barycentric : enable\n" + declarations +
                           "\nlayout(location = 0) out vec4 o;\nvoid main() {\n" + body + "\n}\n";
  std::string log;
  auto module =
      vitrine::test::compile_glsl(VK_SHADER_STAGE_FRAGMENT_BIT, text, vitrine::test::VulkanVersion::k12, log, debug);
  EXPECT_FALSE(module.empty()) << log << text;
  if (stripped) module = without(module, kNames);
  Catcher catcher;
  glass::test::Scene scene;
  scene.run(catcher, VK_SHADER_STAGE_FRAGMENT_BIT, module);
  return catcher.texts;
}

TEST(PixelInputs, HaveTheNamesOfVariables) {
  EXPECT_EQ(inputs_of("layout(location = 3) in vec3 normal; layout(location = 1) flat in ivec2 ids;",
                      "o = vec4(normal, ids.x + ids.y);"),
            (Texts{{"input ids", "(10, 11)"}, {"input normal", "(30, 31, 32)"}}));
}

TEST(PixelInputs, SayWhichComponentsAreRead) {
  EXPECT_EQ(inputs_of("layout(location = 2) in vec4 tint;", "o = vec4(tint.y, tint.w, 0, 0);"),
            (Texts{{"input tint.yw", "(21, 23)"}}));
}

TEST(PixelInputs, ShareALocation) {
  EXPECT_EQ(inputs_of("layout(location = 2) in vec2 uv; layout(location = 2, component = 2) in float fog;",
                      "o = vec4(uv, fog, 0);"),
            (Texts{{"input uv", "(20, 21)"}, {"input fog", "(22)"}}));
}

TEST(PixelInputs, AreMembersOfStructuresAndElementsOfArrays) {
  EXPECT_EQ(inputs_of("struct Light { vec3 color; float power; };\n"
                      "layout(location = 1) in Surface { vec2 uv; Light lights[2]; } surface;\n"
                      "layout(location = 8) in mat2 turn;",
                      "o = vec4(surface.uv + turn[1], surface.lights[1].color.x, surface.lights[0].power);"),
            (Texts{{"input surface.uv", "(10, 11)"},
                   {"input surface.lights[0].power", "(30)"},
                   {"input surface.lights[1].color", "(40)"},
                   {"input turn[1]", "(90, 91)"}}));
}

TEST(PixelInputs, AreMembersOfBlocksWithoutAName) {
  EXPECT_EQ(inputs_of("layout(location = 1) in Surface { vec2 uv; vec2 more; };", "o = vec4(uv, more);"),
            (Texts{{"input uv", "(10, 11)"}, {"input more", "(20, 21)"}}));
}

TEST(PixelInputs, AreBuiltIns) {
  const char* const body = "o = vec4(gl_FragCoord.xy, gl_FrontFacing ? 1 : 0, gl_PrimitiveID);";
  EXPECT_EQ(
      inputs_of("", body),
      (Texts{{"input gl_FragCoord", "(0, 1)"}, {"input gl_FrontFacing", "(true)"}, {"input gl_PrimitiveID", "(0)"}}));
  EXPECT_EQ(inputs_of("", body, true),
            (Texts{{"input FragCoord", "(0, 1)"}, {"input FrontFacing", "(true)"}, {"input PrimitiveId", "(0)"}}));
}

TEST(PixelInputs, WithoutNamesAreLocations) {
  EXPECT_EQ(
      inputs_of("layout(location = 2) in vec2 uv; layout(location = 2, component = 3) in float fog;\n"
                "layout(location = 5) in Surface { vec4 color; } surface;",
                "o = vec4(uv, fog, surface.color.x);", true),
      (Texts{
          {"input location=2", "(20, 21)"}, {"input location=2 component=3", "(23)"}, {"input location=5", "(50)"}}));
}

TEST(PixelInputs, HaveTheNamesOfDebugInformation) {
  EXPECT_EQ(inputs_of("layout(location = 2) in vec2 uv;", "o = vec4(uv, 0, 0);", true,
                      vitrine::test::DebugInfo::kNonSemantic),
            (Texts{{"input uv", "(20, 21)"}}));
}

TEST(PixelInputs, OfAllVerticesAreElements) {
  EXPECT_EQ(inputs_of("layout(location = 4) pervertexEXT in vec2 corner[];", "o = vec4(corner[2], corner[0]);"),
            (Texts{{"input corner[0]", "(40, 41)"}, {"input corner[2]", "(40, 41)"}}));
}

TEST(PixelInputs, OfSixtyFourBitsAreOneNumber) {
  const Texts texts = inputs_of("layout(location = 0) flat in dvec2 far;", "o = vec4(float(far.x + far.y));");
  ASSERT_EQ(texts.size(), 1u);
  EXPECT_EQ(texts[0].first, "input far");
  EXPECT_EQ(std::ranges::count(texts[0].second, ','), 1) << texts[0].second;
}

}  // namespace
}  // namespace vitrine::glass::pixel

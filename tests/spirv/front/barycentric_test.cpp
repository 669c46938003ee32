// Inputs of the vertices of a primitive and barycentric coordinates (SPV_KHR_fragment_shader_barycentric): how they
// become slots, and what modules may not do.
#include <algorithm>
#include <set>

#include "tests/spirv/front/glsl.h"

namespace vitrine::spirv::test {
namespace {

constexpr char kExtension[] = "#extension GL_EXT_fragment_shader_barycentric : require\n";

std::unique_ptr<Shader> fragment_of(const std::string& text) {
  auto shader =
      compile(compile_glsl(VK_SHADER_STAGE_FRAGMENT_BIT, kExtension + text), options_for(VK_SHADER_STAGE_FRAGMENT_BIT));
  EXPECT_TRUE(shader) << shader.message();
  return shader ? shader.take() : nullptr;
}

TEST(Barycentric, EachVertexHasTheSameLocations) {
  const auto shader = fragment_of(
      "layout(location = 3) pervertexEXT in mat2 m[];\nlayout(location = 0) out vec4 color;\n"
      "void main() { color = vec4(m[0][0], m[1][1]) + vec4(m[2][1], 0, 0); }\n");
  ASSERT_NE(shader, nullptr);
  std::set<std::tuple<int, int, int>> slots;
  for (const InterfaceSlot& slot : shader->interface().inputs) {
    EXPECT_EQ(slot.interpolation, Interpolation::kFlat);
    slots.emplace(static_cast<int>(slot.part), slot.location, slot.component);
  }
  const int first = static_cast<int>(InputPart::kVertex0);
  for (const auto& [vertex, location] : {std::pair{0, 3}, std::pair{1, 4}, std::pair{2, 4}})
    for (const int component : {0, 1}) EXPECT_TRUE(slots.contains({first + vertex, location, component})) << vertex;
}

TEST(Barycentric, CoordinatesAreInterpolatedAsTheirNamesSay) {
  const auto shader = fragment_of(
      "layout(location = 0) out vec4 color;\nvoid main() {\n"
      "  color = vec4(gl_BaryCoordEXT.xy, gl_BaryCoordNoPerspEXT.yz) +\n"
      "      vec4(interpolateAtOffset(gl_BaryCoordNoPerspEXT, vec2(0.25)), "
      "interpolateAtCentroid(gl_BaryCoordEXT).z);\n}\n");
  ASSERT_NE(shader, nullptr);
  bool parts = false, centroid = false;
  for (const InterfaceSlot& slot : shader->interface().inputs) {
    const bool linear = slot.built_in == BuiltIn::kBaryCoordNoPersp;
    if (!linear && slot.built_in != BuiltIn::kBaryCoord) continue;
    EXPECT_EQ(slot.interpolation, linear ? Interpolation::kLinear : Interpolation::kPerspective);
    parts |= linear && slot.part == InputPart::kPlaneX;
    centroid |= !linear && slot.sample_location == SampleLocation::kCentroid;
  }
  EXPECT_TRUE(parts);
  EXPECT_TRUE(centroid);
}

/// Decorations that GLSL gives to no built-in.
TEST(Barycentric, CoordinatesLieWhereTheyAreDecorated) {
  for (const auto& [decoration, location] :
       {std::pair{"Centroid", SampleLocation::kCentroid}, std::pair{"Sample", SampleLocation::kSample}}) {
    const std::string text =
        std::string(
            "OpCapability Shader\nOpCapability SampleRateShading\nOpCapability FragmentBarycentricKHR\n"
            "OpExtension \"SPV_KHR_fragment_shader_barycentric\"\nOpMemoryModel Logical GLSL450\n"
            "OpEntryPoint Fragment %main \"main\" %in %out\nOpExecutionMode %main OriginUpperLeft\n"
            "OpDecorate %in BuiltIn BaryCoordKHR\nOpDecorate %in ") +
        decoration +
        "\nOpDecorate %out Location 0\n%void = OpTypeVoid\n%fn = OpTypeFunction %void\n%float = OpTypeFloat 32\n"
        "%v3 = OpTypeVector %float 3\n%in_ptr = OpTypePointer Input %v3\n%out_ptr = OpTypePointer Output %v3\n"
        "%in = OpVariable %in_ptr Input\n%out = OpVariable %out_ptr Output\n%main = OpFunction %void None %fn\n"
        "%entry = OpLabel\n%v = OpLoad %v3 %in\nOpStore %out %v\nOpReturn\nOpFunctionEnd\n";
    auto compiled = compile(assemble(text), options_for(VK_SHADER_STAGE_FRAGMENT_BIT));
    ASSERT_TRUE(compiled) << compiled.message();
    const auto shader = compiled.take();
    EXPECT_EQ(shader->interface().per_sample, location == SampleLocation::kSample);
    EXPECT_EQ(shader->interface().inputs.size(), 3u);
    for (const InterfaceSlot& slot : shader->interface().inputs) EXPECT_EQ(slot.sample_location, location);
  }
}

/// The message of a refused fragment shader that reads an input decorated PerVertexKHR of some type.
std::string message_of(const std::string& type) {
  const std::string text =
      "OpCapability Shader\nOpCapability FragmentBarycentricKHR\n"
      "OpExtension \"SPV_KHR_fragment_shader_barycentric\"\nOpMemoryModel Logical GLSL450\n"
      "OpEntryPoint Fragment %main \"main\" %in %out\nOpExecutionMode %main OriginUpperLeft\n"
      "OpDecorate %in Location 0\nOpDecorate %in PerVertexKHR\nOpDecorate %out Location 0\n"
      "%void = OpTypeVoid\n%fn = OpTypeFunction %void\n%uint = OpTypeInt 32 0\n%float = OpTypeFloat 32\n"
      "%u3 = OpConstant %uint 3\n%u4 = OpConstant %uint 4\n%of3 = OpTypeArray %float %u3\n"
      "%of4 = OpTypeArray %float %u4\n%in_ptr = OpTypePointer Input " +
      type +
      "\n%out_ptr = OpTypePointer Output %float\n%in = OpVariable %in_ptr Input\n%out = OpVariable %out_ptr Output\n"
      "%main = OpFunction %void None %fn\n%entry = OpLabel\n%v = OpLoad " +
      type + " %in\nOpReturn\nOpFunctionEnd\n";
  const auto shader = compile(assemble(text), options_for(VK_SHADER_STAGE_FRAGMENT_BIT));
  return shader ? "compiles" : shader.message();
}

TEST(Barycentric, WhatVerticesHaveIsAnArrayOfThree) {
  EXPECT_EQ(message_of("%of3"), "compiles");
  for (const char* const type : {"%of4", "%float"})
    EXPECT_NE(message_of(type).find("what vertices have is an array of three"), std::string::npos) << type;
}

}  // namespace
}  // namespace vitrine::spirv::test

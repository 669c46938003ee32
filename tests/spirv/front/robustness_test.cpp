// Damaged modules: an error or a shader, never a crash or a hang.
#include <chrono>

#include "spirv/front/translate.h"
#include "spirv/ir_passes.h"
#include "tests/spirv/compute_text.h"
#include "tests/spirv/front/glsl.h"

namespace vitrine::spirv::test {
namespace {

constexpr auto kFragment = VK_SHADER_STAGE_FRAGMENT_BIT;

const char* const kSource = R"(
  layout(set = 0, binding = 0) uniform U { mat4 m; vec4 v[4]; int n; } u;
  layout(set = 0, binding = 1) uniform sampler2D t[2]; layout(location = 0) in vec4 p; layout(location = 0) out vec4 c;
  float f(inout float x, int k) { for (int i = 0; i < k; i++) { if (x > 3.0) return x; x *= p.y; } return x; }
  void main() { float a[3] = float[3](p.x, p.y, p.z); float x = a[u.n];
    switch (u.n) { case 1: x += 1.0; case 2: x = f(x, 5); break; default: x = modf(p.w, a[1]); }
    if (x < 0.0) discard;
    c = u.m * u.v[u.n] + texture(t[1], p.xy) * x; })";

bool time_left(std::chrono::steady_clock::time_point start, int seconds) {
  return std::chrono::steady_clock::now() - start < std::chrono::seconds(seconds);
}

TEST(DamagedModule, EveryTruncation) {
  const Words words = compile_glsl(kFragment, kSource);
  for (std::size_t length = 0; length < words.size(); length++) {
    const std::span<const std::uint32_t> part(words.data(), length);
    static_cast<void>(translate(part, options_for(kFragment)));
    if (length % 16 == 0) {
      EXPECT_FALSE(compile(part, options_for(kFragment)));
    }
  }
}

/// The front end must survive whatever the words say.
TEST(DamagedModule, BitFlipsThroughTheFrontEnd) {
  const Words words = compile_glsl(kFragment, kSource);
  const auto start = std::chrono::steady_clock::now();
  std::size_t accepted = 0;
  // A stride coprime to 32 visits every bit position of the words early, whatever the time allows.
  const std::size_t bits = words.size() * 32;
  for (std::size_t i = 0; i < bits && time_left(start, 2); i++) {
    const std::size_t bit = i * 101 % bits;
    Words damaged = words;
    damaged[bit / 32] ^= 1u << (bit % 32);
    base::Result<ir::Function> result = translate(damaged, options_for(kFragment));
    if (!result) continue;
    accepted++;
    static_cast<void>(ir::verify(result.value()));
  }
  EXPECT_GT(accepted, 0u);
}

TEST(DamagedModule, BitFlipsThroughCompile) {
  const Words words = compile_glsl(kFragment, kSource);
  const auto start = std::chrono::steady_clock::now();
  const std::size_t bits = words.size() * 32;
  for (std::size_t i = 0; i < bits && time_left(start, 2); i++) {
    const std::size_t bit = i * 211 % bits;
    Words damaged = words;
    damaged[bit / 32] ^= 1u << (bit % 32);
    static_cast<void>(compile(damaged, options_for(kFragment)));
  }
}

TEST(DamagedModule, HeaderIsChecked) {
  Words words = compile_glsl(kFragment, kSource);
  EXPECT_EQ(check_module(words), "");
  EXPECT_NE(check_module({}), "");
  Words wrong = words;
  wrong[0] = 0x03022307;
  EXPECT_NE(check_module(wrong).find("magic"), std::string::npos);
  wrong = words;
  wrong[1] = 0x00020000;
  EXPECT_NE(check_module(wrong).find("version"), std::string::npos);
  wrong = words;
  wrong[5] = wrong[5] & 0xffff;
  EXPECT_NE(check_module(wrong).find("end of the module"), std::string::npos);
}

TEST(DamagedModule, WhatIsRefusedSaysWhatTheValidatorSaysToo) {
  const Words words = assemble(R"(OpCapability Shader
    OpMemoryModel Logical GLSL450
    OpEntryPoint Fragment %main "main"
    OpExecutionMode %main OriginUpperLeft
    %void = OpTypeVoid
    %fn = OpTypeFunction %void
    %float = OpTypeFloat 32
    %one = OpConstant %float 1
    %main = OpFunction %void None %fn
    %entry = OpLabel
    %sum = OpIAdd %float %main %one
    OpReturn
    OpFunctionEnd)");
  const auto result = compile(words, options_for(kFragment));
  ASSERT_FALSE(result);
  EXPECT_NE(result.message().find("OpIAdd"), std::string::npos) << result.message();
  EXPECT_NE(result.message().find("(SPIRV-Tools: Invalid use of function result id"), std::string::npos)
      << result.message();
}

/// As the Khronos suite has it: what LocalSize says does not count, so that it may say too much.
TEST(DamagedModule, WorkgroupSizeOverridesLocalSize) {
  ComputeText module;
  module.local_size = "9 13 106";
  module.annotations = "OpDecorate %size BuiltIn WorkgroupSize\n";
  module.declarations = "%u4 = OpConstant %uint 4\n%size = OpConstantComposite %v3uint %u4 %u1 %u1\n";
  const auto shader = compile(assemble(module.text()), options_for(VK_SHADER_STAGE_COMPUTE_BIT));
  ASSERT_TRUE(shader) << shader.message();
  EXPECT_EQ(shader.value()->interface().local_size[0], 4u);
  EXPECT_EQ(shader.value()->interface().local_size[2], 1u);
  module.annotations.clear();
  EXPECT_FALSE(compile(assemble(module.text()), options_for(VK_SHADER_STAGE_COMPUTE_BIT)));
}

/// A fragment shader with a Sample input and no SampleRateShading, as zink writes them.
TEST(DamagedModule, CapabilitiesThatVulkanKnowsNeedNoDeclaration) {
  const Words words = assemble(R"(OpCapability Shader
    OpMemoryModel Logical GLSL450
    OpEntryPoint Fragment %main "main" %in %out
    OpExecutionMode %main OriginUpperLeft
    OpDecorate %in Location 0
    OpDecorate %in Sample
    OpDecorate %out Location 0
    %void = OpTypeVoid
    %fn = OpTypeFunction %void
    %float = OpTypeFloat 32
    %in_ptr = OpTypePointer Input %float
    %out_ptr = OpTypePointer Output %float
    %in = OpVariable %in_ptr Input
    %out = OpVariable %out_ptr Output
    %main = OpFunction %void None %fn
    %entry = OpLabel
    %x = OpLoad %float %in
    OpStore %out %x
    OpReturn
    OpFunctionEnd)");
  const auto result = compile(words, options_for(kFragment));
  EXPECT_TRUE(result) << result.message();
}

/// What nothing does anything with harms nobody.
TEST(DamagedModule, WhatVulkanForbidsIsRefusedWhereItCannotBeExecuted) {
  const auto with = [](const std::string& body) {
    return assemble(R"(OpCapability Shader
    OpMemoryModel Logical GLSL450
    OpEntryPoint Fragment %main "main"
    OpExecutionMode %main OriginUpperLeft
    %void = OpTypeVoid
    %fn = OpTypeFunction %void
    %event = OpTypeEvent
    %ptr = OpTypePointer Function %event
    %main = OpFunction %void None %fn
    %entry = OpLabel
    )" + body + R"(
    OpReturn
    OpFunctionEnd)");
  };
  EXPECT_TRUE(compile(with(""), options_for(kFragment)));
  const auto used = compile(with("%v = OpVariable %ptr Function\n%value = OpLoad %event %v"), options_for(kFragment));
  ASSERT_FALSE(used);
  EXPECT_NE(used.message().find("OpLoad"), std::string::npos) << used.message();
}

/// gfxreconstruct restores stencil contents with such a shader; the reference takes the bits.
TEST(DamagedModule, StencilReferencesMayBeFloats) {
  const Words words = assemble(R"(OpCapability Shader
    OpCapability StencilExportEXT
    OpExtension "SPV_EXT_shader_stencil_export"
    OpMemoryModel Logical GLSL450
    OpEntryPoint Fragment %main "main" %out
    OpExecutionMode %main OriginUpperLeft
    OpExecutionMode %main StencilRefReplacingEXT
    OpDecorate %out BuiltIn FragStencilRefEXT
    %void = OpTypeVoid
    %fn = OpTypeFunction %void
    %float = OpTypeFloat 32
    %two = OpConstant %float 2
    %ptr = OpTypePointer Output %float
    %out = OpVariable %ptr Output
    %main = OpFunction %void None %fn
    %entry = OpLabel
    OpStore %out %two
    OpReturn
    OpFunctionEnd)");
  const auto shader = compile(words, options_for(kFragment));
  ASSERT_TRUE(shader) << shader.message();
  ASSERT_EQ(shader.value()->interface().outputs.size(), 1u);
  EXPECT_EQ(shader.value()->interface().outputs[0].built_in, BuiltIn::kFragStencilRef);
}

/// As the conformance suite's interface matching has it: two arrays of a geometry shader share a location.
TEST(DamagedModule, InputsOfGeometryShadersShareLocations) {
  const Words words = assemble(R"(OpCapability Geometry
    OpMemoryModel Logical GLSL450
    OpEntryPoint Geometry %main "main" %a %b %out
    OpExecutionMode %main Triangles
    OpExecutionMode %main Invocations 1
    OpExecutionMode %main OutputPoints
    OpExecutionMode %main OutputVertices 1
    OpDecorate %a Location 0
    OpDecorate %b Location 0
    OpDecorate %b Component 2
    OpDecorate %out Location 0
    %void = OpTypeVoid
    %fn = OpTypeFunction %void
    %float = OpTypeFloat 32
    %vec2 = OpTypeVector %float 2
    %uint = OpTypeInt 32 0
    %three = OpConstant %uint 3
    %one = OpConstant %uint 1
    %vertices = OpTypeArray %vec2 %three
    %in_ptr = OpTypePointer Input %vertices
    %vertex_ptr = OpTypePointer Input %vec2
    %out_ptr = OpTypePointer Output %vec2
    %a = OpVariable %in_ptr Input
    %b = OpVariable %in_ptr Input
    %out = OpVariable %out_ptr Output
    %main = OpFunction %void None %fn
    %entry = OpLabel
    %at_a = OpAccessChain %vertex_ptr %a %one
    %at_b = OpAccessChain %vertex_ptr %b %one
    %value_a = OpLoad %vec2 %at_a
    %value_b = OpLoad %vec2 %at_b
    %sum = OpFAdd %vec2 %value_a %value_b
    OpStore %out %sum
    OpEmitVertex
    OpReturn
    OpFunctionEnd)");
  const auto shader = compile(words, options_for(VK_SHADER_STAGE_GEOMETRY_BIT));
  EXPECT_TRUE(shader) << shader.message();
}

}  // namespace
}  // namespace vitrine::spirv::test

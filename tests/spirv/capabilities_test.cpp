// A module that declares a capability is accepted where the device has it, and refused by its name where not.
#include "spirv/capabilities.h"

#include <gtest/gtest.h>

#include <spirv/unified1/spirv.hpp11>

#include "spirv/compile.h"
#include "tests/spirv/front/glsl.h"

namespace vitrine::spirv::test {
namespace {

/// A compute shader that does nothing and declares the capability, with the extensions that the validator asks for.
std::string message_of(const std::string& capability) {
  const bool is_model = capability == "VulkanMemoryModel" || capability == "VulkanMemoryModelDeviceScope";
  std::string capabilities = "OpCapability Shader\nOpCapability " + capability + "\n", extensions;
  if (is_model) capabilities += "OpCapability VulkanMemoryModel\n";
  std::string message;
  for (int attempt = 0; attempt < 4; ++attempt) {
    const Words words =
        assemble(capabilities + extensions + "OpMemoryModel Logical " + (is_model ? "Vulkan" : "GLSL450") +
                     "\nOpEntryPoint GLCompute %main \"main\"\nOpExecutionMode %main LocalSize 1 1 1\n"
                     "%void = OpTypeVoid\n%function = OpTypeFunction %void\n"
                     "%main = OpFunction %void None %function\n%entry = OpLabel\nOpReturn\nOpFunctionEnd\n",
                 SPV_ENV_VULKAN_1_3);
    CompileOptions options = options_for(VK_SHADER_STAGE_COMPUTE_BIT);
    const auto shader = compile(words, options);
    if (shader) return {};
    message = shader.message();
    const std::size_t at = message.find("SPV_");
    if (at == std::string::npos) break;
    extensions += "OpExtension \"" + message.substr(at, message.find_first_of(" \n", at) - at) + "\"\n";
  }
  return message;
}

TEST(Capabilities, EverySupportedOneIsAccepted) {
  for (const char* name : {
#define VITRINE_CAPABILITY(name) #name,
#define VITRINE_NUMBERED_CAPABILITY(name, number) "!" #number,
#include "spirv/capabilities.def"
#undef VITRINE_CAPABILITY
#undef VITRINE_NUMBERED_CAPABILITY
       })
    EXPECT_EQ(message_of(name), "") << name;
}

TEST(Capabilities, WhatCompilersDeclareWithoutNeedIsAccepted) { EXPECT_EQ(message_of("SparseResidency"), ""); }

/// As Slang writes geometry shaders.
TEST(Capabilities, LayersInModulesOlderThanTheirCapability) {
  Words words = assemble(
      "OpCapability MultiViewport\nOpCapability Geometry\nOpMemoryModel Logical GLSL450\n"
      "OpEntryPoint Geometry %main \"main\" %layer\nOpExecutionMode %main InputPoints\n"
      "OpExecutionMode %main OutputPoints\nOpExecutionMode %main OutputVertices 1\n"
      "OpExecutionMode %main Invocations 1\nOpDecorate %layer BuiltIn Layer\n"
      "%void = OpTypeVoid\n%function = OpTypeFunction %void\n%int = OpTypeInt 32 1\n%one = OpConstant %int 1\n"
      "%pointer = OpTypePointer Output %int\n%layer = OpVariable %pointer Output\n"
      "%main = OpFunction %void None %function\n%entry = OpLabel\nOpStore %layer %one\nOpEmitVertex\nOpReturn\n"
      "OpFunctionEnd\n");
  ASSERT_EQ(words[6], static_cast<std::uint32_t>(spv::Capability::MultiViewport));
  words[6] = static_cast<std::uint32_t>(spv::Capability::ShaderLayer);
  CompileOptions options = options_for(VK_SHADER_STAGE_GEOMETRY_BIT);
  const auto shader = compile(words, options);
  EXPECT_TRUE(shader.ok()) << shader.message();
}

/// As glslang writes `float16_t(x)` of a value that is one already.
TEST(Capabilities, ConversionsToTheSameWidth) {
  const Words words = assemble(
      "OpCapability Shader\nOpCapability Float16\nOpMemoryModel Logical GLSL450\n"
      "OpEntryPoint GLCompute %main \"main\"\nOpExecutionMode %main LocalSize 1 1 1\n"
      "%void = OpTypeVoid\n%function = OpTypeFunction %void\n%half = OpTypeFloat 16\n%one = OpConstant %half 1\n"
      "%main = OpFunction %void None %function\n%entry = OpLabel\n%same = OpFConvert %half %one\nOpReturn\n"
      "OpFunctionEnd\n");
  CompileOptions options = options_for(VK_SHADER_STAGE_COMPUTE_BIT);
  const auto shader = compile(words, options);
  EXPECT_TRUE(shader.ok()) << shader.message();
}

TEST(Capabilities, OthersAreRefusedByName) {
  for (const std::string name :
       {"RayQueryKHR", "RayTracingKHR", "MeshShadingEXT", "CooperativeMatrixNV", "ImageGatherBiasLodAMD",
        "FragmentDensityEXT", "GroupNonUniformPartitionedNV", "Kernel"})
    EXPECT_EQ(message_of(name), "capability " + name + " is not supported");
}

}  // namespace
}  // namespace vitrine::spirv::test

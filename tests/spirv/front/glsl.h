// GLSL and SPIR-V assembly to words, and the options of a pipeline layout that has everything the tests bind.
#pragma once

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>
#include <gtest/gtest.h>
#include <spirv-tools/libspirv.hpp>

#include "spirv/compile.h"

namespace vitrine::spirv::test {

using Words = std::vector<std::uint32_t>;

inline Words compile_glsl(VkShaderStageFlagBits stage, const std::string& body) {
  static const bool initialized = glslang::InitializeProcess();
  static_cast<void>(initialized);
  const EShLanguage language = stage == VK_SHADER_STAGE_VERTEX_BIT                    ? EShLangVertex
                               : stage == VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT    ? EShLangTessControl
                               : stage == VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT ? EShLangTessEvaluation
                               : stage == VK_SHADER_STAGE_GEOMETRY_BIT                ? EShLangGeometry
                               : stage == VK_SHADER_STAGE_FRAGMENT_BIT                ? EShLangFragment
                                                                                      : EShLangCompute;
  const std::string text = "#version 450\n" + body;
  const char* strings[] = {text.c_str()};
  glslang::TShader shader(language);
  shader.setStrings(strings, 1);
  shader.setEnvInput(glslang::EShSourceGlsl, language, glslang::EShClientVulkan, 100);
  shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_1);
  shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_3);
  constexpr auto kMessages = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules);
  glslang::TProgram program;
  Words words;
  if (!shader.parse(GetDefaultResources(), 450, false, kMessages)) {
    ADD_FAILURE() << shader.getInfoLog() << text;
    return words;
  }
  program.addShader(&shader);
  if (!program.link(kMessages)) {
    ADD_FAILURE() << program.getInfoLog();
    return words;
  }
  glslang::SpvOptions options;
  options.disableOptimizer = true;
  glslang::GlslangToSpv(*program.getIntermediate(language), words, &options);
  return words;
}

inline Words assemble(const std::string& text, spv_target_env environment = SPV_ENV_VULKAN_1_1) {
  spvtools::SpirvTools tools(environment);
  tools.SetMessageConsumer([](spv_message_level_t, const char*, const spv_position_t& at, const char* message) {
    ADD_FAILURE() << "line " << at.line + 1 << ": " << message;
  });
  Words words;
  tools.Assemble(text, &words);
  return words;
}

/// Sets 0 and 1 with bindings 0..7, four descriptors each; descriptor of (binding, element) at slot 4 * binding +
/// element.
inline CompileOptions options_for(VkShaderStageFlagBits stage) {
  CompileOptions options;
  options.stage = stage;
  for (std::uint32_t set = 0; set < 2; set++) {
    SetLayoutInfo layout;
    for (std::uint32_t binding = 0; binding < 8; binding++)
      layout.bindings.push_back({binding, VK_DESCRIPTOR_TYPE_MUTABLE_EXT, set, 4 * binding, 4, nullptr});
    options.sets.push_back(layout);
  }
  return options;
}

}  // namespace vitrine::spirv::test

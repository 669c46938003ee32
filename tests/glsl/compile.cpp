// glslang, as the tests and the fuzzers use it.
#include "tests/glsl/compile.h"

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <spirv-tools/optimizer.hpp>

namespace vitrine::test {
namespace {

EShLanguage language_of(VkShaderStageFlagBits stage) {
  switch (stage) {
    case VK_SHADER_STAGE_VERTEX_BIT:
      return EShLangVertex;
    case VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT:
      return EShLangTessControl;
    case VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT:
      return EShLangTessEvaluation;
    case VK_SHADER_STAGE_GEOMETRY_BIT:
      return EShLangGeometry;
    case VK_SHADER_STAGE_FRAGMENT_BIT:
      return EShLangFragment;
    default:
      return EShLangCompute;
  }
}

}  // namespace

std::vector<std::uint32_t> compile_glsl(VkShaderStageFlagBits stage, const std::string& text, VulkanVersion version,
                                        std::string& log, DebugInfo debug, Language source) {
  static const bool initialized = glslang::InitializeProcess();
  static_cast<void>(initialized);
  const EShLanguage language = language_of(stage);
  const bool newer = version == VulkanVersion::k12;
  const char* strings[] = {text.c_str()};
  const char* names[] = {kSourceName};
  glslang::TShader shader(language);
  shader.setStringsWithLengthsAndNames(strings, nullptr, names, 1);
  const bool hlsl = source == Language::kHlsl;
  if (hlsl) shader.setEntryPoint("main");
  shader.setEnvInput(hlsl ? glslang::EShSourceHlsl : glslang::EShSourceGlsl, language, glslang::EShClientVulkan, 100);
  shader.setEnvClient(glslang::EShClientVulkan, newer ? glslang::EShTargetVulkan_1_2 : glslang::EShTargetVulkan_1_1);
  shader.setEnvTarget(glslang::EShTargetSpv, newer ? glslang::EShTargetSpv_1_5 : glslang::EShTargetSpv_1_3);
  const bool lines = debug != DebugInfo::kNone;
  const auto messages =
      static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules | (hlsl ? EShMsgReadHlsl : EShMsgDefault) |
                               (lines ? EShMsgDebugInfo : EShMsgDefault));
  constexpr int kVersionOfTextsWithout = 450;
  std::vector<std::uint32_t> words;
  if (!shader.parse(GetDefaultResources(), kVersionOfTextsWithout, false, messages)) {
    log = shader.getInfoLog();
    return words;
  }
  glslang::TProgram program;
  program.addShader(&shader);
  if (!program.link(messages)) {
    log = program.getInfoLog();
    return words;
  }
  glslang::SpvOptions options;
  options.disableOptimizer = true;
  options.generateDebugInfo = lines;
  options.emitNonSemanticShaderDebugInfo = options.emitNonSemanticShaderDebugSource = debug == DebugInfo::kNonSemantic;
  glslang::GlslangToSpv(*program.getIntermediate(language), words, &options);
  return words;
}

std::vector<std::uint32_t> optimize(const std::vector<std::uint32_t>& module) {
  spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_2);
  optimizer.RegisterPerformancePasses();
  std::vector<std::uint32_t> optimized;
  if (!optimizer.Run(module.data(), module.size(), &optimized)) optimized.clear();
  return optimized;
}

}  // namespace vitrine::test

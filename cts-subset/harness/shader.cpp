// Compiles the cases' shaders with glslang, or assembles them with SPIRV-Tools.
#include "harness/shader.h"

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>
#include <spirv-tools/libspirv.hpp>
#include <spirv/unified1/spirv.hpp11>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

namespace vitrine::cts {
namespace {

EShLanguage language(VkShaderStageFlagBits stage) {
  switch (stage) {
    case VK_SHADER_STAGE_VERTEX_BIT:
      return EShLangVertex;
    case VK_SHADER_STAGE_FRAGMENT_BIT:
      return EShLangFragment;
    case VK_SHADER_STAGE_COMPUTE_BIT:
      return EShLangCompute;
    case VK_SHADER_STAGE_GEOMETRY_BIT:
      return EShLangGeometry;
    case VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT:
      return EShLangTessControl;
    default:
      return EShLangTessEvaluation;
  }
}

struct Target {
  glslang::EShTargetClientVersion client;
  glslang::EShTargetLanguageVersion spirv;
  spv_target_env validation;
};

Target target_of(const std::string& source) {
  const auto asks = [&](const char* line) { return source.find(line) != std::string::npos; };
  if (asks("target: spirv1.4"))
    return {glslang::EShTargetVulkan_1_1, glslang::EShTargetSpv_1_4, SPV_ENV_VULKAN_1_1_SPIRV_1_4};
  if (asks("target: vulkan1.1")) return {glslang::EShTargetVulkan_1_1, glslang::EShTargetSpv_1_3, SPV_ENV_VULKAN_1_1};
  if (asks("target: vulkan1.3")) return {glslang::EShTargetVulkan_1_3, glslang::EShTargetSpv_1_6, SPV_ENV_VULKAN_1_3};
  return {glslang::EShTargetVulkan_1_0, glslang::EShTargetSpv_1_0, SPV_ENV_VULKAN_1_0};
}

/// glslang folds what has no result (pow(-2.5, 2.2)) to NaN. In literals of vectors beside numbers those are taken out:
/// deviations.md, nan-literals.
void replace_nans(std::vector<uint32_t>& words) {
  std::set<uint32_t> floats, nans;  // ids
  for (size_t at = 5; at < words.size() && words[at] >> 16 != 0; at += words[at] >> 16) {
    const size_t length = words[at] >> 16;
    const auto op = static_cast<spv::Op>(words[at] & 0xffff);
    if (op == spv::Op::OpTypeFloat && words[at + 2] == 32) floats.insert(words[at + 1]);
    if (op == spv::Op::OpConstant && floats.contains(words[at + 1]) && (words[at + 3] & 0x7fffffff) > 0x7f800000)
      nans.insert(words[at + 2]);
    if (op != spv::Op::OpConstantComposite) continue;
    const auto begin = words.begin() + static_cast<ptrdiff_t>(at + 3), end = begin + static_cast<ptrdiff_t>(length - 3);
    const auto number = std::find_if(begin, end, [&](uint32_t id) { return !nans.contains(id); });
    if (number != end)
      std::replace_if(
          begin, end, [&](uint32_t id) { return nans.contains(id); }, *number);
  }
}

std::vector<uint32_t> compile(VkShaderStageFlagBits stage, const std::string& source) {
  static const bool initialized = glslang::InitializeProcess();
  (void)initialized;
  const EShLanguage lang = language(stage);
  const bool hlsl = source.starts_with("// target: hlsl");
  const std::string text = hlsl || source.starts_with("#version") ? source : "#version 450\n" + source;
  const char* strings[] = {text.c_str()};
  glslang::TShader shader(lang);
  shader.setStrings(strings, 1);
  shader.setEnvInput(hlsl ? glslang::EShSourceHlsl : glslang::EShSourceGlsl, lang, glslang::EShClientVulkan, 100);
  if (hlsl) shader.setEntryPoint("main");
  const Target target = target_of(source);
  shader.setEnvClient(glslang::EShClientVulkan, target.client);
  shader.setEnvTarget(glslang::EShTargetSpv, target.spirv);
  const auto messages =
      static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules | (hlsl ? EShMsgReadHlsl : EShMsgDefault));
  const std::string name = hlsl ? "HLSL: " : "GLSL: ";
  if (!shader.parse(GetDefaultResources(), 450, false, messages)) throw std::runtime_error(name + shader.getInfoLog());
  glslang::TProgram program;
  program.addShader(&shader);
  if (!program.link(messages)) throw std::runtime_error(name + program.getInfoLog());
  std::vector<uint32_t> words;
  glslang::SpvOptions spv;
  spv.disableOptimizer = true;
  glslang::GlslangToSpv(*program.getIntermediate(lang), words, &spv);
  replace_nans(words);
  return words;
}

}  // namespace

const std::vector<uint32_t>& compile_glsl(VkShaderStageFlagBits stage, const std::string& source) {
  static std::map<std::pair<int, std::string>, std::vector<uint32_t>> cache;
  const auto key = std::make_pair(static_cast<int>(stage), source);
  if (const auto found = cache.find(key); found != cache.end()) return found->second;
  if (cache.size() > 200) cache.clear();
  return cache[key] = compile(stage, source);
}

const std::vector<uint32_t>& assemble_spirv(const std::string& source) {
  static std::map<std::string, std::vector<uint32_t>> cache;
  if (const auto found = cache.find(source); found != cache.end()) return found->second;
  spvtools::SpirvTools tools(target_of(source).validation);
  std::string message;
  tools.SetMessageConsumer([&](spv_message_level_t, const char*, const spv_position_t& position, const char* text) {
    message += "line " + std::to_string(position.line + 1) + ": " + text + "\n";
  });
  std::vector<uint32_t> words;
  spvtools::ValidatorOptions options;
  options.SetAllowLocalSizeId(true);  // of maintenance4
  if (!tools.Assemble(source, &words) || !tools.Validate(words.data(), words.size(), options))
    throw std::runtime_error("SPIR-V: " + message);
  return cache[source] = words;
}

}  // namespace vitrine::cts

// GLSL to SPIR-V, for tests and fuzzers of the rooms below the driver.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <vulkan/vulkan_core.h>

namespace vitrine::test {

/// What the module is for: 1.1 takes SPIR-V 1.3, 1.2 SPIR-V 1.5.
enum class VulkanVersion : std::uint8_t { k11, k12 };

/// What the module says of its source, a file kSourceName: nothing, OpLine and OpSource, or
/// NonSemantic.Shader.DebugInfo.100.
enum class DebugInfo : std::uint8_t { kNone, kLines, kNonSemantic };
inline constexpr char kSourceName[] = "shader.glsl";

enum class Language : std::uint8_t { kGlsl, kHlsl };

/// The words of `text`, a whole shader (GLSL: with its #version; the entry point is main), not optimised. Empty: it
/// does not compile, `log` says why.
std::vector<std::uint32_t> compile_glsl(VkShaderStageFlagBits stage, const std::string& text, VulkanVersion version,
                                        std::string& log, DebugInfo debug = DebugInfo::kNone,
                                        Language language = Language::kGlsl);

/// The module as spirv-opt -O makes it; empty: it cannot be read.
std::vector<std::uint32_t> optimize(const std::vector<std::uint32_t>& module);

}  // namespace vitrine::test

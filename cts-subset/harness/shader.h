// GLSL and SPIR-V assembly to words, at run time, each text once per process.
#pragma once

#include <vulkan/vulkan.h>

#include <cstdint>
#include <string>
#include <vector>

namespace vitrine::cts {

// A comment "target: vulkan1.1" (SPIR-V 1.3), "target: spirv1.4" or "target: vulkan1.3" (SPIR-V 1.6) in a text raises
// its target from Vulkan 1.0.

/// Compiles GLSL ("#version 450" is put in front unless the text has one). Throws with the log.
const std::vector<uint32_t>& compile_glsl(VkShaderStageFlagBits stage, const std::string& source);
/// Assembles SPIR-V text. Throws with the message.
const std::vector<uint32_t>& assemble_spirv(const std::string& source);

}  // namespace vitrine::cts

// GLSL and SPIR-V assembly to words, and the options of a pipeline layout that has everything the tests bind.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <spirv-tools/libspirv.hpp>

#include "spirv/compile.h"
#include "tests/glsl/compile.h"

namespace vitrine::spirv::test {

using Words = std::vector<std::uint32_t>;

using vitrine::test::DebugInfo;

inline Words compile_glsl(VkShaderStageFlagBits stage, const std::string& body, DebugInfo debug = DebugInfo::kNone) {
  const std::string text = "#version 450\n" + body;
  std::string log;
  Words words = vitrine::test::compile_glsl(stage, text, vitrine::test::VulkanVersion::k11, log, debug);
  if (words.empty()) ADD_FAILURE() << log << text;
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

// What mutation starts from: GLSL shaders that between them use most of what the front end translates.
#pragma once

#include <vector>

#include <vulkan/vulkan_core.h>

#include "tests/fuzz/mutate.h"

namespace vitrine::fuzz {

struct Module {
  VkShaderStageFlagBits stage;
  Words words;
};

/// Ends the process where a seed does not compile.
std::vector<Module> compile_seeds();

}  // namespace vitrine::fuzz

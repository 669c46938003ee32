// What fragment shaders get at locations, in words.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "spirv/shader.h"

namespace vitrine::glass::pixel {

/// "input 0": "(1, 0.5)", by location. `word`: what is in an input register.
std::vector<std::pair<std::string, std::string>> inputs_text(const spirv::ShaderInterface& interface,
                                                             const std::function<std::uint32_t(std::uint32_t)>& word);

}  // namespace vitrine::glass::pixel

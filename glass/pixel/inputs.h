// What fragment shaders get from the stages before and from fixed function, in words.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "spirv/program.h"

namespace vitrine::glass::pixel {

/// "input light.colors[1]": "(1, 0.5)", by location, then built-ins. What the module has no name for is "input
/// location=3" or "input location=3 component=1", or the built-in's name in SPIR-V. Components that the shader does not
/// read are left out: "input uv.y". `word`: what is in an input register; nothing: it is not known.
std::vector<std::pair<std::string, std::string>> inputs_text(
    const spirv::ShaderInterface& interface, const spirv::Program& program,
    const std::function<std::optional<std::uint32_t>(std::uint32_t)>& word);

}  // namespace vitrine::glass::pixel

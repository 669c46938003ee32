// What fixed function may ask about the length of a shader, to choose how it feeds it.
#pragma once

namespace vitrine::spirv {

class Shader;

/// Whether a wave of the shader takes about as long as fixed function does for it: a few instructions, no images.
bool is_short(const Shader& shader);

}  // namespace vitrine::spirv

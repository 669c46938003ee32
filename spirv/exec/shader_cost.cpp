// The estimate of a shader's cost, from its program.
#include "spirv/shader_cost.h"

#include <cstddef>

#include "spirv/program.h"
#include "spirv/shader.h"

namespace vitrine::spirv {

bool is_short(const Shader& shader) {
  constexpr std::size_t kFew = 16;
  const Program& program = shader.program();
  return program.code.size() <= kFew && program.image_ops.empty();
}

}  // namespace vitrine::spirv

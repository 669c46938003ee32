// ir::Function -> executable Shader: uniformity, liveness, register allocation, instruction selection.
#pragma once

#include <memory>

#include "base/result.h"
#include "spirv/ir.h"
#include "spirv/shader.h"

namespace vitrine::spirv {

/// In: what rewrite() gives. Errors name what exceeds a limit (registers, program size).
base::Result<std::unique_ptr<Shader>> lower(ir::Function&& function);

}  // namespace vitrine::spirv

// ir::Function -> executable Shader: uniformity, liveness, register allocation, instruction selection.
#pragma once

#include <memory>

#include "base/result.h"
#include "spirv/ir.h"
#include "spirv/shader.h"

namespace vitrine::spirv {

namespace exec {
class Observer;
}

/// In: what rewrite() gives. Errors name what exceeds a limit (registers, program size). `observer`: whom the program
/// tells what it does (spirv/exec/observe.h); null: nobody. `rehearsal`: Observation::rehearsal.
base::Result<std::unique_ptr<Shader>> lower(ir::Function&& function,
                                            std::shared_ptr<const exec::Observer> observer = nullptr,
                                            std::shared_ptr<const Shader> rehearsal = nullptr);

}  // namespace vitrine::spirv

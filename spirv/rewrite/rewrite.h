// The algebraic rewrites that the reference's compiler applies (lavapipe-shader-math.md section 4), as IR -> IR.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "spirv/ir.h"

namespace vitrine::spirv {

/// Told of the shader before the first step and after each that has changed it: the name of the step (spirv/rewrite/
/// passes.def), where it stands ("step 12, round 1"), and the shader as ir::dump() prints it.
using StepListener = std::function<void(const char* step, const std::string& place, const std::string& text)>;

/// All steps, or only those that the lowering relies on: what the shader computes is nearly what it says, every branch
/// and variable is there, last bits may be others.
enum class Steps : std::uint8_t { kAll, kNeeded };

/// In: what translate() gives (vector ALU). Out: scalar ALU (one component per ALU instruction), rewritten, dead code
/// removed, valid for ir::verify(). `listener` may be empty.
void rewrite(ir::Function& function, const StepListener& listener = {}, Steps steps = Steps::kAll);

}  // namespace vitrine::spirv

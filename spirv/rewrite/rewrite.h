// The algebraic rewrites that the reference's compiler applies (lavapipe-shader-math.md section 4), as IR -> IR.
#pragma once

#include "spirv/ir.h"

namespace vitrine::spirv {

/// In: what translate() gives (vector ALU). Out: scalar ALU (one component per ALU instruction), rewritten, dead code
/// removed, valid for ir::verify().
void rewrite(ir::Function& function);

}  // namespace vitrine::spirv

// Steps that mirror gallivm (Mesa 22.3.6, src/gallium/auxiliary/gallivm), which makes LLVM's instructions of NIR's.
#pragma once

#include "spirv/rewrite/graph/graph.h"

namespace vitrine::spirv::rewriting {

/// Fragment shaders: lookups and derivatives where lanes of a quad may wait read registers that those lanes do not
/// write.
void quad_registers(Graph& graph);

/// Minima and maxima with an operand that is known to be a number become plain ones. The reference decides this on its
/// intermediate code, before its code generator simplifies on its own.
void choose_min_max(Graph& graph);

/// Sums of three and four numbers, which the rules do not look into, become additions.
void build_sums(Graph& graph);

/// What the building blocks of arithmetic simplify on their own, for scalar code.
void build_arit(Graph& graph);

}  // namespace vitrine::spirv::rewriting

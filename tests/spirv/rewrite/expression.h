// Shaders of one expression, as text: "FAdd(FMul(a,b),2.0)". a ... h are scalar inputs, `!Op` is exact, numbers with a
// point are floats, others integers; true and false are booleans; Vec(a,b) puts a vector together. Each occurrence of
// an operation is an SSA value of its own, each letter is one load.
#pragma once

#include <string>
#include <string_view>

#include "spirv/ir.h"

namespace vitrine::spirv::test {

/// A fragment shader whose only output is the expression.
ir::Function shader_of(std::string_view expression);

/// The expression that the function's first output stores, written out as a tree; subtrees used twice appear twice.
std::string expression_of(const ir::Function& function);

}  // namespace vitrine::spirv::test

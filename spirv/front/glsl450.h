// Functions named by glsl450.def. Each sets the value of the OpExtInst; operands count from the instruction's third
// (after set and number). Internal to front/.
#pragma once

#include "spirv/front/expression.h"

namespace vitrine::spirv::front::glsl {

#define VITRINE_GLSL(name, function, op) void function(Translator& t, const Inst& inst, ir::Op op_column);
#include "spirv/front/glsl450.def"
#undef VITRINE_GLSL

/// i-th operand.
Expr arg(Translator& t, const Inst& inst, std::uint32_t i);
void result(Translator& t, const Inst& inst, Expr value);

/// exp(x) = exp2(x * log2 e), log(x) = log2(x) / log2 e (lavapipe-shader-math.md 6.3).
Expr natural_exp(Expr x);
Expr natural_log(Expr x);

}  // namespace vitrine::spirv::front::glsl

// Mixes of halves, which the reference has as one operation until its finalisation (lavapipe-shader-math.md 5.3).
#pragma once

#include "spirv/ir.h"

namespace vitrine::spirv::ir {

/// The op of an instruction of `width` 16 that is mix(a, b, c), to the front end and the rewrites, which take it apart.
/// It shares its number with the op of planes, whose numbers always have 32 bits.
inline constexpr Op kHalfMix = Op::kFFused;

}  // namespace vitrine::spirv::ir

// Local arrays of constants.
#pragma once

#include "spirv/ir.h"

namespace vitrine::spirv::lowering {

/// In: what rewrite() gives. Arrays all of whose elements are set to constants, always the same ones, before anything
/// loads any (`const float weight[16] = ...`) get Array::table instead of the stores. Arrays that an observer looks at
/// in their place (spirv/homes.h) stay.
void make_tables(ir::Function& function);

}  // namespace vitrine::spirv::lowering

// ScalarFunction with places -> Program.
#pragma once

#include <memory>
#include <string>

#include "spirv/lower/registers.h"
#include "spirv/lower/scalar.h"
#include "spirv/program.h"

namespace vitrine::spirv::lowering {

/// Fills in the registers of `interface` (and drops slots that nothing uses). `error`: what has no handler.
std::unique_ptr<Program> emit(const ScalarFunction& function, const Allocation& allocation, ShaderInterface& interface,
                              std::string& error);

}  // namespace vitrine::spirv::lowering

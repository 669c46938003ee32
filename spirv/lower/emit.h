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

/// Writes into the end of each loop what a turn costs (spirv/exec/handlers.h: loop_back), and Program::cost.
void charge_loops(Program& program);

}  // namespace vitrine::spirv::lowering

// SPIR-V words of one entry point -> ir::Function. The words have passed validation; what is not covered is an error
// that names the instruction. Does not apply the reference's rewrites (rewrite/) and does not choose registers
// (lower/).
#pragma once

#include <cstdint>
#include <span>

#include "base/result.h"
#include "spirv/compile.h"
#include "spirv/exec/observe.h"
#include "spirv/ir.h"

namespace vitrine::spirv {

/// Specialises, inlines and structures the entry point `options.entry_point` and builds SSA. ALU instructions are still
/// vectors as the SPIR-V wrote them; rewrite() makes them scalar. Probes are made for those who have an `interest`.
base::Result<ir::Function> translate(std::span<const std::uint32_t> words, const CompileOptions& options,
                                     const exec::Interest& interest = {});

}  // namespace vitrine::spirv

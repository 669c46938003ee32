// A family: the handlers of one translation unit's ops, for the SIMD target in use.
#pragma once

#include "spirv/ir.h"
#include "spirv/program.h"

namespace vitrine::spirv::alu {

inline constexpr unsigned kMaxSources = 3;

/// Handlers of one op: [bit i of the index: source i is uniform], and the one that works on words of the uniform file.
struct OpHandlers {
  Handler wave[1u << kMaxSources] = {};
  Handler scalar = nullptr;
};

/// Indexed by ir::Op; ops of other families have null handlers.
using Family = const OpHandlers*;

Family float_family();
Family transcendental_family();
Family integer_family();
Family compare_family();
Family convert_family();
Family boolean_family();

}  // namespace vitrine::spirv::alu

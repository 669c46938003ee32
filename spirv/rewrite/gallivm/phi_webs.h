// Which values of a shader the reference keeps in registers: those that meet at joins, and what merges with them
// (nir_from_ssa.c: nir_convert_from_ssa; lavapipe-optimizer.md 6.6).
#pragma once

#include <vector>

#include "spirv/rewrite/gallivm/program_order.h"

namespace vitrine::spirv::rewriting {

struct PhiWebs {
  std::vector<std::uint32_t> web;  ///< per value: its register, kNone: it is in none
  std::vector<Join> joins;
};

/// No joins: there are none, or too many to look at.
PhiWebs phi_webs(const Graph& graph);

}  // namespace vitrine::spirv::rewriting

// The steps of rewrite() as data: the rows of passes.def.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "spirv/rewrite/graph/graph.h"
#include "spirv/rewrite/rewrite.h"

namespace vitrine::spirv::rewriting {

enum class Phase : std::uint8_t {
#define VITRINE_PHASE(phase, rounds, what) phase,
#define VITRINE_PASS(phase, when, needed, function, file, mirrors, why)
#include "spirv/rewrite/passes.def"
#undef VITRINE_PHASE
#undef VITRINE_PASS
};

/// Columns of passes.def.
enum class When : std::uint8_t { kAlways, kIfBefore, kAtRest };
enum class Needed : std::uint8_t { kOptional, kNeeded };

struct Pass {
  const char* name;     ///< the function's
  bool (*run)(Graph&);  ///< true: it has changed something; steps of a phase of one round need not say
  Phase phase;
  When when;
  Needed needed;
  bool tells;  ///< whether it has changed something
};

/// All rows, in their order.
std::span<const Pass> passes();

/// The first row of this function, which runs like every other one of it; null: there is none.
const Pass* find_pass(std::string_view name);

/// Runs the steps in their order. Under VITRINE_LOG=ir prints the shader before them and after each that changes
/// something, and tells `listener` of the same; leaves out the steps that VITRINE_PASS_LIMIT and VITRINE_PASS_OFF name;
/// verifies after each in debug builds.
void run_passes(Graph& graph, const StepListener& listener = {}, Steps steps = Steps::kAll);

}  // namespace vitrine::spirv::rewriting

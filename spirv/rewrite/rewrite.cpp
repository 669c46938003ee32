// The order of the steps, which decides bits: that of the reference (lavapipe-shader-math.md 3.2).
#include "spirv/rewrite/rewrite.h"

#include "base/reference_cpu.h"
#include "spirv/rewrite/gallivm/passes.h"
#include "spirv/rewrite/graph/loops.h"
#include "spirv/rewrite/llvm/passes.h"
#include "spirv/rewrite/lower/passes.h"
#include "spirv/rewrite/nir/algebraic/composed.h"
#include "spirv/rewrite/nir/passes.h"
#include "spirv/rewrite/nir/to_lcssa.h"

namespace vitrine::spirv {
namespace {

using rewriting::Graph;

/// A shader that still changes after so many rounds would never stop (rules that undo each other): what it is then is
/// correct, only its spelling differs from the reference's.
constexpr int kMaxRounds = 64;

/// One round of the reference's first loop (3.2 step 3).
bool optimize_once(Graph& graph, bool first) {
  bool changed = rewriting::lower_vars_to_ssa(graph);
  changed |= rewriting::opt_copy_prop_vars(graph);
  changed |= rewriting::opt_copy_prop_arrays(graph);
  changed |= rewriting::copy_prop(graph);
  changed |= rewriting::opt_dce(graph);
  changed |= rewriting::opt_peephole_select(graph);
  changed |= rewriting::join_doubles(graph);
  changed |= rewriting::narrow_comparisons(graph);
  if (first) rewriting::shorten_dot_products(graph);
  changed |= rewriting::opt_algebraic(graph);
  if (first) rewriting::show_products(graph);
  changed |= rewriting::opt_constant_folding(graph);
  changed |= rewriting::opt_remove_phis(graph);
  const bool first_loops = first && rewriting::has_loops(graph);
  if (rewriting::opt_trivial_continues(graph, first) || first_loops) {
    changed = true;
    rewriting::copy_prop(graph);
    rewriting::opt_dce(graph);
    rewriting::opt_remove_phis(graph);
  }
  changed |= rewriting::opt_if_safe(graph);
  changed |= rewriting::opt_if(graph);
  changed |= rewriting::opt_dead_cf(graph);
  changed |= rewriting::opt_remove_phis(graph);
  changed |= rewriting::opt_cse(graph, false);
  changed |= rewriting::lower_alu_to_scalar(graph);
  changed |= rewriting::opt_loop_unroll(graph);
  return changed;
}

/// The reference's finalisation (3.2 step 4), its code generator and what optimises that.
void finish(Graph& graph) {
  rewriting::lower_flrp(graph);
  for (int round = 0; round < kMaxRounds; ++round) {
    bool changed = rewriting::opt_constant_folding(graph);
    changed |= rewriting::opt_algebraic(graph);
    if (!changed) break;
  }
  for (int round = 0; round < kMaxRounds; ++round) {
    if (!rewriting::opt_algebraic_late(graph)) break;
    rewriting::copy_prop(graph);
    rewriting::opt_dce(graph);
    rewriting::opt_cse(graph);
  }
  rewriting::copy_prop(graph);
  rewriting::choose_min_max(graph);
  rewriting::build_arit(graph);
  rewriting::inst_simplify(graph);
  rewriting::copy_prop(graph, true);
  rewriting::opt_dce(graph);
  rewriting::early_cse(graph);
  rewriting::fold_select_into_op(graph);
  rewriting::fold_select_with_identity(graph);
  rewriting::fold_fp_to_int_poison(graph);
}

}  // namespace

void rewrite(ir::Function& function) {
  Graph graph(function);
  rewriting::straighten_loops(graph);
  rewriting::leave_lcssa(graph);
  rewriting::merge_doubles(graph);
  rewriting::hide_composed(graph);
  optimize_once(graph, true);
  rewriting::show_short_products(graph);
  for (int round = 1; round < kMaxRounds; ++round)
    if (!optimize_once(graph, false) && !rewriting::opt_cse(graph)) break;
  finish(graph);
  if (rewriting::expand_sized(graph)) {
    rewriting::copy_prop(graph);
    rewriting::opt_dce(graph);
    rewriting::early_cse(graph);
  }
  if (base::reference_lacks_avx512()) rewriting::lower_without_avx512(graph);
  rewriting::choose_spelling(graph);
  rewriting::opt_dce(graph);
  rewriting::convert_to_lcssa(graph);
  rewriting::close_continues(graph);
  graph.write_back();
}

}  // namespace vitrine::spirv

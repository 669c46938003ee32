// The order of the steps, which decides bits: that of the reference (lavapipe-shader-math.md 3.2).
#include "spirv/rewrite/rewrite.h"

#include "base/reference_cpu.h"
#include "spirv/rewrite/loops.h"
#include "spirv/rewrite/passes.h"

namespace vitrine::spirv {
namespace {

using rewriting::Graph;

/// A shader that still changes after so many rounds would never stop (rules that undo each other): what it is then is
/// correct, only its spelling differs from the reference's.
constexpr int kMaxRounds = 64;

/// One round of the reference's first loop (3.2 step 3).
bool optimize_once(Graph& graph, bool first) {
  bool changed = rewriting::promote_arrays(graph);
  changed |= rewriting::forward_loads(graph);
  changed |= rewriting::forward_arrays(graph);
  changed |= rewriting::propagate_copies(graph);
  changed |= rewriting::remove_dead(graph);
  changed |= rewriting::flatten_branches(graph);
  changed |= rewriting::join_doubles(graph);
  changed |= rewriting::narrow_comparisons(graph);
  if (first) rewriting::shorten_dot_products(graph);
  changed |= rewriting::apply_rules(graph, rewriting::RuleSet::kMain);
  if (first) rewriting::show_products(graph);
  changed |= rewriting::fold_constants(graph);
  changed |= rewriting::remove_trivial_results(graph);
  const bool first_loops = first && rewriting::has_loops(graph);
  if (rewriting::remove_trivial_continues(graph, first) || first_loops) {
    changed = true;
    rewriting::propagate_copies(graph);
    rewriting::remove_dead(graph);
    rewriting::remove_trivial_results(graph);
  }
  changed |= rewriting::evaluate_conditions(graph);
  changed |= rewriting::improve_branches(graph);
  changed |= rewriting::take_constant_branches(graph);
  changed |= rewriting::remove_trivial_results(graph);
  changed |= rewriting::merge_equal(graph, false);
  changed |= rewriting::scalarize(graph);
  changed |= rewriting::unroll_loops(graph);
  return changed;
}

/// The reference's finalisation (3.2 step 4).
void finish(Graph& graph) {
  rewriting::expand_mixes(graph);
  for (int round = 0; round < kMaxRounds; ++round) {
    bool changed = rewriting::fold_constants(graph);
    changed |= rewriting::apply_rules(graph, rewriting::RuleSet::kMain);
    if (!changed) break;
  }
  for (int round = 0; round < kMaxRounds; ++round) {
    if (!rewriting::apply_rules(graph, rewriting::RuleSet::kLate)) break;
    rewriting::propagate_copies(graph);
    rewriting::remove_dead(graph);
    rewriting::merge_equal(graph);
  }
  rewriting::propagate_copies(graph);
  rewriting::choose_extrema(graph);
  rewriting::build_identities(graph);
  rewriting::fold_late_constants(graph);
  rewriting::propagate_copies(graph, true);
  rewriting::remove_dead(graph);
  rewriting::merge_equal_code(graph);
  rewriting::share_selections(graph);
  rewriting::select_identities(graph);
  rewriting::convert_waves(graph);
}

}  // namespace

void rewrite(ir::Function& function) {
  Graph graph(function);
  rewriting::straighten_loops(graph);
  rewriting::open_loops(graph);
  rewriting::merge_doubles(graph);
  rewriting::hide_composed(graph);
  optimize_once(graph, true);
  rewriting::show_short_products(graph);
  for (int round = 1; round < kMaxRounds; ++round)
    if (!optimize_once(graph, false) && !rewriting::merge_equal(graph)) break;
  finish(graph);
  if (rewriting::expand_sized(graph)) {
    rewriting::propagate_copies(graph);
    rewriting::remove_dead(graph);
    rewriting::merge_equal_code(graph);
  }
  if (base::reference_lacks_avx512()) rewriting::follow_avx2(graph);
  rewriting::choose_spelling(graph);
  rewriting::remove_dead(graph);
  rewriting::close_loops(graph);
  rewriting::close_continues(graph);
  graph.write_back();
}

}  // namespace vitrine::spirv

// Steps that mirror passes of NIR, the reference's first compiler (Mesa 22.3.6, src/compiler/nir): each one walk over
// the graph. All return whether they changed anything. Sections cited are of lavapipe-shader-math.md.
#pragma once

#include "spirv/rewrite/graph/graph.h"

namespace vitrine::spirv::rewriting {

/// Uses of Mov, MovB and of components of Vec read the source instead. Joins do so where the source is a value as a
/// whole.
bool copy_prop(Graph& graph);

/// The same, joins also where the source is a component: LLVM has scalars only.
bool copy_prop_into_joins(Graph& graph);

/// Removes what has no effect and whose results nobody uses, and results and parameters that nobody uses.
bool opt_dce(Graph& graph);

/// Loads of words of push constants and buffers that an earlier load brought become its components.
bool opt_copy_prop_vars(Graph& graph);

/// Loads of elements of local arrays become what was stored there; stores to arrays that nothing reads go.
bool opt_copy_prop_arrays(Graph& graph);

/// Local arrays of which only constant elements are accessed become values.
bool lower_vars_to_ssa(Graph& graph);

/// Comparisons of floats that were converted from narrower ones become those of the narrower ones.
bool narrow_comparisons(Graph& graph);

/// Merges equal instructions, the later into the one that dominates it.
bool opt_cse(Graph& graph);

/// The same but for loads of push constants, which are left to opt_copy_prop_vars() in the rounds: the reference has
/// variables there.
bool opt_cse_but_push(Graph& graph);

/// Splits ALU instructions into components, rejoined by Vec.
bool lower_alu_to_scalar(Graph& graph);

/// Evaluates ALU instructions whose operands are all constant, with C semantics and denormals (section 1).
bool opt_constant_folding(Graph& graph);

/// Small branches become unconditional code and selects (3.2: limit 8).
bool opt_peephole_select(Graph& graph);

/// Results and parameters that always carry one value are replaced by it.
bool opt_remove_phis(Graph& graph);

/// Continues at the end of a loop become the way there. In the first round every body that goes round ends in a
/// continue in the reference, so that all loops change.
bool opt_trivial_continues(Graph& graph);

/// Reads of an If's condition where only one of its sides leads become constants: the first of the three walks of
/// opt_if().
bool opt_if_safe(Graph& graph);

/// Where one branch leaves, the other needs no condition; what follows a continue moves into the other branch;
/// neighbours merge; then loops are peeled.
bool opt_if(Graph& graph);

/// An If on a constant becomes its branch; loops without effect go.
bool opt_dead_cf(Graph& graph);

/// Loops with few, constantly many iterations become straight-line code.
bool opt_loop_unroll(Graph& graph);

/// One run of the rule table (section 4.1), and of the table of late rules.
bool opt_algebraic(Graph& graph);
bool opt_algebraic_late(Graph& graph);

/// Operations that no program has, but for sums and mixes, are taken apart as the rules and lower_alu_to_scalar() do.
bool lower_operations(Graph& graph);

/// Mixes of 32 and 64 bits become sums of products before any rule sees them; no rule makes such a mix of anything
/// else.
bool lower_flrp_but_half(Graph& graph);

/// The same of all mixes: those of halves are single operations until the finalisation.
bool lower_flrp(Graph& graph);

}  // namespace vitrine::spirv::rewriting

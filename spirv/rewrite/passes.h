// The steps of rewrite(), each one walk over the graph. All return whether they changed anything.
#pragma once

#include <cstdint>
#include <vector>

#include "spirv/rewrite/graph.h"

namespace vitrine::spirv::rewriting {

/// Uses of Mov, MovB and of components of Vec read the source instead. Joins do so where the source is a value as a
/// whole, as in the reference; `into_joins`: where it is a component, too.
bool propagate_copies(Graph& graph, bool into_joins = false);

/// Removes what has no effect and whose results nobody uses, and results and parameters that nobody uses.
bool remove_dead(Graph& graph);

/// Loads of words of push constants and buffers that an earlier load brought become its components.
bool forward_loads(Graph& graph);

/// Local arrays of which only constant elements are accessed become values.
bool promote_arrays(Graph& graph);

/// Loads of elements of local arrays become what was stored there; stores to arrays that nothing reads go.
bool forward_arrays(Graph& graph);

/// Doubles that are made of the same words become one value: to the reference each is one from the beginning.
void merge_doubles(Graph& graph);

/// Selections of both words of a double become one selection of doubles.
bool join_doubles(Graph& graph);

/// Comparisons of floats that were converted from narrower ones become those of the narrower ones.
bool narrow_comparisons(Graph& graph);

/// Merges equal instructions, the later into the one that dominates it. Loads of `push` constants are left to
/// forward_loads() in the rounds: the reference has variables there.
bool merge_equal(Graph& graph, bool push = true);

/// The same for scalar code as the reference's code generator sees it: literals are equal by their bits.
bool merge_equal_code(Graph& graph);

/// Splits ALU instructions into components, rejoined by Vec.
bool scalarize(Graph& graph);

/// Evaluates ALU instructions whose operands are all constant, with C semantics and denormals (section 1).
bool fold_constants(Graph& graph);

/// Small branches become unconditional code and selects (3.2: limit 8).
bool flatten_branches(Graph& graph);

/// Results and parameters that always carry one value are replaced by it.
bool remove_trivial_results(Graph& graph);

/// Uses of results of loops read the value that the loop ends with, where that is one value; unused results go.
bool open_loops(Graph& graph);

/// The opposite, which the shader core and unrolling need: what leaves a loop (`only` this one, kNone: any) is a
/// result.
void close_loops(Graph& graph, InstId only = kNone);

/// True when something behind the loop reads a value of the loop that is no result.
bool is_used_behind(const Graph& graph, InstId loop);

/// Continues at the end of a loop become the way there; in the `first` round every loop has one.
bool remove_trivial_continues(Graph& graph, bool first);

/// Reads of an If's condition where only one of its sides leads become constants.
bool evaluate_conditions(Graph& graph);

/// Where one branch leaves, the other needs no condition; what follows a continue moves into the other branch;
/// neighbours merge; then loops are peeled.
bool improve_branches(Graph& graph);

/// Parts of improve_branches(), for one If.
bool merge_branches(Graph& graph, InstId id);
bool merge_breaks(Graph& graph, InstId id);

/// Its parts for one loop: arithmetic on parameters moves to where they are made; selections that the first iteration
/// decides become parameters; so does all that the first branch does.
bool split_parameters(Graph& graph, InstId loop);
bool simplify_selections(Graph& graph, InstId loop);
bool peel_loop(Graph& graph, InstId loop);

/// An If on a constant becomes its branch; loops without effect go.
bool take_constant_branches(Graph& graph);

/// Loops with few, constantly many iterations become straight-line code.
bool unroll_loops(Graph& graph);

enum class RuleSet : std::uint8_t { kMain, kLate };
/// One run of the rule table (section 4.1).
bool apply_rules(Graph& graph, RuleSet rules);

/// In the first run of the rules the reference has dot products as single operations; after it, products are open, and
/// sums of two in their next run; sums of three and four stay closed. Shortened dot products open after the round.
/// Remainders and ldexp are single operations until the rules come to them.
void hide_composed(Graph& graph);
void show_products(Graph& graph);
void show_short_products(Graph& graph);
/// Mixes of halves are single operations until the finalisation, other mixes never.
void expand_mixes(Graph& graph);

/// The instructions that make a remainder or ldexp together with the closed one that ends it, operands first; none: it
/// ends neither.
std::vector<InstId> parts_of_composed(const Graph& graph, InstId id);

/// Before the rules of the first round: dot products with vectors that end in zeros.
void shorten_dot_products(Graph& graph);

/// What the reference counts for an arithmetic instruction where its limits count instructions.
unsigned cost_of(const Graph& graph, const Inst& inst);

/// What the reference's code generator simplifies on its own, for scalar code.
void build_identities(Graph& graph);

/// Zero divided by what is not literal is a literal to the reference's optimiser; so is what follows from it.
void fold_late_constants(Graph& graph);

/// Where the sides of an If yield x and x * y, or its like, for several x and one y, x is multiplied by 1.
void share_selections(Graph& graph);

/// x * (c ? y : 1) and its like become c ? x * y : x, as in the masked machine code of the reference.
void select_identities(Graph& graph);

/// Integers converted from the sine or cosine of what is no finite number, or from its sum or product with a literal,
/// become those of 1: the reference's optimiser drops the NaN, of which no integer is defined.
void convert_waves(Graph& graph);

/// Minima and maxima with an operand that is known to be a number become plain ones. The reference decides this on its
/// intermediate code, before its code generator simplifies on its own.
void choose_extrema(Graph& graph);

/// Operations on numbers of 16 and 64 bits become what they consist of. Nothing else reads them after that.
bool expand_sized(Graph& graph);

/// Floats become unsigned integers, and doubles are rounded, as in a reference on a CPU without AVX-512.
void follow_avx2(Graph& graph);

/// Spelling that the executor likes and that keeps every bit: subtractions.
void choose_spelling(Graph& graph);

/// Components that a user reads of operand `index`; 0: all of them, in their order.
unsigned components_read(const Graph& graph, const Inst& user, std::uint32_t index);

/// True when removing the instruction changes nothing if its result is unused.
bool is_pure(const Graph& graph, const Inst& inst);

/// Result bits of `op` for constant operands (booleans 0 / 1). False: this op is not folded.
bool evaluate(ir::Op op, const std::uint32_t operand[3], std::uint32_t& result);

}  // namespace vitrine::spirv::rewriting

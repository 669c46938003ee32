// Steps that mirror LLVM 15, the reference's second compiler, for scalar code: what its optimiser does to what gallivm
// builds.
#pragma once

#include "spirv/rewrite/graph/graph.h"

namespace vitrine::spirv::rewriting {

/// Literals that only the optimiser finds, as zero divided by what is not literal; and what follows from them.
void inst_simplify(Graph& graph);

/// Merges equal instructions; literals are equal by their bits.
bool early_cse(Graph& graph);

/// Where the sides of an If yield x and x * y, or its like, for several x and one y, x is multiplied by 1.
void fold_select_into_op(Graph& graph);

/// x * (c ? y : 1) and its like become c ? x * y : x, as in the masked machine code of the reference.
void fold_select_with_identity(Graph& graph);

/// Integers converted from the sine or cosine of what is no finite number, or from its sum or product with a literal,
/// become those of 1: the optimiser drops the NaN, of which no integer is defined.
void fold_fp_to_int_poison(Graph& graph);

/// If the reference runs on a CPU without AVX-512: floats become unsigned integers, and doubles are rounded, as there.
void lower_without_avx512(Graph& graph);

}  // namespace vitrine::spirv::rewriting

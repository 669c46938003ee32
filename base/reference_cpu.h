// The reference's numbers depend on its CPU in a few places; these are those of an AMD processor with AVX-512, on every
// CPU (design.md section 8), unless a comparison with a reference on another kind asks for its.
#pragma once

namespace vitrine::base {

/// VITRINE_REFERENCE_CPU=avx2: conversions of floats that no unsigned integer is near, selected operands of sums and
/// products, and the rounding of doubles are those of a reference on a CPU without AVX-512. Read once.
bool reference_lacks_avx512();

}  // namespace vitrine::base

// Sums and products of which the first operand that is a NaN survives, in every SIMD target.
//
// IEEE 754 leaves open which NaN survives; x86 keeps the first source operand's. The compiler, for which + and *
// commute, orders the operands of each instruction as suits its registers, so the instruction is written out here.
// AArch64, which chooses others, does as base/x86_arithmetic-inl.h says.

#include "base/simd.h"

#include <hwy/highway.h>

#include "base/lane_math-inl.h"
#include "base/x86_arithmetic-inl.h"

#if defined(VITRINE_SPIRV_ALU_ORDERED_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_SPIRV_ALU_ORDERED_INL_H_
#undef VITRINE_SPIRV_ALU_ORDERED_INL_H_
#else
#define VITRINE_SPIRV_ALU_ORDERED_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::spirv::alu::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using namespace base::HWY_NAMESPACE;

/// rnd(a + b); a's NaN if both are NaN.
template <class V>
HWY_INLINE V ordered_add(V a, V b) {
#if HWY_TARGET == HWY_SSE4
  asm("addps %1, %0" : "+x"(a.raw) : "x"(b.raw));  // a memory operand would have to be aligned
  return a;
#elif HWY_TARGET == HWY_AVX2
  asm("vaddps %2, %1, %0" : "=x"(a.raw) : "x"(a.raw), "xm"(b.raw));
  return a;
#elif HWY_TARGET == HWY_AVX3
  asm("vaddps %2, %1, %0" : "=v"(a.raw) : "v"(a.raw), "vm"(b.raw));
  return a;
#else
  return x86_add(a, b);
#endif
}

/// rnd(a - b); a's NaN if both are NaN.
template <class V>
HWY_INLINE V ordered_sub(V a, V b) {
  return x86_sub(a, b);
}

/// rnd(a / b); a's NaN if both are NaN.
template <class V>
HWY_INLINE V ordered_div(V a, V b) {
  return x86_div(a, b);
}

/// rnd(sqrt(a)).
template <class V>
HWY_INLINE V ordered_sqrt(V a) {
  return x86_sqrt(a);
}

/// rnd(a * b); a's NaN if both are NaN.
template <class V>
HWY_INLINE V ordered_mul(V a, V b) {
#if HWY_TARGET == HWY_SSE4
  asm("mulps %1, %0" : "+x"(a.raw) : "x"(b.raw));
  return a;
#elif HWY_TARGET == HWY_AVX2
  asm("vmulps %2, %1, %0" : "=x"(a.raw) : "x"(a.raw), "xm"(b.raw));
  return a;
#elif HWY_TARGET == HWY_AVX3
  asm("vmulps %2, %1, %0" : "=v"(a.raw) : "v"(a.raw), "vm"(b.raw));
  return a;
#else
  return x86_mul(a, b);
#endif
}

/// rnd(a * b + c); the NaN of the first of a, b and c that is one.
template <class V>
HWY_INLINE V ordered_fma(V a, V b, V c) {
#if HWY_TARGET == HWY_AVX2
  asm("vfmadd231ps %2, %1, %0" : "+x"(c.raw) : "x"(a.raw), "xm"(b.raw));
  return c;
#elif HWY_TARGET == HWY_AVX3
  asm("vfmadd231ps %2, %1, %0" : "+v"(c.raw) : "v"(a.raw), "vm"(b.raw));
  return c;
#elif HWY_TARGET == HWY_NEON
  return x86_fma(a, b, c);
#else
  V result = lanes_fma(a, b, c);
  for (const V operand : {c, b, a})
    result = hn::IfThenElse(hn::Ne(operand, operand), hn::Add(operand, operand), result);
  return result;
#endif
}

}  // namespace vitrine::spirv::alu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

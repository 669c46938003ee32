// Chain links of integer arithmetic and conversions.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "spirv/exec/chain_integer.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "spirv/alu/convert_ops-inl.h"
#include "spirv/alu/integer_ops-inl.h"
#include "spirv/exec/chain-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::spirv::alu::HWY_NAMESPACE {

Handler find_integer_chain(Op op, int accumulator, UniformSources uniform, Link link) {
  return find_family_chain(op, accumulator, uniform, link);
}

}  // namespace vitrine::spirv::alu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vitrine::spirv::alu {

HWY_EXPORT(find_integer_chain);

Handler integer_chain(ir::Op op, int accumulator, UniformSources uniform, exec::Link link) {
  return HWY_DYNAMIC_DISPATCH(find_integer_chain)(op, accumulator, uniform, link);
}

}  // namespace vitrine::spirv::alu
#endif

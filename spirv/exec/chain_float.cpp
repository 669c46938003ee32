// Chain links of float arithmetic.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "spirv/exec/chain_float.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "spirv/alu/float_ops-inl.h"
#include "spirv/exec/chain-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::spirv::alu::HWY_NAMESPACE {

Handler find_float_chain(Op op, int accumulator, UniformSources uniform, Link link) {
  switch (op) {
    case Op::kFAdd:
      return find_chain<Op::kFAdd, 1 | 8>(accumulator, uniform, link);
    case Op::kFSub:
      return find_chain<Op::kFSub, 1 | 2>(accumulator, uniform, link);
    case Op::kFMul:
      return find_chain<Op::kFMul, 1 | 8>(accumulator, uniform, link);
    case Op::kFDiv:
      return find_chain<Op::kFDiv, 1 | 2>(accumulator, uniform, link);
    case Op::kFMulAdd:
      return find_chain<Op::kFMulAdd, 1 | 4>(accumulator, uniform, link);
    case Op::kFMulSub:
      return find_chain<Op::kFMulSub, 1 | 4>(accumulator, uniform, link);
    case Op::kFNMulAdd:
      return find_chain<Op::kFNMulAdd, 1 | 4>(accumulator, uniform, link);
    case Op::kFMin:
      return find_chain<Op::kFMin, 1 | 2>(accumulator, uniform, link);
    case Op::kFMax:
      return find_chain<Op::kFMax, 1 | 2>(accumulator, uniform, link);
    case Op::kFMinPlain:
      return find_chain<Op::kFMinPlain, 1 | 2>(accumulator, uniform, link);
    case Op::kFMaxPlain:
      return find_chain<Op::kFMaxPlain, 1 | 2>(accumulator, uniform, link);
    case Op::kFNeg:
      return find_chain<Op::kFNeg, 1>(accumulator, uniform, link);
    case Op::kFAbs:
      return find_chain<Op::kFAbs, 1>(accumulator, uniform, link);
    case Op::kFRcp:
      return find_chain<Op::kFRcp, 1>(accumulator, uniform, link);
    case Op::kFSqrt:
      return find_chain<Op::kFSqrt, 1>(accumulator, uniform, link);
    case Op::kFRsq:
      return find_chain<Op::kFRsq, 1>(accumulator, uniform, link);
    case Op::kFFloor:
      return find_chain<Op::kFFloor, 1>(accumulator, uniform, link);
    case Op::kFFract:
      return find_chain<Op::kFFract, 1>(accumulator, uniform, link);
    default:
      return nullptr;
  }
}

}  // namespace vitrine::spirv::alu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vitrine::spirv::alu {

HWY_EXPORT(find_float_chain);

Handler float_chain(ir::Op op, int accumulator, UniformSources uniform, exec::Link link) {
  return HWY_DYNAMIC_DISPATCH(find_float_chain)(op, accumulator, uniform, link);
}

}  // namespace vitrine::spirv::alu
#endif

// Chain links of integer arithmetic.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "spirv/exec/chain_integer.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "spirv/alu/integer_ops-inl.h"
#include "spirv/exec/chain-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::spirv::alu::HWY_NAMESPACE {

Handler find_integer_chain(Op op, int accumulator, UniformSources uniform, Link link) {
  switch (op) {
    case Op::kIAdd:
      return find_chain<Op::kIAdd, 1 | 8>(accumulator, uniform, link);
    case Op::kISub:
      return find_chain<Op::kISub, 1 | 2>(accumulator, uniform, link);
    case Op::kIMul:
      return find_chain<Op::kIMul, 1 | 8>(accumulator, uniform, link);
    case Op::kAnd:
      return find_chain<Op::kAnd, 1>(accumulator, uniform, link);
    case Op::kOr:
      return find_chain<Op::kOr, 1>(accumulator, uniform, link);
    case Op::kXor:
      return find_chain<Op::kXor, 1>(accumulator, uniform, link);
    case Op::kNot:
      return find_chain<Op::kNot, 1>(accumulator, uniform, link);
    case Op::kShl:
      return find_chain<Op::kShl, 1 | 2>(accumulator, uniform, link);
    case Op::kUShr:
      return find_chain<Op::kUShr, 1 | 2>(accumulator, uniform, link);
    case Op::kIShr:
      return find_chain<Op::kIShr, 1>(accumulator, uniform, link);
    case Op::kINeg:
      return find_chain<Op::kINeg, 1>(accumulator, uniform, link);
    case Op::kIMin:
      return find_chain<Op::kIMin, 1 | 2>(accumulator, uniform, link);
    case Op::kIMax:
      return find_chain<Op::kIMax, 1 | 2>(accumulator, uniform, link);
    case Op::kUMin:
      return find_chain<Op::kUMin, 1 | 2>(accumulator, uniform, link);
    case Op::kUMax:
      return find_chain<Op::kUMax, 1 | 2>(accumulator, uniform, link);
    default:
      return nullptr;
  }
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

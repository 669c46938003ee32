// Chain links of comparisons and selections.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "spirv/exec/chain_compare.cpp"
#include "base/simd.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "spirv/alu/compare_ops-inl.h"
#include "spirv/exec/chain-inl.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::spirv::alu::HWY_NAMESPACE {

Handler find_compare_chain(Op op, int accumulator, UniformSources uniform, Link link) {
  switch (op) {
    case Op::kFLt:
      return find_chain<Op::kFLt, 1 | 2>(accumulator, uniform, link);
    case Op::kFGe:
      return find_chain<Op::kFGe, 1 | 2>(accumulator, uniform, link);
    case Op::kFEq:
      return find_chain<Op::kFEq, 1 | 2>(accumulator, uniform, link);
    case Op::kFNeu:
      return find_chain<Op::kFNeu, 1 | 2>(accumulator, uniform, link);
    case Op::kIEq:
      return find_chain<Op::kIEq, 1 | 2>(accumulator, uniform, link);
    case Op::kINe:
      return find_chain<Op::kINe, 1 | 2>(accumulator, uniform, link);
    case Op::kILt:
      return find_chain<Op::kILt, 1 | 2>(accumulator, uniform, link);
    case Op::kIGe:
      return find_chain<Op::kIGe, 1 | 2>(accumulator, uniform, link);
    case Op::kULt:
      return find_chain<Op::kULt, 1 | 2>(accumulator, uniform, link);
    case Op::kUGe:
      return find_chain<Op::kUGe, 1 | 2>(accumulator, uniform, link);
    case Op::kSelect:
      return find_chain<Op::kSelect, 2 | 4>(accumulator, uniform, link);
    default:
      return nullptr;
  }
}

}  // namespace vitrine::spirv::alu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vitrine::spirv::alu {

HWY_EXPORT(find_compare_chain);

Handler compare_chain(ir::Op op, int accumulator, UniformSources uniform, exec::Link link) {
  return HWY_DYNAMIC_DISPATCH(find_compare_chain)(op, accumulator, uniform, link);
}

}  // namespace vitrine::spirv::alu
#endif

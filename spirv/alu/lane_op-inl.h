// The form of the arithmetic of one ALU op on a vector of lanes, for any vector width:
//   template <> struct LaneOp<ir::Op::kX> { static V of(V a, ...); }
// Operand and result types follow the letters of the op's row in spirv/ops.def: F float, I int32, U uint32 vectors,
// B a Bools (operand) or a vector mask (result). A result may be any vector of 32-bit lanes: its bits are stored.
// Including a topic's header defines its ops; the handlers of a translation unit are those it has included.

#include <cstdint>

#include "base/simd.h"

#include <hwy/highway.h>

#include "base/lane_math-inl.h"
#include "spirv/ir.h"

#if defined(VITRINE_SPIRV_ALU_LANE_OP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_SPIRV_ALU_LANE_OP_INL_H_
#undef VITRINE_SPIRV_ALU_LANE_OP_INL_H_
#else
#define VITRINE_SPIRV_ALU_LANE_OP_INL_H_
#endif

// No function here that HWY_BEFORE_NAMESPACE could give a target to: clang refuses one without.
namespace vitrine::spirv::alu::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using namespace base::HWY_NAMESPACE;
using ir::Op;

template <Op op>
struct LaneOp;

/// A boolean operand: a mask for vectors of 32-bit unsigned lanes.
template <class D>
struct Bools {
  D d;
  hn::Mask<D> mask;
};

}  // namespace vitrine::spirv::alu::HWY_NAMESPACE

#endif

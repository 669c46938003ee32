// Float arithmetic that IEEE or the hardware defines (lavapipe-shader-math.md sections 0, 5.1, 9).

#include <cstdint>

#include "base/simd.h"

#include "spirv/alu/lane_op-inl.h"
#include "spirv/alu/ordered-inl.h"

#if defined(VITRINE_SPIRV_ALU_FLOAT_OPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_SPIRV_ALU_FLOAT_OPS_INL_H_
#undef VITRINE_SPIRV_ALU_FLOAT_OPS_INL_H_
#else
#define VITRINE_SPIRV_ALU_FLOAT_OPS_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::spirv::alu::HWY_NAMESPACE {

template <>
struct LaneOp<Op::kFNeg> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    return hn::Xor(a, lanes_set<V>(-0.0f));
  }
};

template <>
struct LaneOp<Op::kFAbs> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    return hn::AndNot(lanes_set<V>(-0.0f), a);
  }
};

template <>
struct LaneOp<Op::kFAdd> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return ordered_add(a, b);
  }
};

template <>
struct LaneOp<Op::kFSub> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return ordered_sub(a, b);
  }
};

template <>
struct LaneOp<Op::kFMul> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return ordered_mul(a, b);
  }
};

template <>
struct LaneOp<Op::kFDiv> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return ordered_div(a, b);
  }
};

template <>
struct LaneOp<Op::kFRcp> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    return ordered_div(lanes_set<V>(1.0f), a);
  }
};

template <>
struct LaneOp<Op::kFSqrt> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    return ordered_sqrt(a);
  }
};

template <>
struct LaneOp<Op::kFRsq> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    return ordered_div(lanes_set<V>(1.0f), ordered_sqrt(a));
  }
};

template <>
struct LaneOp<Op::kFFloor> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    return hn::Floor(a);
  }
};

template <>
struct LaneOp<Op::kFCeil> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    return hn::Ceil(a);
  }
};

template <>
struct LaneOp<Op::kFTrunc> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    return hn::Trunc(a);
  }
};

template <>
struct LaneOp<Op::kFRoundEven> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    return hn::Round(a);
  }
};

template <>
struct LaneOp<Op::kFFract> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    return ordered_sub(a, hn::Floor(a));
  }
};

// 5.1: a denormal is a zero under DAZ, which the comparisons see.
template <>
struct LaneOp<Op::kFSign> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    const auto nonzero = hn::Or(hn::Lt(a, lanes_set<V>(0.0f)), hn::Gt(a, lanes_set<V>(0.0f)));
    const V sign = hn::And(a, lanes_set<V>(-0.0f));
    return hn::IfThenElseZero(nonzero, hn::Or(sign, lanes_set<V>(1.0f)));
  }
};

// Section 0, nmin and nmax: the operand that is a number; the second of equal ones.
template <>
struct LaneOp<Op::kFMin> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return hn::IfThenElse(hn::Eq(b, b), lanes_min_second(a, b), a);
  }
};

template <>
struct LaneOp<Op::kFMax> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return hn::IfThenElse(hn::Eq(b, b), lanes_max_second(a, b), a);
  }
};

template <>
struct LaneOp<Op::kFMinPlain> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return lanes_min_second(a, b);
  }
};

template <>
struct LaneOp<Op::kFMaxPlain> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return lanes_max_second(a, b);
  }
};

// Section 9: quads are four consecutive lanes (x0,y0) (x1,y0) (x0,y1) (x1,y1).
template <>
struct LaneOp<Op::kFDdx> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    return ordered_sub(hn::DupOdd(a), hn::DupEven(a));
  }
};

template <>
struct LaneOp<Op::kFDdy> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    const hn::Repartition<std::uint64_t, hn::DFromV<V>> d64;
    const auto rows = hn::BitCast(d64, a);
    const hn::DFromV<V> d;
    return ordered_sub(hn::BitCast(d, hn::InterleaveUpper(d64, rows, rows)),
                       hn::BitCast(d, hn::InterleaveLower(d64, rows, rows)));
  }
};

template <>
struct LaneOp<Op::kFFused> {
  template <class V>
  static HWY_INLINE auto of(V a, V b, V c) {
    return ordered_fma(a, b, c);
  }
};

// ---- superinstructions: every product and every sum rounds

template <>
struct LaneOp<Op::kFMulAdd> {
  template <class V>
  static HWY_INLINE auto of(V a, V b, V c) {
    return ordered_add(ordered_mul(a, b), c);
  }
};

template <>
struct LaneOp<Op::kFMulSub> {
  template <class V>
  static HWY_INLINE auto of(V a, V b, V c) {
    return ordered_sub(ordered_mul(a, b), c);
  }
};

template <>
struct LaneOp<Op::kFNMulAdd> {
  template <class V>
  static HWY_INLINE auto of(V a, V b, V c) {
    return ordered_sub(c, ordered_mul(a, b));
  }
};

}  // namespace vitrine::spirv::alu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

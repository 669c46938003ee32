// Comparisons (lavapipe-shader-math.md section 5.2), moves, selections and conversions from booleans.

#include <cstdint>

#include "base/simd.h"

#include "spirv/alu/lane_op-inl.h"

#if defined(VITRINE_SPIRV_ALU_COMPARE_OPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_SPIRV_ALU_COMPARE_OPS_INL_H_
#undef VITRINE_SPIRV_ALU_COMPARE_OPS_INL_H_
#else
#define VITRINE_SPIRV_ALU_COMPARE_OPS_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::spirv::alu::HWY_NAMESPACE {

// ---- comparisons: results are vector masks

template <>
struct LaneOp<Op::kFLt> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return hn::Lt(a, b);
  }
};

template <>
struct LaneOp<Op::kFGe> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return hn::Ge(a, b);
  }
};

template <>
struct LaneOp<Op::kFEq> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return hn::Eq(a, b);
  }
};

template <>
struct LaneOp<Op::kFNeu> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return hn::Not(hn::Eq(a, b));
  }
};

template <>
struct LaneOp<Op::kIEq> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return hn::Eq(a, b);
  }
};

template <>
struct LaneOp<Op::kINe> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return hn::Not(hn::Eq(a, b));
  }
};

template <>
struct LaneOp<Op::kILt> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return hn::Lt(a, b);
  }
};

template <>
struct LaneOp<Op::kIGe> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return hn::Not(hn::Lt(a, b));
  }
};

template <>
struct LaneOp<Op::kULt> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return hn::Lt(a, b);
  }
};

template <>
struct LaneOp<Op::kUGe> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return hn::Not(hn::Lt(a, b));
  }
};

// ---- moves and selections

template <>
struct LaneOp<Op::kMov> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    return a;
  }
};

template <>
struct LaneOp<Op::kSelect> {
  template <class D, class V>
  static HWY_INLINE V of(Bools<D> a, V b, V c) {
    return hn::IfThenElse(a.mask, b, c);
  }
};

template <>
struct LaneOp<Op::kB2F> {
  template <class D>
  static HWY_INLINE auto of(Bools<D> a) {
    return hn::IfThenElseZero(a.mask, hn::Set(a.d, 0x3f800000u));
  }
};

template <>
struct LaneOp<Op::kB2I> {
  template <class D>
  static HWY_INLINE auto of(Bools<D> a) {
    return hn::IfThenElseZero(a.mask, hn::Set(a.d, 1u));
  }
};

}  // namespace vitrine::spirv::alu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

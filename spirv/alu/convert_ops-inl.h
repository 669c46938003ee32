// Conversions between number types (lavapipe-shader-math.md sections 7.1 and 8).

#include <cstdint>

#include "base/simd.h"

#include "spirv/alu/lane_op-inl.h"

#if defined(VITRINE_SPIRV_ALU_CONVERT_OPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_SPIRV_ALU_CONVERT_OPS_INL_H_
#undef VITRINE_SPIRV_ALU_CONVERT_OPS_INL_H_
#else
#define VITRINE_SPIRV_ALU_CONVERT_OPS_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::spirv::alu::HWY_NAMESPACE {

template <>
struct LaneOp<Op::kF2I> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    return lanes_truncate_to_int(a);
  }
};

template <>
struct LaneOp<Op::kF2U> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    return lanes_truncate_to_uint(a);
  }
};

template <>
struct LaneOp<Op::kI2F> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    return lanes_int_to_float(a);
  }
};

template <>
struct LaneOp<Op::kU2F> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    return lanes_uint_to_float(a);
  }
};

template <>
struct LaneOp<Op::kF2Half> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    return lanes_float_to_half(a);
  }
};

template <>
struct LaneOp<Op::kHalf2F> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    return lanes_half_to_float(a);
  }
};

template <>
struct LaneOp<Op::kQuantizeF16> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    const V result = lanes_half_to_float(lanes_float_to_half(a));
    const V sign = hn::And(result, lanes_set<V>(-0.0f));
    const V magnitude = hn::Xor(result, sign);
    return hn::IfThenElse(hn::Lt(magnitude, lanes_set<V>(6.103515625e-5f)), sign, result);  // 2^-14
  }
};

}  // namespace vitrine::spirv::alu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

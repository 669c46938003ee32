// exp2, log2, pow, sin, cos: the polynomials of lavapipe-shader-math.md section 6. fma only where it says so.

#include <cstdint>

#include "base/simd.h"

#include "spirv/alu/lane_op-inl.h"
#include "spirv/alu/ordered-inl.h"

#if defined(VITRINE_SPIRV_ALU_TRANSCENDENTAL_OPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_SPIRV_ALU_TRANSCENDENTAL_OPS_INL_H_
#undef VITRINE_SPIRV_ALU_TRANSCENDENTAL_OPS_INL_H_
#else
#define VITRINE_SPIRV_ALU_TRANSCENDENTAL_OPS_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::spirv::alu::HWY_NAMESPACE {

/// Section 6.1.
template <class V>
HWY_INLINE V exp2_lanes(V x) {
  using VI = Rebound<std::int32_t, V>;
  x = lanes_min_second(lanes_set<V>(128.0f), x);
  x = lanes_max_second(lanes_set<V>(-126.99999f), x);
  const V whole = hn::Floor(x);
  const V f = hn::Sub(x, whole);
  const V f2 = hn::Mul(f, f);
  V even = lanes_fma(f2, lanes_set<V>(0.00898934009049466391101f), lanes_set<V>(0.240153617044375388211f));
  even = lanes_fma(f2, even, lanes_set<V>(1.0f));
  V odd = lanes_fma(f2, lanes_set<V>(0.00187757667519147912699f), lanes_set<V>(0.0558263180532956664775f));
  odd = lanes_fma(f2, odd, lanes_set<V>(0.693153073200168932794f));
  const V polynomial = lanes_fma(odd, f, even);
  const VI exponent = hn::Add(lanes_truncate_to_int(whole), lanes_set<VI>(127));
  return hn::Mul(lanes_cast<float>(hn::ShiftLeft<23>(exponent)), polynomial);
}

/// True in lanes where x is neither below nor above zero: zeros, NaN, and denormals under DAZ.
template <class V>
HWY_INLINE auto is_zero_or_nan(V x) {
  return hn::Not(hn::Or(hn::Lt(x, lanes_set<V>(0.0f)), hn::Gt(x, lanes_set<V>(0.0f))));
}

/// Section 6.2.
template <class V>
HWY_INLINE V log2_lanes(V x) {
  using VU = Rebound<std::uint32_t, V>;
  using VI = Rebound<std::int32_t, V>;
  const VU bits = lanes_cast<std::uint32_t>(x);
  const VU biased = hn::ShiftRight<23>(hn::And(bits, lanes_set<VU>(0x7f800000u)));
  const V exponent = lanes_int_to_float(hn::Sub(lanes_cast<std::int32_t>(biased), lanes_set<VI>(127)));
  const V one = lanes_set<V>(1.0f);
  const V mantissa = lanes_cast<float>(hn::Or(hn::And(bits, lanes_set<VU>(0x007fffffu)), lanes_set<VU>(0x3f800000u)));
  const V y = hn::Div(hn::Sub(mantissa, one), hn::Add(mantissa, one));
  const V z = hn::Mul(y, y);
  const V z2 = hn::Mul(z, z);
  V even = lanes_fma(z2, lanes_set<V>(0.406718052498846252698f), lanes_set<V>(0.577440339438736392009f));
  even = lanes_fma(z2, even, lanes_set<V>(2.88539009343309178325f));
  const V odd = lanes_fma(z2, lanes_set<V>(0.403343858251329912514f), lanes_set<V>(0.961791550404184197881f));
  const V polynomial = lanes_fma(odd, z, even);
  V result = lanes_fma(y, polynomial, exponent);
  const V infinity = lanes_set<V>(__builtin_inff());
  const V nan = lanes_cast<float>(lanes_set<VU>(0x7fc00000u));
  result = hn::IfThenElse(hn::Lt(x, infinity), result, infinity);
  result = hn::IfThenElse(is_zero_or_nan(x), lanes_set<V>(-__builtin_inff()), result);
  return hn::IfThenElse(hn::Ge(x, lanes_set<V>(0.0f)), result, nan);
}

template <>
struct LaneOp<Op::kFExp2> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    return exp2_lanes(a);
  }
};

template <>
struct LaneOp<Op::kFLog2> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    return log2_lanes(a);
  }
};

// 6.4: zeros and NaN give 0 whatever the exponent is.
template <>
struct LaneOp<Op::kFPow> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return hn::IfThenZeroElse(is_zero_or_nan(a), exp2_lanes(ordered_mul(log2_lanes(a), b)));
  }
};

/// What sine and cosine of section 6.5 share: the octant and both polynomials of the reduced argument.
template <class V>
struct Octant {
  Rebound<std::int32_t, V> j;  ///< octant + 1, before its last bit is dropped
  V sine, cosine;
};

template <class V>
HWY_INLINE Octant<V> reduce_to_octant(V x) {
  using VI = Rebound<std::int32_t, V>;
  const V magnitude = hn::AndNot(lanes_set<V>(-0.0f), x);
  const VI j = hn::Add(lanes_truncate_to_int(hn::Mul(magnitude, lanes_set<V>(1.27323954473516f))), lanes_set<VI>(1));
  const V y = lanes_int_to_float(hn::AndNot(lanes_set<VI>(1), j));
  V r = lanes_fma(y, lanes_set<V>(-0.78515625f), magnitude);
  r = lanes_fma(y, lanes_set<V>(-2.4187564849853515625e-4f), r);
  r = lanes_fma(y, lanes_set<V>(-3.77489497744594108e-8f), r);
  const V z = hn::Mul(r, r);
  V c = lanes_fma(z, lanes_set<V>(2.443315711809948e-5f), lanes_set<V>(-1.388731625493765e-3f));
  c = lanes_fma(c, z, lanes_set<V>(4.166664568298827e-2f));
  c = hn::Mul(hn::Mul(c, z), z);
  c = hn::Add(hn::Sub(c, hn::Mul(z, lanes_set<V>(0.5f))), lanes_set<V>(1.0f));
  V s = lanes_fma(z, lanes_set<V>(-1.9515295891e-4f), lanes_set<V>(8.3321608736e-3f));
  s = lanes_fma(s, z, lanes_set<V>(-1.6666654611e-1f));
  s = lanes_fma(hn::Mul(s, z), r, r);
  return {j, s, c};
}

/// Picks the polynomial by bit 1 of `quadrant`, flips the sign, clamps, and answers NaN for infinities and NaN.
template <class V, class VI>
HWY_INLINE V finish_sine(V x, const Octant<V>& octant, VI quadrant, VI sign) {
  using VU = Rebound<std::uint32_t, V>;
  const VI two = lanes_set<VI>(2);
  const auto use_sine = hn::Eq(hn::And(quadrant, two), hn::Zero(hn::DFromV<VI>()));
  V value = hn::IfThenElse(lanes_mask_cast<V>(use_sine), octant.sine, octant.cosine);
  value = hn::Xor(value, lanes_cast<float>(sign));
  value = lanes_max_second(lanes_min_second(value, lanes_set<V>(1.0f)), lanes_set<V>(-1.0f));
  const V magnitude = hn::AndNot(lanes_set<V>(-0.0f), x);
  const V nan = lanes_cast<float>(lanes_set<VU>(0x7fc00000u));
  return hn::IfThenElse(hn::Lt(magnitude, lanes_set<V>(__builtin_inff())), value, nan);
}

template <>
struct LaneOp<Op::kFSin> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    using VI = Rebound<std::int32_t, V>;
    const auto octant = reduce_to_octant(a);
    const VI sign =
        hn::And(hn::Xor(lanes_cast<std::int32_t>(a), hn::ShiftLeft<29>(octant.j)), lanes_set<VI>(INT32_MIN));
    return finish_sine(a, octant, octant.j, sign);
  }
};

template <>
struct LaneOp<Op::kFCos> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    using VI = Rebound<std::int32_t, V>;
    const auto octant = reduce_to_octant(a);
    const VI quadrant = hn::Sub(hn::AndNot(lanes_set<VI>(1), octant.j), lanes_set<VI>(2));
    const VI sign = hn::ShiftLeft<29>(hn::AndNot(quadrant, lanes_set<VI>(4)));
    return finish_sine(a, octant, quadrant, sign);
  }
};

}  // namespace vitrine::spirv::alu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

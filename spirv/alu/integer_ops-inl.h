// Integer arithmetic, shifts and bit operations (lavapipe-shader-math.md sections 7.2 to 7.4).

#include <cstdint>

#include "base/simd.h"

#include "spirv/alu/lane_op-inl.h"

#if defined(VITRINE_SPIRV_ALU_INTEGER_OPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_SPIRV_ALU_INTEGER_OPS_INL_H_
#undef VITRINE_SPIRV_ALU_INTEGER_OPS_INL_H_
#else
#define VITRINE_SPIRV_ALU_INTEGER_OPS_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::spirv::alu::HWY_NAMESPACE {

/// High halves of the 64-bit products of each pair of lanes.
template <class V>
HWY_INLINE auto high_of_products(V a, V b) {
  const hn::DFromV<V> d;
  const hn::Repartition<std::uint64_t, hn::DFromV<V>> d64;
  const auto odd_lane = [&](V v) HWY_ATTR { return hn::BitCast(d, hn::ShiftRight<32>(hn::BitCast(d64, v))); };
  const auto even = hn::BitCast(d64, hn::MulEven(a, b));
  const auto odd = hn::BitCast(d64, hn::MulEven(odd_lane(a), odd_lane(b)));
  const auto upper = hn::Set(d64, 0xFFFFFFFF00000000u);
  return hn::BitCast(d, hn::Or(hn::ShiftRight<32>(even), hn::And(odd, upper)));
}

/// Unsigned quotient, through binary64: both operands are exact there, and an inexact quotient is further from the next
/// integer than a rounding error. Meaningless where b is 0.
template <class V>
HWY_INLINE V quotient_lanes(V a, V b) {
  const hn::DFromV<V> d;
  const hn::Repartition<std::uint64_t, hn::DFromV<V>> d64;
  const hn::Repartition<double, hn::DFromV<V>> df;
  // The bits of 2^52 + n are those of 2^52 with n in the low half.
  const auto magic = hn::Set(d64, 0x4330000000000000u);
  const auto offset = hn::BitCast(df, magic);
  const auto low = hn::Set(d64, 0xFFFFFFFFu);
  const auto a64 = hn::BitCast(d64, a);
  const auto b64 = hn::BitCast(d64, b);
  const auto to_double = [&](auto n) HWY_ATTR { return hn::Sub(hn::BitCast(df, hn::Or(n, magic)), offset); };
  const auto divide = [&](auto n, auto m) HWY_ATTR {
    return hn::BitCast(d64, hn::Add(hn::Floor(hn::Div(to_double(n), to_double(m))), offset));
  };
  const auto even = divide(hn::And(a64, low), hn::And(b64, low));
  const auto odd = divide(hn::ShiftRight<32>(a64), hn::ShiftRight<32>(b64));
  return hn::BitCast(d, hn::Or(hn::And(even, low), hn::ShiftLeft<32>(odd)));
}

template <class V>
HWY_INLINE auto is_zero(V v) {
  return hn::Eq(v, hn::Zero(hn::DFromV<V>()));
}

/// |a| as unsigned, also of INT_MIN.
template <class V>
HWY_INLINE auto magnitude_lanes(V a) {
  const V sign = hn::ShiftRight<31>(a);
  return lanes_cast<std::uint32_t>(hn::Sub(hn::Xor(a, sign), sign));
}

/// Remainder with the sign of the dividend; meaningless where b is 0.
template <class V>
HWY_INLINE V remainder_lanes(V a, V b) {
  const auto divisor = magnitude_lanes(b);
  const auto dividend = magnitude_lanes(a);
  const auto rest = hn::Sub(dividend, hn::Mul(quotient_lanes(dividend, divisor), divisor));
  const V sign = hn::ShiftRight<31>(a);
  return hn::Sub(hn::Xor(lanes_cast<std::int32_t>(rest), sign), sign);
}

/// Index of the highest 1 of each lane, -1 for 0: the exponent of the value as a float. Dropping each 1 that follows a
/// 1 keeps the conversion from rounding up to the next power of two.
template <class V>
HWY_INLINE auto highest_bit(V v) {
  using VI = Rebound<std::int32_t, V>;
  const auto as_float = lanes_uint_to_float(hn::AndNot(hn::ShiftRight<1>(v), v));
  const VI exponent =
      hn::Sub(lanes_cast<std::int32_t>(hn::ShiftRight<23>(lanes_cast<std::uint32_t>(as_float))), lanes_set<VI>(127));
  return hn::Max(exponent, lanes_set<VI>(-1));
}

template <class V>
HWY_INLINE V shift_count(V bits) {
  return hn::And(bits, lanes_set<V>(31u));
}

template <>
struct LaneOp<Op::kINeg> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    return hn::Sub(hn::Zero(hn::DFromV<V>()), a);
  }
};

template <>
struct LaneOp<Op::kIAbs> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    return magnitude_lanes(a);
  }
};

template <>
struct LaneOp<Op::kISign> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    const V one = lanes_set<V>(1);
    return hn::Max(hn::Min(a, one), lanes_set<V>(-1));
  }
};

template <>
struct LaneOp<Op::kIAdd> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return hn::Add(a, b);
  }
};

template <>
struct LaneOp<Op::kISub> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return hn::Sub(a, b);
  }
};

template <>
struct LaneOp<Op::kIMul> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return hn::Mul(a, b);
  }
};

template <>
struct LaneOp<Op::kIMulHigh> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return high_of_products(a, b);
  }
};

template <>
struct LaneOp<Op::kUMulHigh> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return high_of_products(a, b);
  }
};

// 7.2: by 0 -> 0. INT_MIN / -1: the magnitude 2^31 is INT_MIN again.
template <>
struct LaneOp<Op::kIDiv> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    const V sign = hn::ShiftRight<31>(hn::Xor(a, b));
    const V quotient = lanes_cast<std::int32_t>(quotient_lanes(magnitude_lanes(a), magnitude_lanes(b)));
    return hn::IfThenZeroElse(is_zero(b), hn::Sub(hn::Xor(quotient, sign), sign));
  }
};

template <>
struct LaneOp<Op::kUDiv> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return hn::IfThenElse(is_zero(b), lanes_set<V>(0xFFFFFFFFu), quotient_lanes(a, b));
  }
};

template <>
struct LaneOp<Op::kIRem> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return hn::IfThenElse(is_zero(b), lanes_set<V>(-1), remainder_lanes(a, b));
  }
};

template <>
struct LaneOp<Op::kIMod> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    const V rest = remainder_lanes(a, b);
    const auto adjust = hn::AndNot(is_zero(rest), hn::Lt(hn::Xor(rest, b), hn::Zero(hn::DFromV<V>())));
    return hn::IfThenElse(is_zero(b), lanes_set<V>(-1), hn::Add(rest, hn::IfThenElseZero(adjust, b)));
  }
};

template <>
struct LaneOp<Op::kUMod> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return hn::IfThenElse(is_zero(b), lanes_set<V>(0xFFFFFFFFu), hn::Sub(a, hn::Mul(quotient_lanes(a, b), b)));
  }
};

template <>
struct LaneOp<Op::kIMin> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return hn::Min(a, b);
  }
};

template <>
struct LaneOp<Op::kIMax> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return hn::Max(a, b);
  }
};

template <>
struct LaneOp<Op::kUMin> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return hn::Min(a, b);
  }
};

template <>
struct LaneOp<Op::kUMax> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return hn::Max(a, b);
  }
};

template <>
struct LaneOp<Op::kUAddCarry> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return hn::IfThenElseZero(hn::Lt(hn::Add(a, b), a), lanes_set<V>(1u));
  }
};

template <>
struct LaneOp<Op::kUSubBorrow> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return hn::IfThenElseZero(hn::Lt(a, b), lanes_set<V>(1u));
  }
};

template <>
struct LaneOp<Op::kAnd> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return hn::And(a, b);
  }
};

template <>
struct LaneOp<Op::kOr> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return hn::Or(a, b);
  }
};

template <>
struct LaneOp<Op::kXor> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return hn::Xor(a, b);
  }
};

template <>
struct LaneOp<Op::kNot> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    return hn::Xor(a, lanes_set<V>(0xFFFFFFFFu));
  }
};

template <>
struct LaneOp<Op::kShl> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return hn::Shl(a, shift_count(b));
  }
};

template <>
struct LaneOp<Op::kIShr> {
  template <class V, class VU>
  static HWY_INLINE auto of(V a, VU b) {
    return hn::Shr(a, lanes_cast<std::int32_t>(shift_count(b)));
  }
};

template <>
struct LaneOp<Op::kUShr> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return hn::Shr(a, shift_count(b));
  }
};

template <>
struct LaneOp<Op::kBitCount> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    return hn::PopulationCount(a);
  }
};

template <>
struct LaneOp<Op::kBitReverse> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    const auto swap = [](V v, auto distance, std::uint32_t mask) HWY_ATTR {
      const V low = lanes_set<V>(mask);
      return hn::Or(hn::And(hn::ShiftRight<distance.value>(v), low), hn::ShiftLeft<distance.value>(hn::And(v, low)));
    };
    a = swap(a, std::integral_constant<int, 1>(), 0x55555555u);
    a = swap(a, std::integral_constant<int, 2>(), 0x33333333u);
    a = swap(a, std::integral_constant<int, 4>(), 0x0F0F0F0Fu);
    a = swap(a, std::integral_constant<int, 8>(), 0x00FF00FFu);
    return swap(a, std::integral_constant<int, 16>(), 0x0000FFFFu);
  }
};

template <>
struct LaneOp<Op::kUFindMsb> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    return highest_bit(a);
  }
};

template <>
struct LaneOp<Op::kIFindMsb> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    return highest_bit(lanes_cast<std::uint32_t>(hn::Xor(a, hn::ShiftRight<31>(a))));
  }
};

template <>
struct LaneOp<Op::kFindLsb> {
  template <class V>
  static HWY_INLINE auto of(V a) {
    return highest_bit(hn::And(a, hn::Sub(hn::Zero(hn::DFromV<V>()), a)));
  }
};

// 7.4: shift counts are taken modulo 32 everywhere; 32 bits keep the whole shifted value.
template <>
struct LaneOp<Op::kBfeU> {
  template <class V>
  static HWY_INLINE auto of(V a, V b, V c) {
    const V one = lanes_set<V>(1u);
    const V mask = hn::Sub(hn::Shl(one, shift_count(c)), one);
    const V whole = hn::VecFromMask(hn::DFromV<V>(), hn::Eq(c, lanes_set<V>(32u)));
    return hn::And(hn::Shr(a, shift_count(b)), hn::Or(mask, whole));
  }
};

template <>
struct LaneOp<Op::kBfeI> {
  template <class V, class VU>
  static HWY_INLINE auto of(V a, VU b, VU c) {
    const VU width = lanes_set<VU>(32u);
    const VU left = shift_count(hn::Sub(hn::Sub(width, c), b));
    const VU right = shift_count(hn::Sub(width, c));
    const VU moved = hn::Shl(lanes_cast<std::uint32_t>(a), left);
    const V value = hn::Shr(lanes_cast<std::int32_t>(moved), lanes_cast<std::int32_t>(right));
    return hn::IfThenZeroElse(lanes_mask_cast<V>(is_zero(c)), value);
  }
};

/// `a` turned right by `bits`, 0 to 31 of which count.
template <class V>
HWY_INLINE V turned_right(V a, V bits) {
#if HWY_TARGET == HWY_AVX3
  if constexpr (sizeof(V) == 64) return V{_mm512_rorv_epi32(a.raw, bits.raw)};
#endif
  return hn::Or(hn::Shr(a, shift_count(bits)), hn::Shl(a, shift_count(hn::Sub(lanes_set<V>(32u), bits))));
}

/// The bits of `yes` where `mask` has ones, of `no` elsewhere. (IfVecThenElse takes whole bytes in most targets.)
template <class V>
HWY_INLINE V chosen_bits(V mask, V yes, V no) {
#if HWY_TARGET == HWY_AVX3
  return hn::IfVecThenElse(mask, yes, no);
#else
  return hn::Xor(no, hn::And(mask, hn::Xor(yes, no)));
#endif
}

template <>
struct LaneOp<Op::kRotR> {
  template <class V>
  static HWY_INLINE auto of(V a, V b) {
    return turned_right(a, b);
  }
};

template <>
struct LaneOp<Op::kRotRXor> {
  template <class V>
  static HWY_INLINE auto of(V a, V b, V c) {
    return turned_right(hn::Xor(a, b), c);
  }
};

template <>
struct LaneOp<Op::kXorRotR> {
  template <class V>
  static HWY_INLINE auto of(V a, V b, V c) {
    return hn::Xor(a, turned_right(b, c));
  }
};

template <>
struct LaneOp<Op::kXorShr> {
  template <class V>
  static HWY_INLINE auto of(V a, V b, V c) {
    return hn::Xor(a, hn::Shr(b, shift_count(c)));
  }
};

template <>
struct LaneOp<Op::kXorShl> {
  template <class V>
  static HWY_INLINE auto of(V a, V b, V c) {
    return hn::Xor(a, hn::Shl(b, shift_count(c)));
  }
};

template <>
struct LaneOp<Op::kIAddShl> {
  template <class V>
  static HWY_INLINE auto of(V a, V b, V c) {
    return hn::Add(a, hn::Shl(b, shift_count(c)));
  }
};

template <>
struct LaneOp<Op::kIMulAdd> {
  template <class V>
  static HWY_INLINE auto of(V a, V b, V c) {
    return hn::Add(hn::Mul(a, b), c);
  }
};

template <>
struct LaneOp<Op::kIAdd3> {
  template <class V>
  static HWY_INLINE auto of(V a, V b, V c) {
    return hn::Add(hn::Add(a, b), c);
  }
};

template <>
struct LaneOp<Op::kXor3> {
  template <class V>
  static HWY_INLINE auto of(V a, V b, V c) {
    return hn::Xor3(a, b, c);
  }
};

template <>
struct LaneOp<Op::kBitSelect> {
  template <class V>
  static HWY_INLINE auto of(V a, V b, V c) {
    return chosen_bits(a, b, c);
  }
};

template <>
struct LaneOp<Op::kMajority> {
  template <class V>
  static HWY_INLINE auto of(V a, V b, V c) {
    return chosen_bits(hn::Xor(a, b), c, a);
  }
};

}  // namespace vitrine::spirv::alu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

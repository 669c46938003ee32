// The arithmetic of wide_ops.def as functions of one lane: WideOp<op>::of. Their parameter types are the letters of the
// row. Include after <hwy/highway.h>, in a file that follows the foreach_target pattern: the loop around them becomes
// vector code of the target.

#include <bit>
#include <cmath>
#include <cstdint>

#include "spirv/ir.h"

#if defined(VITRINE_SPIRV_ALU_WIDE_OPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VITRINE_SPIRV_ALU_WIDE_OPS_INL_H_
#undef VITRINE_SPIRV_ALU_WIDE_OPS_INL_H_
#else
#define VITRINE_SPIRV_ALU_WIDE_OPS_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace vitrine::spirv::alu::HWY_NAMESPACE {

using Int64 = std::int64_t;
using Uint64 = std::uint64_t;

template <ir::Op op>
struct WideOp;

/// What MIN and MAX make of a denormal where denormals count as zero, which comparisons know: zero with its sign.
HWY_INLINE double flushed(double a) {
  const Uint64 sign = std::bit_cast<Uint64>(a) & Uint64{1} << 63;
  return a == 0.0 ? std::bit_cast<double>(sign) : a;
}

/// Truncation of a float or double as CVTT* does it: NaN and values out of range give the least integer.
template <class Int, class Float>
HWY_INLINE Int truncate_signed(Float a) {
  constexpr Float limit = sizeof(Int) == 8 ? Float(0x1p63) : Float(0x1p31);
  constexpr Int least = sizeof(Int) == 8 ? static_cast<Int>(INT64_MIN) : static_cast<Int>(INT32_MIN);
  // Doubles just below -2^31 truncate into range.
  const bool fits =
      sizeof(Int) == 4 && sizeof(Float) == 8 ? a > Float(-0x1.00000002p31) && a < limit : a >= -limit && a < limit;
  return fits ? static_cast<Int>(a) : least;
}

/// The same for unsigned integers: NaN and values out of range give all ones.
template <class Uint, class Float>
HWY_INLINE Uint truncate_unsigned(Float a) {
  constexpr Float limit = sizeof(Uint) == 8 ? Float(0x1p64) : Float(0x1p32);
  return a > Float(-1) && a < limit ? static_cast<Uint>(a < 0 ? Float(0) : a) : ~Uint{0};
}

HWY_INLINE Int64 signed_quotient(Int64 a, Int64 b) {
  if (b == 0) return 0;
  return b == -1 ? static_cast<Int64>(0 - static_cast<Uint64>(a)) : a / b;
}

HWY_INLINE Int64 signed_remainder(Int64 a, Int64 b) {
  if (b == 0) return -1;
  return b == -1 ? 0 : a % b;
}

HWY_INLINE Int64 floored_modulo(Int64 a, Int64 b) {
  const Int64 rest = signed_remainder(a, b);
  return b != 0 && rest != 0 && (rest < 0) != (b < 0) ? rest + b : rest;
}

HWY_INLINE Uint64 high_product(Uint64 a, Uint64 b) {
  const Uint64 a0 = a & 0xffffffffu, a1 = a >> 32, b0 = b & 0xffffffffu, b1 = b >> 32;
  const Uint64 middle = a1 * b0 + (a0 * b0 >> 32);
  return a1 * b1 + (middle >> 32) + ((a0 * b1 + (middle & 0xffffffffu)) >> 32);
}

HWY_INLINE Int64 high_product_signed(Int64 a, Int64 b) {
  const Uint64 product = high_product(static_cast<Uint64>(a), static_cast<Uint64>(b));
  return static_cast<Int64>(product - (a < 0 ? static_cast<Uint64>(b) : 0) - (b < 0 ? static_cast<Uint64>(a) : 0));
}

/// sin(a + quadrants * pi / 2) for |a| < 2^16, in double: the error is far below the rounding to binary32.
HWY_INLINE float sine(float a, int quadrants) {
  if (!(__builtin_fabsf(a) < __builtin_inff())) return __builtin_nanf("");
  if (a == 0 && quadrants == 0) return a;
  const double x = static_cast<double>(a), n = __builtin_nearbyint(x * 0x1.45f306dc9c883p-1);
  const double r = (x - n * 0x1.921fb54400000p+0) - n * 0x1.0b4611a626331p-34, z = r * r;
  const int quadrant = (static_cast<int>(n) + quadrants) & 3;
  double value;
  if ((quadrant & 1) == 0) {
    value = -1.0 / 1307674368000.0;
    for (const double c :
         {1.0 / 6227020800.0, -1.0 / 39916800.0, 1.0 / 362880.0, -1.0 / 5040.0, 1.0 / 120.0, -1.0 / 6.0})
      value = value * z + c;
    value = r + r * z * value;
  } else {
    value = 1.0 / 20922789888000.0;
    for (const double c : {-1.0 / 87178291200.0, 1.0 / 479001600.0, -1.0 / 3628800.0, 1.0 / 40320.0, -1.0 / 720.0,
                           1.0 / 24.0, -0.5, 1.0})
      value = value * z + c;
  }
  return static_cast<float>((quadrant & 2) != 0 ? -value : value);
}

HWY_INLINE float power_of_two(float a) {
  if (a != a) return a;
  if (a > 200.0f) return __builtin_inff();
  if (a < -200.0f) return 0.0f;
  const double x = static_cast<double>(a), n = __builtin_nearbyint(x);
  const double r = (x - n) * 0x1.62e42fefa39efp-1;
  double value = 1.0;
  for (int k = 14; k >= 1; --k) value = value * r / k + 1.0;
  return static_cast<float>(value * std::bit_cast<double>(static_cast<Uint64>(static_cast<int>(n) + 1023) << 52));
}

/// For zeros, infinities and normal numbers, which all binary16 are in binary32.
HWY_INLINE float binary_logarithm(float a) {
  if (a != a || a < 0) return __builtin_nanf("");
  if (a == 0) return -__builtin_inff();
  if (a == __builtin_inff()) return a;
  const auto bits = std::bit_cast<Uint64>(static_cast<double>(a));
  double exponent = static_cast<double>(static_cast<int>(bits >> 52) - 1023);
  double m = std::bit_cast<double>((bits & 0xfffffffffffffu) | 0x3ff0000000000000u);
  if (m > 0x1.6a09e667f3bcdp+0) {
    m *= 0.5;
    exponent += 1.0;
  }
  const double s = (m - 1.0) / (m + 1.0), z = s * s;
  double sum = 0;
  for (int k = 23; k >= 1; k -= 2) sum = sum * z + 1.0 / k;
  return static_cast<float>(exponent + 2.0 * s * sum * 0x1.71547652b82fep+0);
}

// Of two NaN operands the first one survives, as in the CPU; the compiler may swap the operands of + and *.
// clang-format off
template <> struct WideOp<ir::Op::kHSin> { static HWY_INLINE float of(float a) { return sine(a, 0); } };
template <> struct WideOp<ir::Op::kHCos> { static HWY_INLINE float of(float a) { return sine(a, 1); } };
template <> struct WideOp<ir::Op::kHExp2> { static HWY_INLINE float of(float a) { return power_of_two(a); } };
template <> struct WideOp<ir::Op::kHLog2> { static HWY_INLINE float of(float a) { return binary_logarithm(a); } };
template <> struct WideOp<ir::Op::kDAdd> { static HWY_INLINE double of(double a, double b) { return a != a ? a + a : a + b; } };
template <> struct WideOp<ir::Op::kDMul> { static HWY_INLINE double of(double a, double b) { return a != a ? a + a : a * b; } };
template <> struct WideOp<ir::Op::kDDiv> { static HWY_INLINE double of(double a, double b) { return a / b; } };
template <> struct WideOp<ir::Op::kDSqrt> { static HWY_INLINE double of(double a) { return __builtin_sqrt(a); } };
template <> struct WideOp<ir::Op::kDFloor> { static HWY_INLINE double of(double a) { return __builtin_floor(a); } };
template <> struct WideOp<ir::Op::kDCeil> { static HWY_INLINE double of(double a) { return __builtin_ceil(a); } };
template <> struct WideOp<ir::Op::kDTrunc> { static HWY_INLINE double of(double a) { return __builtin_trunc(a); } };
template <> struct WideOp<ir::Op::kDRoundEven> { static HWY_INLINE double of(double a) { return __builtin_nearbyint(a); } };
template <> struct WideOp<ir::Op::kDMin> { static HWY_INLINE double of(double a, double b) { return b != b ? a : flushed(a < b ? a : b); } };
template <> struct WideOp<ir::Op::kDMax> { static HWY_INLINE double of(double a, double b) { return b != b ? a : flushed(a > b ? a : b); } };
template <> struct WideOp<ir::Op::kDLt> { static HWY_INLINE bool of(double a, double b) { return a < b; } };
template <> struct WideOp<ir::Op::kDGe> { static HWY_INLINE bool of(double a, double b) { return a >= b; } };
template <> struct WideOp<ir::Op::kDEq> { static HWY_INLINE bool of(double a, double b) { return a == b; } };
template <> struct WideOp<ir::Op::kDNeu> { static HWY_INLINE bool of(double a, double b) { return a != b; } };

template <> struct WideOp<ir::Op::kQAdd> { static HWY_INLINE Uint64 of(Uint64 a, Uint64 b) { return a + b; } };
template <> struct WideOp<ir::Op::kQSub> { static HWY_INLINE Uint64 of(Uint64 a, Uint64 b) { return a - b; } };
template <> struct WideOp<ir::Op::kQMul> { static HWY_INLINE Uint64 of(Uint64 a, Uint64 b) { return a * b; } };
template <> struct WideOp<ir::Op::kLMulHigh> { static HWY_INLINE Int64 of(Int64 a, Int64 b) { return high_product_signed(a, b); } };
template <> struct WideOp<ir::Op::kQMulHigh> { static HWY_INLINE Uint64 of(Uint64 a, Uint64 b) { return high_product(a, b); } };
template <> struct WideOp<ir::Op::kLDiv> { static HWY_INLINE Int64 of(Int64 a, Int64 b) { return signed_quotient(a, b); } };
template <> struct WideOp<ir::Op::kQDiv> { static HWY_INLINE Uint64 of(Uint64 a, Uint64 b) { return b == 0 ? ~Uint64{0} : a / b; } };
template <> struct WideOp<ir::Op::kLRem> { static HWY_INLINE Int64 of(Int64 a, Int64 b) { return signed_remainder(a, b); } };
template <> struct WideOp<ir::Op::kLMod> { static HWY_INLINE Int64 of(Int64 a, Int64 b) { return floored_modulo(a, b); } };
template <> struct WideOp<ir::Op::kQMod> { static HWY_INLINE Uint64 of(Uint64 a, Uint64 b) { return b == 0 ? ~Uint64{0} : a % b; } };
template <> struct WideOp<ir::Op::kQShl> { static HWY_INLINE Uint64 of(Uint64 a, std::uint32_t b) { return a << (b & 63); } };
template <> struct WideOp<ir::Op::kLShr> { static HWY_INLINE Int64 of(Int64 a, std::uint32_t b) { return a >> (b & 63); } };
template <> struct WideOp<ir::Op::kQShr> { static HWY_INLINE Uint64 of(Uint64 a, std::uint32_t b) { return a >> (b & 63); } };
template <> struct WideOp<ir::Op::kLLt> { static HWY_INLINE bool of(Int64 a, Int64 b) { return a < b; } };
template <> struct WideOp<ir::Op::kLGe> { static HWY_INLINE bool of(Int64 a, Int64 b) { return a >= b; } };
template <> struct WideOp<ir::Op::kQLt> { static HWY_INLINE bool of(Uint64 a, Uint64 b) { return a < b; } };
template <> struct WideOp<ir::Op::kQGe> { static HWY_INLINE bool of(Uint64 a, Uint64 b) { return a >= b; } };

template <> struct WideOp<ir::Op::kDFromF> { static HWY_INLINE double of(float a) { return static_cast<double>(a); } };
template <> struct WideOp<ir::Op::kFFromD> { static HWY_INLINE float of(double a) { return static_cast<float>(a); } };
template <> struct WideOp<ir::Op::kDFromI> { static HWY_INLINE double of(std::int32_t a) { return a; } };
template <> struct WideOp<ir::Op::kDFromU> { static HWY_INLINE double of(std::uint32_t a) { return a; } };
template <> struct WideOp<ir::Op::kDFromL> { static HWY_INLINE double of(Int64 a) { return static_cast<double>(a); } };
template <> struct WideOp<ir::Op::kDFromQ> { static HWY_INLINE double of(Uint64 a) { return static_cast<double>(a); } };
template <> struct WideOp<ir::Op::kFFromL> { static HWY_INLINE float of(Int64 a) { return static_cast<float>(a); } };
template <> struct WideOp<ir::Op::kFFromQ> { static HWY_INLINE float of(Uint64 a) { return static_cast<float>(a); } };
template <> struct WideOp<ir::Op::kIFromD> { static HWY_INLINE std::int32_t of(double a) { return truncate_signed<std::int32_t>(a); } };
template <> struct WideOp<ir::Op::kUFromD> { static HWY_INLINE std::uint32_t of(double a) { return truncate_unsigned<std::uint32_t>(a); } };
template <> struct WideOp<ir::Op::kLFromD> { static HWY_INLINE Int64 of(double a) { return truncate_signed<Int64>(a); } };
template <> struct WideOp<ir::Op::kQFromD> { static HWY_INLINE Uint64 of(double a) { return truncate_unsigned<Uint64>(a); } };
template <> struct WideOp<ir::Op::kLFromF> { static HWY_INLINE Int64 of(float a) { return truncate_signed<Int64>(a); } };
template <> struct WideOp<ir::Op::kQFromF> { static HWY_INLINE Uint64 of(float a) { return truncate_unsigned<Uint64>(a); } };
// clang-format on

}  // namespace vitrine::spirv::alu::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

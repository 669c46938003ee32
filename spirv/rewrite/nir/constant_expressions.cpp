// Operations as the reference's compiler computes them on the host (nir_constant_expressions.py): C semantics,
// denormals honoured (lavapipe-shader-math.md sections 1, 7.1). Transcendentals are those of the C library, as they are
// there: this is not shader arithmetic, which never calls it.
#include "spirv/rewrite/nir/constant_expressions.h"

#include <bit>
#include <cmath>

#include "base/float_mode.h"
#include "base/numeric.h"
#include "spirv/rewrite/nir/constant_expressions_float.h"

namespace vitrine::spirv::rewriting {
namespace {

using base::bits_of;
using base::float_of;

/// False: not an op of one float operand.
bool unary_float(Op op, float a, float& r) {
  switch (op) {
    case Op::kFExp2:
      r = std::exp2(a);
      return true;
    case Op::kFLog2:
      r = std::log2(a);
      return true;
    case Op::kFSin:
      r = std::sin(a);
      return true;
    case Op::kFCos:
      r = std::cos(a);
      return true;
    case Op::kFSign:
      r = a > 0.0f ? 1.0f : a < 0.0f ? -1.0f : a == 0.0f ? a : 0.0f;  // of -0 it is -0, unlike at run time
      return true;
    case Op::kFDdx:
    case Op::kFDdy:
      r = 0.0f;
      return true;
    default:
      return fold_unary(op, a, r);
  }
}

bool binary_float(Op op, float a, float b, float& r) {
  if (op != Op::kFPow) return fold_binary(op, a, b, r);
  r = std::pow(a, b);
  return true;
}

bool compare(Op op, const std::uint32_t* v, bool& r) {
  const auto i = static_cast<std::int32_t>(v[0]), j = static_cast<std::int32_t>(v[1]);
  switch (op) {
    case Op::kIEq:
      r = v[0] == v[1];
      return true;
    case Op::kINe:
      r = v[0] != v[1];
      return true;
    case Op::kILt:
      r = i < j;
      return true;
    case Op::kIGe:
      r = i >= j;
      return true;
    case Op::kULt:
      r = v[0] < v[1];
      return true;
    case Op::kUGe:
      r = v[0] >= v[1];
      return true;
    case Op::kMovB:
      r = v[0] != 0;
      return true;
    case Op::kAndB:
      r = v[0] && v[1];
      return true;
    case Op::kOrB:
      r = v[0] || v[1];
      return true;
    case Op::kXorB:
      r = v[0] != v[1];
      return true;
    case Op::kEqB:
      r = v[0] == v[1];
      return true;
    case Op::kNotB:
      r = !v[0];
      return true;
    default:
      return fold_comparison(op, float_of(v[0]), float_of(v[1]), r);
  }
}

/// Division by zero folds to 0, unlike at run time; INT_MIN / -1 wraps.
bool divide(Op op, std::uint32_t a, std::uint32_t b, std::uint32_t& r) {
  const std::int64_t i = static_cast<std::int32_t>(a), j = static_cast<std::int32_t>(b);
  r = 0;
  switch (op) {
    case Op::kIDiv:
      if (j != 0) r = static_cast<std::uint32_t>(i / j);
      return true;
    case Op::kUDiv:
      if (b != 0) r = a / b;
      return true;
    case Op::kUMod:
      if (b != 0) r = a % b;
      return true;
    case Op::kIRem:
      if (j != 0) r = static_cast<std::uint32_t>(i % j);
      return true;
    case Op::kIMod:
      if (j != 0) r = static_cast<std::uint32_t>((i % j + j) % j);
      return true;
    default:
      return false;
  }
}

std::uint32_t highest_bit(std::uint32_t v) {
  return v == 0 ? ~0u : static_cast<std::uint32_t>(31 - std::countl_zero(v));
}

bool bit_operation(Op op, const std::uint32_t* v, std::uint32_t& r) {
  const std::uint32_t a = v[0], b = v[1] & 31;
  const auto i = static_cast<std::int32_t>(a);
  switch (op) {
    case Op::kAnd:
      r = a & v[1];
      return true;
    case Op::kOr:
      r = a | v[1];
      return true;
    case Op::kXor:
      r = a ^ v[1];
      return true;
    case Op::kNot:
      r = ~a;
      return true;
    case Op::kShl:
      r = a << b;
      return true;
    case Op::kIShr:
      r = static_cast<std::uint32_t>(i >> b);
      return true;
    case Op::kUShr:
      r = a >> b;
      return true;
    case Op::kBitCount:
      r = static_cast<std::uint32_t>(std::popcount(a));
      return true;
    case Op::kBitReverse:
      r = 0;
      for (int bit = 0; bit < 32; ++bit) r |= (a >> bit & 1u) << (31 - bit);
      return true;
    case Op::kUFindMsb:
      r = highest_bit(a);
      return true;
    case Op::kIFindMsb:
      r = highest_bit(i < 0 ? ~a : a);
      return true;
    case Op::kFindLsb:
      r = a == 0 ? ~0u : static_cast<std::uint32_t>(std::countr_zero(a));
      return true;
    case Op::kBfeU:
      r = (a >> b) & (v[2] == 32 ? ~0u : (1u << (v[2] & 31)) - 1);
      return true;
    case Op::kBfeI: {
      const auto moved = static_cast<std::int32_t>(a << ((32 - v[2] - v[1]) & 31));
      r = v[2] == 0 ? 0 : static_cast<std::uint32_t>(moved >> ((32 - v[2]) & 31));
      return true;
    }
    default:
      return false;
  }
}

bool integer(Op op, const std::uint32_t* v, std::uint32_t& r) {
  const std::uint32_t a = v[0], b = v[1];
  const auto i = static_cast<std::int32_t>(a), j = static_cast<std::int32_t>(b);
  switch (op) {
    case Op::kINeg:
      r = 0u - a;
      return true;
    case Op::kIAbs:
      r = i < 0 ? 0u - a : a;
      return true;
    case Op::kISign:
      r = i > 0 ? 1u : i < 0 ? ~0u : 0u;
      return true;
    case Op::kIAdd:
      r = a + b;
      return true;
    case Op::kISub:
      r = a - b;
      return true;
    case Op::kIMul:
      r = a * b;
      return true;
    case Op::kIMulHigh:
      r = static_cast<std::uint32_t>((static_cast<std::int64_t>(i) * j) >> 32);
      return true;
    case Op::kUMulHigh:
      r = static_cast<std::uint32_t>((static_cast<std::uint64_t>(a) * b) >> 32);
      return true;
    case Op::kIMin:
      r = i < j ? a : b;
      return true;
    case Op::kIMax:
      r = i > j ? a : b;
      return true;
    case Op::kUMin:
      r = a < b ? a : b;
      return true;
    case Op::kUMax:
      r = a > b ? a : b;
      return true;
    case Op::kUAddCarry:
      r = a + b < a ? 1u : 0u;
      return true;
    case Op::kUSubBorrow:
      r = a < b ? 1u : 0u;
      return true;
    default:
      return divide(op, a, b, r) || bit_operation(op, v, r);
  }
}

bool move_or_convert(Op op, const std::uint32_t* v, std::uint32_t& r) {
  const float x = float_of(v[0]);
  switch (op) {
    case Op::kMov:
      r = v[0];
      return true;
    case Op::kSelect:
    case Op::kSelectB:
      r = v[0] ? v[1] : v[2];
      return true;
    case Op::kB2F:
      r = v[0] ? 0x3f800000u : 0u;
      return true;
    case Op::kB2I:
      r = v[0] ? 1u : 0u;
      return true;
    case Op::kI2F:
      r = bits_of(static_cast<float>(static_cast<std::int32_t>(v[0])));
      return true;
    case Op::kU2F:
      r = bits_of(static_cast<float>(v[0]));
      return true;
    case Op::kF2I:
      r = static_cast<std::uint32_t>(base::truncate_to_int(x));
      return true;
    case Op::kF2U:  // a C cast on x86-64: the low half of the 64-bit conversion
      r = x > -9.2e18f && x < 9.2e18f ? static_cast<std::uint32_t>(static_cast<std::int64_t>(x)) : 0u;
      return true;
    case Op::kF2Half:
      r = base::float_to_half_nearest(x);
      return true;
    case Op::kHalf2F:
      r = bits_of(base::half_to_float(static_cast<std::uint16_t>(v[0])));
      return true;
    default:
      return false;
  }
}

}  // namespace

bool evaluate(Op op, const std::uint32_t operand[3], std::uint32_t& result) {
  float number = 0.0f;
  bool truth = false;
  if (unary_float(op, float_of(operand[0]), number) ||
      binary_float(op, float_of(operand[0]), float_of(operand[1]), number)) {
    result = bits_of(number);
    return true;
  }
  if (compare(op, operand, truth)) {
    result = truth ? 1 : 0;
    return true;
  }
  if (op == Op::kFMulAdd) {
    const float product = float_of(operand[0]) * float_of(operand[1]);
    result = bits_of(product + float_of(operand[2]));
    return true;
  }
  return move_or_convert(op, operand, result) || integer(op, operand, result);
}

}  // namespace vitrine::spirv::rewriting

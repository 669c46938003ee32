// The scalar model of the ALU ops (tests/spirv/alu/model.h): integers in 64-bit arithmetic, floats one operation at a
// time.
#include "tests/spirv/alu/model.h"

#include <bit>
#include <cmath>

#include "base/numeric.h"

namespace vitrine::spirv::alu_model {
namespace {

using base::bits_of;
using base::float_of;
using ir::Op;

constexpr std::uint32_t kNan = 0x7fc00000;
const float kInfinity = HUGE_VALF;

bool flushing() {
  volatile float tiny = float_of(1);
  return tiny == 0.0f;
}

/// A denormal as FTZ / DAZ sees it.
float flushed(float v) { return flushing() && (bits_of(v) & 0x7f800000) == 0 ? float_of(bits_of(v) & 0x80000000) : v; }

/// std::fma may be integer code that knows nothing of FTZ / DAZ.
float fma_model(float a, float b, float c) { return flushed(std::fma(flushed(a), flushed(b), flushed(c))); }

float exp2_model(float x) {  // 6.1
  x = 128.0f < x ? 128.0f : x;
  x = -126.99999f > x ? -126.99999f : x;
  const float n = std::floor(x), f = x - n, x2 = f * f;
  const float even = fma_model(x2, fma_model(x2, 0.00898934009049466391101f, 0.240153617044375388211f), 1.0f);
  const float odd =
      fma_model(x2, fma_model(x2, 0.00187757667519147912699f, 0.0558263180532956664775f), 0.693153073200168932794f);
  const float p = fma_model(odd, f, even);
  const auto integer = static_cast<std::uint32_t>(base::truncate_to_int(n));
  return float_of((integer + 127) << 23) * p;
}

float log2_model(float x) {  // 6.2
  const std::uint32_t bits = bits_of(x);
  const float e = static_cast<float>(static_cast<int>((bits & 0x7f800000) >> 23) - 127);
  const float m = float_of((bits & 0x007fffff) | 0x3f800000);
  const float y = (m - 1.0f) / (m + 1.0f), z = y * y, z2 = z * z;
  const float even =
      fma_model(z2, fma_model(z2, 0.406718052498846252698f, 0.577440339438736392009f), 2.88539009343309178325f);
  const float odd = fma_model(z2, 0.403343858251329912514f, 0.961791550404184197881f);
  float r = fma_model(y, fma_model(odd, z, even), e);
  if (!(x < kInfinity)) r = kInfinity;
  if (!(x < 0.0f) && !(x > 0.0f)) r = -kInfinity;
  if (!(x >= 0.0f)) r = float_of(kNan);
  return r;
}

float pow_model(float x, float y) {  // 6.4
  if (!(x < 0.0f) && !(x > 0.0f)) return 0.0f;
  return exp2_model(log2_model(x) * y);
}

float sine_model(float x, bool cosine) {  // 6.5
  const float ax = float_of(bits_of(x) & 0x7fffffff);
  if (!(ax < kInfinity)) return float_of(kNan);
  const std::uint32_t j = static_cast<std::uint32_t>(base::truncate_to_int(ax * 1.27323954473516f)) + 1;
  const std::uint32_t e = j & ~1u;
  const float y = static_cast<float>(static_cast<std::int32_t>(e));
  float r = fma_model(y, -0.78515625f, ax);
  r = fma_model(y, -2.4187564849853515625e-4f, r);
  r = fma_model(y, -3.77489497744594108e-8f, r);
  const float z = r * r;
  float c = fma_model(z, 2.443315711809948e-5f, -1.388731625493765e-3f);
  c = fma_model(c, z, 4.166664568298827e-2f);
  c = c * z;
  c = c * z;
  c = c - z * 0.5f;
  c = c + 1.0f;
  float s = fma_model(z, -1.9515295891e-4f, 8.3321608736e-3f);
  s = fma_model(s, z, -1.6666654611e-1f);
  s = s * z;
  s = fma_model(s, r, r);
  const std::uint32_t quadrant = cosine ? e - 2 : e;
  const std::uint32_t sign = cosine ? (4 & ~quadrant) << 29 : (bits_of(x) ^ (j << 29)) & 0x80000000;
  float v = float_of(bits_of((quadrant & 2) == 0 ? s : c) ^ sign);
  v = v < 1.0f ? v : 1.0f;
  return v > -1.0f ? v : -1.0f;
}

float unary_float(Op op, float a) {
  switch (op) {
    case Op::kFNeg:
      return float_of(bits_of(a) ^ 0x80000000);
    case Op::kFAbs:
      return float_of(bits_of(a) & 0x7fffffff);
    case Op::kFRcp:
      return 1.0f / a;
    case Op::kFSqrt:
      return a < 0.0f ? float_of(0xFFC00000) : std::sqrt(a);
    case Op::kFRsq:
      return 1.0f / (a < 0.0f ? float_of(0xFFC00000) : std::sqrt(a));
    case Op::kFExp2:
      return exp2_model(a);
    case Op::kFLog2:
      return log2_model(a);
    case Op::kFSin:
      return sine_model(a, false);
    case Op::kFCos:
      return sine_model(a, true);
    case Op::kFSign:
      return a > 0.0f ? 1.0f : a < 0.0f ? -1.0f : 0.0f;
    case Op::kQuantizeF16: {
      const float half = base::half_to_float(base::float_to_half_nearest(a));
      return std::fabs(half) < 0x1p-14f ? float_of(bits_of(half) & 0x80000000) : half;
    }
    default:
      break;
  }
  // Under DAZ a denormal is a zero to ROUNDPS, not to a libm that looks at bits.
  const float input = flushed(a);
  switch (op) {
    case Op::kFFloor:
      return std::floor(input);
    case Op::kFCeil:
      return std::ceil(input);
    case Op::kFTrunc:
      return std::trunc(input);
    case Op::kFRoundEven:
      return std::nearbyint(input);
    default:
      return a - std::floor(input);  // kFFract
  }
}

float float_result(Op op, float a, float b, float c) {
  const bool b_is_nan = b != b;  // MINPS gives a denormal operand as 0 under DAZ
  switch (op) {
    case Op::kFAdd:
      return a + b;
    case Op::kFSub:
      return a - b;
    case Op::kFMul:
      return a * b;
    case Op::kFDiv:
      return a / b;
    case Op::kFPow:
      return pow_model(a, b);
    case Op::kFMin:
      return b_is_nan ? a : flushed(base::min_second(a, b));
    case Op::kFMax:
      return b_is_nan ? a : flushed(base::max_second(a, b));
    case Op::kFMinPlain:
      return flushed(base::min_second(a, b));
    case Op::kFMaxPlain:
      return flushed(base::max_second(a, b));
    case Op::kFFused:
      return std::fma(a, b, c);
    case Op::kFMulAdd:
      return a * b + c;
    case Op::kFMulSub:
      return a * b - c;
    case Op::kFNMulAdd:
      return c - a * b;
    default:
      return unary_float(op, a);
  }
}

bool comparison(Op op, std::uint32_t a, std::uint32_t b) {
  const float x = float_of(a), y = float_of(b);
  const auto i = static_cast<std::int32_t>(a), j = static_cast<std::int32_t>(b);
  switch (op) {
    case Op::kFLt:
      return x < y;
    case Op::kFGe:
      return x >= y;
    case Op::kFEq:
      return x == y;
    case Op::kFNeu:
      return x != y;
    case Op::kIEq:
      return a == b;
    case Op::kINe:
      return a != b;
    case Op::kILt:
      return i < j;
    case Op::kIGe:
      return i >= j;
    case Op::kULt:
      return a < b;
    case Op::kUGe:
      return a >= b;
    case Op::kMovB:
      return a != 0;
    case Op::kAndB:
      return a && b;
    case Op::kOrB:
      return a || b;
    case Op::kXorB:
      return a != b;
    case Op::kEqB:
      return a == b;
    default:
      return !a;  // kNotB
  }
}

std::uint32_t find_msb(std::uint32_t v) { return v == 0 ? ~0u : static_cast<std::uint32_t>(31 - std::countl_zero(v)); }

std::uint32_t reverse(std::uint32_t v) {
  std::uint32_t result = 0;
  for (int i = 0; i < 32; ++i) result |= (v >> i & 1) << (31 - i);
  return result;
}

std::uint32_t divide(Op op, std::uint32_t a, std::uint32_t b) {  // 7.2, 7.3
  if (b == 0) return op == Op::kIDiv ? 0 : ~0u;
  const std::int64_t i = static_cast<std::int32_t>(a), j = static_cast<std::int32_t>(b);
  switch (op) {
    case Op::kIDiv:
      return static_cast<std::uint32_t>(i / j);
    case Op::kUDiv:
      return a / b;
    case Op::kIRem:
      return static_cast<std::uint32_t>(i % j);
    case Op::kUMod:
      return a % b;
    default:
      return static_cast<std::uint32_t>((i % j + j) % j);  // kIMod
  }
}

std::uint32_t bit_field(Op op, std::uint32_t a, std::uint32_t b, std::uint32_t c) {  // 7.4
  if (op == Op::kBfeU) return (a >> (b & 31)) & (c == 32 ? ~0u : (1u << (c & 31)) - 1);
  if (c == 0) return 0;
  const auto moved = static_cast<std::int32_t>(a << ((32 - c - b) & 31));
  return static_cast<std::uint32_t>(moved >> ((32 - c) & 31));
}

std::uint32_t integer_result(Op op, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const auto i = static_cast<std::int32_t>(a), j = static_cast<std::int32_t>(b);
  const std::uint64_t wide_a = a, wide_b = b;
  switch (op) {
    case Op::kINeg:
      return 0u - a;
    case Op::kIAbs:
      return i < 0 ? 0u - a : a;
    case Op::kISign:
      return i > 0 ? 1u : i < 0 ? ~0u : 0u;
    case Op::kIAdd:
      return a + b;
    case Op::kISub:
      return a - b;
    case Op::kIMul:
      return a * b;
    case Op::kIMulHigh:
      return static_cast<std::uint32_t>((static_cast<std::int64_t>(i) * j) >> 32);
    case Op::kUMulHigh:
      return static_cast<std::uint32_t>((wide_a * wide_b) >> 32);
    case Op::kIMin:
      return i < j ? a : b;
    case Op::kIMax:
      return i > j ? a : b;
    case Op::kUMin:
      return a < b ? a : b;
    case Op::kUMax:
      return a > b ? a : b;
    case Op::kUAddCarry:
      return wide_a + wide_b > 0xFFFFFFFFu;
    case Op::kUSubBorrow:
      return a < b;
    case Op::kAnd:
      return a & b;
    case Op::kOr:
      return a | b;
    case Op::kXor:
      return a ^ b;
    case Op::kNot:
      return ~a;
    case Op::kShl:
      return a << (b & 31);
    case Op::kIShr:
      return static_cast<std::uint32_t>(i >> (b & 31));
    case Op::kUShr:
      return a >> (b & 31);
    case Op::kBitCount:
      return static_cast<std::uint32_t>(std::popcount(a));
    case Op::kBitReverse:
      return reverse(a);
    case Op::kUFindMsb:
      return find_msb(a);
    case Op::kIFindMsb:
      return find_msb(i < 0 ? ~a : a);
    case Op::kFindLsb:
      return a == 0 ? ~0u : static_cast<std::uint32_t>(std::countr_zero(a));
    case Op::kF2I:
      return static_cast<std::uint32_t>(base::truncate_to_int(float_of(a)));
    case Op::kF2U:
      return base::truncate_to_uint(float_of(a));
    case Op::kF2Half:
      return base::float_to_half_nearest(float_of(a));
    case Op::kB2I:
      return a ? 1u : 0u;
    case Op::kBfeU:
    case Op::kBfeI:
      return bit_field(op, a, b, c);
    case Op::kRotR:
      return std::rotr(a, static_cast<int>(b & 31));
    case Op::kRotRXor:
      return std::rotr(a ^ b, static_cast<int>(c & 31));
    case Op::kXorRotR:
      return a ^ std::rotr(b, static_cast<int>(c & 31));
    case Op::kXorShr:
      return a ^ b >> (c & 31);
    case Op::kXorShl:
      return a ^ b << (c & 31);
    case Op::kIAddShl:
      return a + (b << (c & 31));
    case Op::kIMulAdd:
      return a * b + c;
    case Op::kIAdd3:
      return a + b + c;
    case Op::kXor3:
      return a ^ b ^ c;
    case Op::kBitSelect:
      return (a & b) | (~a & c);
    case Op::kMajority:
      return (a & b) | (a & c) | (b & c);
    default:
      return divide(op, a, b);
  }
}

}  // namespace

std::uint32_t evaluate(Op op, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  switch (op) {
    case Op::kMov:
      return a;
    case Op::kSelect:
    case Op::kSelectB:
      return a ? b : c;
    case Op::kB2F:
      return a ? 0x3f800000u : 0u;
    case Op::kI2F:
      return bits_of(static_cast<float>(static_cast<std::int32_t>(a)));
    case Op::kU2F:
      return bits_of(static_cast<float>(a));
    case Op::kHalf2F:
      return bits_of(base::half_to_float(static_cast<std::uint16_t>(a)));
    default:
      break;
  }
  switch (ir::alu_info(op).result) {
    case 'B':
      return comparison(op, a, b) ? 1 : 0;
    case 'F':
      return bits_of(float_result(op, float_of(a), float_of(b), float_of(c)));
    default:
      return integer_result(op, a, b, c);
  }
}

bool same_result(Op op, std::uint32_t want, std::uint32_t got) {
  if (want == got) return true;
  return ir::alu_info(op).result == 'F' && std::isnan(float_of(want)) && std::isnan(float_of(got));
}

}  // namespace vitrine::spirv::alu_model

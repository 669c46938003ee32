// GLSL.std.450 without polynomials, in the reference's order of operations (lavapipe-shader-math.md 5.1 to 5.3, 6.3).
#include "spirv/front/glsl450.h"

#include <cmath>

#include <spirv/unified1/GLSL.std.450.h>

#include "spirv/front/debugging.h"
#include "spirv/front/functions.h"

namespace vitrine::spirv::front {
namespace glsl {
namespace {

Expr saturate(Expr x) { return apply(ir::Op::kFSat, {x}); }

/// a - b * c as the front end of the reference writes it: (-b * c) + a.
Expr minus_product(Expr a, Expr b, Expr c) { return multiply_add(-b, c, a); }

Expr length_of(Expr v) { return sqrt(dot(v, v)); }

/// Writes the second result of modf / frexp: through the pointer operand, or as the struct's second member.
void two_results(Translator& t, const Inst& inst, bool has_pointer, Expr first, Expr second) {
  if (!has_pointer) return set_numbers(t, inst, std::array{first, second});
  const Pointer pointer = pointer_of(t, inst.operand(3));
  Value value{pointer.type, {second.id}};
  if (second.high != ir::kNoValue) value.leaves.push_back(second.high);
  store(t, pointer, value);
  result(t, inst, first);
}

/// SPV_KHR_float_controls2: NaN, infinities and the sign of zero count for numbers like `x`. (This device alone.)
bool specials_count(const Expr& x) { return (x.t->function.strict_specials & x.width) != 0; }

/// Where a choice of the lesser or the greater gives `chosen`: -0 is less than +0 where the sign of zero counts.
Expr order_zeros(Expr chosen, Expr a, Expr b, ir::Op op) {
  if (!specials_count(a)) return chosen;
  return select(apply(ir::Op::kFEq, {a, b}), op == ir::Op::kFMin ? a | b : a & b, chosen);
}

Expr clamp(Translator& t, const Inst& inst, ir::Op lower, ir::Op upper) {
  return apply(lower, {apply(upper, {arg(t, inst, 0), arg(t, inst, 1)}), arg(t, inst, 2)});
}

}  // namespace

Expr arg(Translator& t, const Inst& inst, std::uint32_t i) { return number_of(t, inst.operand(i + 2)); }

void result(Translator& t, const Inst& inst, Expr value) { set_number(t, inst, value); }

Expr natural_exp(Expr x) { return apply(ir::Op::kFExp2, {x * 1.4426950408889634f}); }

Expr natural_log(Expr x) { return apply(ir::Op::kFLog2, {x}) * static_cast<float>(1.0 / 1.4426950408889634); }

void unary(Translator& t, const Inst& inst, ir::Op op) { result(t, inst, apply(op, {arg(t, inst, 0)})); }

/// abs(abs(x) >> n) is abs(x) >> n to the reference, even where abs(x) is the least integer. Rules see this in integers
/// of 32 bits only.
void int_abs(Translator& t, const Inst& inst, ir::Op op) {
  const Expr x = arg(t, inst, 0);
  const auto def = [&](std::uint32_t id) { return t.module.constant(id) != nullptr ? nullptr : &t.module.def(id); };
  if (const Inst* shift = def(inst.operand(2)); shift != nullptr && shift->op == spv::Op::OpShiftRightArithmetic) {
    const Inst* inner = def(shift->operand(0));
    const bool absolute = inner != nullptr && inner->op == spv::Op::OpExtInst && inner->operand(0) == inst.operand(0) &&
                          inner->operand(1) == inst.operand(1);
    if (absolute && x.width != 32) return result(t, inst, x);
  }
  result(t, inst, apply(op, {x}));
}

void find_bit(Translator& t, const Inst& inst, ir::Op op) {
  const Expr found = apply(op, {arg(t, inst, 0)});
  result(t, inst, convert_signed(found, static_cast<std::uint8_t>(number_type(t, inst.result_type).width)));
}

/// Both words of the result are the argument's components.
void pack_double(Translator& t, const Inst& inst, ir::Op) {
  const Expr words = arg(t, inst, 0);
  if (words.size() != 2) fail(inst, "operand is not a vector of two");
  Expr number = words[0];
  number.high = words[1].id;
  number.width = 64;
  result(t, inst, number);
}

void unpack_double(Translator& t, const Inst& inst, ir::Op) {
  const Expr number = arg(t, inst, 0);
  if (number.width != 64) fail(inst, "operand is not a double");
  result(t, inst, vector_of(std::array{Expr{&t, number.id}, Expr{&t, number.high}}));
}

void binary(Translator& t, const Inst& inst, ir::Op op) {
  result(t, inst, apply(op, {arg(t, inst, 0), arg(t, inst, 1)}));
}

void ternary(Translator& t, const Inst& inst, ir::Op op) {
  result(t, inst, apply(op, {arg(t, inst, 0), arg(t, inst, 1), arg(t, inst, 2)}));
}

void least(Translator& t, const Inst& inst, ir::Op op) {
  const Expr a = arg(t, inst, 0), b = arg(t, inst, 1);
  result(t, inst, order_zeros(apply(op, {a, b}), a, b, op));
}

void least_exact(Translator& t, const Inst& inst, ir::Op op) {
  const ExactScope exact(t);
  least(t, inst, op);
}

/// What is made of a NaN is one, where that counts.
void power(Translator& t, const Inst& inst, ir::Op op) {
  const Expr x = arg(t, inst, 0), y = arg(t, inst, 1);
  Expr power = apply(op, {x, y});
  if (specials_count(x))
    for (const Expr& operand : {y, x}) power = select(apply(ir::Op::kFNeu, {operand, operand}), operand, power);
  result(t, inst, power);
}

void radians(Translator& t, const Inst& inst, ir::Op) {
  result(t, inst, arg(t, inst, 0) * static_cast<float>(3.14159265358979323846 / 180.0));
}

void degrees(Translator& t, const Inst& inst, ir::Op) {
  result(t, inst, arg(t, inst, 0) * static_cast<float>(180.0 / 3.14159265358979323846));
}

void tan(Translator& t, const Inst& inst, ir::Op) {
  const Expr x = arg(t, inst, 0);
  const Expr sine = apply(ir::Op::kFSin, {x});
  result(t, inst, sine / apply(ir::Op::kFCos, {x}));
}

void exp(Translator& t, const Inst& inst, ir::Op) { result(t, inst, natural_exp(arg(t, inst, 0))); }

void log(Translator& t, const Inst& inst, ir::Op) { result(t, inst, natural_log(arg(t, inst, 0))); }

void clamp_float(Translator& t, const Inst& inst, ir::Op) {
  result(t, inst, clamp(t, inst, ir::Op::kFMin, ir::Op::kFMax));
}

void clamp_exact(Translator& t, const Inst& inst, ir::Op) {
  const ExactScope exact(t);
  clamp_float(t, inst, ir::Op::kMov);
}

void clamp_uint(Translator& t, const Inst& inst, ir::Op) {
  result(t, inst, clamp(t, inst, ir::Op::kUMin, ir::Op::kUMax));
}

void clamp_int(Translator& t, const Inst& inst, ir::Op) {
  result(t, inst, clamp(t, inst, ir::Op::kIMin, ir::Op::kIMax));
}

void step(Translator& t, const Inst& inst, ir::Op) {
  const Expr edge = arg(t, inst, 0), x = arg(t, inst, 1);
  Expr below{&t, ir::kNoValue};
  {
    const ExactScope exact(t);
    below = apply(ir::Op::kSLt, {x, edge});
  }
  result(t, inst, imm(t, 1.0f) - below);
}

void smooth_step(Translator& t, const Inst& inst, ir::Op) {
  const Expr edge0 = arg(t, inst, 0), edge1 = arg(t, inst, 1), x = arg(t, inst, 2);
  const Expr offset = x - edge0;
  const Expr at = saturate(offset / (edge1 - edge0));
  result(t, inst, at * (at * minus_product(imm(t, 3.0f), imm(t, 2.0f), at)));
}

/// Where the parts of a floating-point number are.
struct FloatShape {
  std::uint32_t mantissa;  ///< bits of it in the word with the exponent
  std::uint32_t infinity;  ///< that word of infinity
  std::int32_t bias;
};

FloatShape shape_of(const Expr& x) {
  if (x.width == 64) return {20, 0x7ff00000, 1023};
  return x.width == 16 ? FloatShape{10, 0x7c00, 15} : FloatShape{23, 0x7f800000, 127};
}

/// The word with sign and exponent, and a number with that word replaced.
Expr top_word(const Expr& x) { return {x.t, x.width == 64 ? x.high : x.id}; }
Expr with_top(Expr x, const Expr& word) {
  (x.width == 64 ? x.high : x.id) = word.id;
  return x;
}

Expr int_constant(Translator& t, std::int32_t value) { return imm_u32(t, static_cast<std::uint32_t>(value)); }

void modf(Translator& t, const Inst& inst, ir::Op) {
  const Expr x = arg(t, inst, 0);
  const FloatShape shape = shape_of(x);
  const Expr direction = sign(x), size = abs(x);
  const std::uint64_t infinity = std::uint64_t{shape.infinity} << (x.width == 64 ? 32 : 0);
  const std::uint64_t sign_bit = std::uint64_t{1} << (x.width - 1);
  const Expr infinite = apply(ir::Op::kIEq, {size, constant_bits(t, infinity, x.width)});
  const Expr signed_zero = x & constant_bits(t, sign_bit, x.width);
  Expr fraction = select(infinite, signed_zero, direction * apply(ir::Op::kFFract, {size}));
  Expr whole_part = direction * apply(ir::Op::kFFloor, {size});
  // GLSL.std.450, Modf: "Both the fractional part and the whole number part have the same sign as the input."
  if (specials_count(x)) {
    fraction = fraction | signed_zero;
    whole_part = whole_part | signed_zero;
  }
  two_results(t, inst, inst.has(3), fraction, whole_part);
}

void frexp(Translator& t, const Inst& inst, ir::Op) {
  const Expr x = arg(t, inst, 0);
  const FloatShape shape = shape_of(x);
  const Expr size = abs(x);
  // 0 < |x| < Inf, by bits: denormals keep their fraction (5.1).
  const Expr not_zero = apply(ir::Op::kFNeu, {size, imm(t, 0.0f)});
  const Expr finite = size < imm(t, INFINITY);
  const Expr regular = apply(ir::Op::kAndB, {not_zero, finite});
  const std::uint32_t kept = (x.width == 16 ? 0x8000u : 0x80000000u) | ((1u << shape.mantissa) - 1);
  const Expr top = top_word(x);
  const Expr half = (top & kept) | (static_cast<std::uint32_t>(shape.bias - 1) << shape.mantissa);
  const Expr significand = with_top(x, select(regular, half, top));
  const Expr bias = select(not_zero, int_constant(t, 1 - shape.bias), imm_u32(t, 0));
  const Expr exponent = apply(ir::Op::kIAdd, {top_word(size) >> shape.mantissa, bias});
  two_results(t, inst, inst.has(3), significand, exponent);
}

void ldexp(Translator& t, const Inst& inst, ir::Op op) {
  Expr exponent = arg(t, inst, 1);
  // Any exponent beyond those of 32 bits gives what the greatest and the least of these do: infinities and zeros.
  if (exponent.width == 64)
    for (const auto& [bound, limit] : {std::pair{ir::Op::kIMax, INT32_MIN}, std::pair{ir::Op::kIMin, INT32_MAX}})
      exponent = apply(bound, {exponent, constant_bits(t, static_cast<std::uint64_t>(std::int64_t{limit}), 64)});
  result(t, inst, apply(op, {arg(t, inst, 0), convert_signed(exponent, 32)}));
}

void length(Translator& t, const Inst& inst, ir::Op) { result(t, inst, length_of(arg(t, inst, 0))); }

void distance(Translator& t, const Inst& inst, ir::Op) {
  result(t, inst, length_of(arg(t, inst, 0) - arg(t, inst, 1)));
}

void normalize(Translator& t, const Inst& inst, ir::Op) {
  const Expr v = arg(t, inst, 0);
  result(t, inst, v / length_of(v));
}

void cross(Translator& t, const Inst& inst, ir::Op) {
  const Expr a = arg(t, inst, 0), b = arg(t, inst, 1);
  if (a.size() != 3 || b.size() != 3) fail(inst, "operands are not vectors of three");
  const std::array<std::uint8_t, 4> yzx{1, 2, 0, 0}, zxy{2, 0, 1, 0};
  const Expr negated = -(a.swizzled(zxy) * b.swizzled(yzx));
  result(t, inst, multiply_add(a.swizzled(yzx), b.swizzled(zxy), negated));
}

void face_forward(Translator& t, const Inst& inst, ir::Op) {
  const Expr n = arg(t, inst, 0);
  const Expr facing = dot(arg(t, inst, 2), arg(t, inst, 1)) < imm(t, 0.0f);
  result(t, inst, select(facing, n, -n));
}

void reflect(Translator& t, const Inst& inst, ir::Op) {
  const Expr i = arg(t, inst, 0), n = arg(t, inst, 1);
  const Expr twice = dot(i, n) * 2.0f;
  result(t, inst, minus_product(i, n, twice));
}

void refract(Translator& t, const Inst& inst, ir::Op) {
  const Expr i = arg(t, inst, 0), n = arg(t, inst, 1), eta = arg(t, inst, 2);
  const Expr one = imm(t, 1.0f), d = dot(n, i);
  const Expr inner = minus_product(one, d, d);
  const Expr k = minus_product(one, eta, eta * inner);
  const Expr scale = multiply_add(eta, d, sqrt(k));
  const Expr bent = minus_product(eta * i, scale, n);
  result(t, inst, select(k < imm(t, 0.0f), imm(t, 0.0f), bent));
}

}  // namespace glsl

namespace {

using GlslFunction = void (*)(Translator&, const Inst&, ir::Op);

void translate_glsl(Translator& t, const Inst& inst) {
  switch (inst.operand(1)) {
#define VITRINE_GLSL(name, function, op) \
  case GLSLstd450##name:                 \
    return glsl::function(t, inst, ir::Op::k##op);
#include "spirv/front/glsl450.def"
#undef VITRINE_GLSL
    default:
      fail(inst, "GLSL.std.450 instruction " + std::to_string(inst.operand(1)) + " is not supported");
  }
}

}  // namespace

void extended_instruction(Translator& t, const Inst& inst, ir::Op) {
  const auto set = t.module.ext_imports.find(inst.operand(0));
  switch (set == t.module.ext_imports.end() ? kExtUnknown : set->second) {
    case kExtGlsl450:
      return translate_glsl(t, inst);
    case kExtDebugPrintf:
      return debug_printf(t, inst);
    case kExtNonSemantic:
      return show_break(t, inst);
    case kExtDebugInfo:
      return show_debug_value(t, inst);
    default:
      fail(inst, "extended instruction set is not supported");
  }
}

}  // namespace vitrine::spirv::front

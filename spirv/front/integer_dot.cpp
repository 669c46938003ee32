// Integer dot products (SPIR-V 3.42.13; SPV_KHR_integer_dot_product): sums of products in the width of the result.
#include "spirv/front/expression.h"
#include "spirv/front/functions.h"

namespace vitrine::spirv::front {
namespace {

using spv::Op;

/// The components of an operand: a vector's, or the four bytes of a packed word.
std::vector<Expr> components_of(Translator& t, const Inst& inst, std::uint32_t operand, bool packed) {
  const Expr value = number_of(t, inst.operand(operand));
  std::vector<Expr> parts;
  if (packed) {
    if (value.width != 32 || value.size() != 1) fail(inst, "packed operand is not a 32-bit integer");
    for (std::uint32_t i = 0; i < 4; i++) parts.push_back(convert_unsigned(i == 0 ? value : value >> (8 * i), 8));
  } else {
    for (std::uint32_t i = 0; i < value.size(); i++) parts.push_back(value[i]);
  }
  return parts;
}

Expr extended(const Expr& value, std::uint8_t width, bool is_signed) {
  return is_signed ? convert_signed(value, width) : convert_unsigned(value, width);
}

/// a + b, or the limit of the type that it passes.
Expr saturated_sum(const Expr& a, const Expr& b, bool is_signed) {
  Translator& t = *a.t;
  const std::uint8_t width = a.width;
  const Expr sum = apply(ir::Op::kIAdd, {a, b});
  if (!is_signed)
    return select(apply(ir::Op::kULt, {sum, a}), constant_bits(t, ~std::uint64_t{0} >> (64 - width), width), sum);
  // Overflow: the operands have one sign, the sum the other.
  const Expr flipped = apply(ir::Op::kAnd, {apply(ir::Op::kXor, {a, sum}), apply(ir::Op::kXor, {b, sum})});
  const Expr zero = constant_bits(t, 0, width);
  const std::uint64_t least = std::uint64_t{1} << (width - 1);
  const Expr limit =
      select(apply(ir::Op::kILt, {a, zero}), constant_bits(t, least, width), constant_bits(t, least - 1, width));
  return select(apply(ir::Op::kILt, {flipped, zero}), limit, sum);
}

}  // namespace

void integer_dot(Translator& t, const Inst& inst, ir::Op) {
  const bool accumulates = inst.op == Op::OpSDotAccSat || inst.op == Op::OpUDotAccSat || inst.op == Op::OpSUDotAccSat;
  const bool unsigned_both = inst.op == Op::OpUDot || inst.op == Op::OpUDotAccSat;
  const bool signed_both = inst.op == Op::OpSDot || inst.op == Op::OpSDotAccSat;
  const bool packed = inst.has(accumulates ? 3 : 2);  // the only packed format: four bytes
  const auto width = static_cast<std::uint8_t>(number_type(t, inst.result_type).width);
  const std::vector<Expr> a = components_of(t, inst, 0, packed), b = components_of(t, inst, 1, packed);
  if (a.size() != b.size()) fail(inst, "operands differ in size");
  Expr sum{&t};
  for (std::size_t i = 0; i < a.size(); i++) {
    const Expr product =
        apply(ir::Op::kIMul, {extended(a[i], width, !unsigned_both), extended(b[i], width, signed_both)});
    sum = i == 0 ? product : apply(ir::Op::kIAdd, {sum, product});
  }
  if (accumulates) sum = saturated_sum(sum, number_of(t, inst.operand(2)), !unsigned_both);
  set_number(t, inst, sum);
}

}  // namespace vitrine::spirv::front

// Arithmetic, bit, conversion, comparison and derivative instructions (SPIR-V 3.42.11, .13 to .16).
#include "spirv/front/expression.h"
#include "spirv/front/functions.h"

namespace vitrine::spirv::front {
namespace {

Expr compare(Translator& t, const Inst& inst, ir::Op op, bool swapped) {
  const Expr a = number_of(t, inst.operand(swapped ? 1 : 0)), b = number_of(t, inst.operand(swapped ? 0 : 1));
  return apply(op, {a, b});
}

Expr negate(Expr value) { return apply(ir::Op::kNotB, {value}); }

/// op(a, a) with b: both ordered (AndB of FEq) or some unordered (OrB of FNeu).
Expr self_compare(Expr a, Expr b, ir::Op op, ir::Op join) {
  const Expr left = apply(op, {a, a});
  return apply(join, {left, apply(op, {b, b})});
}

bool float_from_int(spv::Op op) { return op == spv::Op::OpConvertSToF || op == spv::Op::OpConvertUToF; }
bool int_from_float(spv::Op op) { return op == spv::Op::OpConvertFToS || op == spv::Op::OpConvertFToU; }

/// A conversion of a conversion back to the type that it came from: signed integers of floats become truncation,
/// floats of integers nothing (lavapipe-shader-math.md 4.2). The rewrites know that for 32 bits.
std::optional<Expr> convert_back(Translator& t, const Inst& inst, std::uint8_t width) {
  const std::uint32_t operand = inst.operand(0);
  const ir::Function& f = t.function;
  if (t.module.constant(operand) != nullptr || f.signed_zero_inf_nan_preserve || f.denorm_flush_to_zero) return {};
  const Inst& inner = t.module.def(operand);
  const bool truncates = inst.op == spv::Op::OpConvertSToF && inner.op == spv::Op::OpConvertFToS;
  if (!truncates && !(int_from_float(inst.op) && float_from_int(inner.op))) return {};
  if (is_exact(t, inst) || is_exact(t, inner)) return {};
  const Expr source = number_of(t, inner.operand(0));
  if (source.width != width || (width == 32 && number_of(t, operand).width == 32)) return {};
  return truncates ? apply(ir::Op::kFTrunc, {source}) : source;
}

}  // namespace

void ignore(Translator&, const Inst&, ir::Op) {}

void alu(Translator& t, const Inst& inst, ir::Op op) {
  const std::uint32_t sources = ir::alu_info(op).sources;
  std::vector<std::vector<Expr>> operands;
  for (std::uint32_t i = 0; i < sources; i++) {
    operands.push_back(leaf_numbers(t, value_of(t, inst.operand(i))));
    if (operands[i].size() != operands[0].size()) fail(inst, "operands differ in size");
  }
  std::vector<Expr> results;
  for (std::size_t leaf = 0; leaf < operands[0].size(); leaf++) {
    std::vector<Expr> parts;
    for (const auto& operand : operands) parts.push_back(operand[leaf]);
    results.push_back(front::apply(op, parts));
  }
  set_numbers(t, inst, results);
}

/// Bits that a 32-bit operation counts or finds, as the result's type.
void bit_count(Translator& t, const Inst& inst, ir::Op op) {
  const Expr count = apply(op, {number_of(t, inst.operand(0))});
  set_number(t, inst, convert_unsigned(count, static_cast<std::uint8_t>(number_type(t, inst.result_type).width)));
}

void convert_number(Translator& t, const Inst& inst, ir::Op) {
  const Expr value = number_of(t, inst.operand(0));
  const auto width = static_cast<std::uint8_t>(number_type(t, inst.result_type).width);
  if (const std::optional<Expr> source = convert_back(t, inst, width)) return set_number(t, inst, *source);
  const auto converted = [&] {
    switch (inst.op) {
      case spv::Op::OpConvertFToU:
        return float_to_int(value, width, false);
      case spv::Op::OpConvertFToS:
        return float_to_int(value, width, true);
      case spv::Op::OpConvertSToF:
        return int_to_float(value, width, true);
      case spv::Op::OpConvertUToF:
        return int_to_float(value, width, false);
      case spv::Op::OpUConvert:
        return convert_unsigned(value, width);
      case spv::Op::OpSConvert:
        return convert_signed(value, width);
      default: {
        const DecorationRow* mode = t.module.decoration(inst.result, spv::Decoration::FPRoundingMode);
        if (mode != nullptr && mode->value == static_cast<std::uint32_t>(spv::FPRoundingMode::RTZ))
          return truncate_float(value, width);
        const bool nearest = mode != nullptr || t.module.rounds_to_nearest(width);
        return nearest && value.width == 64 && width == 16 ? nearest_half(value) : convert_float(value, width);
      }
    }
  };
  set_number(t, inst, converted());
}

void compare_exact(Translator& t, const Inst& inst, ir::Op op) {
  const ExactScope exact(t);
  set_number(t, inst, compare(t, inst, op, false));
}

void compare_swapped(Translator& t, const Inst& inst, ir::Op op) { set_number(t, inst, compare(t, inst, op, true)); }

void compare_swapped_exact(Translator& t, const Inst& inst, ir::Op op) {
  const ExactScope exact(t);
  set_number(t, inst, compare(t, inst, op, true));
}

void compare_negated(Translator& t, const Inst& inst, ir::Op op) {
  const ExactScope exact(t);
  set_number(t, inst, negate(compare(t, inst, op, false)));
}

void compare_swapped_negated(Translator& t, const Inst& inst, ir::Op op) {
  const ExactScope exact(t);
  set_number(t, inst, negate(compare(t, inst, op, true)));
}

void ordered_not_equal(Translator& t, const Inst& inst, ir::Op) {
  const ExactScope exact(t);
  const Expr a = number_of(t, inst.operand(0)), b = number_of(t, inst.operand(1));
  const Expr differ = apply(ir::Op::kFNeu, {a, b});
  set_number(t, inst, apply(ir::Op::kAndB, {differ, self_compare(a, b, ir::Op::kFEq, ir::Op::kAndB)}));
}

void unordered_equal(Translator& t, const Inst& inst, ir::Op) {
  const ExactScope exact(t);
  const Expr a = number_of(t, inst.operand(0)), b = number_of(t, inst.operand(1));
  const Expr equal = apply(ir::Op::kFEq, {a, b});
  set_number(t, inst, apply(ir::Op::kOrB, {equal, self_compare(a, b, ir::Op::kFNeu, ir::Op::kOrB)}));
}

void is_nan(Translator& t, const Inst& inst, ir::Op op) {
  const ExactScope exact(t);
  const Expr a = number_of(t, inst.operand(0));
  set_number(t, inst, apply(op, {a, a}));
}

void is_inf(Translator& t, const Inst& inst, ir::Op op) {
  const Expr magnitude = abs(number_of(t, inst.operand(0)));
  const std::uint64_t infinity = magnitude.width == 64   ? 0x7ff0000000000000u
                                 : magnitude.width == 16 ? 0x7c00u
                                                         : 0x7f800000u;
  set_number(t, inst, apply(op, {magnitude, constant_bits(t, infinity, magnitude.width)}));
}

void select(Translator& t, const Inst& inst, ir::Op) {
  const Expr condition = number_of(t, inst.operand(0));
  const Value a = value_of(t, inst.operand(1));  // a copy: the same literal is another value where it is named again
  const Value& b = value_of(t, inst.operand(2));
  if (a.leaves.size() != b.leaves.size()) fail(inst, "operands differ in size");
  const Type& number = number_type(t, inst.result_type);
  if (number.kind == Type::Kind::kFloat && number.width != 32)
    return set_number(t, inst, front::select(condition, number_of(t, inst.operand(1)), number_of(t, inst.operand(2))));
  std::vector<ir::ValueId> results;
  for (std::size_t i = 0; i < a.leaves.size(); i++) {
    const bool boolean = is_boolean(t, a.leaves[i]);
    results.push_back(emit(t, boolean ? ir::Op::kSelectB : ir::Op::kSelect, components(t, a.leaves[i]), boolean,
                           {condition.src(), whole(a.leaves[i]), whole(b.leaves[i])}));
  }
  set_value(t, inst, std::move(results));
}

/// `op`: that for two components; those for three and four follow it.
void reduce_boolean(Translator& t, const Inst& inst, ir::Op op) {
  const ir::ValueId vector = scalar_or_vector(t, inst.operand(0));
  const std::uint32_t count = components(t, vector);
  if (count == 1) return set_value(t, inst, vector);
  const std::uint32_t word = op == ir::Op::kBAllIEqual2 ? 1 : 0;
  const ir::ValueId neutral = literal(t, {&word, 1}, true);
  set_value(t, inst, emit(t, for_size(op, count), 1, true, {whole(vector), splat(neutral)}));
}

void extended_add(Translator& t, const Inst& inst, ir::Op carry) {
  const Expr a = number_of(t, inst.operand(0)), b = number_of(t, inst.operand(1));
  const Expr sum = apply(carry == ir::Op::kUAddCarry ? ir::Op::kIAdd : ir::Op::kISub, {a, b});
  set_numbers(t, inst, std::array{sum, apply(carry, {a, b})});
}

void extended_multiply(Translator& t, const Inst& inst, ir::Op high) {
  const Expr a = number_of(t, inst.operand(0)), b = number_of(t, inst.operand(1));
  const Expr low = apply(ir::Op::kIMul, {a, b});
  set_numbers(t, inst, std::array{low, apply(high, {a, b})});
}

/// 7.4. Vulkan has bit fields of 32-bit numbers only; offset and count may be of any width.
void bit_field_extract(Translator& t, const Inst& inst, ir::Op op) {
  const Expr base = number_of(t, inst.operand(0));
  const Expr offset = convert_unsigned(number_of(t, inst.operand(1)), 32);
  const Expr bits = convert_unsigned(number_of(t, inst.operand(2)), 32);
  set_number(t, inst, apply(op, {base, offset, bits}));
}

void bit_field_insert(Translator& t, const Inst& inst, ir::Op) {
  const Expr base = number_of(t, inst.operand(0)), value = number_of(t, inst.operand(1));
  const Expr offset = convert_unsigned(number_of(t, inst.operand(2)), 32);
  const Expr bits = convert_unsigned(number_of(t, inst.operand(3)), 32);
  set_number(t, inst, apply(ir::Op::kBitfieldInsert, {base, value, offset, bits}));
}

void derivative(Translator& t, const Inst& inst, ir::Op op) {
  t.function.interface.needs_helpers = true;
  alu(t, inst, op);
}

void derivative_width(Translator& t, const Inst& inst, ir::Op) {
  t.function.interface.needs_helpers = true;
  const Expr a = number_of(t, inst.operand(0));
  const Expr dx = abs(apply(ir::Op::kFDdx, {a}));
  const Expr dy = abs(apply(ir::Op::kFDdy, {a}));
  set_number(t, inst, dx + dy);
}

}  // namespace vitrine::spirv::front

// Arithmetic, bit, conversion, comparison and derivative instructions (SPIR-V 3.42.11, .13 to .16).
#include "spirv/front/functions.h"

namespace vitrine::spirv::front {
namespace {

bool boolean_result(ir::Op op) { return ir::alu_info(op).result == 'B'; }

/// Scalars next to vectors are repeated for every component.
ir::Src fitted(const Translator& t, ir::ValueId value) {
  return components(t, value) == 1 ? splat(value) : whole(value);
}

std::uint32_t result_components(const Translator& t, const Inst& inst) {
  return leaf_info(t, inst.result_type).components;
}

ir::ValueId compare(Translator& t, const Inst& inst, ir::Op op, bool swapped, bool exact) {
  const bool saved = std::exchange(t.exact, t.exact || exact);
  const ir::ValueId a = scalar_or_vector(t, inst.operand(swapped ? 1 : 0));
  const ir::ValueId b = scalar_or_vector(t, inst.operand(swapped ? 0 : 1));
  const ir::ValueId result = emit(t, op, result_components(t, inst), true, {whole(a), whole(b)});
  t.exact = saved;
  return result;
}

ir::ValueId negate(Translator& t, ir::ValueId value) {
  return emit(t, ir::Op::kNotB, components(t, value), true, {whole(value)});
}

/// op(a, a) with b: both ordered (AndB of FEq) or some unordered (OrB of FNeu).
ir::ValueId self_compare(Translator& t, ir::ValueId a, ir::ValueId b, ir::Op op, ir::Op join) {
  const std::uint32_t n = components(t, a);
  const ir::ValueId left = emit(t, op, n, true, {whole(a), whole(a)});
  const ir::ValueId right = emit(t, op, n, true, {whole(b), whole(b)});
  return emit(t, join, n, true, {whole(left), whole(right)});
}

}  // namespace

void ignore(Translator&, const Inst&, ir::Op) {}

void alu(Translator& t, const Inst& inst, ir::Op op) {
  const std::uint32_t sources = ir::alu_info(op).sources;
  const std::size_t leaves = value_of(t, inst.operand(0)).leaves.size();
  std::vector<ir::ValueId> results;
  for (std::size_t leaf = 0; leaf < leaves; leaf++) {
    std::vector<ir::Src> src;
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < sources; i++) {
      const Value& operand = value_of(t, inst.operand(i));
      if (operand.leaves.size() != leaves) fail(inst, "operands differ in size");
      src.push_back(whole(operand.leaves[leaf]));
      count = std::max(count, components(t, operand.leaves[leaf]));
    }
    results.push_back(emit(t, op, count, boolean_result(op), std::move(src)));
  }
  set_value(t, inst, std::move(results));
}

/// Operands after the first are scalars that apply to every component.
void alu_scalar_tail(Translator& t, const Inst& inst, ir::Op op) {
  std::vector<ir::Src> src{whole(scalar_or_vector(t, inst.operand(0)))};
  for (std::uint32_t i = 1; i < ir::alu_info(op).sources; i++)
    src.push_back(splat(scalar_or_vector(t, inst.operand(i))));
  set_value(t, inst, emit(t, op, result_components(t, inst), false, std::move(src)));
}

void compare_exact(Translator& t, const Inst& inst, ir::Op op) {
  set_value(t, inst, compare(t, inst, op, false, true));
}

void compare_swapped(Translator& t, const Inst& inst, ir::Op op) {
  set_value(t, inst, compare(t, inst, op, true, false));
}

void compare_swapped_exact(Translator& t, const Inst& inst, ir::Op op) {
  set_value(t, inst, compare(t, inst, op, true, true));
}

void compare_negated(Translator& t, const Inst& inst, ir::Op op) {
  set_value(t, inst, negate(t, compare(t, inst, op, false, op != ir::Op::kXorB)));
}

void compare_swapped_negated(Translator& t, const Inst& inst, ir::Op op) {
  set_value(t, inst, negate(t, compare(t, inst, op, true, true)));
}

void ordered_not_equal(Translator& t, const Inst& inst, ir::Op) {
  const bool saved = std::exchange(t.exact, true);
  const ir::ValueId a = scalar_or_vector(t, inst.operand(0)), b = scalar_or_vector(t, inst.operand(1));
  const ir::ValueId differ = emit(t, ir::Op::kFNeu, components(t, a), true, {whole(a), whole(b)});
  const ir::ValueId ordered = self_compare(t, a, b, ir::Op::kFEq, ir::Op::kAndB);
  set_value(t, inst, emit(t, ir::Op::kAndB, components(t, a), true, {whole(differ), whole(ordered)}));
  t.exact = saved;
}

void unordered_equal(Translator& t, const Inst& inst, ir::Op) {
  const bool saved = std::exchange(t.exact, true);
  const ir::ValueId a = scalar_or_vector(t, inst.operand(0)), b = scalar_or_vector(t, inst.operand(1));
  const ir::ValueId equal = emit(t, ir::Op::kFEq, components(t, a), true, {whole(a), whole(b)});
  const ir::ValueId unordered = self_compare(t, a, b, ir::Op::kFNeu, ir::Op::kOrB);
  set_value(t, inst, emit(t, ir::Op::kOrB, components(t, a), true, {whole(equal), whole(unordered)}));
  t.exact = saved;
}

void is_nan(Translator& t, const Inst& inst, ir::Op op) {
  const bool saved = std::exchange(t.exact, true);
  const ir::ValueId a = scalar_or_vector(t, inst.operand(0));
  set_value(t, inst, emit(t, op, components(t, a), true, {whole(a), whole(a)}));
  t.exact = saved;
}

void is_inf(Translator& t, const Inst& inst, ir::Op op) {
  const ir::ValueId a = scalar_or_vector(t, inst.operand(0));
  const ir::ValueId magnitude = emit(t, ir::Op::kFAbs, components(t, a), false, {whole(a)});
  set_value(t, inst, emit(t, op, components(t, a), true, {whole(magnitude), splat(constant_u32(t, 0x7f800000))}));
}

void select(Translator& t, const Inst& inst, ir::Op) {
  const ir::ValueId condition = scalar_or_vector(t, inst.operand(0));
  const Value &a = value_of(t, inst.operand(1)), &b = value_of(t, inst.operand(2));
  if (a.leaves.size() != b.leaves.size()) fail(inst, "operands differ in size");
  std::vector<ir::ValueId> results;
  for (std::size_t i = 0; i < a.leaves.size(); i++) {
    const bool boolean = is_boolean(t, a.leaves[i]);
    results.push_back(emit(t, boolean ? ir::Op::kSelectB : ir::Op::kSelect, components(t, a.leaves[i]), boolean,
                           {fitted(t, condition), whole(a.leaves[i]), whole(b.leaves[i])}));
  }
  set_value(t, inst, std::move(results));
}

void reduce_boolean(Translator& t, const Inst& inst, ir::Op op) {
  const ir::ValueId vector = scalar_or_vector(t, inst.operand(0));
  ir::ValueId result = extract(t, vector, 0);
  for (std::uint8_t i = 1; i < components(t, vector); i++)
    result = emit(t, op, 1, true, {whole(result), splat(vector, i)});
  set_value(t, inst, result);
}

void float_modulo(Translator& t, const Inst& inst, ir::Op round) {
  const ir::ValueId a = scalar_or_vector(t, inst.operand(0)), b = scalar_or_vector(t, inst.operand(1));
  const std::uint32_t n = components(t, a);
  const ir::ValueId quotient = emit(t, ir::Op::kFDiv, n, false, {whole(a), whole(b)});
  const ir::ValueId rounded = emit(t, round, n, false, {whole(quotient)});
  const ir::ValueId product = emit(t, ir::Op::kFMul, n, false, {whole(b), whole(rounded)});
  set_value(t, inst, emit(t, ir::Op::kFSub, n, false, {whole(a), whole(product)}));
}

void extended_add(Translator& t, const Inst& inst, ir::Op carry) {
  const ir::ValueId a = scalar_or_vector(t, inst.operand(0)), b = scalar_or_vector(t, inst.operand(1));
  const ir::Op low = carry == ir::Op::kUAddCarry ? ir::Op::kIAdd : ir::Op::kISub;
  const std::uint32_t n = components(t, a);
  const ir::ValueId sum = emit(t, low, n, false, {whole(a), whole(b)});
  set_value(t, inst, std::vector{sum, emit(t, carry, n, false, {whole(a), whole(b)})});
}

void extended_multiply(Translator& t, const Inst& inst, ir::Op high) {
  const ir::ValueId a = scalar_or_vector(t, inst.operand(0)), b = scalar_or_vector(t, inst.operand(1));
  const std::uint32_t n = components(t, a);
  const ir::ValueId low = emit(t, ir::Op::kIMul, n, false, {whole(a), whole(b)});
  set_value(t, inst, std::vector{low, emit(t, high, n, false, {whole(a), whole(b)})});
}

void bit_field_insert(Translator& t, const Inst& inst, ir::Op) {
  const ir::ValueId base = scalar_or_vector(t, inst.operand(0)), value = scalar_or_vector(t, inst.operand(1));
  const ir::ValueId offset = scalar_or_vector(t, inst.operand(2)), bits = scalar_or_vector(t, inst.operand(3));
  const std::uint32_t n = components(t, base);
  const ir::ValueId mask = emit(t, ir::Op::kBfiMask, 1, false, {whole(bits), whole(offset)});
  const ir::ValueId inverse = emit(t, ir::Op::kNot, 1, false, {whole(mask)});
  const ir::ValueId kept = emit(t, ir::Op::kAnd, n, false, {whole(base), splat(inverse)});
  const ir::ValueId shifted = emit(t, ir::Op::kShl, n, false, {whole(value), splat(offset)});
  const ir::ValueId added = emit(t, ir::Op::kAnd, n, false, {whole(shifted), splat(mask)});
  const ir::ValueId joined = emit(t, ir::Op::kOr, n, false, {whole(kept), whole(added)});
  const ir::ValueId all = emit(t, ir::Op::kULt, 1, true, {whole(constant_u32(t, 31)), whole(bits)});
  set_value(t, inst, emit(t, ir::Op::kSelect, n, false, {splat(all), whole(value), whole(joined)}));
}

void derivative(Translator& t, const Inst& inst, ir::Op op) {
  t.function.interface.needs_helpers = true;
  alu(t, inst, op);
}

void derivative_width(Translator& t, const Inst& inst, ir::Op) {
  t.function.interface.needs_helpers = true;
  const ir::ValueId a = scalar_or_vector(t, inst.operand(0));
  const std::uint32_t n = components(t, a);
  const ir::ValueId dx = emit(t, ir::Op::kFDdx, n, false, {whole(a)});
  const ir::ValueId abs_dx = emit(t, ir::Op::kFAbs, n, false, {whole(dx)});
  const ir::ValueId dy = emit(t, ir::Op::kFDdy, n, false, {whole(a)});
  const ir::ValueId abs_dy = emit(t, ir::Op::kFAbs, n, false, {whole(dy)});
  set_value(t, inst, emit(t, ir::Op::kFAdd, n, false, {whole(abs_dx), whole(abs_dy)}));
}

}  // namespace vitrine::spirv::front

// Constants and specialization constants (SPIR-V 2.12), folded to words. OpSpecConstantOp follows the constant
// folding of the reference: division and remainder by zero give 0, shifts are masked (lavapipe-shader-math.md 7).
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "base/numeric.h"
#include "spirv/front/module.h"
#include "spirv/newer_numbers.h"

namespace vitrine::spirv::front {
namespace {

using spv::Op;
using Words = std::vector<std::uint32_t>;

/// Of all constants of a module: more than large tables take.
constexpr std::size_t kMaxConstantWords = std::size_t{1} << 24;

/// Words of an OpSpecConstant* given at pipeline creation; null: keep the default.
const SpecializationConstant* override_of(const Module& module, const Inst& inst, const CompileOptions& options) {
  const DecorationRow* spec_id = module.decoration(inst.result, spv::Decoration::SpecId);
  if (spec_id == nullptr) return nullptr;
  for (const SpecializationConstant& row : options.specialization)
    if (row.id == spec_id->value) return &row;
  return nullptr;
}

/// Width of the numbers that a type consists of: it is a scalar or vector.
std::uint32_t width_of(const Module& module, std::uint32_t type_id) {
  const Type& type = module.type(type_id);
  return type.kind == Type::Kind::kVector ? module.type(type.element).width : type.width;
}

std::uint64_t cut(std::uint64_t bits, std::uint32_t width) {
  return width >= 64 ? bits : bits & ((std::uint64_t{1} << width) - 1);
}

/// Words of one number.
void push(Words& words, std::uint64_t bits, std::uint32_t width) {
  words.push_back(static_cast<std::uint32_t>(cut(bits, width)));
  if (width == 64) words.push_back(static_cast<std::uint32_t>(bits >> 32));
}

std::vector<std::uint64_t> numbers(const Words& words, std::uint32_t width) {
  std::vector<std::uint64_t> values;
  const std::size_t step = width == 64 ? 2 : 1;
  for (std::size_t i = 0; i + step <= words.size(); i += step)
    values.push_back(words[i] | (step == 2 ? std::uint64_t{words[i + 1]} << 32 : 0));
  return values;
}

std::uint64_t override_bits(const SpecializationConstant& row) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, row.bytes.data(), std::min<std::size_t>(8, row.bytes.size()));
  return bits;
}

/// The literal of an OpConstant or OpSpecConstant.
std::uint64_t literal_bits(const Inst& inst, std::uint32_t width) {
  return inst.operand(0) | (width == 64 ? std::uint64_t{inst.operand(1)} << 32 : 0);
}

const Constant& operand_constant(const Module& module, const Inst& inst, std::uint32_t i) {
  const Constant* value = module.constant(inst.operand(i));
  if (value == nullptr) fail(inst, "operand is not a constant");
  return *value;
}

Words composite(const Module& module, const Inst& inst) {
  Words words;
  for (std::uint32_t i = 0; inst.has(i); i++) {
    const Words& part = operand_constant(module, inst, i).words;
    words.insert(words.end(), part.begin(), part.end());
    if (words.size() > kMaxScalars) fail(inst, "constant is too large");
  }
  return words;
}

/// One constant for every constituent.
Words replicated(const Module& module, const Inst& inst) {
  const Words& part = operand_constant(module, inst, 0).words;
  const Type& type = module.type(inst.result_type);
  Words words;
  if (std::uint64_t{constituents(type)} * part.size() != type.scalars) return words;
  for (std::uint32_t i = 0; i < constituents(type); i++) words.insert(words.end(), part.begin(), part.end());
  return words;
}

std::int64_t signed_of(std::uint64_t bits, std::uint32_t width) {
  const std::uint32_t shift = 64 - width;
  return static_cast<std::int64_t>(bits << shift) >> shift;
}

std::uint64_t signed_quotient(std::int64_t a, std::int64_t b) {
  if (b == 0) return 0;
  return b == -1 ? 0 - static_cast<std::uint64_t>(a) : static_cast<std::uint64_t>(a / b);
}

std::int64_t signed_remainder(std::int64_t a, std::int64_t b) { return b == 0 || b == -1 ? 0 : a % b; }

std::int64_t floored_remainder(std::int64_t a, std::int64_t b) {
  const std::int64_t rest = signed_remainder(a, b);
  return rest != 0 && (a < 0) != (b < 0) ? rest + b : rest;
}

double float_of_width(std::uint64_t bits, std::uint32_t width) {
  if (width == 64) return std::bit_cast<double>(bits);
  const auto word = static_cast<std::uint32_t>(bits);
  return static_cast<double>(width == 16 ? base::half_to_float(static_cast<std::uint16_t>(word))
                                         : base::float_of(word));
}

/// `once`: a half of a double is rounded once, not to binary32 on the way as in the reference.
std::uint64_t bits_of_float(double value, std::uint32_t width, bool once) {
  if (width == 64) return std::bit_cast<std::uint64_t>(value);
  float single = static_cast<float>(value);
  if (width == 32) return base::bits_of(single);
  if (once && static_cast<double>(single) != value) {  // round to odd: no tie that is none
    const bool grown = std::fabs(static_cast<double>(single)) > std::fabs(value);
    single = base::float_of((base::bits_of(single) - grown) | 1);
  }
  return base::float_to_half_nearest(single);
}

std::uint64_t quantize(std::uint64_t bits) {
  const float value = base::float_of(static_cast<std::uint32_t>(bits));
  const float half = base::half_to_float(base::float_to_half_nearest(value));
  return std::fabs(half) < 0x1p-14f ? bits & 0x80000000u : base::bits_of(half);
}

/// One component of a component-wise integer or boolean operation. `width`: of the operands.
std::uint64_t fold(const Module& module, const Inst& inst, Op op, std::uint64_t a, std::uint64_t b, std::uint32_t width,
                   std::uint32_t result_width) {
  const std::int64_t signed_a = signed_of(a, width), signed_b = signed_of(b, width);
  const std::uint32_t count = static_cast<std::uint32_t>(b) & (width - 1);
  switch (op) {
    case Op::OpUConvert:
    case Op::OpBitcast:
    case Op::OpCopyObject:
      return a;
    case Op::OpSConvert:
      return static_cast<std::uint64_t>(signed_a);
    case Op::OpFConvert:
      return width == result_width
                 ? a
                 : bits_of_float(float_of_width(a, width), result_width, module.rounds_to_nearest(result_width));
    case Op::OpQuantizeToF16:
      return quantize(a);
    case Op::OpSNegate:
      return 0 - a;
    case Op::OpNot:
      return ~a;
    case Op::OpIAdd:
      return a + b;
    case Op::OpISub:
      return a - b;
    case Op::OpIMul:
      return a * b;
    case Op::OpUDiv:
      return b == 0 ? 0 : a / b;
    case Op::OpUMod:
      return b == 0 ? 0 : a % b;
    case Op::OpSDiv:
      return signed_quotient(signed_a, signed_b);
    case Op::OpSRem:
      return static_cast<std::uint64_t>(signed_remainder(signed_a, signed_b));
    case Op::OpSMod:
      return static_cast<std::uint64_t>(floored_remainder(signed_a, signed_b));
    case Op::OpShiftRightLogical:
      return a >> count;
    case Op::OpShiftRightArithmetic:
      return static_cast<std::uint64_t>(signed_a >> count);
    case Op::OpShiftLeftLogical:
      return a << count;
    case Op::OpBitwiseOr:
    case Op::OpLogicalOr:
      return a | b;
    case Op::OpBitwiseXor:
      return a ^ b;
    case Op::OpBitwiseAnd:
    case Op::OpLogicalAnd:
      return a & b;
    case Op::OpLogicalNot:
      return a ^ 1;
    case Op::OpLogicalEqual:
    case Op::OpIEqual:
      return a == b;
    case Op::OpLogicalNotEqual:
    case Op::OpINotEqual:
      return a != b;
    case Op::OpUGreaterThan:
      return a > b;
    case Op::OpSGreaterThan:
      return signed_a > signed_b;
    case Op::OpUGreaterThanEqual:
      return a >= b;
    case Op::OpSGreaterThanEqual:
      return signed_a >= signed_b;
    case Op::OpULessThan:
      return a < b;
    case Op::OpSLessThan:
      return signed_a < signed_b;
    case Op::OpULessThanEqual:
      return a <= b;
    case Op::OpSLessThanEqual:
      return signed_a <= signed_b;
    default:
      fail(inst, "operation " + std::to_string(static_cast<unsigned>(op)) + " is not supported in a constant");
  }
}

/// First scalar of the part of `type` that the literal indices from operand `next` on select; `type` becomes its type.
std::uint32_t locate(const Module& module, const Inst& inst, std::uint32_t next, std::uint32_t& type) {
  std::uint32_t at = 0;
  for (; inst.has(next); next++) {
    const Type& whole = module.type(type);
    const std::uint32_t index = inst.operand(next);
    if (whole.kind == Type::Kind::kStruct) {
      if (index >= whole.members.size()) fail(inst, "member out of range");
      for (std::uint32_t i = 0; i < index; i++) at += module.type(whole.members[i]).scalars;
      type = whole.members[index];
    } else {
      if (index >= whole.count) fail(inst, "index out of range");
      type = whole.element;
      at += index * module.type(type).scalars;
    }
  }
  return at;
}

Words spec_constant_op(const Module& module, const Inst& inst) {
  const Op op = static_cast<Op>(inst.operand(0));
  const Constant& a = operand_constant(module, inst, 1);
  if (op == Op::OpCompositeExtract) {
    std::uint32_t type = a.type;
    const std::uint32_t at = locate(module, inst, 2, type);
    const std::uint32_t count = module.type(type).scalars;
    if (at + count > a.words.size()) fail(inst, "index out of range");
    return Words(a.words.begin() + at, a.words.begin() + at + count);
  }
  if (op == Op::OpCompositeInsert) {
    const Constant& whole = operand_constant(module, inst, 2);
    std::uint32_t type = whole.type;
    const std::uint32_t at = locate(module, inst, 3, type);
    Words words = whole.words;
    if (at + a.words.size() > words.size()) fail(inst, "index out of range");
    std::copy(a.words.begin(), a.words.end(), words.begin() + at);
    return words;
  }
  const std::uint32_t width = width_of(module, a.type), result_width = width_of(module, inst.result_type);
  if (width == 0 || result_width == 0) fail(inst, "operand is not a number");
  const std::vector<std::uint64_t> first = numbers(a.words, width);
  Words words;
  if (op == Op::OpVectorShuffle) {
    std::vector<std::uint64_t> both = first;
    const std::vector<std::uint64_t> second = numbers(operand_constant(module, inst, 2).words, width);
    both.insert(both.end(), second.begin(), second.end());
    for (std::uint32_t i = 3; inst.has(i); i++)
      push(words, inst.operand(i) < both.size() ? both[inst.operand(i)] : 0, width);
    return words;
  }
  if (op == Op::OpSelect) {
    const std::vector<std::uint64_t> yes = numbers(operand_constant(module, inst, 2).words, result_width);
    const std::vector<std::uint64_t> no = numbers(operand_constant(module, inst, 3).words, result_width);
    if (yes.size() != no.size()) fail(inst, "operands differ in size");
    for (std::size_t i = 0; i < yes.size(); i++)
      push(words, first[first.size() == 1 ? 0 : std::min(i, first.size() - 1)] != 0 ? yes[i] : no[i], result_width);
    return words;
  }
  // Only the count of a shift may be of another width.
  const bool binary = inst.has(2);
  const Constant& b = operand_constant(module, inst, binary ? 2 : 1);
  const std::vector<std::uint64_t> second = numbers(b.words, width_of(module, b.type));
  if (second.size() != first.size()) fail(inst, "operands differ in size");
  if (op == Op::OpBitcast && width != result_width) fail(inst, "size of the components changes");
  for (std::size_t i = 0; i < first.size(); i++)
    push(words, fold(module, inst, op, first[i], second[i], width, result_width), result_width);
  return words;
}

}  // namespace

void fold_constant(Module& module, const Inst& inst, const CompileOptions& options) {
  Constant value;
  value.type = inst.result_type;
  const Type& type = module.type(value.type);
  if (is_too_large(type) || module.constant_words > kMaxConstantWords) fail(inst, "constant is too large");
  switch (inst.op) {
    case Op::OpConstantTrue:
      value.words = {1};
      break;
    case Op::OpConstantFalse:
      value.words = {0};
      break;
    case Op::OpSpecConstantTrue:
    case Op::OpSpecConstantFalse: {
      const SpecializationConstant* given = override_of(module, inst, options);
      const bool yes = given ? cut(override_bits(*given), 32) != 0 : inst.op == Op::OpSpecConstantTrue;
      value.words = {yes};
      break;
    }
    case Op::OpConstant:
      push(value.words, literal_bits(inst, type.width), type.width);
      break;
    case Op::OpSpecConstant: {
      const SpecializationConstant* given = override_of(module, inst, options);
      push(value.words, given ? override_bits(*given) : literal_bits(inst, type.width), type.width);
      break;
    }
    case Op::OpConstantComposite:
    case Op::OpSpecConstantComposite:
      value.words = composite(module, inst);
      break;
    case Op::OpConstantNull:
      value.words.assign(type.scalars, 0);
      break;
    case Op::OpUndef:
      value.words.assign(type.scalars, 0);
      value.undefined = true;
      break;
    case Op::OpSpecConstantOp:
      value.words = spec_constant_op(module, inst);
      break;
    default:
      if (!newer::is_replicated_constant(inst.op)) fail(inst, "is not supported");
      value.words = replicated(module, inst);
  }
  if (value.words.size() != type.scalars) fail(inst, "constant does not fit its type");
  module.constant_words += value.words.size();
  module.constants[inst.result] = std::move(value);
}

}  // namespace vitrine::spirv::front

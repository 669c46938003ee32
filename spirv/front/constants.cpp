// Constants and specialization constants (SPIR-V 2.12), folded to 32-bit words. OpSpecConstantOp follows the constant
// folding of the reference: division and remainder by zero give 0, shifts are masked (lavapipe-shader-math.md 7).
#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/numeric.h"
#include "spirv/front/module.h"

namespace vitrine::spirv::front {
namespace {

using spv::Op;
using Words = std::vector<std::uint32_t>;

/// Words of an OpSpecConstant* given at pipeline creation; null: keep the default.
const SpecializationConstant* override_of(const Module& module, const Inst& inst, const CompileOptions& options) {
  const DecorationRow* spec_id = module.decoration(inst.result, spv::Decoration::SpecId);
  if (spec_id == nullptr) return nullptr;
  for (const SpecializationConstant& row : options.specialization)
    if (row.id == spec_id->value) return &row;
  return nullptr;
}

std::uint32_t override_word(const SpecializationConstant& row) {
  std::uint32_t word = 0;
  std::memcpy(&word, row.bytes.data(), std::min<std::size_t>(4, row.bytes.size()));
  return word;
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

std::int32_t as_int(std::uint32_t word) { return static_cast<std::int32_t>(word); }

std::uint32_t signed_quotient(std::uint32_t a, std::uint32_t b) {
  if (b == 0) return 0;
  return b == UINT32_MAX ? 0u - a : static_cast<std::uint32_t>(as_int(a) / as_int(b));
}

std::uint32_t signed_remainder(std::uint32_t a, std::uint32_t b) {
  return b == 0 || b == UINT32_MAX ? 0 : static_cast<std::uint32_t>(as_int(a) % as_int(b));
}

std::uint32_t floored_remainder(std::uint32_t a, std::uint32_t b) {
  const std::uint32_t rest = signed_remainder(a, b);
  return rest != 0 && (as_int(a) < 0) != (as_int(b) < 0) ? rest + b : rest;
}

/// One component of a component-wise integer or boolean operation.
std::uint32_t fold(const Inst& inst, Op op, std::uint32_t a, std::uint32_t b) {
  switch (op) {
    case Op::OpUConvert:
    case Op::OpSConvert:
    case Op::OpFConvert:
    case Op::OpBitcast:
    case Op::OpCopyObject:
      return a;
    case Op::OpQuantizeToF16: {
      const float half = base::half_to_float(base::float_to_half_nearest(base::float_of(a)));
      return std::fabs(half) < 0x1p-14f ? a & 0x80000000u : base::bits_of(half);
    }
    case Op::OpSNegate:
      return 0u - a;
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
      return signed_quotient(a, b);
    case Op::OpSRem:
      return signed_remainder(a, b);
    case Op::OpSMod:
      return floored_remainder(a, b);
    case Op::OpShiftRightLogical:
      return a >> (b & 31);
    case Op::OpShiftRightArithmetic:
      return static_cast<std::uint32_t>(as_int(a) >> (b & 31));
    case Op::OpShiftLeftLogical:
      return a << (b & 31);
    case Op::OpBitwiseOr:
      return a | b;
    case Op::OpBitwiseXor:
      return a ^ b;
    case Op::OpBitwiseAnd:
      return a & b;
    case Op::OpLogicalOr:
      return a | b;
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
      return as_int(a) > as_int(b);
    case Op::OpUGreaterThanEqual:
      return a >= b;
    case Op::OpSGreaterThanEqual:
      return as_int(a) >= as_int(b);
    case Op::OpULessThan:
      return a < b;
    case Op::OpSLessThan:
      return as_int(a) < as_int(b);
    case Op::OpULessThanEqual:
      return a <= b;
    case Op::OpSLessThanEqual:
      return as_int(a) <= as_int(b);
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
  if (op == Op::OpVectorShuffle) {
    Words both = a.words, words;
    const Words& b = operand_constant(module, inst, 2).words;
    both.insert(both.end(), b.begin(), b.end());
    for (std::uint32_t i = 3; inst.has(i); i++)
      words.push_back(inst.operand(i) < both.size() ? both[inst.operand(i)] : 0);
    return words;
  }
  const bool binary = inst.has(2);
  Words words = op == Op::OpSelect ? operand_constant(module, inst, 2).words : a.words;
  const Words& b = operand_constant(module, inst, op == Op::OpSelect ? 3 : binary ? 2 : 1).words;
  if (b.size() != words.size()) fail(inst, "operands differ in size");
  for (std::size_t i = 0; i < words.size(); i++)
    if (op == Op::OpSelect)
      words[i] = a.words[a.words.size() == 1 ? 0 : std::min(i, a.words.size() - 1)] ? words[i] : b[i];
    else
      words[i] = fold(inst, op, words[i], b[i]);
  return words;
}

}  // namespace

void fold_constant(Module& module, const Inst& inst, const CompileOptions& options) {
  Constant value;
  value.type = inst.result_type;
  const Type& type = module.type(value.type);
  if (type.scalars > kMaxScalars) fail(inst, "constant is too large");
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
      value.words = {given ? override_word(*given) != 0 : inst.op == Op::OpSpecConstantTrue};
      break;
    }
    case Op::OpConstant:
      value.words = {inst.operand(0)};
      break;
    case Op::OpSpecConstant: {
      const SpecializationConstant* given = override_of(module, inst, options);
      value.words = {given ? override_word(*given) : inst.operand(0)};
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
      fail(inst, "is not supported");
  }
  if (value.words.size() != type.scalars) fail(inst, "constant does not fit its type");
  module.constants[inst.result] = std::move(value);
}

}  // namespace vitrine::spirv::front

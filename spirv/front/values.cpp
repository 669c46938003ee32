// SPIR-V values as lists of leaves (scalars and vectors).
#include "spirv/front/expression.h"

namespace vitrine::spirv::front {

const Type& number_type(const Translator& t, std::uint32_t type_id) {
  const Type& type = t.module.type(type_id);
  return type.kind == Type::Kind::kVector ? t.module.type(type.element) : type;
}

ir::ValueInfo leaf_info(const Translator& t, std::uint32_t type_id) {
  const Type& type = t.module.type(type_id);
  const bool is_vector = type.kind == Type::Kind::kVector;
  const Type& number = number_type(t, type_id);
  switch (number.kind) {
    case Type::Kind::kBool:
    case Type::Kind::kInt:
    case Type::Kind::kFloat:
      break;
    case Type::Kind::kPointer:
      if (number.leaves != 0) break;
      [[fallthrough]];
    default:
      throw Failure("%" + std::to_string(type_id) + " is not a scalar or vector type");
  }
  return {static_cast<std::uint8_t>(is_vector ? type.count : 1), number.kind == Type::Kind::kBool};
}

void leaf_types(const Translator& t, std::uint32_t type_id, std::vector<std::uint32_t>& leaves) {
  const Type& type = t.module.type(type_id);
  if (is_too_large(type)) throw Failure("value of type %" + std::to_string(type_id) + " is too large");
  switch (type.kind) {
    case Type::Kind::kStruct:
      for (std::uint32_t member : type.members) leaf_types(t, member, leaves);
      break;
    case Type::Kind::kMatrix:
    case Type::Kind::kArray:
      for (std::uint32_t i = 0; i < type.count; i++) leaf_types(t, type.element, leaves);
      break;
    default:
      leaf_info(t, type_id);
      leaves.insert(leaves.end(), type.leaves, type_id);
  }
}

namespace {

/// Constants up to this size are a value of their own wherever they are named, as in the reference: a vector composed
/// of literals is then no constant for its first round.
constexpr std::uint32_t kMaxLiteral = 16;

}  // namespace

Value constant_value(Translator& t, std::uint32_t type, std::span<const std::uint32_t> words, bool is_undefined) {
  std::vector<std::uint32_t> types;
  leaf_types(t, type, types);
  Value value{type, {}};
  std::size_t at = 0;
  for (std::size_t i = 0; i < types.size();) {
    const ir::ValueInfo info = leaf_info(t, types[i]);
    const std::uint32_t parts = t.module.type(types[i]).leaves;
    if (at + parts * info.components > words.size()) throw Failure("constant does not fit its type");
    for (std::uint32_t part = 0; part < parts; part++) {
      std::uint32_t leaf[4] = {};
      for (std::uint32_t c = 0; c < info.components; c++) {
        leaf[c] = words[at + c * parts + part];
        if (info.boolean) leaf[c] = leaf[c] != 0;
      }
      const std::span<const std::uint32_t> own(leaf, info.components);
      value.leaves.push_back(is_undefined                  ? undefined(t, info.components, info.boolean)
                             : words.size() <= kMaxLiteral ? literal(t, own, info.boolean)
                                                           : constant(t, own, info.boolean));
    }
    at += parts * info.components;
    i += parts;
  }
  return value;
}

const Value& value_of(Translator& t, std::uint32_t id) {
  const auto found = t.values.find(id);
  const Constant* value = t.module.constant(id);
  if (found != t.values.end() && (value == nullptr || value->words.size() > kMaxLiteral)) return found->second;
  if (value == nullptr && is_static_pointer(t, id))
    return t.pointer_values[id] = pointer_value(t, t.module.def(id).result_type, pointer_of(t, id));
  if (value == nullptr) throw Failure("%" + std::to_string(id) + " has no value here");
  return t.values[id] = constant_value(t, value->type, value->words, value->undefined);
}

ir::ValueId scalar_or_vector(Translator& t, std::uint32_t id) {
  const Value& value = value_of(t, id);
  if (value.leaves.size() != 1) throw Failure("%" + std::to_string(id) + " is not a scalar or vector");
  return value.leaves[0];
}

Expr number_of(Translator& t, std::uint32_t id) {
  const Value& value = value_of(t, id);
  const std::size_t leaves = t.module.type(value.type).leaves;
  if (value.leaves.size() != leaves || leaves > 2) throw Failure("%" + std::to_string(id) + " is not a number");
  leaf_info(t, value.type);
  return leaf_numbers(t, value)[0];
}

std::vector<Expr> leaf_numbers(Translator& t, const Value& value) {
  std::vector<std::uint32_t> types;
  leaf_types(t, value.type, types);
  if (types.size() != value.leaves.size()) throw Failure("value does not fit its type");
  std::vector<Expr> numbers;
  for (std::size_t i = 0; i < types.size(); i++) {
    Expr number{&t, value.leaves[i]};
    number.width = static_cast<std::uint8_t>(number_type(t, types[i]).width);
    if (number.width == 64) number.high = value.leaves[++i];
    numbers.push_back(number);
  }
  return numbers;
}

void set_numbers(Translator& t, const Inst& inst, std::span<const Expr> numbers) {
  std::vector<ir::ValueId> leaves;
  for (const Expr& number : numbers) {
    leaves.push_back(number.id);
    if (number.high != ir::kNoValue) leaves.push_back(number.high);
  }
  set_value(t, inst, std::move(leaves));
}

void set_number(Translator& t, const Inst& inst, const Expr& number) { set_numbers(t, inst, {&number, 1}); }

ir::ValueId number(Translator& t, std::uint32_t id, std::uint32_t count) {
  const ir::ValueId value = scalar_or_vector(t, id);
  const std::uint32_t width = number_type(t, value_of(t, id).type).width;
  if (width != 32) throw Failure(std::to_string(width) + "-bit operand is not supported here");
  if (components(t, value) != count || is_boolean(t, value)) throw Failure("operand does not fit its type");
  return value;
}

ir::ValueId index_word(Translator& t, std::uint32_t id) {
  const Expr value = number_of(t, id);
  if (value.size() != 1 || is_boolean(t, value.id)) throw Failure("index is not an integer");
  const bool is_signed = number_type(t, value_of(t, id).type).is_signed;
  return (is_signed ? convert_signed(value, 32) : convert_unsigned(value, 32)).id;
}

ir::ValueId condition(Translator& t, std::uint32_t id) {
  const ir::ValueId value = scalar_or_vector(t, id);
  if (components(t, value) != 1 || !is_boolean(t, value)) throw Failure("condition is not a boolean");
  return value;
}

void set_value(Translator& t, const Inst& inst, std::vector<ir::ValueId> leaves) {
  std::vector<std::uint32_t> types;
  leaf_types(t, inst.result_type, types);
  if (types.size() != leaves.size()) fail(inst, "value does not fit its type");
  t.leaves += leaves.size();
  if (t.leaves > kMaxLeaves) fail(inst, "the values of the shader are too large");
  for (std::size_t i = 0; i < types.size(); i++) check_leaf(t, types[i], leaves[i]);
  t.values[inst.result] = {inst.result_type, std::move(leaves)};
}

void set_value(Translator& t, const Inst& inst, ir::ValueId leaf) { set_value(t, inst, std::vector{leaf}); }

Part find_part(const Translator& t, const Inst& inst, std::uint32_t type, std::uint32_t first_operand) {
  Part part{0, type, {}};
  for (std::uint32_t i = first_operand; inst.has(i); i++) {
    const std::uint32_t index = inst.operand(i);
    const Type& whole = t.module.type(part.type);
    switch (whole.kind) {
      case Type::Kind::kStruct:
        if (index >= whole.members.size()) fail(inst, "member out of range");
        for (std::uint32_t m = 0; m < index; m++) part.first += t.module.type(whole.members[m]).leaves;
        part.type = whole.members[index];
        break;
      case Type::Kind::kArray:
      case Type::Kind::kMatrix:
      case Type::Kind::kVector:
        if (index >= whole.count) fail(inst, "index out of range");
        part.type = whole.element;
        if (whole.kind == Type::Kind::kVector)
          part.component = index;
        else
          part.first += index * t.module.type(part.type).leaves;
        break;
      default:
        fail(inst, "index into a scalar");
    }
  }
  return part;
}

}  // namespace vitrine::spirv::front

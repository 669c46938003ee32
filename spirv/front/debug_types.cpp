// Types and names for debuggers (OpName, OpMemberName; layouts by Offset, ArrayStride, MatrixStride).
#include "spirv/front/debug_types.h"

#include <algorithm>

namespace vitrine::spirv::front {
namespace {

using spv::Op;
using Kind = SourceType::Kind;

/// Words of a value that is taken apart.
constexpr std::uint64_t kMostCells = 1u << 16;

std::uint32_t cells_of(std::uint64_t each, std::uint64_t count) {
  return each * count > kMostCells ? 0 : static_cast<std::uint32_t>(each * count);
}

std::string scalar_name(const Type& type) {
  if (type.kind == Type::Kind::kBool) return "bool";
  if (type.kind == Type::Kind::kFloat) return type.width == 32 ? "float" : type.width == 64 ? "double" : "float16_t";
  std::string name = type.is_signed ? "int" : "uint";
  return type.width == 32 ? name : name + std::to_string(type.width) + "_t";
}

std::string prefix_of(const SourceType& component) {
  switch (component.kind) {
    case Kind::kBool:
      return "b";
    case Kind::kInt:
      return component.width == 32 ? "i" : 'i' + std::to_string(component.width);
    case Kind::kUint:
      return component.width == 32 ? "u" : 'u' + std::to_string(component.width);
    default:
      return component.width == 32 ? "" : component.width == 64 ? "d" : "f16";
  }
}

}  // namespace

DebugTypes::DebugTypes(const Module& module, SourceVariables& tables) : module_(module), tables_(tables) {
  for (const Inst& inst : module.code) {
    if (inst.op == Op::OpFunction) break;
    if (inst.op == Op::OpName && inst.has(0)) names_[inst.operand(0)] = string_at(inst, 1);
    if (inst.op == Op::OpMemberName && inst.has(1))
      member_names_[{inst.operand(0), inst.operand(1)}] = string_at(inst, 2);
  }
}

std::string DebugTypes::name(std::uint32_t id) const {
  const auto found = names_.find(id);
  return found == names_.end() ? std::string() : found->second;
}

std::string DebugTypes::id_name(std::uint32_t id) const {
  std::string named = name(id);
  return named.empty() ? '%' + std::to_string(id) : named;
}

std::string DebugTypes::member_name(std::uint32_t type_id, std::uint32_t member) const {
  const auto found = member_names_.find({type_id, member});
  return found != member_names_.end() && !found->second.empty() ? found->second : '_' + std::to_string(member);
}

std::uint32_t DebugTypes::number(std::uint32_t type_id) {
  const auto found = numbers_.find(type_id);
  if (found != numbers_.end()) return found->second;
  numbers_[type_id] = 0;  // a type that holds pointers to itself
  SourceType made = make(type_id);
  tables_.types.push_back(std::move(made));
  return numbers_[type_id] = static_cast<std::uint32_t>(tables_.types.size() - 1);
}

SourceType DebugTypes::make(std::uint32_t type_id) {
  const Type& type = module_.type(type_id);
  SourceType made;
  made.name = id_name(type_id);
  made.width = type.width;
  switch (type.kind) {
    case Type::Kind::kBool:
    case Type::Kind::kInt:
    case Type::Kind::kFloat:
      made.kind = type.kind == Type::Kind::kBool    ? Kind::kBool
                  : type.kind == Type::Kind::kFloat ? Kind::kFloat
                  : type.is_signed                  ? Kind::kInt
                                                    : Kind::kUint;
      made.name = scalar_name(type);
      made.cells = type.width == 64 ? 2 : 1;
      return made;
    case Type::Kind::kVector:
    case Type::Kind::kMatrix:
    case Type::Kind::kArray:
    case Type::Kind::kRuntimeArray: {
      made.element = number(type.element);
      made.count = type.kind == Type::Kind::kRuntimeArray ? 0 : type.count;
      made.array_stride = type.array_stride;
      const SourceType& element = tables_.types[made.element];
      made.cells = cells_of(element.cells, made.count);
      if (type.kind == Type::Kind::kVector) {
        made.kind = Kind::kVector;
        made.name = prefix_of(element) + "vec" + std::to_string(type.count);
      } else if (type.kind == Type::Kind::kMatrix) {
        made.kind = Kind::kMatrix;
        made.name = prefix_of(tables_.types[element.element]) + "mat" + std::to_string(type.count) +
                    (type.count == element.count ? "" : 'x' + std::to_string(element.count));
      } else {
        made.kind = Kind::kArray;
        made.name = element.name + "[" + (made.count == 0 ? "" : std::to_string(made.count)) + "]";
      }
      return made;
    }
    case Type::Kind::kStruct:
      made.kind = Kind::kStruct;
      add_members(type_id, made);
      return made;
    default:
      return made;
  }
}

void DebugTypes::add_members(std::uint32_t type_id, SourceType& made) {
  const Type& type = module_.type(type_id);
  std::uint64_t cells = 0;
  for (std::uint32_t i = 0; i < type.members.size(); ++i) {
    SourceType::Member member;
    member.name = member_name(type_id, i);
    member.type = number(type.members[i]);
    if (const DecorationRow* row = module_.decoration(type_id, spv::Decoration::Offset, i + 1))
      member.offset = row->value;
    if (const DecorationRow* row = module_.decoration(type_id, spv::Decoration::MatrixStride, i + 1))
      member.matrix_stride = row->value;
    member.row_major = module_.decoration(type_id, spv::Decoration::RowMajor, i + 1) != nullptr;
    cells += tables_.types[member.type].cells;
    made.members.push_back(std::move(member));
  }
  made.cells = cells > kMostCells ? 0 : static_cast<std::uint32_t>(cells);
}

}  // namespace vitrine::spirv::front

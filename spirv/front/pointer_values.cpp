// Pointers as values (SPIR-V 2.16.1, variable pointers; SPV_KHR_physical_storage_buffer): what OpPhi, OpSelect, loads
// and calls pass on. Two words: of an address, the low and the high one; else a handle of the buffer (ir::BufferHandle;
// Workgroup: 1, so that no pointer equals a null one) and a byte offset.
#include <algorithm>

#include "spirv/front/expression.h"
#include "spirv/front/functions.h"

namespace vitrine::spirv::front {
namespace {

/// The handle of the buffer; an array element outside of the binding leads nowhere.
Expr buffer_handle(Translator& t, const Pointer& pointer) {
  const Binding& binding = pointer.binding;
  if (binding.set == ir::kAnySet) return {&t, pointer.element};
  if (binding.slot + std::uint64_t{binding.count} > ir::BufferHandle::kSlotMask)
    throw Failure("the binding has too many descriptors");
  const Expr first = imm_u32(t, ir::BufferHandle::make(binding.set, binding.slot));
  if (pointer.element == ir::kNoValue) return first;
  if (const auto* words = constant_of(t, pointer.element))
    return imm_u32(t,
                   (*words)[0] < binding.count ? ir::BufferHandle::make(binding.set, binding.slot + (*words)[0]) : 0);
  const Expr element{&t, pointer.element};
  const Expr inside = apply(ir::Op::kULt, {element, imm_u32(t, binding.count)});
  return select(inside, apply(ir::Op::kIAdd, {first, element}), imm_u32(t, 0));
}

Expr byte_offset(Translator& t, const Pointer& pointer) {
  const Expr constant = imm_u32(t, pointer.constant_offset);
  if (pointer.offset == ir::kNoValue) return constant;
  const Expr offset{&t, pointer.offset};
  return pointer.constant_offset == 0 ? offset : apply(ir::Op::kIAdd, {offset, constant});
}

/// The address with the signed offset added.
std::vector<ir::ValueId> address_leaves(Translator& t, const Pointer& pointer) {
  if (pointer.offset == ir::kNoValue && pointer.constant_offset == 0) return {pointer.low, pointer.high};
  const Expr low{&t, pointer.low}, high{&t, pointer.high}, offset = byte_offset(t, pointer);
  const Expr sum = apply(ir::Op::kIAdd, {low, offset}), carry = apply(ir::Op::kUAddCarry, {low, offset});
  const Expr sign = apply(ir::Op::kIShr, {offset, imm_u32(t, 31)});
  return {sum.id, apply(ir::Op::kIAdd, {apply(ir::Op::kIAdd, {high, sign}), carry}).id};
}

/// The type of an array of buffers.
bool is_block_array(const Translator& t, const Type& type) {
  const bool array = type.kind == Type::Kind::kArray || type.kind == Type::Kind::kRuntimeArray;
  return array && (t.module.decoration(type.element, spv::Decoration::Block) != nullptr ||
                   t.module.decoration(type.element, spv::Decoration::BufferBlock) != nullptr);
}

/// Bytes from the start of a value in a buffer to its end: the stride of an array of them whose pointers have none.
std::uint32_t bytes_of(const Translator& t, std::uint32_t type_id) {
  const Type& type = t.module.type(type_id);
  if (type.kind == Type::Kind::kStruct && is_too_large(type))
    throw Failure("type %" + std::to_string(type_id) + " is too large");
  std::uint32_t end = 0;
  switch (type.kind) {
    case Type::Kind::kArray:
      return type.count * type.array_stride;
    case Type::Kind::kStruct:
      for (std::uint32_t i = 0; i < type.members.size(); i++) {
        const DecorationRow* offset = t.module.decoration(type_id, spv::Decoration::Offset, i + 1);
        end = std::max(end, (offset != nullptr ? offset->value : 0) + bytes_of(t, type.members[i]));
      }
      return end;
    case Type::Kind::kVector:
      return type.count * bytes_of(t, type.element);
    default:
      return type.width / 8;
  }
}

}  // namespace

bool is_static_pointer(const Translator& t, std::uint32_t id) {
  return t.pointers.count(id) != 0 || t.module.def(id).op == spv::Op::OpVariable;
}

Value pointer_value(Translator& t, std::uint32_t type, const Pointer& pointer) {
  switch (pointer.kind) {
    case Pointer::Kind::kGlobal:
      return {type, address_leaves(t, pointer)};
    case Pointer::Kind::kShared:
      return {type, {constant_u32(t, 1), byte_offset(t, pointer).id}};
    case Pointer::Kind::kStorage:
      return {type, {buffer_handle(t, pointer).id, byte_offset(t, pointer).id}};
    default:
      break;
  }
  throw Failure("a pointer of this storage class is not a value");
}

Pointer pointer_from(Translator& t, const Value& value) {
  const Type& type = t.module.type(value.type);
  if (type.kind != Type::Kind::kPointer || value.leaves.size() != 2) throw Failure("operand is not a pointer");
  Pointer pointer;
  pointer.type = type.element;
  switch (type.storage) {
    case spv::StorageClass::PhysicalStorageBuffer:
      pointer.kind = Pointer::Kind::kGlobal;
      pointer.low = value.leaves[0];
      pointer.high = value.leaves[1];
      return pointer;
    case spv::StorageClass::Workgroup:
      pointer.kind = Pointer::Kind::kShared;
      pointer.explicit_layout = has_workgroup_blocks(t);
      pointer.offset = value.leaves[1];
      return pointer;
    default:
      pointer.kind = Pointer::Kind::kStorage;
      pointer.binding = {ir::kAnySet, 0, UINT32_MAX, nullptr};
      pointer.descriptor_array = is_block_array(t, t.module.type(type.element));
      pointer.element = value.leaves[0];
      pointer.offset = value.leaves[1];
      return pointer;
  }
}

void pointer_equal(Translator& t, const Inst& inst, ir::Op compare) {
  const Value a = value_of(t, inst.operand(0)), b = value_of(t, inst.operand(1));
  if (a.leaves.size() != 2 || b.leaves.size() != 2) fail(inst, "operand is not a pointer");
  const Expr first = apply(compare, {Expr{&t, a.leaves[0]}, Expr{&t, b.leaves[0]}});
  const Expr second = apply(compare, {Expr{&t, a.leaves[1]}, Expr{&t, b.leaves[1]}});
  set_number(t, inst, apply(compare == ir::Op::kIEq ? ir::Op::kAndB : ir::Op::kOrB, {first, second}));
}

void pointer_difference(Translator& t, const Inst& inst, ir::Op) {
  const Value a = value_of(t, inst.operand(0)), b = value_of(t, inst.operand(1));
  const Type& type = t.module.type(a.type);
  if (a.leaves.size() != 2 || b.leaves.size() != 2) fail(inst, "operand is not a pointer");
  if (type.storage == spv::StorageClass::PhysicalStorageBuffer) fail(inst, "storage class is not supported");
  const bool shared = type.storage == spv::StorageClass::Workgroup && !has_workgroup_blocks(t);
  const std::uint32_t stride = shared                   ? 4 * t.module.type(type.element).scalars
                               : type.array_stride != 0 ? type.array_stride
                                                        : bytes_of(t, type.element);
  if (stride == 0) fail(inst, "pointer type without ArrayStride");
  const Expr bytes = apply(ir::Op::kISub, {Expr{&t, a.leaves[1]}, Expr{&t, b.leaves[1]}});
  const Expr elements = apply(ir::Op::kIDiv, {bytes, imm_u32(t, stride)});
  set_number(t, inst, convert_signed(elements, static_cast<std::uint8_t>(number_type(t, inst.result_type).width)));
}

}  // namespace vitrine::spirv::front

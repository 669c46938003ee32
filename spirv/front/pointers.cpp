// Pointers: what a variable stands for, and access chains into it (SPIR-V 3.42.8; Vulkan, Shader Resource Interface).
#include <algorithm>

#include "spirv/front/context.h"
#include "spirv/front/functions.h"

namespace vitrine::spirv::front {
namespace {

using spv::Decoration;
using spv::StorageClass;

Pointer descriptor_pointer(const Translator& t, const Inst& variable, std::uint32_t type_id) {
  Pointer pointer;
  pointer.kind = Pointer::Kind::kDescriptor;
  pointer.type = type_id;
  const Type& type = t.module.type(type_id);
  pointer.descriptor_array = type.kind == Type::Kind::kArray || type.kind == Type::Kind::kRuntimeArray;
  pointer.binding = find_binding(t, variable);
  return pointer;
}

/// Bytes that a value of a type with an explicit layout takes, without padding at its end. `member`: what holds it as
/// a member of a structure.
std::uint64_t explicit_bytes(const Translator& t, std::uint32_t type_id,
                             std::pair<std::uint32_t, std::uint32_t> member) {
  const Type& type = t.module.type(type_id);
  if (is_too_large(type)) throw Failure("type %" + std::to_string(type_id) + " is too large");
  switch (type.kind) {
    case Type::Kind::kStruct: {
      std::uint64_t bytes = 0;
      for (std::uint32_t i = 0; i < type.members.size(); i++) {
        const DecorationRow* offset = t.module.decoration(type_id, Decoration::Offset, i + 1);
        const std::uint64_t size = explicit_bytes(t, type.members[i], {type_id, i + 1});
        bytes = std::max(bytes, (offset == nullptr ? 0 : offset->value) + size);
      }
      return bytes;
    }
    case Type::Kind::kArray:
      return std::uint64_t{type.array_stride} * type.count;
    case Type::Kind::kMatrix: {
      const DecorationRow* stride = t.module.decoration(member.first, Decoration::MatrixStride, member.second);
      const bool row_major = t.module.decoration(member.first, Decoration::RowMajor, member.second) != nullptr;
      return (stride == nullptr ? 0 : std::uint64_t{stride->value}) *
             (row_major ? t.module.type(type.element).count : type.count);
    }
    case Type::Kind::kVector:
      return std::uint64_t{type.count} * t.module.type(type.element).width / 8;
    default:
      return type.width / 8;
  }
}

/// Block variables: uniform buffers, storage buffers, push constants.
Pointer buffer_pointer(Translator& t, const Inst& variable, StorageClass storage, std::uint32_t type_id) {
  Pointer pointer;
  pointer.type = type_id;
  if (storage == StorageClass::PushConstant) {
    pointer.kind = Pointer::Kind::kPush;
    const auto bytes = std::min<std::uint64_t>(explicit_bytes(t, type_id, {}), kMaxPushConstantBytes);
    t.function.interface.push_bytes = std::max(t.function.interface.push_bytes, static_cast<std::uint32_t>(bytes));
    return pointer;
  }
  const Type& type = t.module.type(type_id);
  pointer.descriptor_array = type.kind == Type::Kind::kArray || type.kind == Type::Kind::kRuntimeArray;
  pointer.kind = is_storage_buffer(t, variable) ? Pointer::Kind::kStorage : Pointer::Kind::kUniform;
  pointer.binding = find_binding(t, variable);
  return pointer;
}

Pointer shared_pointer(Translator& t, const Inst& variable, std::uint32_t type_id) {
  if (t.options.stage != VK_SHADER_STAGE_COMPUTE_BIT) fail(variable, "Workgroup memory is of compute shaders only");
  if (variable.has(1)) {  // "must be OpConstantNull" (Vulkan, Workgroup storage class); the memory starts as zeros
    const Constant* start = t.module.constant(variable.operand(1));
    if (start == nullptr || std::any_of(start->words.begin(), start->words.end(), [](auto word) { return word != 0; }))
      fail(variable, "initializer of a Workgroup variable is not zero");
  }
  Pointer pointer;
  pointer.kind = Pointer::Kind::kShared;
  pointer.type = type_id;
  pointer.explicit_layout = has_workgroup_blocks(t);
  std::uint32_t& bytes = t.function.interface.shared_bytes;
  // "all such variables must be decorated with Aliased" where there are several blocks: they share their memory.
  pointer.constant_offset = pointer.explicit_layout ? 0 : bytes;
  const std::uint64_t size =
      pointer.explicit_layout ? explicit_bytes(t, type_id, {}) : 4ull * t.module.type(type_id).scalars;
  const std::uint64_t end = pointer.constant_offset + size;
  if (end > (1u << 20)) fail(variable, "too much Workgroup memory");
  bytes = std::max(bytes, static_cast<std::uint32_t>(end));
  if (variable.has(1))
    t.function.interface.zeroed_shared.push_back({pointer.constant_offset, static_cast<std::uint32_t>(end)});
  return pointer;
}

Pointer declare(Translator& t, const Inst& variable) {
  const Type& pointer_type = t.module.type(variable.result_type);
  const std::uint32_t type = pointer_type.element;
  if (in_stage_memory(t, variable)) return stage_pointer(t, variable);
  switch (pointer_type.storage) {
    case StorageClass::Uniform:
    case StorageClass::StorageBuffer:
    case StorageClass::PushConstant:
      return buffer_pointer(t, variable, pointer_type.storage, type);
    case StorageClass::UniformConstant:
      return descriptor_pointer(t, variable, type);
    case StorageClass::Workgroup:
      return shared_pointer(t, variable, type);
    case StorageClass::Private:
    case StorageClass::Input:
    case StorageClass::Output: {
      const Pointer pointer = local_pointer(t, new_local(t, type, pointer_type.storage, variable.result));
      if (variable.has(1)) {
        ir::NodeList* const list = std::exchange(t.list, &t.prologue);
        store(t, pointer, value_of(t, variable.operand(1)));
        t.list = list;
      }
      return pointer;
    }
    default:
      fail(variable, "storage class is not supported");
  }
}

/// The constant's value as a signed number; beyond 32 bits it is outside of everything.
std::uint32_t constant_index(const Translator& t, const Constant& constant) {
  const std::uint32_t width = t.module.type(constant.type).width, low = constant.words[0];
  if (width == 64 && constant.words[1] != static_cast<std::uint32_t>(static_cast<std::int32_t>(low) >> 31)) return ~0u;
  if (width >= 32 || !t.module.type(constant.type).is_signed) return low;
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(low << (32 - width)) >> (32 - width));
}

Step make_step(Translator& t, std::uint32_t index_id) {
  const Constant* constant = t.module.constant(index_id);
  if (constant != nullptr && !constant->undefined && t.module.type(constant->type).kind == Type::Kind::kInt)
    return {false, constant_index(t, *constant), ir::kNoValue};
  const ir::ValueId value = index_word(t, index_id);
  if (const auto* words = constant_of(t, value)) return {false, (*words)[0], ir::kNoValue};
  return {true, 0, value};
}

void step_local(const Inst& inst, const Type& type, Pointer& pointer, Step step) {
  if (type.kind != Type::Kind::kStruct && type.count == 0) fail(inst, "index into an array without elements");
  if (!step.dynamic && step.index >= type.count && type.kind != Type::Kind::kStruct) {
    step.index = type.count - 1;  // lavapipe-shader-math.md 10: clamped to the last element
  }
  if (type.kind == Type::Kind::kVector)
    pointer.component = step;
  else
    pointer.path.push_back(step);
}

void add_offset(Translator& t, Pointer& pointer, const Step& step, std::uint32_t scale) {
  if (step.dynamic)
    pointer.offset = add_scaled(t, pointer.offset, step.value, scale);
  else
    pointer.constant_offset += step.index * scale;
}

void step_struct(Translator& t, const Inst& inst, const Type& type, Pointer& pointer, const Step& step) {
  if (pointer.word_layout()) {
    for (std::uint32_t i = 0; i < step.index; i++)
      pointer.constant_offset += 4 * t.module.type(type.members[i]).scalars;
    return;
  }
  const std::uint32_t member = step.index + 1;
  const DecorationRow* offset = t.module.decoration(type.id, Decoration::Offset, member);
  if (offset == nullptr) fail(inst, "member of a block without Offset");
  pointer.constant_offset += offset->value;
  if (const DecorationRow* stride = t.module.decoration(type.id, Decoration::MatrixStride, member))
    pointer.matrix_stride = stride->value;
  pointer.row_major = t.module.decoration(type.id, Decoration::RowMajor, member) != nullptr;
  pointer.is_volatile |= t.module.decoration(type.id, Decoration::Volatile, member) != nullptr;
}

void step_memory(Translator& t, const Inst& inst, const Type& type, Pointer& pointer, const Step& step) {
  const bool shared = pointer.word_layout();
  const std::uint32_t natural = shared ? 4 * t.module.type(type.element ? type.element : type.id).scalars : 0;
  switch (type.kind) {
    case Type::Kind::kStruct:
      step_struct(t, inst, type, pointer, step);
      break;
    case Type::Kind::kArray:
    case Type::Kind::kRuntimeArray:
      add_offset(t, pointer, step, shared ? natural : type.array_stride);
      break;
    case Type::Kind::kMatrix:
      if (shared) {
        add_offset(t, pointer, step, natural);
      } else if (pointer.row_major) {
        add_offset(t, pointer, step, number_type(t, type.element).width / 8);
        pointer.component_stride = pointer.matrix_stride;
      } else {
        add_offset(t, pointer, step, pointer.matrix_stride);
      }
      break;
    case Type::Kind::kVector:
      add_offset(t, pointer, step, component_bytes(t, pointer));
      break;
    default:
      fail(inst, "index into a scalar");
  }
}

}  // namespace

bool has_workgroup_blocks(const Translator& t) { return t.module.has_workgroup_blocks; }

std::uint32_t component_bytes(const Translator& t, const Pointer& pointer) {
  if (pointer.component_stride != 0) return pointer.component_stride;
  const Type& number = number_type(t, pointer.type);
  return pointer.word_layout() ? 4 * number.scalars : number.width / 8;
}

std::uint32_t new_local(Translator& t, std::uint32_t type, StorageClass storage, std::uint32_t variable) {
  t.locals.push_back({type, storage, variable, {}});
  return static_cast<std::uint32_t>(t.locals.size() - 1);
}

std::uint32_t new_local(Translator& t, ir::ValueInfo info) {
  t.locals.push_back({0, StorageClass::Function, 0, info});
  return static_cast<std::uint32_t>(t.locals.size() - 1);
}

std::uint32_t new_flag(Translator& t) { return new_local(t, ir::ValueInfo{1, true}); }

Pointer local_pointer(const Translator& t, std::uint32_t local) {
  Pointer pointer;
  pointer.kind = Pointer::Kind::kLocal;
  pointer.type = t.locals[local].type;
  pointer.variable = t.locals[local].variable;
  pointer.local = local;
  return pointer;
}

const Pointer& pointer_of(Translator& t, std::uint32_t id) {
  const auto found = t.pointers.find(id);
  if (found != t.pointers.end()) return found->second;
  if (t.values.count(id) != 0 || t.module.constant(id) != nullptr)
    return t.value_pointers[id] = pointer_from(t, value_of(t, id));
  const Inst& variable = t.module.def(id);
  if (variable.op != spv::Op::OpVariable) fail(variable, "is not a pointer that is supported");
  const Deeper deeper(t, "initial values are");
  Pointer pointer = declare(t, variable);
  pointer.variable = id;
  pointer.is_volatile = t.module.decoration(id, Decoration::Volatile) != nullptr;
  return t.pointers[id] = std::move(pointer);
}

void step_into(Translator& t, const Inst& inst, Pointer& pointer, const Step& step) {
  const Type& type = t.module.type(pointer.type);
  if (pointer.descriptor_array) {
    if (!step.dynamic && step.index >= pointer.binding.count) fail(inst, "array element is outside the binding");
    const ir::ValueId index = step.dynamic ? step.value : constant_u32(t, step.index);
    pointer.element = pointer.binding.set == ir::kAnySet ? add_scaled(t, pointer.element, index, 1) : index;
    pointer.descriptor_array = false;
    pointer.type = type.element;
    return;
  }
  if (type.kind == Type::Kind::kStruct && (step.dynamic || step.index >= type.members.size()))
    fail(inst, "member out of range");
  if (pointer.component) fail(inst, "index into a scalar");
  if (pointer.kind == Pointer::Kind::kLocal) {
    if (type.kind != Type::Kind::kStruct && type.kind != Type::Kind::kArray && type.kind != Type::Kind::kMatrix &&
        type.kind != Type::Kind::kVector)
      fail(inst, "index into a scalar");
    step_local(inst, type, pointer, step);
  } else if (pointer.kind == Pointer::Kind::kDescriptor || pointer.kind == Pointer::Kind::kTexel) {
    fail(inst, "index into an image or sampler");
  } else if (pointer.stage) {
    step_stage(t, inst, type, pointer, step);
  } else {
    step_memory(t, inst, type, pointer, step);
  }
  pointer.type = type.kind == Type::Kind::kStruct ? type.members[step.index] : type.element;
}

void access_chain(Translator& t, const Inst& inst, ir::Op) {
  Pointer pointer = pointer_of(t, inst.operand(0));
  for (std::uint32_t i = 1; inst.has(i); i++) step_into(t, inst, pointer, make_step(t, inst.operand(i)));
  t.pointers[inst.result] = std::move(pointer);
}

void pointer_access_chain(Translator& t, const Inst& inst, ir::Op) {
  Pointer pointer = pointer_of(t, inst.operand(0));
  if (pointer.kind != Pointer::Kind::kStorage && pointer.kind != Pointer::Kind::kShared &&
      pointer.kind != Pointer::Kind::kGlobal)
    fail(inst, "storage class is not supported");
  const Type& type = t.module.type(t.module.def(inst.operand(0)).result_type);
  const std::uint32_t natural = pointer.word_layout() ? 4 * t.module.type(pointer.type).scalars : 0;
  const std::uint32_t stride = natural != 0 ? natural : type.array_stride;
  if (stride == 0) fail(inst, "pointer type without ArrayStride");
  add_offset(t, pointer, make_step(t, inst.operand(1)), stride);
  for (std::uint32_t i = 2; inst.has(i); i++) step_into(t, inst, pointer, make_step(t, inst.operand(i)));
  t.pointers[inst.result] = std::move(pointer);
}

ir::ValueId add_scaled(Translator& t, ir::ValueId base, ir::ValueId index, std::uint32_t scale) {
  ir::ValueId scaled = index;
  if (scale != 1)
    scaled = (scale & (scale - 1)) == 0 && scale != 0
                 ? emit(t, ir::Op::kShl, 1, false,
                        {whole(index), whole(constant_u32(t, static_cast<std::uint32_t>(std::countr_zero(scale))))})
                 : emit(t, ir::Op::kIMul, 1, false, {whole(index), whole(constant_u32(t, scale))});
  return base == ir::kNoValue ? scaled : emit(t, ir::Op::kIAdd, 1, false, {whole(base), whole(scaled)});
}

}  // namespace vitrine::spirv::front

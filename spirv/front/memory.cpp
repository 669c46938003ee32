// Loads and stores through pointers: local variables become LoadVar / StoreVar of leaves, buffers and workgroup memory
// become loads and stores of consecutive words (SPIR-V 3.42.8; lavapipe-shader-math.md 10).
#include <algorithm>

#include "spirv/front/context.h"
#include "spirv/front/debugging.h"
#include "spirv/front/functions.h"
#include "spirv/front/interface.h"

namespace vitrine::spirv::front {
namespace {

std::uint32_t new_access(Translator& t, const Pointer& pointer, const std::vector<Step>& path) {
  t.accesses.push_back({pointer.local, path});
  return static_cast<std::uint32_t>(t.accesses.size() - 1);
}

std::vector<ir::Src> dynamic_sources(const std::vector<Step>& path) {
  std::vector<ir::Src> sources;
  for (const Step& step : path)
    if (step.dynamic) sources.push_back(whole(step.value));
  return sources;
}

ir::ValueId load_leaf_local(Translator& t, const Pointer& pointer, std::uint32_t leaf_type,
                            const std::vector<Step>& path) {
  const ir::ValueInfo info = leaf_info(t, leaf_type);
  const ir::ValueId value = emit(t, ir::Op::kLoadVar, info.components, info.boolean, dynamic_sources(path));
  last_instr(t).data[0] = new_access(t, pointer, path);
  return value;
}

void store_leaf_local(Translator& t, const Pointer& pointer, ir::ValueId value, const std::vector<Step>& path) {
  t.stored.emplace(pointer.local, path.empty() || path[0].dynamic ? kWholeVariable : path[0].index);
  std::vector<ir::Src> sources = dynamic_sources(path);
  sources.insert(sources.begin(), whole(value));
  emit_effect(t, ir::Op::kStoreVar, std::move(sources)).data[0] = new_access(t, pointer, path);
}

/// Visits the leaves below `path` in order: f(leaf type, path). The last step to a 64-bit number's words is 0 or 1.
template <class F>
void each_local_leaf(Translator& t, std::uint32_t type_id, std::vector<Step>& path, const F& f) {
  const Type& type = t.module.type(type_id);
  const bool is_struct = type.kind == Type::Kind::kStruct;
  const bool is_leaf = !is_struct && type.kind != Type::Kind::kArray && type.kind != Type::Kind::kMatrix;
  if (is_leaf && type.leaves < 2) return f(type_id, path);
  if (is_too_large(type)) throw Failure("variable of type %" + std::to_string(type_id) + " is too large");
  const std::uint32_t count = is_leaf     ? type.leaves
                              : is_struct ? static_cast<std::uint32_t>(type.members.size())
                                          : type.count;
  for (std::uint32_t i = 0; i < count; i++) {
    path.push_back({false, i, ir::kNoValue});
    if (is_leaf)
      f(type_id, path);
    else
      each_local_leaf(t, is_struct ? type.members[i] : type.element, path, f);
    path.pop_back();
  }
}

Value load_local(Translator& t, const Pointer& pointer) {
  Value value{pointer.type, {}};
  std::vector<Step> path = pointer.path;
  if (pointer.component) {
    // The pointee is one component; the leaves are those of the vector that holds it.
    const Step& component = *pointer.component;
    each_local_leaf(t, vector_type_of(t, pointer), path, [&](std::uint32_t vector, const std::vector<Step>& at) {
      const ir::ValueId leaf = load_leaf_local(t, pointer, vector, at);
      value.leaves.push_back(component.dynamic ? extract_dynamic(t, leaf, component.value)
                                               : extract(t, leaf, component.index));
    });
    return value;
  }
  each_local_leaf(t, pointer.type, path, [&](std::uint32_t leaf, const std::vector<Step>& at) {
    value.leaves.push_back(load_leaf_local(t, pointer, leaf, at));
  });
  return value;
}

void store_local(Translator& t, const Pointer& pointer, const Value& value) {
  std::vector<Step> path = pointer.path;
  std::size_t next = 0;
  if (pointer.component) {
    const Step& component = *pointer.component;
    each_local_leaf(t, vector_type_of(t, pointer), path, [&](std::uint32_t vector, const std::vector<Step>& at) {
      const ir::ValueId old = load_leaf_local(t, pointer, vector, at), scalar = value.leaves.at(next++);
      check_leaf(t, pointer.type, scalar);
      store_leaf_local(
          t, pointer,
          component.dynamic ? insert_dynamic(t, old, scalar, component.value) : insert(t, old, scalar, component.index),
          at);
    });
    return;
  }
  each_local_leaf(t, pointer.type, path, [&](std::uint32_t leaf, const std::vector<Step>& at) {
    check_leaf(t, leaf, value.leaves.at(next));
    store_leaf_local(t, pointer, value.leaves.at(next++), at);
  });
}

/// `count` words, or numbers of `size` bytes, from `byte` on.
ir::ValueId load_words(Translator& t, const Pointer& pointer, std::uint32_t count, std::uint32_t byte,
                       std::uint32_t size = 4) {
  Pointer at = pointer;
  at.constant_offset += byte;
  const std::uint32_t narrow = size == 4 ? 0 : size;
  const ir::Src offset = whole(dynamic_offset(t, at));
  if (at.kind == Pointer::Kind::kPush) {
    const ir::ValueId value = emit(t, ir::Op::kLoadPush, count, false, {offset});
    last_instr(t).data[0] = at.constant_offset;
    last_instr(t).imm[1] = narrow;
    return value;
  }
  if (at.kind == Pointer::Kind::kShared) {
    const ir::ValueId value = emit(t, ir::Op::kLoadShared, count, false, {offset});
    last_instr(t).data[3] = at.constant_offset;
    last_instr(t).imm[1] = narrow;
    last_instr(t).imm[2] = at.is_volatile ? 1 : 0;
    return value;
  }
  if (at.kind == Pointer::Kind::kGlobal) {
    const ir::ValueId value = emit(t, ir::Op::kLoadGlobal, count, false, {whole(at.low), whole(at.high), offset});
    last_instr(t).data[3] = at.constant_offset;
    last_instr(t).imm[1] = narrow;
    return value;
  }
  const ir::Op op = at.kind == Pointer::Kind::kUniform ? ir::Op::kLoadUniform : ir::Op::kLoadStorage;
  const ir::Src element = whole(descriptor_element(t, at));
  const ir::ValueId value = emit(t, op, count, false, {element, offset});
  set_buffer(last_instr(t), at);
  last_instr(t).imm[1] = narrow;
  last_instr(t).imm[2] = at.is_volatile ? 1 : 0;
  return value;
}

void store_words(Translator& t, const Pointer& pointer, ir::Src value, std::uint32_t count, std::uint32_t byte,
                 std::uint32_t size = 4) {
  Pointer at = pointer;
  at.constant_offset += byte;
  const ir::Src offset = whole(dynamic_offset(t, at));
  const std::uint32_t mask = (1u << count) - 1;
  if (at.kind == Pointer::Kind::kShared) {
    ir::Instr& instr = emit_effect(t, ir::Op::kStoreShared, {offset, value});
    instr.data[3] = at.constant_offset;
    instr.imm[0] = mask;
    instr.imm[1] = size == 4 ? 0 : size;
    return;
  }
  t.function.interface.writes_memory = true;
  if (at.kind == Pointer::Kind::kGlobal) {
    ir::Instr& instr = emit_effect(t, ir::Op::kStoreGlobal, {whole(at.low), whole(at.high), offset, value});
    instr.data[3] = at.constant_offset;
    instr.imm[0] = mask;
    instr.imm[1] = size == 4 ? 0 : size;
    return;
  }
  const ir::Src element = whole(descriptor_element(t, at));
  ir::Instr& instr = emit_effect(t, ir::Op::kStoreStorage, {element, offset, value});
  set_buffer(instr, at);
  instr.imm[0] = mask;
  instr.imm[1] = size == 4 ? 0 : size;
}

/// Memory below `pointer`, leaf by leaf: f(pointer to the leaf).
template <class F>
void each_memory_leaf(Translator& t, const Pointer& pointer, const F& f) {
  const Type& type = t.module.type(pointer.type);
  const bool is_struct = type.kind == Type::Kind::kStruct;
  if (!is_struct && type.kind != Type::Kind::kArray && type.kind != Type::Kind::kMatrix) return f(pointer);
  if (is_too_large(type)) throw Failure("value of type %" + std::to_string(type.id) + " is too large");
  const std::uint32_t count = is_struct ? static_cast<std::uint32_t>(type.members.size()) : type.count;
  for (std::uint32_t i = 0; i < count; i++) {
    Pointer part = pointer;
    step_into(t, *t.inst, part, {false, i, ir::kNoValue});
    each_memory_leaf(t, part, f);
  }
}

/// Words of the vector or scalar at `pointer` in memory order.
std::vector<ir::Src> load_adjacent(Translator& t, const Pointer& pointer, std::uint32_t count, std::uint32_t byte,
                                   std::uint32_t size) {
  std::vector<ir::Src> words;
  for (std::uint32_t first = 0; first < count; first += 4) {
    const std::uint32_t part = std::min(count - first, 4u);
    const ir::ValueId value = load_words(t, pointer, part, byte + size * first, size);
    for (std::uint8_t i = 0; i < part; i++) words.push_back(splat(value, i));
  }
  return words;
}

void store_adjacent(Translator& t, const Pointer& pointer, std::span<const ir::Src> words, std::uint32_t byte,
                    std::uint32_t size) {
  for (std::uint32_t first = 0; first < words.size(); first += 4) {
    const auto part = words.subspan(first, std::min<std::size_t>(words.size() - first, 4));
    const ir::ValueId value = vec(t, {part.begin(), part.end()}, false);
    store_words(t, pointer, whole(value), static_cast<std::uint32_t>(part.size()), byte + size * first, size);
  }
}

/// How a vector or scalar lies in memory.
struct Layout {
  std::uint32_t components, words;  ///< words: of a component
  std::uint32_t size;               ///< bytes of a component, or of one of its words
  std::uint32_t stride;             ///< bytes between components
  bool dense() const { return stride == size * words || components == 1; }
};

Layout layout_of(const Translator& t, const Pointer& pointer) {
  const std::uint32_t width = number_type(t, pointer.type).width;
  const bool in_word = width >= 32 || pointer.word_layout();
  return {leaf_info(t, pointer.type).components, t.module.type(pointer.type).leaves, in_word ? 4 : width / 8,
          component_bytes(t, pointer)};
}

void load_leaf_memory(Translator& t, const Pointer& pointer, std::vector<ir::ValueId>& leaves) {
  const ir::ValueInfo info = leaf_info(t, pointer.type);
  const Layout layout = layout_of(t, pointer);
  if (layout.dense() && layout.words == 1) {
    leaves.push_back(load_words(t, pointer, layout.components, 0, layout.size));
    if (pointer.stage) leaves.back() = from_interface(t, pointer.type, leaves.back());
  } else {
    std::vector<ir::Src> words;
    if (layout.dense()) words = load_adjacent(t, pointer, layout.components * layout.words, 0, layout.size);
    for (std::uint32_t i = 0; i < layout.components && !layout.dense(); i++)
      for (const ir::Src& word : load_adjacent(t, pointer, layout.words, i * layout.stride, layout.size))
        words.push_back(word);
    for (std::uint32_t part = 0; part < layout.words; part++) {
      std::vector<ir::Src> parts;
      for (std::uint32_t i = 0; i < layout.components; i++) parts.push_back(words[i * layout.words + part]);
      const bool one = parts.size() == 1;
      leaves.push_back(one ? extract(t, parts[0].value, parts[0].swizzle[0]) : vec(t, std::move(parts), false));
    }
  }
  if (!info.boolean) return;
  leaves.back() = emit(t, ir::Op::kINe, info.components, true, {whole(leaves.back()), splat(constant_u32(t, 0))});
}

/// `leaves`: those of the value at `pointer`.
void store_leaf_memory(Translator& t, const Pointer& pointer, std::span<const ir::ValueId> leaves) {
  for (const ir::ValueId leaf : leaves) check_leaf(t, pointer.type, leaf);
  const ir::ValueInfo info = leaf_info(t, pointer.type);
  const Layout layout = layout_of(t, pointer);
  ir::ValueId first = leaves[0];
  if (info.boolean) first = emit(t, ir::Op::kB2I, info.components, false, {whole(first)});
  if (pointer.stage) first = to_interface(t, pointer.type, first);
  if (layout.dense() && layout.words == 1)
    return store_words(t, pointer, whole(first), layout.components, 0, layout.size);
  std::vector<ir::Src> words;
  for (std::uint8_t i = 0; i < layout.components; i++)
    for (std::uint32_t part = 0; part < layout.words; part++)
      words.push_back(splat(part == 0 ? first : leaves[part], i));
  if (layout.dense()) return store_adjacent(t, pointer, words, 0, layout.size);
  for (std::uint32_t i = 0; i < layout.components; i++)
    store_adjacent(t, pointer, std::span(words).subspan(i * layout.words, layout.words), i * layout.stride,
                   layout.size);
}

bool is_memory(const Pointer& pointer) {
  return pointer.kind == Pointer::Kind::kUniform || pointer.kind == Pointer::Kind::kStorage ||
         pointer.kind == Pointer::Kind::kPush || pointer.kind == Pointer::Kind::kShared ||
         pointer.kind == Pointer::Kind::kGlobal;
}

ImageHandle load_handle(Translator& t, const Pointer& pointer) {
  ImageHandle handle;
  const Type& type = t.module.type(pointer.type);
  if (type.kind != Type::Kind::kSampler) {
    handle.image_type = type.kind == Type::Kind::kSampledImage ? type.element : type.id;
    handle.image = pointer.binding;
    handle.image_element = pointer.element;
  }
  if (type.kind != Type::Kind::kImage) {
    handle.sampler = pointer.binding;
    handle.sampler_element = pointer.element;
  }
  handle.combined = type.kind == Type::Kind::kSampledImage;
  return handle;
}

}  // namespace

std::uint32_t vector_type_of(const Translator& t, const Pointer& pointer) {
  std::uint32_t type = t.locals[pointer.local].type;
  for (const Step& step : pointer.path) {
    const Type& whole = t.module.type(type);
    type = whole.kind == Type::Kind::kStruct ? whole.members[step.index] : whole.element;
  }
  return type;
}

ir::ValueId dynamic_offset(Translator& t, const Pointer& pointer) {
  return pointer.offset == ir::kNoValue ? constant_u32(t, 0) : pointer.offset;
}

ir::ValueId descriptor_element(Translator& t, const Pointer& pointer) {
  return pointer.element == ir::kNoValue ? constant_u32(t, 0) : pointer.element;
}

void set_buffer(ir::Instr& instr, const Pointer& pointer) {
  instr.data[0] = pointer.binding.set;
  instr.data[1] = pointer.binding.slot;
  instr.data[2] = pointer.binding.count;
  instr.data[3] = pointer.constant_offset;
}

Value load(Translator& t, const Pointer& pointer) {
  if (pointer.kind == Pointer::Kind::kLocal) return load_local(t, pointer);
  if (!is_memory(pointer) || pointer.descriptor_array) throw Failure("load through this pointer is not supported");
  Value value{pointer.type, {}};
  each_memory_leaf(t, pointer, [&](const Pointer& leaf) { load_leaf_memory(t, leaf, value.leaves); });
  return value;
}

void store(Translator& t, const Pointer& pointer, const Value& value) {
  if (pointer.kind == Pointer::Kind::kLocal) return store_local(t, pointer, value);
  if (pointer.descriptor_array || (pointer.kind != Pointer::Kind::kStorage && pointer.kind != Pointer::Kind::kShared &&
                                   pointer.kind != Pointer::Kind::kGlobal))
    throw Failure("store through this pointer is not supported");
  std::size_t next = 0;
  each_memory_leaf(t, pointer, [&](const Pointer& leaf) {
    const std::uint32_t count = t.module.type(leaf.type).leaves;
    if (next + count > value.leaves.size()) throw Failure("value does not fit its type");
    store_leaf_memory(t, leaf, std::span(value.leaves).subspan(next, count));
    next += count;
  });
}

void store_raw(Translator& t, std::uint32_t local, ir::ValueId value) {
  store_leaf_local(t, local_pointer(t, local), value, {});
}

ir::ValueId load_raw(Translator& t, std::uint32_t local) {
  const ir::ValueInfo info = t.locals[local].info;
  const ir::ValueId value = emit(t, ir::Op::kLoadVar, info.components, info.boolean, {});
  last_instr(t).data[0] = new_access(t, local_pointer(t, local), {});
  return value;
}

void store_flag(Translator& t, std::uint32_t flag, bool value) {
  // A constant of this place: rewrites ask where it is made.
  const ir::ValueId word = emit(t, ir::Op::kConst, 1, true, {});
  last_instr(t).imm[0] = value ? 1 : 0;
  store_raw(t, flag, word);
}

ir::ValueId load_flag(Translator& t, std::uint32_t flag) { return load_raw(t, flag); }

void load_instruction(Translator& t, const Inst& inst, ir::Op) {
  const Pointer& pointer = pointer_of(t, inst.operand(0));
  if (pointer.kind == Pointer::Kind::kDescriptor) {
    if (pointer.descriptor_array) fail(inst, "load of a whole descriptor array is not supported");
    t.images[inst.result] = load_handle(t, pointer);
    return;
  }
  const bool is_volatile =
      pointer.is_volatile ||
      (inst.has(1) && (inst.operand(1) & static_cast<std::uint32_t>(spv::MemoryAccessMask::Volatile)) != 0);
  if (!is_volatile) {
    set_value(t, inst, load(t, pointer).leaves);
    return show_input(t, pointer, t.values[inst.result]);
  }
  // "the value of HelperInvocation changes" with demotion (Vulkan, Built-In Variables): read where it is loaded.
  const DecorationRow* built_in = t.module.decoration(pointer.variable, spv::Decoration::BuiltIn);
  if (built_in != nullptr && built_in->value == static_cast<std::uint32_t>(spv::BuiltIn::HelperInvocation))
    return is_helper(t, inst, ir::Op::kMov);
  Pointer marked = pointer;
  marked.is_volatile = true;
  set_value(t, inst, load(t, marked).leaves);
}

void store_instruction(Translator& t, const Inst& inst, ir::Op) {
  const Pointer pointer = pointer_of(t, inst.operand(0));
  store(t, pointer, value_of(t, inst.operand(1)));
  show_assignment(t, pointer, value_of(t, inst.operand(1)));
}

void copy_memory(Translator& t, const Inst& inst, ir::Op) {
  const Pointer target = pointer_of(t, inst.operand(0));
  const Pointer source = pointer_of(t, inst.operand(1));
  const Value value = load(t, source);
  store(t, target, value);
  show_assignment(t, target, value);
}

void function_variable(Translator& t, const Inst& inst, ir::Op) {
  const std::uint32_t type = t.module.type(inst.result_type).element;
  const Pointer pointer = local_pointer(t, new_local(t, type, spv::StorageClass::Function, inst.result));
  t.pointers[inst.result] = pointer;
  show_variable(t, pointer, inst.result);
  if (!inst.has(1)) return;
  store(t, pointer, value_of(t, inst.operand(1)));
  show_assignment(t, pointer, value_of(t, inst.operand(1)));
}

void array_length(Translator& t, const Inst& inst, ir::Op) {
  const Pointer pointer = pointer_of(t, inst.operand(0));
  if (pointer.kind != Pointer::Kind::kStorage) fail(inst, "is supported for storage buffers only");
  Pointer array = pointer;
  step_into(t, inst, array, {false, inst.operand(1), ir::kNoValue});
  const std::uint32_t stride = t.module.type(array.type).array_stride;
  if (stride == 0) fail(inst, "array without ArrayStride");
  const ir::ValueId value = emit(t, ir::Op::kArrayLength, 1, false, {whole(descriptor_element(t, pointer))});
  ir::Instr& instr = last_instr(t);
  set_buffer(instr, pointer);
  instr.imm = {array.constant_offset, stride, 0, 0};
  set_value(t, inst, value);
}

}  // namespace vitrine::spirv::front

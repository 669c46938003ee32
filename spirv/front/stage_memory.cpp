// Inputs and outputs that tessellation and geometry shaders have in memory: arrays of vertices, patches, emitted
// vertices (Vulkan, Shader Interfaces; Tessellation; Geometry Shading). They become loads and stores of workgroup
// memory at offsets that fixed function supplies.
#include "spirv/stage_memory.h"

#include <algorithm>
#include <utility>

#include "spirv/front/functions.h"
#include "spirv/front/interface.h"

namespace vitrine::spirv::front {
namespace {

using spv::Decoration;
using Kind = Type::Kind;

constexpr std::uint32_t kMaxLocations = 128;
/// Of an emitted vertex: its locations and built-ins.
constexpr std::uint32_t kMaxVertexWords = 4 * kMaxLocations + 128;

bool is_tess_level(const Translator& t, const Inst& variable) {
  const DecorationRow* row = t.module.decoration(variable.result, Decoration::BuiltIn);
  return row != nullptr && (row->value == static_cast<std::uint32_t>(spv::BuiltIn::TessLevelOuter) ||
                            row->value == static_cast<std::uint32_t>(spv::BuiltIn::TessLevelInner));
}

/// Not in memory, although HLSL declares it as a patch's or as an array.
bool is_tess_coord(const Translator& t, const Inst& variable) {
  const DecorationRow* row = t.module.decoration(variable.result, Decoration::BuiltIn);
  return row != nullptr && row->value == static_cast<std::uint32_t>(spv::BuiltIn::TessCoord);
}

/// The decoration may stand at the members of a block instead.
bool is_patch(const Translator& t, const Inst& variable) {
  if (t.module.decoration(variable.result, Decoration::Patch) != nullptr || is_tess_level(t, variable)) return true;
  const Type& type = t.module.type(t.module.type(variable.result_type).element);
  return type.kind == Kind::kStruct && t.module.decoration(type.id, Decoration::Patch, 1) != nullptr;
}

/// Locations that a value of this type takes.
std::uint32_t locations(const Translator& t, std::uint32_t type_id) {
  const Type& type = t.module.type(type_id);
  if (is_too_large(type)) throw Failure("interface variable is too large");
  std::uint32_t sum = 0;
  switch (type.kind) {
    case Kind::kStruct:
      for (const std::uint32_t member : type.members) sum += locations(t, member);
      return sum;
    case Kind::kArray:
    case Kind::kMatrix:
      return type.count * locations(t, type.element);
    default:
      return type.scalars > 4 ? 2 : 1;
  }
}

std::uint32_t location_word(bool patch, std::uint32_t location) {
  return (patch ? kPatchHeaderWords : kVertexHeaderWords) + 4 * location;
}

std::uint32_t end_of(const Inst& variable, std::uint32_t location, std::uint32_t count) {
  if (location > kMaxLocations || count > kMaxLocations - location) fail(variable, "location is too large");
  return location + count;
}

/// Locations up to the last one that the variable (of `type_id` per vertex) uses.
std::uint32_t locations_end(const Translator& t, const Inst& variable, std::uint32_t type_id) {
  const DecorationRow* location = t.module.decoration(variable.result, Decoration::Location);
  const bool built_in = t.module.decoration(variable.result, Decoration::BuiltIn) != nullptr;
  const Type& type = t.module.type(type_id);
  std::uint32_t end = location != nullptr ? end_of(variable, location->value, locations(t, type_id)) : 0;
  if (type.kind == Kind::kStruct) {
    for (std::uint32_t i = 0; i < type.members.size(); i++)
      if (const DecorationRow* row = t.module.decoration(type_id, Decoration::Location, i + 1))
        end = std::max(end, end_of(variable, row->value, locations(t, type.members[i])));
  }
  return built_in ? 0 : end;
}

std::uint32_t byte_of_built_in(const Inst& inst, std::uint32_t built_in) {
  const std::uint32_t word = built_in_word(built_in_row(inst, built_in).slot);
  if (word == kNoStageWord) fail(inst, "built-in " + std::to_string(built_in) + " is not supported in this place");
  return 4 * word;
}

void add(Translator& t, Pointer& pointer, const Step& step, std::uint32_t scale) {
  if (step.dynamic)
    pointer.offset = add_scaled(t, pointer.offset, step.value, scale);
  else
    pointer.constant_offset += step.index * scale;
}

/// Byte offset of an input vertex: a word of the invocation's row of the table.
ir::ValueId load_vertex_offset(Translator& t, ir::ValueId address, std::uint32_t added) {
  const ir::ValueId value = emit(t, ir::Op::kLoadShared, 1, false, {whole(address)});
  last_instr(t).data[3] = added;
  return value;
}

ir::ValueId vertex_offset(Translator& t, const Step& vertex) {
  const ir::ValueId row = built_in_input(t, BuiltIn::kVertexTable);
  if (vertex.dynamic) return load_vertex_offset(t, add_scaled(t, row, vertex.value, 4), 0);
  const auto known = t.vertex_offsets.find(vertex.index);
  if (known != t.vertex_offsets.end()) return known->second;
  ir::NodeList* const list = std::exchange(t.list, &t.prologue);
  const ir::ValueId offset = load_vertex_offset(t, row, 4 * vertex.index);
  t.list = list;
  return t.vertex_offsets[vertex.index] = offset;
}

void select_vertex(Translator& t, Pointer& pointer, const Step& step) {
  pointer.vertex_array = false;
  if (t.module.type(t.module.def(pointer.variable).result_type).storage == spv::StorageClass::Input) {
    pointer.offset = vertex_offset(t, step);
    return;
  }
  pointer.offset = built_in_input(t, BuiltIn::kPatchOffset);
  pointer.constant_offset += 4 * t.function.interface.modes.patch_words;
  add(t, pointer, step, 4 * t.function.interface.modes.vertex_words);
}

void step_member(Translator& t, const Inst& inst, const Type& type, Pointer& pointer, std::uint32_t index) {
  if (const DecorationRow* row = t.module.decoration(type.id, Decoration::BuiltIn, index + 1)) {
    pointer.constant_offset += byte_of_built_in(inst, row->value) - 4 * location_word(pointer.patch, 0);
    pointer.built_in = true;
    return;
  }
  if (const DecorationRow* row = t.module.decoration(type.id, Decoration::Location, index + 1)) {
    const DecorationRow* component = t.module.decoration(type.id, Decoration::Component, index + 1);
    pointer.constant_offset += 4 * (4 * row->value + (component != nullptr ? component->value : 0));
    return;
  }
  for (std::uint32_t i = 0; i < index; i++) pointer.constant_offset += 16 * locations(t, type.members[i]);
}

void store_word(Translator& t, ir::ValueId address, std::uint32_t word, ir::Src value, std::uint32_t components,
                bool exact) {
  ir::Instr& instr = emit_effect(t, ir::Op::kStoreShared, {whole(address), value});
  instr.data[3] = 4 * word;
  instr.imm[0] = (1u << components) - 1;
  instr.exact = exact;
}

/// Calls f(number of the local, leaf, its first word) for everything an emitted vertex holds.
template <class F>
std::uint32_t each_emitted(Translator& t, F&& f) {
  std::uint32_t word = 1;
  for (std::uint32_t i = 0; i < t.emitted_locals; i++) {
    const Local local = t.locals[i];
    if (local.storage != spv::StorageClass::Output) continue;
    t.inst = &t.module.def(local.variable);
    for (const Leaf& leaf : interface_leaves(t, local)) {
      f(i, leaf, word);
      word += t.module.type(leaf.type).scalars;
    }
  }
  return word;
}

void prepare_geometry(Translator& t) {
  for (const std::uint32_t id : t.module.interface) {
    const Inst& variable = t.module.def(id);
    if (variable.op == spv::Op::OpVariable && t.module.type(variable.result_type).storage == spv::StorageClass::Output)
      pointer_of(t, id);
  }
  t.emitted_locals = static_cast<std::uint32_t>(t.locals.size());
  t.function.interface.modes.vertex_words = each_emitted(t, [](std::uint32_t, const Leaf&, std::uint32_t) {});
  if (t.function.interface.modes.vertex_words > kMaxVertexWords) throw Failure("outputs of a vertex are too many");
  t.list = &t.prologue;
  t.emitted_local = new_local(t, ir::ValueInfo{1, false});
  store_raw(t, t.emitted_local, constant_u32(t, 0));
  for (std::uint32_t& local : t.starts_local) {
    local = new_local(t, ir::ValueInfo{1, false});
    store_raw(t, local, constant_u32(t, kEmitStarts));
  }
}

void prepare_control(Translator& t) {
  StageModes& modes = t.function.interface.modes;
  std::uint32_t vertex = 0, patch = 0;
  for (const std::uint32_t id : t.module.interface) {
    const Inst& variable = t.module.def(id);
    if (variable.op != spv::Op::OpVariable) continue;
    const Type& pointer = t.module.type(variable.result_type);
    if (pointer.storage != spv::StorageClass::Output) continue;
    if (is_patch(t, variable))
      patch = std::max(patch, locations_end(t, variable, pointer.element));
    else
      vertex = std::max(vertex, locations_end(t, variable, t.module.type(pointer.element).element));
  }
  modes.patch_words = location_word(true, patch);
  modes.vertex_words = location_word(false, vertex);
}

std::uint32_t stream_of(Translator& t, const Inst& inst) {
  if (inst.op == spv::Op::OpEmitVertex || inst.op == spv::Op::OpEndPrimitive) return 0;
  const std::uint32_t stream = t.module.constant_u32(inst.operand(0), inst);
  if (stream >= t.starts_local.size()) fail(inst, "vertex stream is out of range");
  return stream;
}

}  // namespace

bool in_stage_memory(const Translator& t, const Inst& variable) {
  const Type& pointer = t.module.type(variable.result_type);
  const bool input = pointer.storage == spv::StorageClass::Input;
  const bool arrayed = input && t.module.type(pointer.element).kind == Kind::kArray;
  if (input && is_tess_coord(t, variable)) return false;
  switch (t.options.stage) {
    case VK_SHADER_STAGE_GEOMETRY_BIT:
      return arrayed;
    case VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT:
      return arrayed || pointer.storage == spv::StorageClass::Output;
    case VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT:
      return arrayed || (input && is_patch(t, variable));
    default:
      return false;
  }
}

namespace {

Pointer place(Translator& t, const Inst& variable) {
  const Type& type = t.module.type(variable.result_type);
  Pointer pointer;
  pointer.kind = Pointer::Kind::kShared;
  pointer.stage = true;
  pointer.variable = variable.result;
  pointer.type = type.element;
  pointer.patch = is_patch(t, variable);
  pointer.vertex_array = !pointer.patch;
  if (pointer.patch) pointer.offset = built_in_input(t, BuiltIn::kPatchOffset);
  const std::uint32_t whole_type = pointer.patch ? type.element : t.module.type(type.element).element;
  if (type.storage == spv::StorageClass::Input && !pointer.patch) {
    std::uint32_t& end = t.function.interface.modes.input_locations;
    end = std::max(end, locations_end(t, variable, whole_type));
  }
  if (const DecorationRow* row = t.module.decoration(variable.result, Decoration::BuiltIn)) {
    pointer.built_in = true;
    pointer.constant_offset = byte_of_built_in(variable, row->value);
    return pointer;
  }
  const DecorationRow* location = t.module.decoration(variable.result, Decoration::Location);
  const DecorationRow* component = t.module.decoration(variable.result, Decoration::Component);
  pointer.constant_offset = 4 * (location_word(pointer.patch, location != nullptr ? location->value : 0) +
                                 (component != nullptr ? component->value : 0));
  return pointer;
}

}  // namespace

Pointer stage_pointer(Translator& t, const Inst& variable) {
  const Pointer pointer = place(t, variable);
  if (variable.has(1)) {
    const Inst* const inst = std::exchange(t.inst, &variable);
    ir::NodeList* const list = std::exchange(t.list, &t.prologue);
    store(t, pointer, value_of(t, variable.operand(1)));
    t.list = list;
    t.inst = inst;
  }
  return pointer;
}

void step_stage(Translator& t, const Inst& inst, const Type& type, Pointer& pointer, const Step& step) {
  if (pointer.vertex_array) return select_vertex(t, pointer, step);
  switch (type.kind) {
    case Kind::kStruct:
      return step_member(t, inst, type, pointer, step.index);
    case Kind::kArray:
      return add(t, pointer, step,
                 pointer.built_in ? 4 * t.module.type(type.element).scalars : 16 * locations(t, type.element));
    case Kind::kMatrix:
      return add(t, pointer, step, 16);
    case Kind::kVector:
      return add(t, pointer, step, 4 * t.module.type(type.element).scalars);
    default:
      fail(inst, "index into a scalar");
  }
}

void prepare_stage(Translator& t) {
  if (t.options.stage == VK_SHADER_STAGE_GEOMETRY_BIT) prepare_geometry(t);
  if (t.options.stage == VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT) prepare_control(t);
}

void emit_vertex(Translator& t, const Inst& inst, ir::Op) {
  const StageModes& modes = t.function.interface.modes;
  const ir::Origin fallback = std::exchange(t.fallback, origin_here(t));
  const std::uint32_t stream = stream_of(t, inst);
  const ir::ValueId count = load_raw(t, t.emitted_local);
  const ir::ValueId limit = constant_u32(t, modes.max_vertices);
  const ir::ValueId room = emit(t, ir::Op::kULt, 1, true, {whole(count), whole(limit)});
  ir::Node& node = emit_node(t, ir::Node::Kind::kIf);
  node.condition = whole(room);
  ir::NodeList* const list = std::exchange(t.list, &node.then_list);
  const ir::ValueId address = add_scaled(t, built_in_input(t, BuiltIn::kEmitOffset), count, 4 * modes.vertex_words);
  const ir::ValueId starts = load_raw(t, t.starts_local[stream]);
  const ir::ValueId flags = emit(t, ir::Op::kOr, 1, false, {whole(starts), whole(constant_u32(t, stream))});
  store_word(t, address, 0, whole(flags), 1, false);
  each_emitted(t, [&](std::uint32_t local, const Leaf& leaf, std::uint32_t word) {
    Pointer pointer = local_pointer(t, local);
    pointer.path = leaf.path;
    pointer.type = leaf.type;
    const std::vector<ir::ValueId> values = load(t, pointer).leaves;
    if (values.size() == 1)
      return store_word(t, address, word, whole(to_interface(t, leaf.type, values[0])), components(t, values[0]),
                        leaf.invariant);
    for (std::uint32_t i = 0; i < t.module.type(leaf.type).scalars; i++) {
      const ir::Src part = splat(values[i % values.size()], static_cast<std::uint8_t>(i / values.size()));
      store_word(t, address, word + i, part, 1, leaf.invariant);
    }
  });
  t.inst = &inst;
  store_raw(t, t.starts_local[stream], constant_u32(t, 0));
  const ir::ValueId next = emit(t, ir::Op::kIAdd, 1, false, {whole(count), whole(constant_u32(t, 1))});
  store_raw(t, t.emitted_local, next);
  t.list = list;
  t.fallback = fallback;
}

void end_primitive(Translator& t, const Inst& inst, ir::Op) {
  store_raw(t, t.starts_local[stream_of(t, inst)], constant_u32(t, kEmitStarts));
}

void finish_emission(Translator& t) {
  each_emitted(t, [&](std::uint32_t local, const Leaf& leaf, std::uint32_t word) {
    // Stores record their first step; of a 64-bit number that is the word.
    const bool wide = t.module.type(leaf.type).leaves > 1;
    const std::uint32_t first = !leaf.path.empty() ? leaf.path[0].index : wide ? 0 : kWholeVariable;
    const bool captured = leaf.slot.xfb_buffer < kMaxXfbBuffers;  // whatever it holds
    if (!captured && t.stored.count({local, first}) == 0 && t.stored.count({local, kWholeVariable}) == 0) return;
    for (std::uint32_t i = 0; i < t.module.type(leaf.type).scalars; i++) {
      InterfaceSlot slot = word_slot(leaf, i);
      slot.reg = word + i;
      t.function.interface.emitted.push_back(slot);
    }
  });
  t.list = &t.function.body;
  const ir::ValueId count = load_raw(t, t.emitted_local);
  emit_effect(t, ir::Op::kStoreOutput, {whole(count)}).data[0] =
      static_cast<std::uint32_t>(t.function.interface.outputs.size());
  InterfaceSlot slot;
  slot.built_in = BuiltIn::kEmittedVertices;
  slot.type = BaseType::kUint;
  t.function.interface.outputs.push_back(slot);
}

}  // namespace vitrine::spirv::front

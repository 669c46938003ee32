// The shader's interface: numbered locations and built-ins as InterfaceSlots (Vulkan, Shader
// Interfaces; Built-In Variables). Inputs are stored to their variables before the body, outputs loaded after it.
#include "spirv/front/interface.h"

#include <algorithm>
#include <utility>

#include "spirv/front/functions.h"
#include "spirv/stage_memory.h"

namespace vitrine::spirv::front {
namespace {

using spv::Decoration;
using Kind = Type::Kind;

/// The value is composed by subgroup_built_in().
constexpr ir::Op kOfSubgroup = ir::Op::kCount;
/// 0 in every invocation.
constexpr ir::Op kZero = ir::Op::kConst;

constexpr BuiltInRow kBuiltIns[] = {
    {spv::BuiltIn::VertexIndex, BuiltIn::kVertexIndex, ir::Op::kLoadInput, 1},
    {spv::BuiltIn::InstanceIndex, BuiltIn::kInstanceIndex, ir::Op::kLoadInput, 1},
    {spv::BuiltIn::BaseVertex, BuiltIn::kBaseVertex, ir::Op::kLoadInput, 1},
    {spv::BuiltIn::BaseInstance, BuiltIn::kBaseInstance, ir::Op::kLoadInput, 1},
    {spv::BuiltIn::DrawIndex, BuiltIn::kDrawIndex, ir::Op::kLoadInput, 1},
    {spv::BuiltIn::ViewIndex, BuiltIn::kViewIndex, ir::Op::kLoadInput, 1},
    {spv::BuiltIn::Position, BuiltIn::kPosition, ir::Op::kLoadInput, 4},
    {spv::BuiltIn::PointSize, BuiltIn::kPointSize, ir::Op::kLoadInput, 1},
    {spv::BuiltIn::ClipDistance, BuiltIn::kClipDistance, ir::Op::kLoadInput, 1},
    {spv::BuiltIn::CullDistance, BuiltIn::kCullDistance, ir::Op::kLoadInput, 1},
    {spv::BuiltIn::Layer, BuiltIn::kLayer, ir::Op::kLoadInput, 1},
    {spv::BuiltIn::ViewportIndex, BuiltIn::kViewportIndex, ir::Op::kLoadInput, 1},
    {spv::BuiltIn::PrimitiveShadingRateKHR, BuiltIn::kPrimitiveShadingRate, ir::Op::kLoadInput, 1},
    {spv::BuiltIn::ShadingRateKHR, BuiltIn::kShadingRate, ir::Op::kLoadInput, 1},
    {spv::BuiltIn::FragCoord, BuiltIn::kFragCoord, ir::Op::kLoadInput, 4},
    {spv::BuiltIn::FrontFacing, BuiltIn::kFrontFacing, ir::Op::kLoadInput, 1},
    {spv::BuiltIn::PointCoord, BuiltIn::kPointCoord, ir::Op::kLoadInput, 2},
    {spv::BuiltIn::BaryCoordKHR, BuiltIn::kBaryCoord, ir::Op::kLoadInput, 3},
    {spv::BuiltIn::BaryCoordNoPerspKHR, BuiltIn::kBaryCoordNoPersp, ir::Op::kLoadInput, 3},
    {spv::BuiltIn::SampleId, BuiltIn::kSampleId, ir::Op::kLoadInput, 1},
    {spv::BuiltIn::SamplePosition, BuiltIn::kSamplePosition, ir::Op::kLoadInput, 2},
    {spv::BuiltIn::SampleMask, BuiltIn::kSampleMask, ir::Op::kLoadInput, 1},
    {spv::BuiltIn::PrimitiveId, BuiltIn::kPrimitiveId, ir::Op::kLoadInput, 1},
    {spv::BuiltIn::InvocationId, BuiltIn::kInvocationId, ir::Op::kLoadInput, 1},
    {spv::BuiltIn::PatchVertices, BuiltIn::kPatchVertices, ir::Op::kLoadInput, 1},
    {spv::BuiltIn::TessCoord, BuiltIn::kTessCoord, ir::Op::kLoadInput, 3},
    {spv::BuiltIn::TessLevelOuter, BuiltIn::kTessLevelOuter, ir::Op::kLoadInput, 1},
    {spv::BuiltIn::TessLevelInner, BuiltIn::kTessLevelInner, ir::Op::kLoadInput, 1},
    {spv::BuiltIn::FragDepth, BuiltIn::kFragDepth, ir::Op::kLoadInput, 1},
    {spv::BuiltIn::FragStencilRefEXT, BuiltIn::kFragStencilRef, ir::Op::kLoadInput, 1},
    {spv::BuiltIn::DeviceIndex, BuiltIn::kNone, kZero, 1},
    {spv::BuiltIn::HelperInvocation, BuiltIn::kNone, ir::Op::kHelperInvocation, 1},
    {spv::BuiltIn::WorkgroupId, BuiltIn::kNone, ir::Op::kWorkgroupId, 3},
    {spv::BuiltIn::NumWorkgroups, BuiltIn::kNone, ir::Op::kNumWorkgroups, 3},
    {spv::BuiltIn::LocalInvocationId, BuiltIn::kNone, ir::Op::kLocalInvocationId, 3},
    {spv::BuiltIn::GlobalInvocationId, BuiltIn::kNone, ir::Op::kGlobalInvocationId, 3},
    {spv::BuiltIn::LocalInvocationIndex, BuiltIn::kNone, ir::Op::kLocalInvocationIndex, 1},
    {spv::BuiltIn::SubgroupSize, BuiltIn::kNone, kOfSubgroup, 1},
    {spv::BuiltIn::SubgroupLocalInvocationId, BuiltIn::kNone, kOfSubgroup, 1},
    {spv::BuiltIn::SubgroupId, BuiltIn::kNone, kOfSubgroup, 1},
    {spv::BuiltIn::NumSubgroups, BuiltIn::kNone, kOfSubgroup, 1},
    {spv::BuiltIn::SubgroupEqMask, BuiltIn::kNone, kOfSubgroup, 4},
    {spv::BuiltIn::SubgroupGeMask, BuiltIn::kNone, kOfSubgroup, 4},
    {spv::BuiltIn::SubgroupGtMask, BuiltIn::kNone, kOfSubgroup, 4},
    {spv::BuiltIn::SubgroupLeMask, BuiltIn::kNone, kOfSubgroup, 4},
    {spv::BuiltIn::SubgroupLtMask, BuiltIn::kNone, kOfSubgroup, 4},
};

/// A decoration of the variable or of the struct member it is in.
struct Decorated {
  const Module& module;
  std::uint32_t variable = 0;
  std::uint32_t block = 0, member = 0;  ///< member number + 1

  const DecorationRow* find(Decoration kind) const {
    if (member != 0)
      if (const DecorationRow* row = module.decoration(block, kind, member)) return row;
    return module.decoration(variable, kind);
  }
  bool has(Decoration kind) const { return find(kind) != nullptr; }
};

/// Bits of the widest number in it.
std::uint32_t widest_number(const Translator& t, std::uint32_t type_id) {
  const Type& type = t.module.type(type_id);
  if (type.kind == Kind::kArray || type.kind == Kind::kMatrix || type.kind == Kind::kVector)
    return widest_number(t, type.element);
  if (type.kind != Kind::kStruct) return type.width;
  std::uint32_t width = 0;
  for (const std::uint32_t member : type.members) width = std::max(width, widest_number(t, member));
  return width;
}

struct Walk {
  Translator& t;
  const Inst& variable;
  bool input = false;
  std::vector<Leaf> leaves;
  std::vector<Step> path;
  std::uint32_t location = 0;
  std::uint32_t element = 0;  ///< scalars of the built-in so far (ClipDistance[i])
  bool captured = false;      ///< by transform feedback
  std::uint32_t xfb_offset = 0;
  std::uint32_t block = 0;  ///< number of the block in an array of them
  InputPart part = InputPart::kValue;

  void leaf(std::uint32_t type_id, const Decorated& decorated) {
    Leaf leaf;
    leaf.path = path;
    leaf.type = type_id;
    const ir::ValueInfo info = leaf_info(t, type_id);
    InterfaceSlot& slot = leaf.slot;
    const Type& type = t.module.type(type_id);
    const Type& number = type.kind == Kind::kVector ? t.module.type(type.element) : type;
    slot.type = number.kind == Kind::kFloat && number.width <= 32 ? BaseType::kFloat
                : number.kind == Kind::kInt && number.is_signed   ? BaseType::kInt
                                                                  : BaseType::kUint;
    if (const DecorationRow* row = decorated.find(Decoration::BuiltIn)) {
      leaf.built_in = &built_in_row(variable, row->value);
      slot.built_in = leaf.built_in->slot;
      slot.component = static_cast<std::uint8_t>(element);
      element += info.components;
      if (element > 64) fail(variable, "built-in array is too large");
    } else {
      if (location > 127) fail(variable, "location is too large");
      const std::uint32_t words = info.components * type.leaves;
      slot.location = static_cast<std::uint16_t>(location);
      location += words > 4 ? 2 : 1;
      const DecorationRow* component = decorated.find(Decoration::Component);
      slot.component = component ? static_cast<std::uint8_t>(component->value) : std::uint8_t{0};
      if (slot.component + words > (words > 4 ? 8u : 4u)) fail(variable, "components do not fit the location");
      if (const DecorationRow* index = decorated.find(Decoration::Index))
        slot.index = static_cast<std::uint8_t>(index->value);
    }
    interpolation(slot, decorated);
    if (!input) feedback(slot, decorated, info.components * type.leaves, number.width);
    leaf.invariant = decorated.has(Decoration::Invariant);
    leaves.push_back(std::move(leaf));
  }

  void interpolation(InterfaceSlot& slot, const Decorated& decorated) const {
    slot.part = part;
    if (decorated.has(Decoration::Flat) || slot.type != BaseType::kFloat || is_of_vertex(part))
      slot.interpolation = Interpolation::kFlat;
    else if (decorated.has(Decoration::NoPerspective) || slot.built_in == BuiltIn::kBaryCoordNoPersp)
      slot.interpolation = Interpolation::kLinear;
    if (decorated.has(Decoration::Sample))
      slot.sample_location = SampleLocation::kSample;
    else if (decorated.has(Decoration::Centroid))
      slot.sample_location = SampleLocation::kCentroid;
  }

  /// Transform feedback: leaves of a captured variable or block member lie one after the other; the blocks of an array
  /// go to consecutive buffers.
  /// `words`: of the leaf; `width`: bits of a number.
  void feedback(InterfaceSlot& slot, const Decorated& decorated, std::uint32_t words, std::uint32_t width) {
    const DecorationRow* stream = decorated.find(Decoration::Stream);
    if (stream != nullptr) slot.stream = static_cast<std::uint8_t>(stream->value & 3);
    if (!captured) return;
    const DecorationRow* buffer = decorated.find(Decoration::XfbBuffer);
    slot.xfb_buffer = static_cast<std::uint8_t>(((buffer != nullptr ? buffer->value : 0) + block) % kMaxXfbBuffers);
    slot.xfb_offset = xfb_offset;
    if (width == 16) slot.xfb_offset |= slot.type == BaseType::kFloat ? kXfbHalf : kXfbShort;
    xfb_offset += captured_bytes(slot.xfb_offset) * words;
    if (const DecorationRow* stride = decorated.find(Decoration::XfbStride))
      t.function.interface.xfb_stride[slot.xfb_buffer] = stride->value;
  }

  void start_capture(const DecorationRow* offset) {
    captured = offset != nullptr;
    if (captured) xfb_offset = offset->value & kXfbBytes;
  }

  /// Whatever is captured lies at a multiple of the bytes of its widest number.
  void align_capture(std::uint32_t type_id) {
    if (!captured) return;
    const std::uint32_t bytes = std::max(widest_number(t, type_id) / 8, 1u);
    xfb_offset = (xfb_offset + bytes - 1) & ~(bytes - 1);
  }

  /// PerVertexKHR: an array of what the vertices of the primitive have, each at the same locations (Vulkan 1.3.239,
  /// Interface Matching).
  void vertices(std::uint32_t type_id, const Decorated& decorated) {
    const Type& array = t.module.type(type_id);
    if (array.kind != Kind::kArray || array.count > 3) fail(variable, "what vertices have is an array of three");
    for (std::uint32_t i = 0, first = location; i < array.count; i++) {
      location = first;
      part = static_cast<InputPart>(static_cast<std::uint32_t>(InputPart::kVertex0) + i);
      path.push_back({false, i, ir::kNoValue});
      type(array.element, decorated);
      path.pop_back();
    }
    part = InputPart::kValue;
  }

  void type(std::uint32_t type_id, Decorated decorated) {
    const Type& type_here = t.module.type(type_id);
    if (is_too_large(type_here)) fail(variable, "interface variable is too large");
    align_capture(type_id);
    const bool is_struct = type_here.kind == Kind::kStruct;
    if (!is_struct && type_here.kind != Kind::kArray && type_here.kind != Kind::kMatrix)
      return leaf(type_id, decorated);
    if (type_here.scalars > 4096) fail(variable, "interface variable is too large");
    const std::uint32_t count = is_struct ? static_cast<std::uint32_t>(type_here.members.size()) : type_here.count;
    for (std::uint32_t i = 0; i < count; i++) {
      path.push_back({false, i, ir::kNoValue});
      if (is_struct) {
        // Members of a block carry decorations of their own; nested structs count on.
        if (decorated.member == 0) {
          decorated.block = type_id;
          decorated.member = i + 1;
          if (const DecorationRow* row = t.module.decoration(type_id, Decoration::Location, i + 1))
            location = row->value;
          // Members of a block are captured one by one, those of a structure follow its first.
          const DecorationRow* offset = t.module.decoration(type_id, Decoration::Offset, i + 1);
          const bool is_block = t.module.decoration(type_id, Decoration::Block) != nullptr;
          if (!input && (is_block || offset != nullptr)) start_capture(offset);
          element = 0;
        }
        type(type_here.members[i], decorated);
        if (decorated.block == type_id && decorated.member == i + 1) decorated.member = 0;
      } else {
        type(type_here.element, decorated);
      }
      path.pop_back();
    }
    if (is_struct && decorated.member == 0 && t.module.decoration(type_id, Decoration::Block) != nullptr) block++;
  }
};

/// Whether an input is decorated PerVertexKHR, or the blocks that it is an array of are.
bool is_per_vertex(const Translator& t, const Local& local) {
  if (t.options.stage != VK_SHADER_STAGE_FRAGMENT_BIT || local.storage != spv::StorageClass::Input) return false;
  if (t.module.decoration(local.variable, Decoration::PerVertexKHR) != nullptr) return true;
  const Type& array = t.module.type(local.type);
  if (array.kind != Kind::kArray) return false;
  const Type& block = t.module.type(array.element);
  for (std::uint32_t i = 0; block.kind == Kind::kStruct && i < block.members.size(); i++)
    if (t.module.decoration(block.id, Decoration::PerVertexKHR, i + 1) != nullptr) return true;
  return false;
}

std::vector<ir::ValueId> input_values(Translator& t, const Leaf& leaf) {
  const ir::ValueInfo info = leaf_info(t, leaf.type);
  if (leaf.built_in != nullptr && leaf.built_in->op == kOfSubgroup) return {subgroup_built_in(t, leaf.built_in->spirv)};
  if (leaf.built_in != nullptr && leaf.built_in->op == kZero) return {constant_u32(t, 0)};
  if (leaf.built_in != nullptr && leaf.built_in->slot == BuiltIn::kNone)
    return {emit(t, leaf.built_in->op, leaf.built_in->components, info.boolean, {})};
  const std::uint32_t words = t.module.type(leaf.type).leaves;
  std::vector<std::vector<ir::Src>> parts(words);
  for (std::uint32_t i = 0; i < info.components * words; i++)
    parts[i % words].push_back(whole(load_input(t, word_slot(leaf, i))));
  std::vector<ir::ValueId> values;
  for (auto& part : parts) values.push_back(vec(t, std::move(part), false));
  if (info.boolean)
    values[0] = emit(t, ir::Op::kINe, info.components, true, {whole(values[0]), splat(constant_u32(t, 0))});
  else
    values[0] = from_interface(t, leaf.type, values[0]);
  return values;
}

void store_outputs(Translator& t, const Leaf& leaf, std::vector<ir::ValueId> values) {
  values[0] = to_interface(t, leaf.type, values[0]);
  const auto words = static_cast<std::uint32_t>(values.size());
  for (std::uint32_t i = 0; i < components(t, values[0]) * words; i++) {
    ir::Instr& instr =
        emit_effect(t, ir::Op::kStoreOutput, {splat(values[i % words], static_cast<std::uint8_t>(i / words))});
    instr.data[0] = static_cast<std::uint32_t>(t.function.interface.outputs.size());
    instr.exact = leaf.invariant;
    t.function.interface.outputs.push_back(word_slot(leaf, i));
  }
}

/// Outputs that the shader does not name have the value of their initializer all the same.
void declare_initialized(Translator& t) {
  for (const std::uint32_t id : t.module.interface) {
    const Inst& variable = t.module.def(id);
    if (variable.op == spv::Op::OpVariable && variable.has(1) &&
        t.module.type(variable.result_type).storage == spv::StorageClass::Output)
      pointer_of(t, id);
  }
}

/// Fragment outputs that reach no attachment are dead.
bool is_live(const Translator& t, const Leaf& leaf) {
  if (t.options.stage != VK_SHADER_STAGE_FRAGMENT_BIT || leaf.slot.built_in != BuiltIn::kNone) return true;
  return leaf.slot.location < 32 && (t.options.live_color_outputs >> leaf.slot.location & 1) != 0;
}

}  // namespace

const BuiltInRow& built_in_row(const Inst& variable, std::uint32_t built_in) {
  for (const BuiltInRow& row : kBuiltIns)
    if (static_cast<std::uint32_t>(row.spirv) == built_in) return row;
  fail(variable, "built-in " + std::to_string(built_in) + " is not supported");
}

InterfaceSlot word_slot(const Leaf& leaf, std::uint32_t word) {
  InterfaceSlot slot = leaf.slot;
  slot.xfb_offset += captured_bytes(slot.xfb_offset) * word;
  if (slot.built_in != BuiltIn::kNone) {
    slot.component = static_cast<std::uint8_t>(slot.component + word);
    return slot;
  }
  const std::uint32_t component = slot.component + word;
  slot.location = static_cast<std::uint16_t>(slot.location + component / 4);
  slot.component = static_cast<std::uint8_t>(component % 4);
  return slot;
}

std::vector<Leaf> interface_leaves(Translator& t, const Local& local) {
  const Inst& variable = t.module.def(local.variable);
  Walk walk{t, variable, local.storage == spv::StorageClass::Input, {}, {}, 0, 0, false, 0, 0, InputPart::kValue};
  if (const DecorationRow* row = t.module.decoration(local.variable, Decoration::Location)) walk.location = row->value;
  if (!walk.input) walk.start_capture(t.module.decoration(local.variable, Decoration::Offset));
  const Decorated decorated{t.module, local.variable, 0, 0};
  is_per_vertex(t, local) ? walk.vertices(local.type, decorated) : walk.type(local.type, decorated);
  return std::move(walk.leaves);
}

ir::ValueId load_input(Translator& t, const InterfaceSlot& slot) {
  // Nothing supplies inputs of compute shaders: zero, which is as good as any value.
  if (t.options.stage == VK_SHADER_STAGE_COMPUTE_BIT) return constant_u32(t, 0);
  // Fixed function fills one register per component of a built-in, however it is declared.
  const Interpolation mode = slot.built_in == BuiltIn::kNone ? slot.interpolation : Interpolation::kPerspective;
  const Translator::InputKey key{slot.built_in, slot.location, slot.component, mode, slot.part, slot.sample_location};
  if (const auto known = t.loaded_inputs.find(key); known != t.loaded_inputs.end()) {
    for (InterfaceSlot& loaded : t.function.interface.inputs)
      if (loaded.built_in == slot.built_in && loaded.component == slot.component) loaded.implied &= slot.implied;
    return known->second;
  }
  const ir::ValueId value = emit(t, ir::Op::kLoadInput, 1, false, {});
  last_instr(t).data[0] = static_cast<std::uint32_t>(t.function.interface.inputs.size());
  t.function.interface.inputs.push_back(slot);
  t.loaded_inputs.emplace(key, value);
  return value;
}

ir::ValueId built_in_input(Translator& t, BuiltIn built_in, std::uint8_t component) {
  ir::NodeList* const list = std::exchange(t.list, &t.prologue);
  InterfaceSlot slot;
  slot.built_in = built_in;
  slot.component = component;
  slot.type = BaseType::kUint;
  const ir::ValueId value = load_input(t, slot);
  t.list = list;
  return value;
}

ir::ValueId fragment_position(Translator& t) {
  ir::NodeList* const list = std::exchange(t.list, &t.prologue);
  const bool exact = std::exchange(t.exact, false);
  std::vector<ir::Src> parts;
  InterfaceSlot slot;
  slot.built_in = BuiltIn::kFragCoord;
  for (slot.component = 0; slot.component < 2; slot.component++)
    parts.push_back(whole(emit(t, ir::Op::kF2I, 1, false, {whole(load_input(t, slot))})));
  // The layer is that of the view or, without views, that of the primitive.
  slot.built_in = BuiltIn::kViewIndex;
  slot.component = 0;
  slot.type = BaseType::kInt;
  const ir::ValueId view = load_input(t, slot);
  slot.built_in = BuiltIn::kLayer;
  slot.implied = true;
  parts.push_back(whole(emit(t, ir::Op::kIAdd, 1, false, {whole(view), whole(load_input(t, slot))})));
  const ir::ValueId position = vec(t, std::move(parts), false);
  t.list = list;
  t.exact = exact;
  return position;
}

void connect_interface(Translator& t) {
  declare_initialized(t);
  t.inst = nullptr;
  t.exact = false;
  for (std::uint32_t i = 0; i < t.locals.size(); i++) {
    const Local local = t.locals[i];
    const bool input = local.storage == spv::StorageClass::Input;
    if (!input && local.storage != spv::StorageClass::Output) continue;
    t.inst = &t.module.def(local.variable);
    if (!input && t.options.stage == VK_SHADER_STAGE_GEOMETRY_BIT) continue;  // emitted
    for (const Leaf& leaf : interface_leaves(t, local)) {
      if (!input && !is_live(t, leaf)) continue;
      Pointer pointer = local_pointer(t, i);
      pointer.path = leaf.path;
      pointer.type = leaf.type;
      t.list = input ? &t.prologue : &t.function.body;
      if (input)
        store(t, pointer, {leaf.type, input_values(t, leaf)});
      else
        store_outputs(t, leaf, load(t, pointer).leaves);
    }
  }
  if (t.options.stage == VK_SHADER_STAGE_GEOMETRY_BIT) finish_emission(t);
  t.inst = nullptr;
  for (auto& node : t.function.body) t.prologue.push_back(std::move(node));
  t.function.body = std::move(t.prologue);
}

}  // namespace vitrine::spirv::front

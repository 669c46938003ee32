// Splits SPIR-V words into instructions and reads the declarations of a module (SPIR-V 1.6, section 2.4: logical
// layout).
#include "spirv/front/parse.h"

#include <algorithm>

#include "spirv/front/sources.h"
#include "spirv/newer_numbers.h"

namespace vitrine::spirv::front {

using spv::Op;

namespace {

constexpr std::size_t kMaxDecorations = std::size_t{1} << 20;

std::uint32_t string_words(const Inst& inst, std::uint32_t operand) {
  return static_cast<std::uint32_t>(string_at(inst, operand).size() / 4 + 1);
}

ExtSet ext_set(const std::string& name) {
  if (name == "GLSL.std.450") return kExtGlsl450;
  if (name == "NonSemantic.Shader.DebugInfo.100") return kExtDebugInfo;
  if (name == "NonSemantic.DebugPrintf") return kExtDebugPrintf;
  if (name.rfind("NonSemantic.", 0) == 0) return kExtNonSemantic;
  return kExtUnknown;
}

std::uint32_t saturating(std::uint64_t value) {
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(value, UINT32_MAX));
}

/// Pointers that are values: an address, or a buffer and an offset.
void set_pointer_size(Type& type) {
  switch (type.storage) {
    case spv::StorageClass::PhysicalStorageBuffer:
    case spv::StorageClass::StorageBuffer:
    case spv::StorageClass::Workgroup:
      type.width = 64;
      type.leaves = type.scalars = 2;
      break;
    default:
      break;
  }
}

/// A pointer type that structures use before it is declared.
void read_forward_pointer(Module& module, const Inst& inst) {
  Type type;
  type.kind = Type::Kind::kPointer;
  type.id = inst.operand(0);
  type.storage = static_cast<spv::StorageClass>(inst.operand(1));
  set_pointer_size(type);
  if (!module.types.emplace(type.id, type).second) fail(inst, "the type is declared already");
}

/// What was made of a pointer that was announced holds for the pointer that is declared.
void check_announced(const Module& module, const Inst& inst, const Type& type) {
  const auto announced = module.types.find(type.id);
  if (announced == module.types.end()) return;
  if (type.kind != Type::Kind::kPointer || announced->second.storage != type.storage)
    fail(inst, "is not the pointer that OpTypeForwardPointer announced");
}

void expect(const Inst& inst, bool fits) {
  if (!fits) fail(inst, "a type cannot consist of this one");
}

bool is_scalar(const Type& type) {
  return type.kind == Type::Kind::kBool || type.kind == Type::Kind::kInt || type.kind == Type::Kind::kFloat;
}

void read_type(Module& module, const Inst& inst) {
  Type type;
  using Kind = Type::Kind;
  type.id = inst.operand(0);
  auto element = [&](Kind kind) -> const Type& {
    type.kind = kind;
    type.element = inst.operand(1);
    const Type& of = module.type(type.element);
    type.depth_of_nesting = of.depth_of_nesting + 1;
    return of;
  };
  auto repeat = [&](const Type& of, std::uint64_t count) {
    type.count = saturating(count);
    type.leaves = saturating(of.leaves * count);
    type.scalars = saturating(of.scalars * count);
    type.parts = saturating(of.parts * count + 1);
  };
  switch (inst.op) {
    case Op::OpTypeVoid:
      type.kind = Kind::kVoid;
      break;
    case Op::OpTypeBool:
      type.kind = Kind::kBool;
      type.width = 32;
      type.leaves = type.scalars = 1;
      break;
    case Op::OpTypeInt:
    case Op::OpTypeFloat:
      type.kind = inst.op == Op::OpTypeInt ? Kind::kInt : Kind::kFloat;
      type.width = inst.operand(1);
      type.is_signed = inst.op == Op::OpTypeInt && inst.operand(2) != 0;
      if ((type.width != 8 || inst.op == Op::OpTypeFloat) && type.width != 16 && type.width != 32 && type.width != 64)
        fail(inst, "unsupported width");
      type.leaves = type.scalars = type.width == 64 ? 2 : 1;
      break;
    case Op::OpTypeVector:
      repeat(element(Kind::kVector), inst.operand(2));
      if (type.count < 2 || type.count > 4) fail(inst, "unsupported vector size");
      expect(inst, is_scalar(module.type(type.element)));
      type.leaves = module.type(type.element).leaves;
      type.parts = 1;
      break;
    case Op::OpTypeMatrix:
      repeat(element(Kind::kMatrix), inst.operand(2));
      if (type.count < 2 || type.count > 4) fail(inst, "unsupported matrix size");
      expect(inst, module.type(type.element).kind == Kind::kVector);
      break;
    case Op::OpTypeArray:
      repeat(element(Kind::kArray), module.constant_u32(inst.operand(2), inst));
      break;
    case Op::OpTypeRuntimeArray:
      element(Kind::kRuntimeArray);
      break;
    case Op::OpTypeStruct: {
      type.kind = Kind::kStruct;
      std::uint64_t leaves = 0, scalars = 0, parts = 1;
      for (std::uint32_t i = 1; inst.has(i); i++) {
        const Type& member = module.type(inst.operand(i));
        type.members.push_back(member.id);
        type.depth_of_nesting = std::max(type.depth_of_nesting, member.depth_of_nesting + 1);
        leaves += member.leaves;
        scalars += member.scalars;
        parts += member.parts;
      }
      type.leaves = saturating(leaves);
      type.scalars = saturating(scalars);
      type.parts = saturating(parts);
      break;
    }
    case Op::OpTypePointer:
      type.kind = Kind::kPointer;
      type.storage = static_cast<spv::StorageClass>(inst.operand(1));
      type.element = inst.operand(2);
      set_pointer_size(type);
      break;
    case Op::OpTypeImage:
      element(Kind::kImage);
      type.dim = static_cast<spv::Dim>(inst.operand(2));
      type.depth = inst.operand(3) == 1;
      type.arrayed = inst.operand(4) != 0;
      type.multisampled = inst.operand(5) != 0;
      type.format = static_cast<spv::ImageFormat>(inst.operand(7));
      break;
    case Op::OpTypeSampler:
      type.kind = Kind::kSampler;
      break;
    case Op::OpTypeSampledImage:
      expect(inst, element(Kind::kSampledImage).kind == Kind::kImage);
      break;
    case Op::OpTypeFunction:
      type.kind = Kind::kFunction;
      type.element = inst.operand(1);
      for (std::uint32_t i = 2; inst.has(i); i++) type.members.push_back(inst.operand(i));
      break;
    default:
      break;
  }
  if (type.depth_of_nesting > kMaxTypeDepth) fail(inst, "type is too deeply nested");
  if (const DecorationRow* stride = module.decoration(type.id, spv::Decoration::ArrayStride))
    type.array_stride = stride->value;
  check_announced(module, inst, type);
  module.types[type.id] = std::move(type);
}

void read_decoration(Module& module, const Inst& inst) {
  DecorationRow row;
  row.id = inst.operand(0);
  std::uint32_t next = 1;
  if (inst.op == Op::OpMemberDecorate) {
    row.member = inst.operand(next++);
    if (row.member > UINT32_MAX - 1) fail(inst, "member number too large");
    row.member++;
  }
  row.kind = static_cast<spv::Decoration>(inst.operand(next++));
  if (inst.has(next)) row.value = inst.operand(next);
  module.decorations.push_back(row);
}

void read_group_decoration(Module& module, const Inst& inst) {
  const std::uint32_t group = inst.operand(0);
  const bool members = inst.op == Op::OpGroupMemberDecorate;
  const std::size_t before = module.decorations.size();
  for (std::uint32_t i = 1; inst.has(i); i += members ? 2 : 1)
    for (std::size_t row = 0; row < before; row++) {
      if (module.decorations[row].id != group) continue;
      DecorationRow copy = module.decorations[row];
      copy.id = inst.operand(i);
      if (members) copy.member = inst.operand(i + 1) + 1;
      module.decorations.push_back(copy);
      if (module.decorations.size() > kMaxDecorations) fail(inst, "too many decorations");
    }
}

/// What has a result and its type, and a number of its own in opcodes.def or newer_numbers.h.
bool is_numbered(Op op) {
  if (newer::is_replicated_constant(op) || op == newer::kExtInstWithForwardRefs) return true;
  switch (static_cast<std::uint32_t>(op)) {
#define VITRINE_OPCODE(name, function, op, effect)
#define VITRINE_NUMBERED_OPCODE(name, number, function, op, effect) case number:
#include "spirv/opcodes.def"
#undef VITRINE_OPCODE
#undef VITRINE_NUMBERED_OPCODE
    return true;
    default:
      return false;
  }
}

/// Splits the words into instructions.
void split(Module& module, std::span<const std::uint32_t> words) {
  if (words.size() < 5 || words[0] != spv::MagicNumber) throw Failure("not a SPIR-V module");
  for (std::size_t at = 5; at < words.size();) {
    const std::uint32_t length = words[at] >> 16;
    if (length == 0 || length > words.size() - at) throw Failure("SPIR-V instruction runs past the end of the module");
    Inst inst;
    inst.words = words.subspan(at, length);
    inst.op = static_cast<Op>(words[at] & 0xffff);
    bool has_result = false, has_type = false;
    spv::HasResultAndType(inst.op, &has_result, &has_type);
    if (is_numbered(inst.op)) has_result = has_type = true;
    // All that differs is that operands may be defined below, and those of sets without meaning are only looked up.
    if (inst.op == newer::kExtInstWithForwardRefs) inst.op = Op::OpExtInst;
    if (has_type) inst.result_type = inst.words.size() > inst.first ? inst.words[inst.first] : 0, inst.first++;
    if (has_result) inst.result = inst.words.size() > inst.first ? inst.words[inst.first] : 0, inst.first++;
    if (inst.first > inst.words.size()) throw Failure("SPIR-V instruction is too short");
    // Types keep their own id as operand 0, so that operands count as in the specification's table of a type.
    if (has_result && !has_type && spv::Op::OpTypeVoid <= inst.op && inst.op <= spv::Op::OpTypeFunction) inst.first--;
    inst.origin = {inst.result, 0};
    if (has_result && inst.result == 0) throw Failure("SPIR-V instruction defines the id 0");
    // All tables go by id: what an id means must never change.
    const auto index = static_cast<std::uint32_t>(module.code.size());
    if (has_result && !module.definition.emplace(inst.result, index).second) fail(inst, "the id is defined already");
    module.code.push_back(inst);
    at += length;
  }
}

spv::ExecutionModel model_of(VkShaderStageFlagBits stage) {
  switch (stage) {
    case VK_SHADER_STAGE_VERTEX_BIT:
      return spv::ExecutionModel::Vertex;
    case VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT:
      return spv::ExecutionModel::TessellationControl;
    case VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT:
      return spv::ExecutionModel::TessellationEvaluation;
    case VK_SHADER_STAGE_GEOMETRY_BIT:
      return spv::ExecutionModel::Geometry;
    case VK_SHADER_STAGE_FRAGMENT_BIT:
      return spv::ExecutionModel::Fragment;
    case VK_SHADER_STAGE_COMPUTE_BIT:
      return spv::ExecutionModel::GLCompute;
    default:
      throw Failure("shader stage is not supported");
  }
}

/// Entry point, its execution modes, imports, decorations: everything that may be referred to before it is declared.
void read_preamble(Module& module, const CompileOptions& options) {
  const spv::ExecutionModel model = model_of(options.stage);
  for (const Inst& inst : module.code) switch (inst.op) {
      case Op::OpEntryPoint: {
        if (static_cast<spv::ExecutionModel>(inst.operand(0)) != model || string_at(inst, 2) != options.entry_point)
          break;
        module.entry_function = inst.operand(1);
        for (std::uint32_t i = 2 + string_words(inst, 2); inst.has(i); i++) module.interface.push_back(inst.operand(i));
        break;
      }
      case Op::OpExtInstImport:
        module.ext_imports[inst.result] = ext_set(string_at(inst, 0));
        break;
      case Op::OpDecorate:
      case Op::OpDecorateId:
      case Op::OpMemberDecorate:
        read_decoration(module, inst);
        break;
      case Op::OpGroupDecorate:
      case Op::OpGroupMemberDecorate:
        read_group_decoration(module, inst);
        break;
      default:
        break;
    }
  if (module.entry_function == 0) throw Failure("no entry point \"" + options.entry_point + "\" for this stage");
  for (const Inst& inst : module.code)
    if ((inst.op == Op::OpExecutionMode || inst.op == Op::OpExecutionModeId) &&
        inst.operand(0) == module.entry_function)
      module.modes.push_back(inst);
  std::stable_sort(
      module.decorations.begin(), module.decorations.end(),
      [](const DecorationRow& a, const DecorationRow& b) { return a.id != b.id ? a.id < b.id : a.member < b.member; });
}

void read_functions(Module& module) {
  Function function;
  Block block;
  bool inside = false;
  for (std::uint32_t i = 0; i < module.code.size(); i++) {
    const Inst& inst = module.code[i];
    if (inst.op == Op::OpFunction) {
      function = {inst.result, {}, 0};
    } else if (inst.op == Op::OpFunctionParameter) {
      function.params.push_back(inst.result);
    } else if (inst.op == Op::OpFunctionEnd) {
      module.functions[function.id] = function;
    } else if (inst.op == Op::OpLabel) {
      if (function.entry == 0) function.entry = inst.result;
      block = {};
      block.label = inst.result;
      block.first = i + 1;
      inside = true;
    } else if (inst.op == Op::OpSelectionMerge || inst.op == Op::OpLoopMerge) {
      block.merge_op = inst.op;
      block.merge = inst.operand(0);
      if (inst.op == Op::OpLoopMerge) block.continue_target = inst.operand(1);
    } else if (is_block_end(inst.op) && inside) {
      block.last = i;
      module.blocks[block.label] = block;
      inside = false;
    }
  }
}

bool has_workgroup_blocks(const Module& module) {
  return std::any_of(module.globals.begin(), module.globals.end(), [&](std::uint32_t index) {
    const Type& pointer = module.type(module.code[index].result_type);
    return pointer.storage == spv::StorageClass::Workgroup &&
           module.decoration(pointer.element, spv::Decoration::Block) != nullptr;
  });
}

}  // namespace

Module parse_module(std::span<const std::uint32_t> words, const CompileOptions& options, SourceTexts texts) {
  Module module;
  split(module, words);
  read_sources(module, words, options.entry_point, texts);
  read_preamble(module, options);
  bool in_function = false;
  for (std::uint32_t i = 0; i < module.code.size(); i++) {
    const Inst& inst = module.code[i];
    if (inst.op == Op::OpFunction) in_function = true;
    if (Op::OpTypeVoid <= inst.op && inst.op <= Op::OpTypeFunction) read_type(module, inst);
    if (inst.op == Op::OpTypeForwardPointer) read_forward_pointer(module, inst);
    if ((Op::OpConstantTrue <= inst.op && inst.op <= Op::OpSpecConstantOp) || newer::is_replicated_constant(inst.op))
      fold_constant(module, inst, options);
    if (inst.op == Op::OpUndef && !in_function) fold_constant(module, inst, options);
    if (inst.op == Op::OpVariable && !in_function) module.globals.push_back(i);
    module.votes_in_quads |= inst.op == newer::kQuadAny || inst.op == newer::kQuadAll;
  }
  module.has_workgroup_blocks = has_workgroup_blocks(module);
  read_functions(module);
  return module;
}

}  // namespace vitrine::spirv::front

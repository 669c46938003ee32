// What a module calls the inputs of its entry point: OpName and OpMemberName, or DebugGlobalVariable of
// NonSemantic.Shader.DebugInfo.100 where a variable has no OpName.
#include <spirv/unified1/NonSemanticShaderDebugInfo100.h>

#include "spirv/front/debug_types.h"
#include "spirv/front/debugging.h"
#include "spirv/front/interface.h"

namespace vitrine::spirv::front {
namespace {

using Kind = SourceType::Kind;

/// Operands of a DebugGlobalVariable, the set and the instruction in front of them.
constexpr std::uint32_t kName = 2, kVariable = 9;

/// By OpVariable.
std::unordered_map<std::uint32_t, std::string> global_names(const Module& module) {
  std::unordered_map<std::uint32_t, std::string> names;
  for (const Inst& inst : module.code) {
    if (inst.op != spv::Op::OpExtInst || !inst.has(kVariable)) continue;
    const auto set = module.ext_imports.find(inst.operand(0));
    if (set == module.ext_imports.end() || set->second != kExtDebugInfo) continue;
    if (inst.operand(1) != NonSemanticShaderDebugInfo100DebugGlobalVariable) continue;
    const auto text = module.definition.find(inst.operand(kName));
    if (text == module.definition.end() || module.code[text->second].op != spv::Op::OpString) continue;
    names[inst.operand(kVariable)] = string_at(module.code[text->second], 0);
  }
  return names;
}

/// The name of a leaf. Members of a block without a name stand for themselves, as in GLSL; a variable without one has
/// none, however its members are called.
std::string name_of(const Module& module, const DebugTypes& names, std::string variable, const Local& local,
                    const Leaf& leaf) {
  const Type* type = &module.type(local.type);
  if (variable.empty() && type->kind != Type::Kind::kStruct) return {};
  for (const Step& step : leaf.path) {
    if (type->kind != Type::Kind::kStruct) {
      variable += '[' + std::to_string(step.index) + ']';
      type = &module.type(type->element);
      continue;
    }
    const std::string member = names.member_name(type->id, step.index);
    if (variable.empty() && member == '_' + std::to_string(step.index)) return {};
    variable += (variable.empty() ? "" : ".") + member;
    type = &module.type(type->members[step.index]);
  }
  return variable;
}

SourceInput input_of(const Module& module, const Leaf& leaf) {
  const Type& type = module.type(leaf.type);
  const Type& number = type.kind == Type::Kind::kVector ? module.type(type.element) : type;
  SourceInput input;
  input.built_in = leaf.slot.built_in;
  input.location = leaf.slot.location;
  input.component = leaf.slot.component;
  input.part = leaf.slot.part;
  input.wide = number.width == 64;
  input.words = static_cast<std::uint8_t>((type.kind == Type::Kind::kVector ? type.count : 1) * (input.wide ? 2 : 1));
  input.kind = number.kind == Type::Kind::kBool    ? Kind::kBool
               : number.kind == Type::Kind::kFloat ? Kind::kFloat
               : number.is_signed                  ? Kind::kInt
                                                   : Kind::kUint;
  return input;
}

}  // namespace

std::vector<SourceInput> input_names(Translator& t) {
  SourceVariables tables;
  const DebugTypes names(t.module, tables);
  const auto globals = global_names(t.module);
  std::vector<SourceInput> inputs;
  for (const Local& local : t.locals) {
    if (local.storage != spv::StorageClass::Input || local.variable == 0) continue;
    t.inst = &t.module.def(local.variable);
    std::string variable = names.name(local.variable);
    if (const auto global = globals.find(local.variable); variable.empty() && global != globals.end())
      variable = global->second;
    for (const Leaf& leaf : interface_leaves(t, local)) {
      // What no register holds, as gl_HelperInvocation.
      if (leaf.built_in != nullptr && leaf.built_in->slot == BuiltIn::kNone) continue;
      SourceInput input = input_of(t.module, leaf);
      input.name = name_of(t.module, names, variable, local, leaf);
      inputs.push_back(std::move(input));
    }
  }
  t.inst = nullptr;
  return inputs;
}

}  // namespace vitrine::spirv::front

// Probes of what the specification leaves undefined: operations for some operands, derivatives and barriers where
// invocations are missing, OpUnreachable; and of floating-point results.
#include <spirv/unified1/GLSL.std.450.h>
#include <vulkan/vulkan_core.h>

#include "spirv/front/functions.h"

namespace vitrine::spirv::front {
namespace {

using spv::Op;

bool takes_derivatives(Op op) {
  switch (op) {
    case Op::OpDPdx:
    case Op::OpDPdy:
    case Op::OpFwidth:
    case Op::OpDPdxFine:
    case Op::OpDPdyFine:
    case Op::OpFwidthFine:
    case Op::OpDPdxCoarse:
    case Op::OpDPdyCoarse:
    case Op::OpFwidthCoarse:
    case Op::OpImageSampleImplicitLod:
    case Op::OpImageSampleDrefImplicitLod:
    case Op::OpImageSampleProjImplicitLod:
    case Op::OpImageSampleProjDrefImplicitLod:
    case Op::OpImageSparseSampleImplicitLod:
    case Op::OpImageSparseSampleDrefImplicitLod:
    case Op::OpImageQueryLod:
      return true;
    default:
      return false;
  }
}

/// Operations that are undefined for some operands (SPIR-V 3.49.13, 3.49.11, 3.49.14): all their operands are numbers.
bool may_be_undefined(Op op) {
  switch (op) {
    case Op::OpUDiv:
    case Op::OpSDiv:
    case Op::OpUMod:
    case Op::OpSRem:
    case Op::OpSMod:
    case Op::OpFRem:
    case Op::OpFMod:
    case Op::OpShiftLeftLogical:
    case Op::OpShiftRightLogical:
    case Op::OpShiftRightArithmetic:
    case Op::OpBitFieldInsert:
    case Op::OpBitFieldSExtract:
    case Op::OpBitFieldUExtract:
    case Op::OpConvertFToU:
    case Op::OpConvertFToS:
      return true;
    default:
      return false;
  }
}

/// The same of GLSL.std.450.
bool function_may_be_undefined(std::uint32_t number) {
  switch (number) {
    case GLSLstd450Asin:
    case GLSLstd450Acos:
    case GLSLstd450Acosh:
    case GLSLstd450Atanh:
    case GLSLstd450Pow:
    case GLSLstd450Log:
    case GLSLstd450Log2:
    case GLSLstd450Sqrt:
    case GLSLstd450InverseSqrt:
    case GLSLstd450FClamp:
    case GLSLstd450UClamp:
    case GLSLstd450SClamp:
    case GLSLstd450NClamp:
    case GLSLstd450SmoothStep:
      return true;
    default:
      return false;
  }
}

/// Operations whose result is a number made of numbers: what merely hands on a value makes no NaN.
bool computes_float(Op op) {
  switch (op) {
    case Op::OpFAdd:
    case Op::OpFSub:
    case Op::OpFMul:
    case Op::OpFDiv:
    case Op::OpFRem:
    case Op::OpFMod:
    case Op::OpVectorTimesScalar:
    case Op::OpDot:
    case Op::OpFConvert:
    case Op::OpConvertUToF:
    case Op::OpConvertSToF:
    case Op::OpQuantizeToF16:
      return true;
    default:
      return false;
  }
}

bool is_glsl(const Translator& t, const Inst& inst) {
  if (inst.op != Op::OpExtInst) return false;
  const auto set = t.module.ext_imports.find(inst.operand(0));
  return set != t.module.ext_imports.end() && set->second == kExtGlsl450;
}

/// Whether the instruction's value is a scalar or vector of floats.
bool is_float(const Translator& t, std::uint32_t type) {
  const Type* kind = &t.module.type(type);
  if (kind->kind == Type::Kind::kVector) kind = &t.module.type(kind->element);
  return kind->kind == Type::Kind::kFloat;
}

/// Whether a probe can read the operand: a number, boolean or vector.
bool is_plain_value(const Translator& t, std::uint32_t id) {
  const Inst& definition = t.module.def(id);
  if (definition.result_type == 0) return false;
  const Type* type = &t.module.type(definition.result_type);
  if (type->kind == Type::Kind::kVector) type = &t.module.type(type->element);
  return type->kind == Type::Kind::kInt || type->kind == Type::Kind::kFloat || type->kind == Type::Kind::kBool;
}

void probe_operation(Translator& t, const Inst& inst, bool with_result) {
  Probe probe;
  probe.kind = Probe::Kind::kOperation;
  probe.id = inst.result;
  probe.opcode = static_cast<std::uint16_t>(inst.op);
  probe.has_result = with_result;
  const bool glsl = is_glsl(t, inst);
  probe.number = glsl ? inst.operand(1) : number_type(t, inst.result_type).width;
  std::vector<ir::Src> words;
  for (std::uint32_t i = glsl ? 2 : 0; inst.has(i); ++i) {
    if (!is_plain_value(t, inst.operand(i))) return;
    probe.values.push_back(probe_value(t, inst, inst.operand(i), words));
  }
  if (with_result) probe.values.push_back(probe_value(t, inst, inst.result, words));
  emit_probe(t, std::move(probe), std::move(words));
}

}  // namespace

void probe_before(Translator& t, const Inst& inst) {
  Probe probe;
  probe.id = inst.result;
  probe.opcode = static_cast<std::uint16_t>(inst.op);
  if (takes_derivatives(inst.op) && t.options.stage == VK_SHADER_STAGE_FRAGMENT_BIT) {
    probe.kind = Probe::Kind::kQuad;
  } else if (inst.op == Op::OpControlBarrier && (t.options.stage == VK_SHADER_STAGE_COMPUTE_BIT ||
                                                 t.options.stage == VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT)) {
    const auto* scope = constant_of(t, index_word(t, inst.operand(0)));
    if (scope == nullptr || (*scope)[0] != static_cast<std::uint32_t>(spv::Scope::Workgroup)) return;
    probe.kind = Probe::Kind::kBarrier;
  } else if (inst.op == Op::OpUnreachable) {
    probe.kind = Probe::Kind::kUnreachable;
  } else {
    return;
  }
  emit_probe(t, std::move(probe), {});
}

void probe_after(Translator& t, const Inst& inst) {
  const bool glsl = is_glsl(t, inst);
  const bool undefined =
      t.interest.arithmetic && (glsl ? function_may_be_undefined(inst.operand(1)) : may_be_undefined(inst.op));
  const bool number = t.interest.numbers && (glsl || computes_float(inst.op)) && is_float(t, inst.result_type);
  if (undefined || number) probe_operation(t, inst, number);
}

}  // namespace vitrine::spirv::front

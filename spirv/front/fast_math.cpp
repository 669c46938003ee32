// What may be done to floating-point numbers where the module says it (SPV_KHR_float_controls2): FPFastMathMode of
// instructions, FPFastMathDefault of the entry point.
#include "spirv/front/expression.h"
#include "spirv/newer_numbers.h"

namespace vitrine::spirv::front {
namespace {

using Mask = spv::FPFastMathModeMask;

constexpr std::uint32_t kFast = static_cast<std::uint32_t>(Mask::Fast);
/// The rewrites make no difference between what contracts, reassociates and transforms; AllowTransform comes with the
/// other two.
constexpr std::uint32_t kRewrites = newer::kAllowTransform | static_cast<std::uint32_t>(Mask::AllowRecip);
constexpr std::uint32_t kOrdinaryNumbers = static_cast<std::uint32_t>(Mask::NotNaN) |
                                           static_cast<std::uint32_t>(Mask::NotInf) |
                                           static_cast<std::uint32_t>(Mask::NSZ);

bool allows(std::uint32_t mode, std::uint32_t all) { return (mode & kFast) != 0 || (mode & all) == all; }

/// Bits of the floats that a type consists of, of structures the first member's; 0: it is no such type.
std::uint32_t float_width(const Module& module, std::uint32_t id) {
  const Type* type = &module.type(id);
  while (type->kind != Type::Kind::kFloat) {
    const bool grouped =
        type->kind == Type::Kind::kVector || type->kind == Type::Kind::kMatrix || type->kind == Type::Kind::kArray;
    if (type->kind == Type::Kind::kStruct && !type->members.empty())
      type = &module.type(type->members[0]);
    else if (grouped)
      type = &module.type(type->element);
    else
      return 0;
  }
  return type->width;
}

/// Of the result, else of the first operand: what compares and converts gives other numbers.
std::uint32_t float_width(const Module& module, const Inst& inst) {
  if (inst.result_type == 0) return 0;
  if (const std::uint32_t width = float_width(module, inst.result_type); width != 0) return width;
  const std::uint32_t first = inst.op == spv::Op::OpExtInst ? 2 : 0;
  if (!inst.has(first)) return 0;
  const auto operand = module.definition.find(inst.operand(first));
  if (operand == module.definition.end()) return 0;
  const std::uint32_t type = module.code[operand->second].result_type;
  return type == 0 || module.types.count(type) == 0 ? 0 : float_width(module, type);
}

/// NaN, infinities and the sign of zero count for numbers of `width` bits, to the end.
void keep_specials(ir::Function& function, std::uint32_t width) {
  function.signed_zero_inf_nan_preserve |= width == 32;
  function.inexact_off |= static_cast<std::uint8_t>(width & (16 | 64));
  function.strict_specials |= static_cast<std::uint8_t>(width & (16 | 32 | 64));
}

bool is_default(const Inst& mode) {
  return static_cast<spv::ExecutionMode>(mode.operand(1)) == newer::kFPFastMathDefault;
}

}  // namespace

void read_fast_math(Translator& t) {
  const Module& module = t.module;
  for (const Inst& mode : module.modes) {
    if (!is_default(mode)) continue;
    if (!t.fast_math_defaults) t.fast_math_defaults.emplace();
    const std::uint32_t width = float_width(module, mode.operand(2));
    if (width == 0) fail(mode, "operand is not a floating-point type");
    (*t.fast_math_defaults)[width] = module.constant_u32(mode.operand(3), mode);
  }
  // "any type for which a default is not set uses no fast math flags"
  if (t.fast_math_defaults)
    for (const std::uint32_t width : {16u, 32u, 64u})
      if (!allows((*t.fast_math_defaults)[width], kOrdinaryNumbers)) keep_specials(t.function, width);
  // The rewrites know it of whole shaders.
  for (const DecorationRow& row : module.decorations) {
    if (row.kind != spv::Decoration::FPFastMathMode || allows(row.value, kOrdinaryNumbers)) continue;
    const auto decorated = module.definition.find(row.id);
    if (decorated == module.definition.end()) continue;
    keep_specials(t.function, float_width(module, module.code[decorated->second]));
  }
}

bool is_exact(const Translator& t, const Inst& inst) {
  if (inst.result == 0) return false;
  if (const DecorationRow* mode = t.module.decoration(inst.result, spv::Decoration::FPFastMathMode))
    return !allows(mode->value, kRewrites);
  if (t.module.decoration(inst.result, spv::Decoration::NoContraction) != nullptr) return true;
  if (!t.fast_math_defaults) return false;
  const auto mode = t.fast_math_defaults->find(float_width(t.module, inst));
  return mode != t.fast_math_defaults->end() && !allows(mode->second, kRewrites);
}

}  // namespace vitrine::spirv::front

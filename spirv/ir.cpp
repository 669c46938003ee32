// The rows of ops.def, intrinsics.def and wide_ops.def as data.
#include "spirv/ir.h"

namespace vitrine::spirv::ir {
namespace {

constexpr char kF = 'F', kI = 'I', kU = 'U', kB = 'B', kD = 'D', kL = 'L', kQ = 'Q';
#define VITRINE_STRING(x) #x
constexpr AluInfo kAluInfos[] = {
#define VITRINE_ALU(name, sources, result, operands, swap, chain, effect) \
  {#name, sources, k##result, VITRINE_STRING(operands), #swap[0], 0},
#include "spirv/ops.def"
#define VITRINE_NIR(name, sources, result, operands, swap, reads, effect) \
  {#name, sources, k##result, VITRINE_STRING(operands), #swap[0], reads},
#include "spirv/ops.def"
};
constexpr WideInfo kWideInfos[] = {
#define VITRINE_WIDE(name, result, operands, effect) {#name, k##result, VITRINE_STRING(operands)},
#include "spirv/wide_ops.def"
#undef VITRINE_WIDE
};
#undef VITRINE_STRING

constexpr const char* kIntrinsicNames[] = {
#define VITRINE_INTRINSIC(name, sources, result, effect) #name,
#include "spirv/intrinsics.def"
#undef VITRINE_INTRINSIC
};

}  // namespace

const AluInfo& alu_info(Op op) { return kAluInfos[static_cast<std::size_t>(op)]; }

const WideInfo& wide_info(Op op) {
  return kWideInfos[static_cast<std::size_t>(op) - static_cast<std::size_t>(Op::kIntrinsicEnd) - 1];
}

std::uint32_t components_read(Op op, std::uint32_t width, std::uint32_t components, std::size_t index) {
  if (op >= Op::kExecutedCount && alu_info(op).reads != 0) return alu_info(op).reads;
  if (width != 64) return components;
  return is_selection(op) || alu_info(op).operands[index] == 'F' ? 2 : 1;
}

std::uint32_t components_read(const Instr& instr, std::size_t index) {
  return components_read(instr.op, instr.width, instr.components, index);
}

const char* op_name(Op op) {
  if (op < Op::kAluCount) return alu_info(op).name;
  if (is_wide(op)) return wide_info(op).name;
  if (op == Op::kAluCount || op >= Op::kIntrinsicEnd) return "?";
  return kIntrinsicNames[static_cast<std::size_t>(op) - static_cast<std::size_t>(Op::kAluCount) - 1];
}

}  // namespace vitrine::spirv::ir

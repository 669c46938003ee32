// What instructions say of the order of accesses: Memory Operands, Image Operands, scopes, Memory Semantics and the
// decoration Coherent (SPIR-V 3.20 Decoration, 3.25 Memory Semantics, 3.26 Memory Operands, 3.27 Scope).
#include "spirv/memory_order.h"

#include "spirv/front/functions.h"

namespace vitrine::spirv::front {
namespace {

using spv::Decoration;
using spv::Op;

bool is_marked(const Translator& t, std::uint32_t id) {
  for (const DecorationRow& row : t.module.decorations_of(id))
    if (row.kind == Decoration::Coherent || row.kind == Decoration::Volatile) return true;
  return false;
}

/// The variable that a pointer, or an image, leads back to; 0: nobody knows.
std::uint32_t variable_of(const Translator& t, std::uint32_t id) {
  for (std::uint32_t steps = 0; steps < 64; ++steps) {
    if (const auto pointer = t.pointers.find(id); pointer != t.pointers.end() && pointer->second.variable != 0)
      return pointer->second.variable;
    if (t.module.definition.find(id) == t.module.definition.end()) return 0;
    const Inst& made = t.module.def(id);
    switch (made.op) {
      case Op::OpVariable:
        return id;
      case Op::OpAccessChain:
      case Op::OpInBoundsAccessChain:
      case Op::OpPtrAccessChain:
      case Op::OpCopyObject:
      case Op::OpLoad:
      case Op::OpImageTexelPointer:
      case Op::OpImage:
        id = made.operand(0);
        break;
      default:
        return 0;
    }
  }
  return 0;
}

/// Whether the variable, or a member of its block, is coherent.
bool is_coherent(const Translator& t, std::uint32_t id) {
  const std::uint32_t variable = variable_of(t, id);
  if (variable == 0) return true;
  if (is_marked(t, variable)) return true;
  std::uint32_t type = t.module.type(t.module.def(variable).result_type).element;
  while (t.module.type(type).kind == Type::Kind::kArray || t.module.type(type).kind == Type::Kind::kRuntimeArray)
    type = t.module.type(type).element;
  return is_marked(t, type);
}

/// Image Operands as the Memory Operands that mean the same.
std::uint32_t memory_operands(std::uint32_t image_operands) {
  const auto has = [&](spv::ImageOperandsMask bit) { return (image_operands & static_cast<std::uint32_t>(bit)) != 0; };
  return (has(spv::ImageOperandsMask::MakeTexelAvailable) ? MemoryOrder::kPointerAvailable : 0) |
         (has(spv::ImageOperandsMask::MakeTexelVisible) ? MemoryOrder::kPointerVisible : 0) |
         (has(spv::ImageOperandsMask::NonPrivateTexel) ? MemoryOrder::kNonPrivate : 0);
}

MemoryOrder access_order(const Translator& t, std::uint32_t pointer, std::uint32_t operands) {
  MemoryOrder order;
  order.bits = static_cast<std::uint16_t>(operands);
  order.coherent = is_coherent(t, pointer);
  return order;
}

std::uint32_t constant_or(const Translator& t, std::uint32_t id, std::uint32_t otherwise) {
  const Constant* constant = t.module.constant(id);
  return constant == nullptr || constant->words.empty() ? otherwise : constant->words[0];
}

MemoryScope scope_of(const Translator& t, std::uint32_t id) {
  return static_cast<MemoryScope>(constant_or(t, id, static_cast<std::uint32_t>(MemoryScope::kUnknown)) & 7);
}

MemoryOrder semantics_of(const Translator& t, const Inst& inst, std::uint32_t scope) {
  MemoryOrder order;
  order.memory = scope_of(t, inst.operand(scope));
  order.bits = static_cast<std::uint16_t>(constant_or(t, inst.operand(scope + 1), 0));
  order.coherent = true;
  return order;
}

bool is_atomic(Op op) {
  return (op >= Op::OpAtomicLoad && op <= Op::OpAtomicXor) || op == Op::OpAtomicFAddEXT || op == Op::OpAtomicFMinEXT ||
         op == Op::OpAtomicFMaxEXT;
}

std::uint32_t operand_or_none(const Inst& inst, std::uint32_t at) { return inst.has(at) ? inst.operand(at) : 0; }

}  // namespace

std::uint32_t order_of(const Translator& t, const Inst& inst) {
  switch (inst.op) {
    case Op::OpLoad:
      return access_order(t, inst.operand(0), operand_or_none(inst, 1)).word();
    case Op::OpStore:
    case Op::OpCopyMemory:
      return access_order(t, inst.operand(0), operand_or_none(inst, 2)).word();
    case Op::OpImageRead:
    case Op::OpImageFetch:
    case Op::OpImageSparseRead:
      return access_order(t, inst.operand(0), memory_operands(operand_or_none(inst, 2))).word();
    case Op::OpImageWrite:
      return access_order(t, inst.operand(0), memory_operands(operand_or_none(inst, 3))).word();
    case Op::OpControlBarrier: {
      MemoryOrder order = semantics_of(t, inst, 1);
      order.execution = scope_of(t, inst.operand(0));
      return order.word();
    }
    case Op::OpMemoryBarrier:
      return semantics_of(t, inst, 0).word();
    default:
      return is_atomic(inst.op) ? semantics_of(t, inst, 1).word() : 0;
  }
}

void probe_order(Translator& t, const Inst& inst) {
  const bool orders = inst.op == Op::OpControlBarrier || inst.op == Op::OpMemoryBarrier ||
                      inst.op == Op::OpBeginInvocationInterlockEXT || inst.op == Op::OpEndInvocationInterlockEXT;
  if (!orders) return;
  Probe probe;
  probe.kind = Probe::Kind::kOrder;
  probe.opcode = static_cast<std::uint16_t>(inst.op);
  probe.number = order_of(t, inst);
  emit_probe(t, std::move(probe), {});
}

}  // namespace vitrine::spirv::front

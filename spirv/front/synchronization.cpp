// Barriers, atomics, helper invocations and subgroup basics (SPIR-V 3.42.18 to .21, .24).
#include "spirv/front/expression.h"
#include "spirv/front/functions.h"

namespace vitrine::spirv::front {
namespace {

using spv::Op;

struct AtomicRow {
  Op opcode;
  ir::AtomicOp op;
};

constexpr AtomicRow kAtomics[] = {
    {Op::OpAtomicLoad, ir::AtomicOp::kLoad},         {Op::OpAtomicStore, ir::AtomicOp::kStore},
    {Op::OpAtomicExchange, ir::AtomicOp::kExchange}, {Op::OpAtomicCompareExchange, ir::AtomicOp::kCompareExchange},
    {Op::OpAtomicIIncrement, ir::AtomicOp::kAdd},    {Op::OpAtomicIDecrement, ir::AtomicOp::kSub},
    {Op::OpAtomicIAdd, ir::AtomicOp::kAdd},          {Op::OpAtomicISub, ir::AtomicOp::kSub},
    {Op::OpAtomicSMin, ir::AtomicOp::kIMin},         {Op::OpAtomicUMin, ir::AtomicOp::kUMin},
    {Op::OpAtomicSMax, ir::AtomicOp::kIMax},         {Op::OpAtomicUMax, ir::AtomicOp::kUMax},
    {Op::OpAtomicAnd, ir::AtomicOp::kAnd},           {Op::OpAtomicOr, ir::AtomicOp::kOr},
    {Op::OpAtomicXor, ir::AtomicOp::kXor},           {Op::OpAtomicFAddEXT, ir::AtomicOp::kFAdd},
    {Op::OpAtomicFMinEXT, ir::AtomicOp::kFMin},      {Op::OpAtomicFMaxEXT, ir::AtomicOp::kFMax},
};

ir::AtomicOp atomic_op(const Inst& inst) {
  for (const AtomicRow& row : kAtomics)
    if (row.opcode == inst.op) return row.op;
  fail(inst, "is not supported");
}

/// What binary16 has: nothing that compares or counts.
bool has_half(ir::AtomicOp op) {
  switch (op) {
    case ir::AtomicOp::kLoad:
    case ir::AtomicOp::kStore:
    case ir::AtomicOp::kExchange:
    case ir::AtomicOp::kFAdd:
    case ir::AtomicOp::kFMin:
    case ir::AtomicOp::kFMax:
      return true;
    default:
      return false;
  }
}

/// Operand and comparator of an atomic. Operands: pointer, scope, semantics, then what the operation takes.
struct AtomicOperands {
  Expr value, comparator;  ///< no id: absent
};

void add_words(std::vector<ir::Src>& src, const Expr& operand) {
  if (operand.id != ir::kNoValue) src.push_back(whole(operand.id));
  if (operand.high != ir::kNoValue) src.push_back(whole(operand.high));
}

AtomicOperands atomic_operands(Translator& t, const Inst& inst, std::uint8_t width) {
  switch (inst.op) {
    case Op::OpAtomicLoad:
      return {};
    case Op::OpAtomicIIncrement:
    case Op::OpAtomicIDecrement:
      return {constant_bits(t, 1, width), {}};
    case Op::OpAtomicCompareExchange:
      return {number_of(t, inst.operand(4)), number_of(t, inst.operand(5))};
    default:
      return {number_of(t, inst.operand(3)), {}};
  }
}

/// A scalar as one vector of its words, low first; nothing of an absent operand.
ir::ValueId words_of(Translator& t, const Expr& operand) {
  if (operand.high == ir::kNoValue) return operand.id;
  return vec(t, {whole(operand.id), whole(operand.high)}, false);
}

/// On a texel, which has the width of the image's Sampled Type: an integer where that is 64.
ir::ValueId image_atomic(Translator& t, ir::AtomicOp op, const Pointer& pointer, const AtomicOperands& operands) {
  const std::uint32_t width = number_type(t, pointer.type).width;
  auto info = std::make_shared<ir::ImageInfo>(image_info(t, pointer.image));
  if (width != (info->wide ? 64 : 32))
    fail(*t.inst, std::to_string(width) + "-bit atomics on this image are not supported");
  info->access = ir::ImageAccess::kAtomic;
  info->atomic = op;
  ImageSources sources(*info);
  add_elements(t, pointer.image, *info, sources);
  sources.add(ir::ImageOperand::kCoord, pointer.coord);
  sources.add(ir::ImageOperand::kSample, pointer.sample);
  sources.add(ir::ImageOperand::kValue, words_of(t, operands.value));
  sources.add(ir::ImageOperand::kCompare, words_of(t, operands.comparator));
  check_image(*t.inst, *info, 1);
  const ir::ValueId result = emit(t, ir::Op::kImage, info->wide ? 2 : 1, false, sources.take());
  last_instr(t).image = std::move(info);
  return result;
}

/// On what a pointer to a number of `width` bits leads to.
ir::ValueId memory_atomic(Translator& t, ir::AtomicOp op, const Pointer& pointer, const AtomicOperands& operands,
                          std::uint8_t width) {
  std::vector<ir::Src> src;
  const bool global = pointer.kind == Pointer::Kind::kGlobal, shared = pointer.kind == Pointer::Kind::kShared;
  if (pointer.kind == Pointer::Kind::kStorage) src.push_back(whole(descriptor_element(t, pointer)));
  if (global) src.insert(src.end(), {whole(pointer.low), whole(pointer.high)});
  src.push_back(whole(dynamic_offset(t, pointer)));
  add_words(src, operands.value);
  add_words(src, operands.comparator);
  if (!shared && !global && pointer.kind != Pointer::Kind::kStorage) fail(*t.inst, "storage class is not supported");
  const bool wide = width == 64;
  const ir::Op kind = shared ? ir::Op::kAtomicShared : global ? ir::Op::kAtomicGlobal : ir::Op::kAtomicStorage;
  const ir::ValueId result = emit(t, kind, wide ? 2 : 1, false, std::move(src));
  ir::Instr& instr = last_instr(t);
  set_buffer(instr, pointer);
  instr.imm[0] = static_cast<std::uint32_t>(op);
  if (width == 16) instr.imm[2] = 1;  // binary16, in imm[1] bytes or, where every scalar has a word, in that
  instr.imm[1] = wide ? 8 : width == 16 && !pointer.word_layout() ? 2 : 0;
  return result;
}

/// Memory is coherent, so all that a barrier asks for is that loads behind it are made behind it.
void order_memory(Translator& t, const Inst& inst, std::uint32_t semantics) {
  const auto acquires = spv::MemorySemanticsMask::Acquire | spv::MemorySemanticsMask::AcquireRelease |
                        spv::MemorySemanticsMask::SequentiallyConsistent;
  if ((t.module.constant_u32(inst.operand(semantics), inst) & static_cast<std::uint32_t>(acquires)) != 0)
    emit_effect(t, ir::Op::kMemoryBarrier);
}

}  // namespace

void atomic(Translator& t, const Inst& inst, ir::Op) {
  const Pointer pointer = pointer_of(t, inst.operand(0));
  const ir::AtomicOp op = atomic_op(inst);
  const std::uint32_t type = t.module.type(pointer.type).kind == Type::Kind::kPointer ? 0 : pointer.type;
  if (type == 0 || leaf_info(t, type).components != 1) fail(inst, "operand is not a pointer to a number");
  const Type& kind_of_number = number_type(t, type);
  const auto width = static_cast<std::uint8_t>(kind_of_number.width);
  if (width < 32 && (width != 16 || kind_of_number.kind != Type::Kind::kFloat || !has_half(op)))
    fail(inst, "is not supported on narrow integers");
  const AtomicOperands operands = atomic_operands(t, inst, width);
  for (const Expr& operand : {operands.value, operands.comparator})
    if (operand.id != ir::kNoValue && (operand.size() != 1 || operand.width != width))
      fail(inst, "operand does not fit its type");
  const ir::ValueId result = pointer.kind == Pointer::Kind::kTexel ? image_atomic(t, op, pointer, operands)
                                                                   : memory_atomic(t, op, pointer, operands, width);
  if (pointer.kind != Pointer::Kind::kShared && op != ir::AtomicOp::kLoad) t.function.interface.writes_memory = true;
  if (inst.result == 0) return;
  set_value(t, inst, width == 64 ? std::vector{extract(t, result, 0), extract(t, result, 1)} : std::vector{result});
}

void barrier(Translator& t, const Inst& inst, ir::Op) {
  // A subgroup is one wave, which runs in lockstep.
  const std::uint32_t scope = t.module.constant_u32(inst.operand(0), inst);
  if (t.options.stage == VK_SHADER_STAGE_COMPUTE_BIT && scope == static_cast<std::uint32_t>(spv::Scope::Workgroup))
    emit_effect(t, ir::Op::kBarrier);
  else
    order_memory(t, inst, 2);
}

/// Fragments of one pixel that write memory run one after the other, in order: the critical section needs no lock.
void interlock(Translator& t, const Inst&, ir::Op) { emit_effect(t, ir::Op::kMemoryBarrier); }

void memory_barrier(Translator& t, const Inst& inst, ir::Op) { order_memory(t, inst, 1); }

void demote(Translator& t, const Inst&, ir::Op) {
  t.function.interface.uses_discard = true;
  emit_effect(t, ir::Op::kDemote);
}

void is_helper(Translator& t, const Inst& inst, ir::Op) {
  set_value(t, inst, emit(t, ir::Op::kHelperInvocation, 1, true, {}));
}

void read_clock(Translator& t, const Inst& inst, ir::Op) {
  const ir::ValueId time = emit(t, ir::Op::kReadClock, 2, false, {});
  if (t.module.type(inst.result_type).leaves == 2)
    return set_value(t, inst, std::vector{extract(t, time, 0), extract(t, time, 1)});
  set_value(t, inst, time);
}

}  // namespace vitrine::spirv::front

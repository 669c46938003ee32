// Probes of accesses: addresses that must be aligned (Vulkan 1.3.239, VUID-RuntimeSpirv-PhysicalStorageBuffer64-06314
// and -06315), descriptors on which invocations must agree (VUID-RuntimeSpirv-NonUniform-06274).
#include <algorithm>

#include "spirv/front/functions.h"

namespace vitrine::spirv::front {
namespace {

using spv::Op;

/// Bytes of the largest scalar that a value of the type has; 0: none.
std::uint32_t largest_scalar(const Translator& t, std::uint32_t type_id) {
  const Type& type = t.module.type(type_id);
  switch (type.kind) {
    case Type::Kind::kInt:
    case Type::Kind::kFloat:
      return type.width / 8;
    case Type::Kind::kPointer:
      return 8;
    case Type::Kind::kVector:
    case Type::Kind::kMatrix:
    case Type::Kind::kArray:
    case Type::Kind::kRuntimeArray:
      return largest_scalar(t, type.element);
    case Type::Kind::kStruct: {
      std::uint32_t bytes = 0;
      for (const std::uint32_t member : type.members) bytes = std::max(bytes, largest_scalar(t, member));
      return bytes;
    }
    default:
      return 0;
  }
}

bool is_atomic(Op op) {
  return (op >= Op::OpAtomicLoad && op <= Op::OpAtomicXor) || op == Op::OpAtomicFAddEXT || op == Op::OpAtomicFMinEXT ||
         op == Op::OpAtomicFMaxEXT;
}

/// Memory Operands from operand `at` on (SPIR-V, Memory Operands): what Aligned promises; 0: nothing. `end`: behind
/// them.
std::uint32_t aligned_operand(const Inst& inst, std::uint32_t at, std::uint32_t& end) {
  using Mask = spv::MemoryAccessMask;
  end = at;
  if (!inst.has(at)) return 0;
  const std::uint32_t mask = inst.operand(at++);
  const auto has = [&](Mask bit) { return (mask & static_cast<std::uint32_t>(bit)) != 0; };
  const std::uint32_t aligned = has(Mask::Aligned) && inst.has(at) ? inst.operand(at++) : 0;
  at += has(Mask::MakePointerAvailable) + has(Mask::MakePointerVisible);
  end = at;
  return aligned;
}

/// Whether `id` is made with a NonUniform decoration: on itself, or on what it is made of. Compilers leave it out on
/// OpSampledImage, and for atomic operations on all but the index.
bool is_non_uniform(const Translator& t, std::uint32_t id, bool sampler) {
  for (;;) {
    if (t.module.decoration(id, spv::Decoration::NonUniform) != nullptr) return true;
    const Inst& made = t.module.def(id);
    switch (made.op) {
      case Op::OpSampledImage:
        id = made.operand(sampler ? 1 : 0);
        break;
      case Op::OpAccessChain:
      case Op::OpInBoundsAccessChain:
      case Op::OpPtrAccessChain:
        for (std::uint32_t i = 1; made.has(i); ++i)
          if (t.module.decoration(made.operand(i), spv::Decoration::NonUniform) != nullptr) return true;
        id = made.operand(0);
        break;
      case Op::OpLoad:
      case Op::OpImage:
      case Op::OpImageTexelPointer:
      case Op::OpCopyObject:
        id = made.operand(0);
        break;
      case Op::OpVariable:
        return false;
      default:
        return true;  // a parameter or a choice: it may be decorated where it comes from
    }
  }
}

void probe_alignment(Translator& t, const Inst& inst, const Pointer& pointer, std::uint32_t aligned) {
  Probe probe;
  probe.kind = Probe::Kind::kAligned;
  probe.id = inst.result;
  probe.opcode = static_cast<std::uint16_t>(inst.op);
  probe.number = std::max(aligned, largest_scalar(t, pointer.type));
  if (probe.number < 2) return;
  std::vector<ir::Src> words;
  for (const ir::ValueId word :
       {pointer.low, pointer.high, dynamic_offset(t, pointer), constant_u32(t, pointer.constant_offset)}) {
    probe.values.push_back({.first_word = static_cast<std::uint32_t>(words.size())});
    words.push_back(splat(word));
  }
  emit_probe(t, std::move(probe), std::move(words));
}

/// `elements`: indices of descriptors; none, or a constant: there is nothing to say.
void probe_descriptors(Translator& t, const Inst& inst, std::uint32_t operand,
                       std::initializer_list<std::pair<ir::ValueId, bool>> elements) {
  Probe probe;
  probe.kind = Probe::Kind::kDescriptor;
  probe.id = inst.result;
  probe.opcode = static_cast<std::uint16_t>(inst.op);
  std::vector<ir::Src> words;
  for (const auto& [element, sampler] : elements) {
    if (element == ir::kNoValue || constant_of(t, element) != nullptr || is_non_uniform(t, operand, sampler)) continue;
    probe.values.push_back({.first_word = static_cast<std::uint32_t>(words.size())});
    words.push_back(splat(element));
  }
  if (!words.empty()) emit_probe(t, std::move(probe), std::move(words));
}

void probe_image(Translator& t, const Inst& inst, std::uint32_t operand, const ImageHandle& image) {
  // A combined image sampler is one descriptor.
  const ir::ValueId sampler = image.combined ? ir::kNoValue : image.sampler_element;
  probe_descriptors(t, inst, operand, {{image.image_element, false}, {sampler, true}});
}

void probe_pointer(Translator& t, const Inst& inst, std::uint32_t operand, std::uint32_t aligned) {
  const Pointer pointer = pointer_of(t, operand);
  switch (pointer.kind) {
    case Pointer::Kind::kGlobal:
      return probe_alignment(t, inst, pointer, aligned);
    case Pointer::Kind::kUniform:
    case Pointer::Kind::kStorage:
      return probe_descriptors(t, inst, operand, {{pointer.element, false}});
    case Pointer::Kind::kTexel:
      return probe_image(t, inst, operand, pointer.image);
    default:
      return;
  }
}

/// Image instructions that read or write texels, not those that ask for sizes.
bool accesses_image(Op op) {
  return (op >= Op::OpImageSampleImplicitLod && op <= Op::OpImageWrite) ||
         (op >= Op::OpImageSparseSampleImplicitLod && op <= Op::OpImageSparseDrefGather) || op == Op::OpImageSparseRead;
}

}  // namespace

void probe_access(Translator& t, const Inst& inst) {
  std::uint32_t end = 0;
  if (inst.op == Op::OpLoad) {
    const std::uint32_t aligned = aligned_operand(inst, 1, end);
    probe_pointer(t, inst, inst.operand(0), aligned);
  } else if (inst.op == Op::OpStore) {
    const std::uint32_t aligned = aligned_operand(inst, 2, end);
    probe_pointer(t, inst, inst.operand(0), aligned);
  } else if (inst.op == Op::OpCopyMemory) {
    const std::uint32_t target = aligned_operand(inst, 2, end);
    const std::uint32_t source = inst.has(end) ? aligned_operand(inst, end, end) : target;
    probe_pointer(t, inst, inst.operand(0), target);
    probe_pointer(t, inst, inst.operand(1), source);
  } else if (is_atomic(inst.op)) {
    probe_pointer(t, inst, inst.operand(0), 0);
  } else if (accesses_image(inst.op)) {
    const auto image = t.images.find(inst.operand(0));
    if (image != t.images.end()) probe_image(t, inst, inst.operand(0), image->second);
  }
}

}  // namespace vitrine::spirv::front

// What one pass through a block of a module costs, in instructions of SPIR-V: the same on every device.
#include <algorithm>
#include <optional>

#include "spirv/front/functions.h"
#include "spirv/newer_numbers.h"

namespace vitrine::spirv::front {
namespace {

using spv::Op;

/// Bytes of a value, without padding.
std::uint32_t bytes_of(const Module& module, std::uint32_t type_id) {
  const Type& type = module.type(type_id);
  switch (type.kind) {
    case Type::Kind::kInt:
    case Type::Kind::kFloat:
      return type.width / 8;
    case Type::Kind::kBool:
      return 4;
    case Type::Kind::kPointer:
      return 8;
    case Type::Kind::kVector:
    case Type::Kind::kMatrix:
    case Type::Kind::kArray:
      return type.count * bytes_of(module, type.element);
    case Type::Kind::kStruct: {
      std::uint32_t bytes = 0;
      for (const std::uint32_t member : type.members) bytes += bytes_of(module, member);
      return bytes;
    }
    default:
      return 0;
  }
}

/// Whether a pointer leads to memory and not to a variable of the invocation.
bool leads_to_memory(const Module& module, std::uint32_t pointer) {
  switch (module.type(module.def(pointer).result_type).storage) {
    case spv::StorageClass::Uniform:
    case spv::StorageClass::StorageBuffer:
    case spv::StorageClass::PushConstant:
    case spv::StorageClass::Workgroup:
    case spv::StorageClass::PhysicalStorageBuffer:
      return true;
    default:
      return false;
  }
}

bool in(Op op, Op first, Op last) { return op >= first && op <= last; }

std::optional<Cost> cost_of_access(const Module& module, const Inst& inst) {
  switch (inst.op) {
    case Op::OpLoad:
      return leads_to_memory(module, inst.operand(0)) ? Cost::kLoads : Cost::kMoves;
    case Op::OpStore:
    case Op::OpCopyMemory:
      return leads_to_memory(module, inst.operand(0)) ? Cost::kStores : Cost::kMoves;
    case Op::OpImageRead:
    case Op::OpImageWrite:
    case Op::OpImageFetch:
    case Op::OpImageSparseRead:
    case Op::OpImageSparseFetch:
      return Cost::kTexels;
    default:
      return std::nullopt;
  }
}

std::optional<Cost> cost_of_control(const Inst& inst) {
  switch (inst.op) {
    case Op::OpBranchConditional:
    case Op::OpSwitch:
      return Cost::kBranches;
    case Op::OpFunctionCall:
      return Cost::kCalls;
    case Op::OpControlBarrier:
    case Op::OpMemoryBarrier:
      return Cost::kBarriers;
    default:
      return std::nullopt;
  }
}

std::optional<Cost> cost_of_value(const Module& module, const Inst& inst) {
  const Op op = inst.op;
  if (op == Op::OpExtInst) {
    const auto set = module.ext_imports.find(inst.operand(0));
    const bool glsl = set != module.ext_imports.end() && set->second == kExtGlsl450;
    return glsl ? std::optional(Cost::kArithmetic) : std::nullopt;
  }
  if (op == Op::OpSelect || in(op, Op::OpVectorExtractDynamic, Op::OpCopyObject) || op == Op::OpPhi ||
      op == Op::OpExpectKHR || op == Op::OpAccessChain || op == Op::OpInBoundsAccessChain ||
      op == Op::OpPtrAccessChain || op == Op::OpBitcast)
    return Cost::kMoves;
  if (in(op, Op::OpConvertFToU, Op::OpQuantizeToF16)) return Cost::kConversions;
  if (op == Op::OpTranspose || in(op, Op::OpSNegate, Op::OpNot) || in(op, Op::OpBitFieldInsert, Op::OpBitCount) ||
      in(op, Op::OpSDot, Op::OpSUDotAccSat))
    return Cost::kArithmetic;
  if (in(op, Op::OpDPdx, Op::OpFwidthCoarse)) return Cost::kDerivatives;
  if (in(op, Op::OpAtomicLoad, Op::OpAtomicXor) || op == Op::OpAtomicFAddEXT || op == Op::OpAtomicFMinEXT ||
      op == Op::OpAtomicFMaxEXT)
    return Cost::kAtomics;
  if (in(op, Op::OpSampledImage, Op::OpImageQuerySamples) ||
      in(op, Op::OpImageSparseSampleImplicitLod, Op::OpImageSparseDrefGather))
    return Cost::kLookups;
  if (in(op, Op::OpGroupNonUniformElect, Op::OpGroupNonUniformQuadSwap) || op == newer::kQuadAll ||
      op == newer::kQuadAny)
    return Cost::kSubgroup;
  return std::nullopt;
}

/// Nothing: it is no instruction that does something when it runs.
std::optional<Cost> cost_of(const Module& module, const Inst& inst) {
  if (const auto cost = cost_of_access(module, inst)) return cost;
  if (const auto cost = cost_of_control(inst)) return cost;
  return cost_of_value(module, inst);
}

std::uint32_t& of(Probe& probe, Cost cost) { return probe.costs[static_cast<std::size_t>(cost)]; }

void count_bytes(const Module& module, const Inst& inst, Cost cost, Probe& probe) {
  if (cost == Cost::kLoads) of(probe, Cost::kBytesLoaded) += bytes_of(module, inst.result_type);
  if (cost == Cost::kStores && inst.op == Op::OpStore)
    of(probe, Cost::kBytesStored) += bytes_of(module, module.def(inst.operand(1)).result_type);
}

void count_at(Probe& probe, std::uint32_t place) {
  const auto at = std::find_if(probe.instructions.begin(), probe.instructions.end(),
                               [&](const auto& entry) { return entry.first == place; });
  if (at == probe.instructions.end()) {
    probe.instructions.emplace_back(place, 1);
  } else {
    ++at->second;
  }
}

}  // namespace

void count_costs(const Module& module, const Block& block, Probe& probe) {
  for (std::uint32_t i = block.first; i <= block.last; ++i) {
    const Inst& inst = module.code[i];
    const std::optional<Cost> cost = cost_of(module, inst);
    if (!cost) continue;
    ++of(probe, *cost);
    count_bytes(module, inst, *cost, probe);
    count_at(probe, inst.origin.place);
  }
}

}  // namespace vitrine::spirv::front

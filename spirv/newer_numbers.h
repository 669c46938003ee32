// Numbers of SPIR-V that older headers do not know (1.3.239's): by the names of those that do. Capabilities and
// instructions of that kind are rows of capabilities.def and opcodes.def with their numbers.
#pragma once

#include <cstdint>
#include <spirv/unified1/spirv.hpp11>

namespace vitrine::spirv::newer {

inline constexpr auto kQuadDerivatives = static_cast<spv::ExecutionMode>(5088);
inline constexpr auto kRequireFullQuads = static_cast<spv::ExecutionMode>(5089);
inline constexpr auto kMaximallyReconverges = static_cast<spv::ExecutionMode>(6023);
inline constexpr auto kFPFastMathDefault = static_cast<spv::ExecutionMode>(6028);

inline constexpr auto kExtInstWithForwardRefs = static_cast<spv::Op>(4433);
inline constexpr auto kConstantCompositeReplicate = static_cast<spv::Op>(4461);
inline constexpr auto kSpecConstantCompositeReplicate = static_cast<spv::Op>(4462);
inline constexpr auto kCompositeConstructReplicate = static_cast<spv::Op>(4463);
inline constexpr auto kQuadAll = static_cast<spv::Op>(5110);
inline constexpr auto kQuadAny = static_cast<spv::Op>(5111);

/// FP Fast Math Mode.
inline constexpr std::uint32_t kAllowTransform = 0x40000;

/// A constant whose components are one other constant.
constexpr bool is_replicated_constant(spv::Op op) {
  return op == kConstantCompositeReplicate || op == kSpecConstantCompositeReplicate;
}

}  // namespace vitrine::spirv::newer

// Chains: consecutive ALU instructions that hand one value on in SIMD registers. A whole wave of 32-bit lanes fits in
// four AVX-512 or eight AVX2 registers, which is what the calling convention passes, so each handler of a chain jumps
// to the next with the accumulator in place and only the values that somebody else reads are stored.
#pragma once

#include "spirv/program.h"

namespace vitrine::spirv::exec {

/// Which source of an operation is the accumulator. kAllSources: the first two sources are the same accumulator.
inline constexpr int kNoAccumulator = -1, kAllSources = 3;

/// What a link of a chain does with its result.
enum class Link : std::uint8_t {
  kKeep,   ///< hands it on
  kStore,  ///< writes register dst and hands it on
  kLast,   ///< writes register (or mask) dst; the chain ends
};

/// Whether `op` may be a link. The answer is that of every target: it decides the order of operations and operands, and
/// so which of two NaNs survives.
bool is_chain_link(ir::Op op, int accumulator, UniformSources uniform, Link link);

/// The handler of `op` as a link; null where there is none, and in targets whose registers do not hold a wave. A chain
/// starts with kNoAccumulator and kKeep or kStore; every later link has an accumulator. Chained instructions must be
/// adjacent, and no jump may lead into a chain.
Handler chain_handler(ir::Op op, int accumulator, UniformSources uniform, Link link);

}  // namespace vitrine::spirv::exec

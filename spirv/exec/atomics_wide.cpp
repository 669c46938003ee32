// Atomic operations on 64-bit integers of buffers and behind pointers (really atomic) and of shared memory (owned by
// one thread). Lanes act in increasing order.
#include <atomic>

#include "spirv/exec/atomic_ops.h"
#include "spirv/exec/buffers.h"
#include "spirv/exec/handlers.h"

namespace vitrine::spirv::exec {
namespace {

/// Two registers as a 64-bit number.
std::uint64_t lane_value(Wave& wave, std::uint32_t low, std::uint32_t high, std::size_t lane) {
  if (low == kNoOperand) return 0;
  return reg(wave, low).lane[lane] | std::uint64_t{reg(wave, high).lane[lane]} << 32;
}

template <bool kAtomic>
std::uint64_t act(const MemoryOp& row, const Bytes& bytes, std::uint32_t offset, std::uint64_t operand,
                  std::uint64_t comparator) {
  offset &= ~7u;
  if (std::uint64_t{offset} + 8 > bytes.size) return 0;
  std::byte* const at = bytes.data + offset;
  if constexpr (kAtomic) {
    return apply_atomic<true>(row.atomic, reinterpret_cast<std::uint64_t*>(at), operand, comparator);
  } else {
    std::uint64_t word;
    std::memcpy(&word, at, sizeof(word));
    const std::uint64_t old = apply_atomic<false>(row.atomic, &word, operand, comparator);
    std::memcpy(at, &word, sizeof(word));
    return old;
  }
}

/// `offset_of`: byte offset of a lane.
template <bool kAtomic, class F>
void run_lanes(Wave& wave, const Instruction* i, const MemoryOp& row, const Bytes& bytes, base::LaneMask active,
               const F& offset_of) {
  base::for_each_lane(active, [&](std::size_t lane) {
    const std::uint64_t old =
        act<kAtomic>(row, bytes, offset_of(lane) + row.added, lane_value(wave, row.data[0], row.data[1], lane),
                     lane_value(wave, row.data[2], row.data[3], lane));
    if (i->dst != kNoOperand) reg(wave, i->dst).lane[lane] = static_cast<std::uint32_t>(old);
    if (i->extra[1] != kNoOperand) reg(wave, i->extra[1]).lane[lane] = static_cast<std::uint32_t>(old >> 32);
  });
}

template <bool kAtomic, bool kUniform>
void run(Wave& wave, const Instruction* i, const MemoryOp& row, const Bytes& bytes, base::LaneMask active) {
  run_lanes<kAtomic>(wave, i, row, bytes, active, [&](std::size_t lane) {
    return kUniform ? uniform_word(wave, i->src[0]) : reg(wave, i->src[0]).lane[lane];
  });
}

/// Lanes that do not take part (helpers) read 0.
void clear_results(Wave& wave, const Instruction* i) {
  for (const std::uint32_t place : {i->dst, i->extra[1]})
    if (place != kNoOperand)
      base::for_each_lane(wave.active & ~wave.live, [&](std::size_t lane) { reg(wave, place).lane[lane] = 0; });
}

template <bool kUniform>
const Instruction* on_buffer(Wave& wave, const Instruction* i) {
  const MemoryOp& row = memory_op(wave, i);
  clear_results(wave, i);
  for_each_buffer(wave, row, wave.active & wave.live,
                  [&](const Bytes& bytes, base::LaneMask active) { run<true, kUniform>(wave, i, row, bytes, active); });
  return i + 1;
}

template <bool kUniform>
const Instruction* on_shared(Wave& wave, const Instruction* i) {
  clear_results(wave, i);
  run<false, kUniform>(wave, i, memory_op(wave, i), shared_bytes(wave), wave.active & wave.live);
  return i + 1;
}

const Instruction* behind_pointers(Wave& wave, const Instruction* i) {
  const MemoryOp& row = memory_op(wave, i);
  clear_results(wave, i);
  for_each_stretch(wave, i, row, wave.active & wave.live,
                   [&](const Bytes& bytes, base::LaneMask active, const base::WaveRegister& offset) {
                     run_lanes<true>(wave, i, row, bytes, active, [&](std::size_t lane) { return offset.lane[lane]; });
                   });
  return i + 1;
}

}  // namespace

Handler atomic_wide(Space space, bool uniform) {
  if (space == Space::kGlobal) return behind_pointers;
  if (space == Space::kBuffer) return uniform ? on_buffer<true> : on_buffer<false>;
  return uniform ? on_shared<true> : on_shared<false>;
}

}  // namespace vitrine::spirv::exec

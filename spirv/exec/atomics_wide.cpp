// Atomic operations on 64-bit integers of buffers and behind pointers (really atomic) and of shared memory (owned by
// one thread). Lanes act in increasing order.
#include <atomic>

#include "spirv/exec/atomic_ops.h"
#include "spirv/exec/atomic_spaces.h"

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

struct Wides {
  static void clear_results(Wave& wave, const Instruction* i) {
    for (const std::uint32_t place : {i->dst, i->extra[1]}) clear_result(wave, place);
  }

  /// `offset_of`: byte offset of a lane.
  template <bool kAtomic, class F>
  static void run_lanes(Wave& wave, const Instruction* i, const MemoryOp& row, const Bytes& bytes,
                        base::LaneMask active, const F& offset_of) {
    base::for_each_lane(active, [&](std::size_t lane) {
      const std::uint64_t old =
          act<kAtomic>(row, bytes, offset_of(lane) + row.added, lane_value(wave, row.data[0], row.data[1], lane),
                       lane_value(wave, row.data[2], row.data[3], lane));
      if (i->dst != kNoOperand) reg(wave, i->dst).lane[lane] = static_cast<std::uint32_t>(old);
      if (i->extra[1] != kNoOperand) reg(wave, i->extra[1]).lane[lane] = static_cast<std::uint32_t>(old >> 32);
    });
  }
};

}  // namespace

Handler atomic_wide(Space space, bool uniform) { return AtomicSpaces<Wides>::handler(space, uniform); }

}  // namespace vitrine::spirv::exec

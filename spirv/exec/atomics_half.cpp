// Atomic operations on binary16 of buffers and behind pointers (really atomic) and of shared memory (owned by one
// thread). Lanes act in increasing order.
#include "spirv/exec/atomics_half.h"

#include <atomic>

#include "base/numeric.h"
#include "spirv/exec/atomic_ops.h"
#include "spirv/exec/atomic_spaces.h"

namespace vitrine::spirv::exec {
namespace {

/// A sum has one rounding: binary32 has the bits that make the second harmless.
std::uint16_t combine(ir::AtomicOp op, std::uint16_t old, std::uint16_t operand) {
  const float a = base::half_to_float(old), b = base::half_to_float(operand);
  switch (op) {
    case ir::AtomicOp::kFAdd:
      return base::float_to_half_nearest(a + b);
    case ir::AtomicOp::kFMin:
    case ir::AtomicOp::kFMax:
      return extremum(op, old, operand, a, b);
    case ir::AtomicOp::kExchange:
    case ir::AtomicOp::kStore:
      return operand;
    default:
      return old;
  }
}

/// Returns the old value.
std::uint16_t act_atomically(ir::AtomicOp op, std::byte* at, std::uint16_t operand) {
  std::atomic_ref<std::uint16_t> shared(*reinterpret_cast<std::uint16_t*>(at));
  std::uint16_t old = shared.load(std::memory_order_relaxed);
  if (op == ir::AtomicOp::kLoad) return old;
  while (!shared.compare_exchange_weak(old, combine(op, old, operand), std::memory_order_relaxed)) {
  }
  return old;
}

/// `bytes`: of the place, 2 or 4; numbers are zero-extended in a word.
std::uint16_t act_alone(ir::AtomicOp op, std::byte* at, std::uint16_t operand, std::uint32_t bytes) {
  std::uint32_t word = 0;
  std::memcpy(&word, at, bytes);
  const auto old = static_cast<std::uint16_t>(word);
  word = combine(op, old, operand);
  std::memcpy(at, &word, bytes);
  return old;
}

struct Halves {
  static void clear_results(Wave& wave, const Instruction* i) { clear_result(wave, i->dst); }

  /// `offset_of`: byte offset of a lane.
  template <bool kAtomic, class F>
  static void run_lanes(Wave& wave, const Instruction* i, const MemoryOp& row, const Bytes& bytes,
                        base::LaneMask active, const F& offset_of) {
    base::for_each_lane(active, [&](std::size_t lane) {
      const std::uint32_t offset = (offset_of(lane) + row.added) & ~(row.element_bytes - 1);
      const auto operand =
          static_cast<std::uint16_t>(row.data[0] == kNoOperand ? 0 : reg(wave, row.data[0]).lane[lane]);
      std::uint16_t old = 0;
      if (std::uint64_t{offset} + row.element_bytes <= bytes.size)
        old = kAtomic ? act_atomically(row.atomic, bytes.data + offset, operand)
                      : act_alone(row.atomic, bytes.data + offset, operand, row.element_bytes);
      if (i->dst != kNoOperand) reg(wave, i->dst).lane[lane] = old;
    });
  }
};

}  // namespace

Handler atomic_half(Space space, bool uniform) { return AtomicSpaces<Halves>::handler(space, uniform); }

}  // namespace vitrine::spirv::exec

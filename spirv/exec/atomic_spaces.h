// Where the lanes of a wave act atomically: on buffers, on shared memory, behind pointers.
#pragma once

#include "spirv/exec/buffers.h"
#include "spirv/exec/handlers.h"

namespace vitrine::spirv::exec {

/// Lanes that do not take part (helpers) read 0. `place`: of a register, or kNoOperand.
inline void clear_result(Wave& wave, std::uint32_t place) {
  if (place == kNoOperand) return;
  base::for_each_lane(wave.active & ~wave.live, [&](std::size_t lane) { reg(wave, place).lane[lane] = 0; });
}

/// The handlers of one kind of number. Numbers::clear_results(wave, i) clears what helpers read;
/// Numbers::run_lanes<kAtomic>(wave, i, row, bytes, active, offset_of) acts, lane after lane, at the byte offsets
/// offset_of(lane) + row.added of `bytes`.
template <class Numbers>
class AtomicSpaces {
 public:
  static Handler handler(Space space, bool uniform) {
    if (space == Space::kGlobal) return behind_pointers;
    if (space == Space::kBuffer) return uniform ? on_buffer<true> : on_buffer<false>;
    return uniform ? on_shared<true> : on_shared<false>;
  }

 private:
  template <bool kAtomic, bool kUniform>
  static void run(Wave& wave, const Instruction* i, const MemoryOp& row, const Bytes& bytes, base::LaneMask active) {
    Numbers::template run_lanes<kAtomic>(wave, i, row, bytes, active, [&](std::size_t lane) {
      return kUniform ? uniform_word(wave, i->src[0]) : reg(wave, i->src[0]).lane[lane];
    });
  }

  template <bool kUniform>
  static const Instruction* on_buffer(Wave& wave, const Instruction* i) {
    const MemoryOp& row = memory_op(wave, i);
    Numbers::clear_results(wave, i);
    for_each_buffer(wave, row, wave.active & wave.live, [&](const Bytes& bytes, base::LaneMask active) {
      run<true, kUniform>(wave, i, row, bytes, active);
    });
    return i + 1;
  }

  template <bool kUniform>
  static const Instruction* on_shared(Wave& wave, const Instruction* i) {
    Numbers::clear_results(wave, i);
    run<false, kUniform>(wave, i, memory_op(wave, i), shared_bytes(wave), wave.active & wave.live);
    return i + 1;
  }

  static const Instruction* behind_pointers(Wave& wave, const Instruction* i) {
    const MemoryOp& row = memory_op(wave, i);
    Numbers::clear_results(wave, i);
    for_each_stretch(wave, i, row, wave.active & wave.live,
                     [&](const Bytes& bytes, base::LaneMask active, const base::WaveRegister& offset) {
                       Numbers::template run_lanes<true>(wave, i, row, bytes, active,
                                                         [&](std::size_t lane) { return offset.lane[lane]; });
                     });
    return i + 1;
  }
};

}  // namespace vitrine::spirv::exec

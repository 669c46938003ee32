// Atomic operations on buffers (really atomic: other workers may work on the same words) and on shared memory (owned by
// one thread). Lanes act in increasing order.
#include <algorithm>
#include <atomic>

#include "base/numeric.h"
#include "spirv/exec/atomic_ops.h"
#include "spirv/exec/atomic_spaces.h"
#include "spirv/exec/handlers.h"
#include "spirv/exec/same_words.h"

namespace vitrine::spirv::exec {
namespace {

std::uint32_t* aligned_word(const Bytes& bytes, std::uint32_t offset) {
  offset &= ~3u;
  return contains_word(bytes, offset) ? reinterpret_cast<std::uint32_t*>(bytes.data + offset) : nullptr;
}

/// One lane after the other, each at its own offset.
template <bool kAtomic>
void run_lanes(Wave& wave, const Instruction* i, const MemoryOp& row, const Bytes& bytes, base::LaneMask active,
               const std::uint32_t* offset) {
  static const base::WaveRegister zero{};
  const std::uint32_t* operand = row.data[0] != kNoOperand ? reg(wave, row.data[0]).lane : zero.lane;
  const std::uint32_t* compare = row.compare != kNoOperand ? reg(wave, row.compare).lane : zero.lane;
  std::uint32_t* result = i->dst != kNoOperand ? reg(wave, i->dst).lane : nullptr;
  base::for_each_lane(active, [&](std::size_t lane) {
    std::uint32_t* word = aligned_word(bytes, offset[lane] + row.added);
    const std::uint32_t old = word ? apply_atomic<kAtomic>(row.atomic, word, operand[lane], compare[lane]) : 0;
    if (result) result[lane] = old;
  });
}

/// `uniform`: the offset is a word that all lanes share.
template <bool kAtomic>
void run(Wave& wave, const Instruction* i, const MemoryOp& row, const Bytes& bytes, base::LaneMask active,
         bool uniform) {
  if (active == 0) return;
  base::WaveRegister same;
  const base::WaveRegister& offsets = uniform ? same : reg(wave, i->src[0]);
  if (uniform) {
    std::fill_n(same.lane, base::kWaveWidth, uniform_word(wave, i->src[0]));
  } else if (!is_several(active) || !have_same_word(offsets, active)) {
    return run_lanes<kAtomic>(wave, i, row, bytes, active, offsets.lane);
  }
  std::uint32_t* word = aligned_word(bytes, offsets.lane[first_of(active)] + row.added);
  const std::uint32_t* operand = row.data[0] != kNoOperand ? reg(wave, row.data[0]).lane : nullptr;
  std::uint32_t* result = i->dst != kNoOperand ? reg(wave, i->dst).lane : nullptr;
  if (word != nullptr && operand != nullptr && combine_lanes<kAtomic>(row.atomic, word, operand, active, result))
    return;
  run_lanes<kAtomic>(wave, i, row, bytes, active, offsets.lane);
}

template <bool kUniform>
const Instruction* on_buffer(Wave& wave, const Instruction* i) {
  const MemoryOp& row = memory_op(wave, i);
  clear_result(wave, i->dst);
  for_each_buffer(wave, row, wave.active & wave.live,
                  [&](const Bytes& bytes, base::LaneMask active) { run<true>(wave, i, row, bytes, active, kUniform); });
  return i + 1;
}

template <bool kUniform>
const Instruction* on_shared(Wave& wave, const Instruction* i) {
  const MemoryOp& row = memory_op(wave, i);
  clear_result(wave, i->dst);
  run<false>(wave, i, row, shared_bytes(wave), wave.active & wave.live, kUniform);
  return i + 1;
}

}  // namespace

const Instruction* atomic_global(Wave& wave, const Instruction* i) {
  const MemoryOp& row = memory_op(wave, i);
  clear_result(wave, i->dst);
  for_each_stretch(wave, i, row, wave.active & wave.live,
                   [&](const Bytes& bytes, base::LaneMask lanes, const base::WaveRegister& offset) {
                     run_lanes<true>(wave, i, row, bytes, lanes, offset.lane);
                   });
  return i + 1;
}

Handler atomic_buffer(bool uniform) { return uniform ? on_buffer<true> : on_buffer<false>; }
Handler atomic_shared(bool uniform) { return uniform ? on_shared<true> : on_shared<false>; }

}  // namespace vitrine::spirv::exec

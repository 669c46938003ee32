// Local arrays that stayed in memory: element e of lane l lies at array_base + e*256 + l*4. Indices are clamped to the
// last element (lavapipe-shader-math.md section 10).
#include <algorithm>

#include "spirv/exec/buffers.h"
#include "spirv/exec/handlers.h"

namespace vitrine::spirv::exec {
namespace {

std::uint32_t* element(Wave& wave, const MemoryOp& row, std::uint32_t index) {
  const std::uint32_t clamped = std::min(index + row.added, row.array_elements - 1);
  return reinterpret_cast<std::uint32_t*>(wave.arrays + row.array_base) + std::size_t{clamped} * base::kWaveWidth;
}

template <bool kUniform>
const Instruction* load(Wave& wave, const Instruction* i) {
  const MemoryOp& row = memory_op(wave, i);
  std::uint32_t* to = reg(wave, i->dst).lane;
  if constexpr (kUniform) {
    std::memcpy(to, element(wave, row, uniform_word(wave, i->src[0])), sizeof(base::WaveRegister));
  } else {
    const std::uint32_t* index = reg(wave, i->src[0]).lane;
    for (std::size_t lane = 0; lane < base::kWaveWidth; ++lane) to[lane] = element(wave, row, index[lane])[lane];
  }
  return i + 1;
}

template <bool kUniform>
const Instruction* store(Wave& wave, const Instruction* i) {
  const MemoryOp& row = memory_op(wave, i);
  const std::uint32_t* from = reg(wave, i->src[1]).lane;
  if constexpr (kUniform) {
    std::uint32_t* to = element(wave, row, uniform_word(wave, i->src[0]));
    if (wave.active == base::kAllLanes) {
      std::memcpy(to, from, sizeof(base::WaveRegister));
    } else {
      base::for_each_lane(wave.active, [&](std::size_t lane) { to[lane] = from[lane]; });
    }
  } else {
    const std::uint32_t* index = reg(wave, i->src[0]).lane;
    base::for_each_lane(wave.active, [&](std::size_t lane) { element(wave, row, index[lane])[lane] = from[lane]; });
  }
  return i + 1;
}

}  // namespace

const Instruction* clear_arrays(Wave& wave, const Instruction* i) {
  std::memset(wave.arrays, 0, wave.program->array_bytes);
  return i + 1;
}

Handler load_array(bool uniform) { return uniform ? load<true> : load<false>; }
Handler store_array(bool uniform) { return uniform ? store<true> : store<false>; }

}  // namespace vitrine::spirv::exec

// Values that an invocation learns from where it runs: workgroup, lane, helper state.
#include "spirv/exec/handlers.h"
#include "spirv/exec/operands.h"

#include <chrono>

namespace vitrine::spirv::exec {
namespace {

template <class F>
const Instruction* fill(Wave& wave, const Instruction* i, F&& value) {
  std::uint32_t* to = reg(wave, i->dst).lane;
  for (std::uint32_t lane = 0; lane < base::kWaveWidth; ++lane) to[lane] = value(lane);
  return i + 1;
}

int first_lane(base::LaneMask lanes) { return lanes != 0 ? std::countr_zero(lanes) : 0; }

}  // namespace

const Instruction* helper_invocation(Wave& wave, const Instruction* i) {
  mask(wave, i->dst) = ~wave.live;
  return i + 1;
}

const Instruction* elect(Wave& wave, const Instruction* i) {
  const base::LaneMask lanes = participants(wave);
  mask(wave, i->dst) = lanes & (~lanes + 1);
  return i + 1;
}

const Instruction* read_first(Wave& wave, const Instruction* i) {
  uniform_word(wave, i->dst) = reg(wave, i->src[0]).lane[first_lane(participants(wave))];
  return i + 1;
}

const Instruction* read_clock(Wave& wave, const Instruction* i) {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  const auto time = static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(now).count());
  uniform_word(wave, i->dst) = static_cast<std::uint32_t>(time >> (i->extra[0] * 32));
  return i + 1;
}

const Instruction* read_first_mask(Wave& wave, const Instruction* i) {
  const int lane = first_lane(participants(wave));
  uniform_word(wave, i->dst) = static_cast<std::uint32_t>(mask(wave, i->src[0]) >> lane & 1);
  return i + 1;
}

const Instruction* workgroup_id(Wave& wave, const Instruction* i) {
  uniform_word(wave, i->dst) = wave.workgroup_id[i->extra[0]];
  return i + 1;
}

const Instruction* num_workgroups(Wave& wave, const Instruction* i) {
  uniform_word(wave, i->dst) = wave.num_workgroups[i->extra[0]];
  return i + 1;
}

const Instruction* subgroup_id(Wave& wave, const Instruction* i) {
  uniform_word(wave, i->dst) = wave.first_invocation / static_cast<std::uint32_t>(base::kWaveWidth);
  return i + 1;
}

const Instruction* local_invocation_id(Wave& wave, const Instruction* i) {
  const std::uint32_t* size = wave.program->local_size;
  const std::uint32_t stride = i->extra[0] == 0 ? 1 : i->extra[0] == 1 ? size[0] : size[0] * size[1];
  const std::uint32_t extent = size[i->extra[0]];
  const std::uint32_t first = wave.first_invocation;
  if (extent == 1) return fill(wave, i, [](std::uint32_t) { return 0u; });
  if (std::has_single_bit(stride) && std::has_single_bit(extent)) {
    const int shift = std::countr_zero(stride);
    return fill(wave, i, [=](std::uint32_t lane) { return (first + lane) >> shift & (extent - 1); });
  }
  std::uint32_t value = first / stride % extent, left = stride - first % stride;
  return fill(wave, i, [=](std::uint32_t) mutable {
    const std::uint32_t result = value;
    if (--left == 0) {
      left = stride;
      value = value + 1 == extent ? 0 : value + 1;
    }
    return result;
  });
}

const Instruction* local_invocation_index(Wave& wave, const Instruction* i) {
  return fill(wave, i, [&](std::uint32_t lane) { return wave.first_invocation + lane; });
}

const Instruction* subgroup_invocation(Wave& wave, const Instruction* i) {
  return fill(wave, i, [](std::uint32_t lane) { return lane; });
}

}  // namespace vitrine::spirv::exec

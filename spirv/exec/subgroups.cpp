// Group operations over the lanes of a subgroup (Vulkan, Group Operations). A wave holds one subgroup or several; each
// starts at a multiple of its size. Reductions go from the lowest lane to the highest, so that sums of floats have one
// result.
#include <limits>

#include "base/numeric.h"
#include "spirv/exec/handlers.h"
#include "spirv/exec/operands.h"

namespace vitrine::spirv::exec {
namespace {

using base::LaneMask;
using ir::GroupMode;
using ir::GroupOp;

/// Lanes of the subgroup or cluster of `size` that starts at `first` which take part.
LaneMask participants(const Wave& wave, std::uint32_t first, std::uint32_t size) {
  const LaneMask all = base::first_lanes(size) << first;
  const LaneMask lanes = wave.active & wave.live & all;
  return lanes != 0 ? lanes : wave.active & all;
}

LaneMask ballot_of(const Wave& wave, LaneMask holds, std::uint32_t first, std::uint32_t size) {
  return (participants(wave, first, size) & holds) >> first;
}

std::uint32_t word_of(LaneMask lanes, std::uint32_t word) { return static_cast<std::uint32_t>(lanes >> (32 * word)); }

/// The result of no lanes at all.
constexpr std::uint32_t identity(GroupOp op) {
  switch (op) {
    case GroupOp::kIMul:
      return 1;
    case GroupOp::kFMul:
      return 0x3f800000;
    case GroupOp::kIMin:
      return 0x7fffffff;
    case GroupOp::kUMin:
    case GroupOp::kAnd:
      return 0xffffffff;
    case GroupOp::kFMin:
      return 0x7f800000;  // +Inf
    case GroupOp::kIMax:
      return 0x80000000;
    case GroupOp::kFMax:
      return 0xff800000;  // -Inf
    default:
      return 0;
  }
}

template <GroupOp kOp>
std::uint32_t combine(std::uint32_t value, std::uint32_t sum) {
  const auto signed_value = static_cast<std::int32_t>(value), signed_sum = static_cast<std::int32_t>(sum);
  const float a = base::float_of(value), b = base::float_of(sum);
  switch (kOp) {
    case GroupOp::kIAdd:
      return value + sum;
    case GroupOp::kFAdd:
      return base::bits_of(a + b);
    case GroupOp::kIMul:
      return value * sum;
    case GroupOp::kFMul:
      return base::bits_of(a * b);
    case GroupOp::kIMin:
      return signed_value < signed_sum ? value : sum;
    case GroupOp::kUMin:
      return value < sum ? value : sum;
    case GroupOp::kFMin:
      return a < b ? value : sum;
    case GroupOp::kIMax:
      return signed_value > signed_sum ? value : sum;
    case GroupOp::kUMax:
      return value > sum ? value : sum;
    case GroupOp::kFMax:
      return a > b ? value : sum;
    case GroupOp::kAnd:
      return value & sum;
    case GroupOp::kOr:
      return value | sum;
    case GroupOp::kXor:
      return value ^ sum;
  }
}

template <GroupOp kOp>
std::uint32_t total(const std::uint32_t* from, LaneMask lanes) {
  std::uint32_t sum = identity(kOp);
  base::for_each_lane(lanes, [&](std::size_t lane) { sum = combine<kOp>(from[lane], sum); });
  return sum;
}

template <GroupOp kOp>
const Instruction* reduce_uniform(Wave& wave, const Instruction* i) {
  uniform_word(wave, i->dst) = total<kOp>(reg(wave, i->src[0]).lane, exec::participants(wave));
  return i + 1;
}

template <GroupOp kOp, GroupMode kMode>
const Instruction* reduce_lanes(Wave& wave, const Instruction* i) {
  const base::WaveRegister& from = reg(wave, i->src[0]);
  std::uint32_t* to = reg(wave, i->dst).lane;
  const std::uint32_t size = i->extra[0];
  for (std::uint32_t first = 0; first < base::kWaveWidth; first += size) {
    const LaneMask lanes = participants(wave, first, size);
    if constexpr (kMode == GroupMode::kReduce) {
      std::fill_n(to + first, size, total<kOp>(from.lane, lanes));
    } else {
      std::uint32_t sum = identity(kOp);
      base::for_each_lane(lanes, [&](std::size_t lane) {
        const std::uint32_t next = combine<kOp>(from.lane[lane], sum);
        to[lane] = kMode == GroupMode::kInclusive ? next : sum;
        sum = next;
      });
    }
  }
  return i + 1;
}

template <GroupOp kOp>
Handler reduce_handler(GroupMode mode, bool uniform) {
  if (uniform) return reduce_uniform<kOp>;
  switch (mode) {
    case GroupMode::kReduce:
      return reduce_lanes<kOp, GroupMode::kReduce>;
    case GroupMode::kInclusive:
      return reduce_lanes<kOp, GroupMode::kInclusive>;
    case GroupMode::kExclusive:
      return reduce_lanes<kOp, GroupMode::kExclusive>;
  }
  return nullptr;
}

}  // namespace

const Instruction* ballot(Wave& wave, const Instruction* i) {
  const LaneMask holds = mask(wave, i->src[0]);
  std::uint32_t* to = reg(wave, i->dst).lane;
  const std::uint32_t size = i->extra[0];
  for (std::uint32_t first = 0; first < base::kWaveWidth; first += size)
    std::fill_n(to + first, size, word_of(ballot_of(wave, holds, first, size), i->extra[1]));
  return i + 1;
}

const Instruction* ballot_uniform(Wave& wave, const Instruction* i) {
  uniform_word(wave, i->dst) = word_of(exec::participants(wave) & mask(wave, i->src[0]), i->extra[1]);
  return i + 1;
}

const Instruction* shuffle(Wave& wave, const Instruction* i) {
  const base::WaveRegister& from = reg(wave, i->src[0]);
  const std::uint32_t* index = reg(wave, i->src[1]).lane;
  std::uint32_t* to = reg(wave, i->dst).lane;
  const std::uint32_t inside = i->extra[0] - 1;
  for (std::uint32_t lane = 0; lane < base::kWaveWidth; ++lane)
    to[lane] = from.lane[(lane & ~inside) | (index[lane] & inside)];
  return i + 1;
}

Handler reduce(GroupOp op, GroupMode mode, bool uniform) {
  switch (op) {
    case GroupOp::kIAdd:
      return reduce_handler<GroupOp::kIAdd>(mode, uniform);
    case GroupOp::kFAdd:
      return reduce_handler<GroupOp::kFAdd>(mode, uniform);
    case GroupOp::kIMul:
      return reduce_handler<GroupOp::kIMul>(mode, uniform);
    case GroupOp::kFMul:
      return reduce_handler<GroupOp::kFMul>(mode, uniform);
    case GroupOp::kIMin:
      return reduce_handler<GroupOp::kIMin>(mode, uniform);
    case GroupOp::kUMin:
      return reduce_handler<GroupOp::kUMin>(mode, uniform);
    case GroupOp::kFMin:
      return reduce_handler<GroupOp::kFMin>(mode, uniform);
    case GroupOp::kIMax:
      return reduce_handler<GroupOp::kIMax>(mode, uniform);
    case GroupOp::kUMax:
      return reduce_handler<GroupOp::kUMax>(mode, uniform);
    case GroupOp::kFMax:
      return reduce_handler<GroupOp::kFMax>(mode, uniform);
    case GroupOp::kAnd:
      return reduce_handler<GroupOp::kAnd>(mode, uniform);
    case GroupOp::kOr:
      return reduce_handler<GroupOp::kOr>(mode, uniform);
    case GroupOp::kXor:
      return reduce_handler<GroupOp::kXor>(mode, uniform);
  }
  return nullptr;
}

}  // namespace vitrine::spirv::exec

// Group operations over the lanes of a subgroup (Vulkan, Group Operations). A wave holds one subgroup or several; each
// starts at a multiple of its size. Reductions go from the lowest lane to the highest, so that sums of floats have one
// result.
#include <bit>
#include <limits>
#include <type_traits>

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
  return exec::participants(wave, base::first_lanes(size) << first);
}

LaneMask ballot_of(const Wave& wave, LaneMask holds, std::uint32_t first, std::uint32_t size) {
  return (participants(wave, first, size) & holds) >> first;
}

std::uint32_t word_of(LaneMask lanes, std::uint32_t word) { return static_cast<std::uint32_t>(lanes >> (32 * word)); }

/// The floating-point number in a word of 32 or 64 bits.
template <class Word>
using FloatOf = std::conditional_t<sizeof(Word) == 4, float, double>;

/// The result of no lanes at all.
template <GroupOp kOp, class Word>
constexpr Word identity() {
  using Float = FloatOf<Word>;
  using Signed = std::make_signed_t<Word>;
  switch (kOp) {
    case GroupOp::kIMul:
      return 1;
    case GroupOp::kFMul:
    case GroupOp::kHMul:
      return std::bit_cast<Word>(Float{1});
    case GroupOp::kIMin:
      return static_cast<Word>(std::numeric_limits<Signed>::max());
    case GroupOp::kUMin:
    case GroupOp::kAnd:
      return static_cast<Word>(~Word{0});
    case GroupOp::kFMin:
      return std::bit_cast<Word>(std::numeric_limits<Float>::infinity());
    case GroupOp::kIMax:
      return static_cast<Word>(std::numeric_limits<Signed>::min());
    case GroupOp::kFMax:
      return std::bit_cast<Word>(-std::numeric_limits<Float>::infinity());
    default:
      return 0;
  }
}

/// A binary32 number rounded to binary16; numbers of 64 bits stay (no operation of kH* has them).
std::uint32_t rounded(float value) { return base::bits_of(base::half_to_float(base::float_to_half_nearest(value))); }
std::uint64_t rounded(double value) { return std::bit_cast<std::uint64_t>(value); }

template <GroupOp kOp, class Word>
Word combine(Word value, Word sum) {
  using Signed = std::make_signed_t<Word>;
  const auto signed_value = static_cast<Signed>(value), signed_sum = static_cast<Signed>(sum);
  const auto a = std::bit_cast<FloatOf<Word>>(value), b = std::bit_cast<FloatOf<Word>>(sum);
  switch (kOp) {
    case GroupOp::kIAdd:
      return value + sum;
    case GroupOp::kFAdd:
      return std::bit_cast<Word>(a + b);
    case GroupOp::kHAdd:
      return rounded(a + b);
    case GroupOp::kIMul:
      return value * sum;
    case GroupOp::kFMul:
      return std::bit_cast<Word>(a * b);
    case GroupOp::kHMul:
      return rounded(a * b);
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

/// Calls f(lane) for the lanes that take part of `size` from `first` on, the lowest first.
template <class F>
void for_participants(LaneMask lanes, std::uint32_t first, std::uint32_t size, F&& f) {
  if (lanes != base::first_lanes(size) << first) return base::for_each_lane(lanes, f);
  for (std::size_t lane = first; lane < first + size; ++lane) f(lane);
}

template <GroupOp kOp>
std::uint32_t total(const std::uint32_t* from, LaneMask lanes, std::uint32_t first, std::uint32_t size) {
  auto sum = identity<kOp, std::uint32_t>();
  for_participants(lanes, first, size, [&](std::size_t lane) { sum = combine<kOp>(from[lane], sum); });
  return sum;
}

template <GroupOp kOp>
const Instruction* reduce_uniform(Wave& wave, const Instruction* i) {
  uniform_word(wave, i->dst) = total<kOp>(reg(wave, i->src[0]).lane, exec::participants(wave), 0, base::kWaveWidth);
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
      std::fill_n(to + first, size, total<kOp>(from.lane, lanes, first, size));
    } else {
      auto sum = identity<kOp, std::uint32_t>();
      for_participants(lanes, first, size, [&](std::size_t lane) {
        const std::uint32_t next = combine<kOp>(from.lane[lane], sum);
        to[lane] = kMode == GroupMode::kInclusive ? next : sum;
        sum = next;
      });
    }
  }
  return i + 1;
}

template <GroupOp kOp, GroupMode kMode>
const Instruction* reduce_pairs(Wave& wave, const Instruction* i) {
  const std::uint32_t *low = reg(wave, i->src[0]).lane, *high = reg(wave, i->src[1]).lane;
  const auto put = [&](std::size_t lane, std::uint64_t value) {
    if (i->dst != kNoOperand) reg(wave, i->dst).lane[lane] = static_cast<std::uint32_t>(value);
    if (i->extra[1] != kNoOperand) reg(wave, i->extra[1]).lane[lane] = static_cast<std::uint32_t>(value >> 32);
  };
  const std::uint32_t size = i->extra[0];
  for (std::uint32_t first = 0; first < base::kWaveWidth; first += size) {
    const LaneMask lanes = participants(wave, first, size);
    auto sum = identity<kOp, std::uint64_t>();
    for_participants(lanes, first, size, [&](std::size_t lane) {
      const std::uint64_t next = combine<kOp>(std::uint64_t{high[lane]} << 32 | low[lane], sum);
      if (kMode != GroupMode::kReduce) put(lane, kMode == GroupMode::kInclusive ? next : sum);
      sum = next;
    });
    for (std::size_t lane = first; lane < first + size && kMode == GroupMode::kReduce; ++lane) put(lane, sum);
  }
  return i + 1;
}

template <GroupOp kOp>
Handler wide_handler(GroupMode mode) {
  switch (mode) {
    case GroupMode::kReduce:
      return reduce_pairs<kOp, GroupMode::kReduce>;
    case GroupMode::kInclusive:
      return reduce_pairs<kOp, GroupMode::kInclusive>;
    case GroupMode::kExclusive:
      return reduce_pairs<kOp, GroupMode::kExclusive>;
  }
  return nullptr;
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

/// Calls f.operator()<kOp>() for the operation `op`.
template <class F>
Handler with_operation(GroupOp op, const F& f) {
  switch (op) {
    case GroupOp::kIAdd:
      return f.template operator()<GroupOp::kIAdd>();
    case GroupOp::kFAdd:
      return f.template operator()<GroupOp::kFAdd>();
    case GroupOp::kHAdd:
      return f.template operator()<GroupOp::kHAdd>();
    case GroupOp::kIMul:
      return f.template operator()<GroupOp::kIMul>();
    case GroupOp::kFMul:
      return f.template operator()<GroupOp::kFMul>();
    case GroupOp::kHMul:
      return f.template operator()<GroupOp::kHMul>();
    case GroupOp::kIMin:
      return f.template operator()<GroupOp::kIMin>();
    case GroupOp::kUMin:
      return f.template operator()<GroupOp::kUMin>();
    case GroupOp::kFMin:
      return f.template operator()<GroupOp::kFMin>();
    case GroupOp::kIMax:
      return f.template operator()<GroupOp::kIMax>();
    case GroupOp::kUMax:
      return f.template operator()<GroupOp::kUMax>();
    case GroupOp::kFMax:
      return f.template operator()<GroupOp::kFMax>();
    case GroupOp::kAnd:
      return f.template operator()<GroupOp::kAnd>();
    case GroupOp::kOr:
      return f.template operator()<GroupOp::kOr>();
    case GroupOp::kXor:
      return f.template operator()<GroupOp::kXor>();
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
  if (wave.active == base::kAllLanes) {
    for (std::uint32_t lane = 0; lane < base::kWaveWidth; ++lane)
      to[lane] = from.lane[(lane & ~inside) | (index[lane] & inside)];
    return i + 1;
  }
  // What an inactive lane has is undefined, and could be another wave's.
  for (std::uint32_t lane = 0; lane < base::kWaveWidth; ++lane) {
    const std::uint32_t other = (lane & ~inside) | (index[lane] & inside);
    to[lane] = (wave.active >> other & 1) != 0 ? from.lane[other] : 0;
  }
  return i + 1;
}

Handler reduce(GroupOp op, GroupMode mode, bool uniform) {
  return with_operation(op, [&]<GroupOp kOp>() { return reduce_handler<kOp>(mode, uniform); });
}

Handler reduce_wide(GroupOp op, GroupMode mode) {
  return with_operation(op, [&]<GroupOp kOp>() { return wide_handler<kOp>(mode); });
}

}  // namespace vitrine::spirv::exec

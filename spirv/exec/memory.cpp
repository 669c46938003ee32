// Loads and stores of buffers, push constants and shared memory with one address per lane. Addresses that are equal,
// adjacent or evenly spaced become vector loads; the rest are gathers. Words out of range read 0, stores there are
// dropped (lavapipe-shader-math.md section 10).
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "spirv/exec/memory.cpp"
#include <algorithm>

#include "base/simd.h"

#include <hwy/foreach_target.h>

#include "base/lane_math-inl.h"
#include "spirv/exec/buffers.h"
#include "spirv/exec/handlers.h"

HWY_BEFORE_NAMESPACE();
namespace vitrine::spirv::exec::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
namespace lanes = vitrine::base::HWY_NAMESPACE;

using Words = hn::ScalableTag<std::uint32_t>;
using Register = base::WaveRegister;

/// Lanes are the first ones of the wave, so that an even spacing can be looked for: how many; 0 if not.
std::size_t prefix_length(base::LaneMask active) {
  const auto count = static_cast<std::size_t>(std::countr_one(active));
  return active == base::first_lanes(count) ? count : 0;
}

/// Offset of lane i is start + i*stride for the first `count` lanes.
struct Linear {
  bool valid = false;
  std::uint32_t start = 0, stride = 0;
};

Linear find_linear(const Register& offset, std::size_t count) {
  const Words d;
  Linear linear{true, offset.lane[0], count > 1 ? offset.lane[1] - offset.lane[0] : 4};
  const auto step = hn::Set(d, linear.stride * static_cast<std::uint32_t>(hn::Lanes(d)));
  auto expected = hn::Add(hn::Set(d, linear.start), hn::Mul(hn::Iota(d, 0), hn::Set(d, linear.stride)));
  auto different = hn::Zero(d);
  std::size_t lane = 0;
  for (; lane + hn::Lanes(d) <= count; lane += hn::Lanes(d), expected = hn::Add(expected, step))
    different = hn::Or(different, hn::Xor(expected, hn::Load(d, offset.lane + lane)));
  linear.valid = hn::AllTrue(d, hn::Eq(different, hn::Zero(d)));
  for (; lane < count && linear.valid; ++lane)
    linear.valid = offset.lane[lane] == linear.start + static_cast<std::uint32_t>(lane) * linear.stride;
  return linear;
}

/// All words of an evenly spaced access lie inside.
bool inside(const Bytes& bytes, const Linear& linear, std::size_t count, std::uint32_t added, std::uint32_t words) {
  const std::uint64_t first = linear.start + added;  // wraps, as every lane's address does
  const std::uint64_t last = first + std::uint64_t{linear.stride} * (count - 1) + 4 * words;
  return last <= bytes.size && last <= UINT32_MAX;
}

void fill(std::uint32_t* to, std::uint32_t value) {
  const Words d;
  for (std::size_t lane = 0; lane < base::kWaveWidth; lane += hn::Lanes(d)) hn::Store(hn::Set(d, value), d, to + lane);
}

/// Structures of 2, 3 or 4 words, one per lane: transposed in registers.
void load_structures(const std::byte* from, std::uint32_t words, std::uint32_t* const to[4]) {
  const Words d;
  const auto* source = reinterpret_cast<const std::uint32_t*>(from);
  hn::Vec<Words> v[4];
  for (std::size_t lane = 0; lane < base::kWaveWidth; lane += hn::Lanes(d), source += words * hn::Lanes(d)) {
    if (words == 2) {
      hn::LoadInterleaved2(d, source, v[0], v[1]);
    } else if (words == 3) {
      hn::LoadInterleaved3(d, source, v[0], v[1], v[2]);
    } else {
      hn::LoadInterleaved4(d, source, v[0], v[1], v[2], v[3]);
    }
    for (std::uint32_t c = 0; c < words; ++c)
      if (to[c] != nullptr) hn::Store(v[c], d, to[c] + lane);
  }
}

/// Loads a vector of structures if the row asks for whole ones at an even spacing. False: not done.
bool try_structures(const Bytes& bytes, const MemoryOp& row, const Register& offset, base::LaneMask active,
                    std::uint32_t* const to[4]) {
  if (row.components < 2 || active != base::kAllLanes || row.at[1] != 4 || (row.components > 2 && row.at[2] != 8) ||
      (row.components > 3 && row.at[3] != 12))
    return false;
  const std::uint32_t stride = offset.lane[1] - offset.lane[0], words = stride / 4;
  if (stride % 4 != 0 || words > 4 || words < row.components) return false;
  const Linear linear = find_linear(offset, base::kWaveWidth);
  if (!linear.valid || !inside(bytes, linear, base::kWaveWidth, row.added, words)) return false;
  load_structures(bytes.data + (linear.start + row.added), words, to);
  return true;
}

/// Loads words at any offsets for the lanes of one vector; `in_range` for the words' first bytes.
HWY_INLINE hn::Vec<Words> gather(const Bytes& bytes, hn::Vec<Words> wanted, hn::Mask<Words> active) {
  const Words d;
  const hn::RebindToSigned<Words> di;
  const auto last = hn::Set(d, static_cast<std::uint32_t>(bytes.size - 4));
  const auto in_range = hn::And(active, hn::Eq(hn::Min(wanted, last), wanted));
  const auto safe = hn::BitCast(di, hn::IfThenElseZero(in_range, wanted));
  return hn::IfThenElseZero(in_range, hn::GatherOffset(d, reinterpret_cast<const std::uint32_t*>(bytes.data), safe));
}

/// One vector of lanes at a time: lanes that share an address or read adjacent words need no gather. (A row of a
/// workgroup's tile is such a vector even where the wave as a whole is not evenly spaced.)
void load_vectors(const Bytes& bytes, const MemoryOp& row, const Register& offset, base::LaneMask active,
                  std::uint32_t* const to[4]) {
  const Words d;
  constexpr std::uint64_t kMaxSpan = 4 * base::kWaveWidth + 16;
  const std::uint32_t highest = *std::max_element(row.at.begin(), row.at.begin() + row.components);
  const auto adjacent = hn::Mul(hn::Iota(d, 0), hn::Set(d, 4u));
  const base::LaneMask vector_lanes = base::first_lanes(hn::Lanes(d));
  for (std::size_t lane = 0; lane < base::kWaveWidth; lane += hn::Lanes(d)) {
    const base::LaneMask wanted_lanes = active >> lane & vector_lanes;
    if (wanted_lanes == 0) continue;
    const auto wanted = hn::Load(d, offset.lane + lane);
    const auto spread = hn::Sub(wanted, hn::Set(d, offset.lane[lane]));
    const std::uint64_t first = offset.lane[lane] + row.added;  // wraps, as every lane's address does
    const bool inner = first + highest + kMaxSpan <= std::min<std::uint64_t>(bytes.size, UINT32_MAX);
    if (inner && wanted_lanes == vector_lanes && hn::AllTrue(d, hn::Eq(spread, adjacent))) {
      for (std::uint32_t c = 0; c < row.components; ++c)
        if (to[c] != nullptr)
          hn::Store(hn::LoadU(d, reinterpret_cast<const std::uint32_t*>(bytes.data + first + row.at[c])), d,
                    to[c] + lane);
    } else if (inner && wanted_lanes == vector_lanes && hn::AllTrue(d, hn::Eq(spread, hn::Zero(d)))) {
      for (std::uint32_t c = 0; c < row.components; ++c)
        if (to[c] != nullptr)
          hn::Store(hn::Set(d, load_word(bytes, static_cast<std::uint32_t>(first + row.at[c]))), d, to[c] + lane);
    } else {
      const auto mask = lanes::lanes_mask_from_bits(d, wanted_lanes);
      for (std::uint32_t c = 0; c < row.components; ++c)
        if (to[c] != nullptr)
          hn::Store(gather(bytes, hn::Add(wanted, hn::Set(d, row.added + row.at[c])), mask), d, to[c] + lane);
    }
  }
}

void load_lanes(const Bytes& bytes, const MemoryOp& row, const Register& offset, base::LaneMask active,
                std::uint32_t* const to[4]) {
  base::for_each_lane(active, [&](std::size_t lane) {
    for (std::uint32_t c = 0; c < row.components; ++c)
      if (to[c] != nullptr) to[c][lane] = load_word(bytes, offset.lane[lane] + row.added + row.at[c]);
  });
}

void load_words(const Bytes& bytes, const MemoryOp& row, const Register& offset, base::LaneMask active,
                std::uint32_t* const to[4]) {
  if (try_structures(bytes, row, offset, active, to)) return;
  if (bytes.size < 4 || bytes.size > INT32_MAX) return load_lanes(bytes, row, offset, active, to);
  load_vectors(bytes, row, offset, active, to);
}

void results(Wave& wave, const MemoryOp& row, std::uint32_t* to[4]) {
  for (std::uint32_t c = 0; c < 4; ++c) to[c] = row.data[c] == kNoOperand ? nullptr : reg(wave, row.data[c]).lane;
}

/// `offset` for an address that all lanes share.
const Register& offsets(Wave& wave, const Instruction* i, bool uniform, Register& spare) {
  if (!uniform) return reg(wave, i->src[0]);
  fill(spare.lane, uniform_word(wave, i->src[0]));
  return spare;
}

template <bool kUniform>
const Instruction* load_buffer_target(Wave& wave, const Instruction* i) {
  const MemoryOp& row = memory_op(wave, i);
  std::uint32_t* to[4];
  results(wave, row, to);
  Register spare;
  const Register& offset = offsets(wave, i, kUniform, spare);
  if (row.index.file != IndexOperand::File::kVarying) {
    for_each_buffer(wave, row, wave.active,
                    [&](const Bytes& bytes, base::LaneMask active) { load_words(bytes, row, offset, active, to); });
    return i + 1;
  }
  for_each_buffer(wave, row, wave.active,
                  [&](const Bytes& bytes, base::LaneMask active) { load_lanes(bytes, row, offset, active, to); });
  return i + 1;
}

const Instruction* load_push_target(Wave& wave, const Instruction* i) {
  const MemoryOp& row = memory_op(wave, i);
  std::uint32_t* to[4];
  results(wave, row, to);
  load_words(push_bytes(wave), row, reg(wave, i->src[0]), wave.active, to);
  return i + 1;
}

const Instruction* load_shared_target(Wave& wave, const Instruction* i) {
  const MemoryOp& row = memory_op(wave, i);
  std::uint32_t* to[4];
  results(wave, row, to);
  load_words(shared_bytes(wave), row, reg(wave, i->src[0]), wave.active, to);
  return i + 1;
}

void store_adjacent(std::byte* to, const std::uint32_t* from, std::size_t count) { std::memcpy(to, from, count * 4); }

/// Structures of 1 to 4 words of the lanes of a vector.
void store_vector(std::byte* to, std::uint32_t words, const std::uint32_t* const from[4], std::size_t lane) {
  const Words d;
  auto* target = reinterpret_cast<std::uint32_t*>(to);
  const auto word = [&](std::size_t i) HWY_ATTR { return hn::Load(d, from[i] + lane); };
  switch (words) {
    case 1:
      return hn::StoreU(word(0), d, target);
    case 2:
      return hn::StoreInterleaved2(word(0), word(1), d, target);
    case 3:
      return hn::StoreInterleaved3(word(0), word(1), word(2), d, target);
    default:
      return hn::StoreInterleaved4(word(0), word(1), word(2), word(3), d, target);
  }
}

void store_structures(std::byte* to, std::uint32_t words, const std::uint32_t* const from[4]) {
  for (std::size_t lane = 0; lane < base::kWaveWidth; lane += hn::Lanes(Words()))
    store_vector(to + 4 * words * lane, words, from, lane);
}

void store_lanes(const Bytes& bytes, const MemoryOp& row, const Register& offset, base::LaneMask active,
                 const std::uint32_t* const from[4]) {
  base::for_each_lane(active, [&](std::size_t lane) {
    for (std::uint32_t c = 0; c < 4; ++c) {
      const std::uint32_t at = offset.lane[lane] + row.added + 4 * c;
      if ((row.write_mask >> c & 1) && contains_word(bytes, at)) std::memcpy(bytes.data + at, from[c] + lane, 4);
    }
  });
}

/// One vector of lanes at a time, whose structures follow one another in a row of a workgroup's tile.
void store_vectors(const Bytes& bytes, const MemoryOp& row, const Register& offset, base::LaneMask active,
                   std::uint32_t words, const std::uint32_t* const from[4]) {
  const Words d;
  const auto adjacent = hn::Mul(hn::Iota(d, 0), hn::Set(d, 4 * words));
  const base::LaneMask vector_lanes = base::first_lanes(hn::Lanes(d));
  const std::uint64_t limit = std::min<std::uint64_t>(bytes.size, UINT32_MAX);
  for (std::size_t lane = 0; lane < base::kWaveWidth; lane += hn::Lanes(d)) {
    const base::LaneMask wanted = active & vector_lanes << lane;
    if (wanted == 0) continue;
    const std::uint32_t first = offset.lane[lane] + row.added;  // wraps, as every lane's address does
    const auto spread = hn::Sub(hn::Load(d, offset.lane + lane), hn::Set(d, offset.lane[lane]));
    const bool inner = std::uint64_t{first} + 4 * words * hn::Lanes(d) <= limit;
    if (inner && wanted == vector_lanes << lane && hn::AllTrue(d, hn::Eq(spread, adjacent))) {
      store_vector(bytes.data + first, words, from, lane);
    } else {
      store_lanes(bytes, row, offset, wanted, from);
    }
  }
}

void store_words(const Bytes& bytes, const MemoryOp& row, const Register& offset, base::LaneMask active,
                 const std::uint32_t* const from[4]) {
  const auto words = static_cast<std::uint32_t>(std::popcount(row.write_mask));
  const bool dense = words != 0 && row.write_mask == (1u << words) - 1;
  const std::size_t count = prefix_length(active);
  if (dense && count != 0) {
    const Linear linear = find_linear(offset, count);
    if (linear.valid && linear.stride == 4 * words && inside(bytes, linear, count, row.added, words)) {
      std::byte* to = bytes.data + (linear.start + row.added);
      if (words == 1) return store_adjacent(to, from[0], count);
      if (count == base::kWaveWidth) return store_structures(to, words, from);
    }
  }
  dense ? store_vectors(bytes, row, offset, active, words, from) : store_lanes(bytes, row, offset, active, from);
}

/// Lanes that store to one address do so in their order: the last remains, and nobody sees the others.
template <bool kUniform>
void store_words_in_order(const Bytes& bytes, const MemoryOp& row, const Register& offset, base::LaneMask active,
                          const std::uint32_t* const from[4]) {
  kUniform ? store_lanes(bytes, row, offset, last_lane(active), from) : store_words(bytes, row, offset, active, from);
}

template <bool kUniform>
const Instruction* store_buffer_target(Wave& wave, const Instruction* i) {
  const MemoryOp& row = memory_op(wave, i);
  std::uint32_t* from[4];
  results(wave, row, from);
  Register spare;
  const Register& offset = offsets(wave, i, kUniform, spare);
  for_each_buffer(wave, row, wave.active & wave.live, [&](const Bytes& bytes, base::LaneMask active) {
    store_words_in_order<kUniform>(bytes, row, offset, active, from);
  });
  return i + 1;
}

template <bool kUniform>
const Instruction* store_shared_target(Wave& wave, const Instruction* i) {
  const MemoryOp& row = memory_op(wave, i);
  std::uint32_t* from[4];
  results(wave, row, from);
  Register spare;
  const Register& offset = offsets(wave, i, kUniform, spare);
  store_words_in_order<kUniform>(shared_bytes(wave), row, offset, wave.active & wave.live, from);
  return i + 1;
}

const Instruction* load_global_target(Wave& wave, const Instruction* i) {
  const MemoryOp& row = memory_op(wave, i);
  std::uint32_t* to[4];
  results(wave, row, to);
  for_each_stretch(wave, i, row, wave.active, [&](const Bytes& bytes, base::LaneMask lanes, const Register& offset) {
    lanes == wave.active ? load_words(bytes, row, offset, lanes, to) : load_lanes(bytes, row, offset, lanes, to);
  });
  return i + 1;
}

const Instruction* store_global_target(Wave& wave, const Instruction* i) {
  const MemoryOp& row = memory_op(wave, i);
  std::uint32_t* from[4];
  results(wave, row, from);
  for_each_stretch(wave, i, row, wave.active & wave.live,
                   [&](const Bytes& bytes, base::LaneMask lanes, const Register& offset) {
                     store_words(bytes, row, offset, lanes, from);
                   });
  return i + 1;
}

Handler load_global_handler() { return load_global_target; }
Handler store_global_handler() { return store_global_target; }
Handler load_buffer_handler(bool uniform) { return uniform ? load_buffer_target<true> : load_buffer_target<false>; }
Handler load_push_handler() { return load_push_target; }
Handler load_shared_handler() { return load_shared_target; }
Handler store_buffer_handler(bool uniform) { return uniform ? store_buffer_target<true> : store_buffer_target<false>; }
Handler store_shared_handler(bool uniform) { return uniform ? store_shared_target<true> : store_shared_target<false>; }

}  // namespace vitrine::spirv::exec::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vitrine::spirv::exec {

HWY_EXPORT(load_buffer_handler);
HWY_EXPORT(load_push_handler);
HWY_EXPORT(load_shared_handler);
HWY_EXPORT(store_buffer_handler);
HWY_EXPORT(store_shared_handler);
HWY_EXPORT(load_global_handler);
HWY_EXPORT(store_global_handler);

Handler load_buffer(bool uniform) { return HWY_DYNAMIC_DISPATCH(load_buffer_handler)(uniform); }
Handler load_push() { return HWY_DYNAMIC_DISPATCH(load_push_handler)(); }
Handler load_shared() { return HWY_DYNAMIC_DISPATCH(load_shared_handler)(); }
Handler store_buffer(bool uniform) { return HWY_DYNAMIC_DISPATCH(store_buffer_handler)(uniform); }
Handler load_global() { return HWY_DYNAMIC_DISPATCH(load_global_handler)(); }
Handler store_global() { return HWY_DYNAMIC_DISPATCH(store_global_handler)(); }
Handler store_shared(bool uniform) { return HWY_DYNAMIC_DISPATCH(store_shared_handler)(uniform); }

}  // namespace vitrine::spirv::exec
#endif

// Loads and stores of numbers of one or two bytes: lane by lane. Those out of range read 0, stores there are dropped
// (lavapipe-shader-math.md section 10).
#include "spirv/exec/buffers.h"
#include "spirv/exec/handlers.h"

namespace vitrine::spirv::exec {
namespace {

bool contains(const Bytes& bytes, std::uint32_t offset, std::uint32_t size) {
  return std::uint64_t{offset} + size <= bytes.size;
}

std::uint32_t load_element(const Bytes& bytes, const MemoryOp& row, std::uint32_t offset) {
  std::uint32_t value = 0;
  if (contains(bytes, offset, row.element_bytes)) std::memcpy(&value, bytes.data + offset, row.element_bytes);
  return value;
}

/// The components of one lane, from byte `first` on.
void load_components(Wave& wave, const MemoryOp& row, const Bytes& bytes, std::size_t lane, std::uint32_t first) {
  for (std::uint32_t c = 0; c < row.components; ++c)
    if (row.data[c] != kNoOperand) reg(wave, row.data[c]).lane[lane] = load_element(bytes, row, first + row.at[c]);
}

/// Calls f(bytes, lanes) for what the row's space is.
template <Space space, class F>
void for_each_memory(Wave& wave, const MemoryOp& row, base::LaneMask active, F&& f) {
  if constexpr (space == Space::kBuffer) {
    for_each_buffer(wave, row, active, f);
  } else if constexpr (space == Space::kPush) {
    f(push_bytes(wave), active);
  } else {
    f(shared_bytes(wave), active);
  }
}

/// Byte offset of a lane; src[0] is a register or a uniform word.
template <bool uniform>
std::uint32_t offset_of(Wave& wave, const Instruction* i, std::size_t lane) {
  if constexpr (uniform) {
    static_cast<void>(lane);
    return uniform_word(wave, i->src[0]);
  } else {
    return reg(wave, i->src[0]).lane[lane];
  }
}

template <Space space, bool uniform>
const Instruction* load_lanes(Wave& wave, const Instruction* i) {
  const MemoryOp& row = memory_op(wave, i);
  for_each_memory<space>(wave, row, wave.active, [&](const Bytes& bytes, base::LaneMask active) {
    base::for_each_lane(active, [&](std::size_t lane) {
      load_components(wave, row, bytes, lane, offset_of<uniform>(wave, i, lane) + row.added);
    });
  });
  return i + 1;
}

/// Into the uniform file: address and array element are uniform.
template <Space space>
const Instruction* load_words(Wave& wave, const Instruction* i) {
  const MemoryOp& row = memory_op(wave, i);
  const std::uint32_t offset = uniform_word(wave, i->src[0]) + row.added;
  Bytes bytes;
  if constexpr (space == Space::kBuffer)
    bytes = buffer_bytes(wave, row,
                         row.index.file == IndexOperand::File::kUniform ? uniform_word(wave, row.index.value) : 0);
  else
    bytes = space == Space::kPush ? push_bytes(wave) : shared_bytes(wave);
  for (std::uint32_t c = 0; c < row.components; ++c)
    if (row.data[c] != kNoOperand) uniform_word(wave, row.data[c]) = load_element(bytes, row, offset + row.at[c]);
  return i + 1;
}

/// The components of one lane, from byte `first` on.
void store_components(Wave& wave, const MemoryOp& row, const Bytes& bytes, std::size_t lane, std::uint32_t first) {
  const std::uint32_t size = row.element_bytes;
  for (std::uint32_t c = 0; c < 4; ++c) {
    const std::uint32_t offset = first + c * size;
    if ((row.write_mask >> c & 1) != 0 && contains(bytes, offset, size))
      std::memcpy(bytes.data + offset, &reg(wave, row.data[c]).lane[lane], size);
  }
}

template <Space space, bool uniform>
const Instruction* store_lanes(Wave& wave, const Instruction* i) {
  const MemoryOp& row = memory_op(wave, i);
  for_each_memory<space>(wave, row, wave.active & wave.live, [&](const Bytes& bytes, base::LaneMask active) {
    base::for_each_lane(uniform ? last_lane(active) : active, [&](std::size_t lane) {
      store_components(wave, row, bytes, lane, offset_of<uniform>(wave, i, lane) + row.added);
    });
  });
  return i + 1;
}

/// Behind pointers.
const Instruction* load_pointers(Wave& wave, const Instruction* i) {
  const MemoryOp& row = memory_op(wave, i);
  for_each_stretch(
      wave, i, row, wave.active, [&](const Bytes& bytes, base::LaneMask active, const base::WaveRegister& offset) {
        base::for_each_lane(
            active, [&](std::size_t lane) { load_components(wave, row, bytes, lane, offset.lane[lane] + row.added); });
      });
  return i + 1;
}

const Instruction* store_pointers(Wave& wave, const Instruction* i) {
  const MemoryOp& row = memory_op(wave, i);
  for_each_stretch(wave, i, row, wave.active & wave.live,
                   [&](const Bytes& bytes, base::LaneMask active, const base::WaveRegister& start) {
                     base::for_each_lane(active, [&](std::size_t lane) {
                       store_components(wave, row, bytes, lane, start.lane[lane] + row.added);
                     });
                   });
  return i + 1;
}

}  // namespace

Handler load_narrow(Space space, bool uniform) {
  switch (space) {
    case Space::kBuffer:
      return uniform ? load_lanes<Space::kBuffer, true> : load_lanes<Space::kBuffer, false>;
    case Space::kPush:
      return uniform ? load_lanes<Space::kPush, true> : load_lanes<Space::kPush, false>;
    case Space::kGlobal:
      return load_pointers;
    default:
      return uniform ? load_lanes<Space::kShared, true> : load_lanes<Space::kShared, false>;
  }
}

Handler load_narrow_uniform(Space space) {
  return space == Space::kBuffer ? load_words<Space::kBuffer>
         : space == Space::kPush ? load_words<Space::kPush>
                                 : load_words<Space::kShared>;
}

Handler store_narrow(Space space, bool uniform) {
  if (space == Space::kGlobal) return store_pointers;
  if (space == Space::kBuffer) return uniform ? store_lanes<Space::kBuffer, true> : store_lanes<Space::kBuffer, false>;
  return uniform ? store_lanes<Space::kShared, true> : store_lanes<Space::kShared, false>;
}

}  // namespace vitrine::spirv::exec

// Which bytes a memory instruction may touch: descriptors resolved with bounds, robust by default (design.md section
// 6).
#pragma once

#include <algorithm>
#include <bit>

#include "spirv/addresses.h"
#include "spirv/exec/operands.h"

namespace vitrine::spirv::exec {

struct Bytes {
  std::byte* data = nullptr;
  std::uint64_t size = 0;
};

inline const MemoryOp& memory_op(const Wave& wave, const Instruction* instruction) {
  return wave.program->memory_ops[instruction->extra[0]];
}

/// The descriptor at a slot, or null.
inline const Descriptor* find_descriptor(const Wave& wave, std::uint32_t set, std::uint32_t slot) {
  if (set == ir::kAnySet) {
    set = ir::BufferHandle::set(slot);
    slot = ir::BufferHandle::slot(slot);
  }
  if (set > kMaxSets || slot >= wave.resources->set_size[set]) return nullptr;
  return wave.resources->set[set] == nullptr ? nullptr : wave.resources->set[set] + slot;
}

/// The bound range of array element `element` (beyond row.slot) of the binding.
inline Bytes buffer_bytes(const Wave& wave, const MemoryOp& row, std::uint32_t element) {
  if (element != 0 && element >= row.count) return {};
  const Descriptor* descriptor = find_descriptor(wave, row.set, row.slot + element);
  return descriptor ? Bytes{descriptor->data, descriptor->size} : Bytes{};
}

/// Whether the 32-bit word at `offset` lies inside.
inline bool contains_word(const Bytes& bytes, std::uint32_t offset) { return std::uint64_t{offset} + 4 <= bytes.size; }

inline std::uint32_t load_word(const Bytes& bytes, std::uint32_t offset) {
  std::uint32_t word = 0;
  if (contains_word(bytes, offset)) std::memcpy(&word, bytes.data + offset, sizeof(word));
  return word;
}

/// Calls f(bytes, lanes) once per distinct array element among `active`.
template <class F>
inline void for_each_buffer(Wave& wave, const MemoryOp& row, base::LaneMask active, F&& f) {
  if (row.index.file == IndexOperand::File::kConstant) return f(buffer_bytes(wave, row, 0), active);
  if (row.index.file == IndexOperand::File::kUniform)
    return f(buffer_bytes(wave, row, uniform_word(wave, row.index.value)), active);
  const base::WaveRegister& index = reg(wave, row.index.value);
  while (active != 0) {
    const std::uint32_t element = index.lane[std::countr_zero(active)];
    base::LaneMask same = 0;
    base::for_each_lane(active, [&](std::size_t lane) {
      if (index.lane[lane] == element) same |= base::LaneMask{1} << lane;
    });
    f(buffer_bytes(wave, row, element), same);
    active &= ~same;
  }
}

/// The highest of `lanes`, if there is one.
inline base::LaneMask last_lane(base::LaneMask lanes) {
  return lanes == 0 ? 0 : base::LaneMask{1} << (std::bit_width(lanes) - 1);
}

/// Calls f(bytes, lanes, offsets) for the memory behind the pointers of `active`: lanes whose addresses lie in the same
/// stretch of live memory together, others alone and with no bytes. `offsets` (plus row.added) counts from bytes.data.
template <class F>
inline void for_each_stretch(Wave& wave, const Instruction* i, const MemoryOp& row, base::LaneMask active, F&& f) {
  constexpr std::uint64_t kReach = std::uint64_t{1} << 30;  // offsets inside a stretch are 31-bit
  const base::WaveRegister &low = reg(wave, i->src[0]), &high = reg(wave, i->src[1]), &offset = reg(wave, i->src[2]);
  std::uint64_t address[base::kWaveWidth];
  base::for_each_lane(active, [&](std::size_t lane) {
    const auto distance = static_cast<std::int32_t>(offset.lane[lane] + row.added);
    address[lane] = (std::uint64_t{high.lane[lane]} << 32 | low.lane[lane]) +
                    static_cast<std::uint64_t>(static_cast<std::int64_t>(distance));
  });
  base::WaveRegister relative{};
  while (active != 0) {
    const int first = std::countr_zero(active);
    const AddressRange range = find_addresses(address[first]);
    if (range.begin == range.end) {
      f(Bytes{}, base::LaneMask{1} << first, relative);
      active &= active - 1;
      continue;
    }
    const std::uint64_t reach = address[first] - std::min(address[first] - range.begin, kReach);
    const std::uint64_t begin = std::max(range.begin, reach & ~std::uint64_t{7});
    const std::uint64_t end = address[first] + std::min(range.end - address[first], kReach);
    base::LaneMask together = 0;
    base::for_each_lane(active, [&](std::size_t lane) {
      if (address[lane] - begin >= end - begin) return;
      together |= base::LaneMask{1} << lane;
      relative.lane[lane] = static_cast<std::uint32_t>(address[lane] - begin) - row.added;
    });
    f(Bytes{reinterpret_cast<std::byte*>(begin), end - begin}, together, relative);
    active &= ~together;
  }
}

inline Bytes push_bytes(const Wave& wave) {
  return {const_cast<std::byte*>(wave.resources->push_constants),
          wave.resources->push_constants ? kMaxPushConstantBytes : 0};
}
inline Bytes shared_bytes(const Wave& wave) { return {wave.shared, wave.shared_size}; }

}  // namespace vitrine::spirv::exec

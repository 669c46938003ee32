// Which bytes a memory instruction may touch: descriptors resolved with bounds, robust by default (DESIGN.md section
// 6).
#pragma once

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

inline Bytes push_bytes(const Wave& wave) {
  return {const_cast<std::byte*>(wave.resources->push_constants),
          wave.resources->push_constants ? kMaxPushConstantBytes : 0};
}
inline Bytes shared_bytes(const Wave& wave) { return {wave.shared, wave.shared ? wave.program->shared_bytes : 0}; }

}  // namespace vitrine::spirv::exec
